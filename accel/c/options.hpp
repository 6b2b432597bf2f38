// Options as C gives them, and what the classes take instead.
#pragma once

#include <raylanes/bounded_tree.hpp>
#include <raylanes/bvh.hpp>
#include <raylanes/queries.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "call.hpp"

namespace raylanes::c {

raylanes_build_options build_defaults();
raylanes_ray_options ray_defaults();
raylanes_point_options point_defaults();

// Throws std::invalid_argument unless so many bytes may be the beginning of options of `known` bytes.
void require_options_size(std::size_t size, std::size_t known);

// The options given, as far as they go, and the defaults of the others.
template <class Options>
Options completed(const Options* given, const Options& defaults) {
  Options options = defaults;
  if (given == nullptr) return options;
  std::size_t size;
  std::memcpy(&size, given, sizeof size);
  require_options_size(size, sizeof(Options));
  std::memcpy(static_cast<void*>(&options), given, size);
  return options;
}

// The function of C as the classes take it; empty for none.
Progress progress_of(raylanes_progress function, void* context);
// The words of triangles.
std::span<const std::uint32_t> masks_of(const raylanes_ray_options& c);
// Throws std::invalid_argument if there is a filter.
void refuse_filter(const raylanes_ray_options& c);

// From the primitive of a raylanes_scene_hit, and of a raylanes_scene_hit_d.
inline constexpr std::int32_t to_instance_of_hits =
    offsetof(raylanes_scene_hit, instance) - offsetof(raylanes_scene_hit, primitive);

BuildOptions build_options(const raylanes_build_options* given);
BoundedBuildOptions bounded_build_options(const raylanes_build_options* given);

// The options of a call with `count` rays, of any class that the queries of rays have, and what they refer to.
// Behind `after` there are hits of the type AnyHit.
template <class Options, class AnyHit>
class RayOptions {
 public:
  [[gnu::noinline]] RayOptions(const raylanes_ray_options* given, std::size_t count)
      : c_(completed(given, ray_defaults())), progress_(progress_of(c_.progress, c_.progress_context)) {
    options_.path = path_of(c_.path);
    options_.threads = c_.threads;
    options_.facing = enumerator_of<Facing>("facing", c_.facing, facing_names.size());
    options_.active = c_.active;
    if (progress_) options_.progress = &progress_;
    if (c_.skip != nullptr)
      options_.skip = {c_.skip, count, skip_stride(count), is_in_scene ? c_.skip_to_instance : 0};
    if constexpr (requires { options_.mask; }) options_.mask = c_.mask;
    if constexpr (requires { options_.filter_mask; }) options_.filter_mask = c_.filter_mask;
    if constexpr (requires { options_.masks; }) options_.masks = masks_of(c_);
    if constexpr (requires { options_.after; })
      if (c_.after != nullptr)
        options_.after = {c_.after, count,
                          checked_stride("after", c_.after, count, c_.after_stride, sizeof(AnyHit)),
                          is_in_scene ? to_instance_of_hits : 0};
    if constexpr (requires { options_.max_count; })
      options_.max_count = static_cast<std::uint32_t>(
          std::min<std::size_t>(c_.max_count, std::numeric_limits<std::uint32_t>::max()));
  }
  RayOptions(const RayOptions&) = delete;
  RayOptions& operator=(const RayOptions&) = delete;

  // For calls without filters.
  const Options& unfiltered() const {
    refuse_filter(c_);
    return options_;
  }
  // Returns ask(options, filters...) with the filter of a batch, if there is one.
  template <class Ask>
  void ask_batch(const Ask& ask) const {
    if (c_.filter == nullptr) return ask(options_);
    ask(options_, HitFilterOf<AnyHit>([&](std::span<const std::size_t> rays, std::span<const AnyHit> hits,
                                          std::span<std::uint8_t> rejected) {
          if (c_.filter(c_.filter_context, rays.size(), rays.data(), hits.data(), rejected.data()) != 0)
            throw Cancelled();
        }));
  }
  // Returns ask(options, filters...) with the filter of one ray, if there is one.
  template <class Ask>
  auto ask_one(const Ask& ask) const {
    if (c_.filter == nullptr) return ask(options_);
    return ask(options_, [&](const AnyHit& hit) {
      const std::size_t ray = 0;
      std::uint8_t rejected = 0;
      if (c_.filter(c_.filter_context, 1, &ray, &hit, &rejected) != 0) throw Cancelled();
      return rejected != 0;
    });
  }

 private:
  static constexpr bool is_in_scene = requires(const AnyHit& hit) { hit.instance; };
  // Scenes take hits that lie side by side.
  std::size_t skip_stride(std::size_t count) const {
    const bool are_hits = is_in_scene && c_.skip_stride == 0;
    return checked_stride("skip", c_.skip, count, are_hits ? sizeof(AnyHit) : c_.skip_stride,
                          sizeof(std::uint32_t));
  }

  raylanes_ray_options c_;
  Progress progress_;
  Options options_;
};

// The options of a call with points, of any class that the queries of points have, and what they refer to.
template <class Options>
class PointOptions {
 public:
  [[gnu::noinline]] explicit PointOptions(const raylanes_point_options* given) {
    const QuietFloats quiet;  // floats round max_distance
    const raylanes_point_options c = completed(given, point_defaults());
    progress_ = progress_of(c.progress, c.progress_context);
    if (progress_) options_.progress = &progress_;
    options_.path = path_of(c.path);
    options_.threads = c.threads;
    options_.active = c.active;
    if constexpr (requires { options_.rule; })
      options_.rule = enumerator_of<InsideRule>("rule", c.rule, inside_rule_names.size());
    if constexpr (requires { options_.max_distance; })
      options_.max_distance = static_cast<decltype(options_.max_distance)>(c.max_distance);
    if constexpr (requires { options_.accuracy; }) options_.accuracy = c.accuracy;
    if constexpr (requires { options_.mask; }) options_.mask = c.mask;
  }
  PointOptions(const PointOptions&) = delete;
  PointOptions& operator=(const PointOptions&) = delete;
  const Options& operator*() const { return options_; }

 private:
  Progress progress_;
  Options options_;
};

}  // namespace raylanes::c

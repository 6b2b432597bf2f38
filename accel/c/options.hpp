// Options as C gives them, and what the classes take instead.
#pragma once

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

BuildOptions build_options(const raylanes_build_options* given);

// The options of a call with `count` rays, of any class that the queries of rays have.
template <class Options>
Options ray_options(const raylanes_ray_options* given, std::size_t count) {
  const raylanes_ray_options c = completed(given, ray_defaults());
  Options options;
  options.path = path_of(c.path);
  options.threads = c.threads;
  options.facing = enumerator_of<Facing>("facing", c.facing, facing_names.size());
  options.active = c.active;
  if (c.skip != nullptr)
    options.skip = {c.skip, count,
                    checked_stride("skip", c.skip, count, c.skip_stride, sizeof(std::uint32_t))};
  if constexpr (requires { options.after; })
    if (c.after != nullptr)
      options.after = {c.after, count,
                       checked_stride("after", c.after, count, c.after_stride, sizeof(options.after[0]))};
  if constexpr (requires { options.max_count; })
    options.max_count = static_cast<std::uint32_t>(
        std::min<std::size_t>(c.max_count, std::numeric_limits<std::uint32_t>::max()));
  return options;
}

// The options of a call with points, of any class that the queries of points have.
template <class Options>
Options point_options(const raylanes_point_options* given) {
  const QuietFloats quiet;  // floats round max_distance
  const raylanes_point_options c = completed(given, point_defaults());
  Options options;
  options.path = path_of(c.path);
  options.threads = c.threads;
  options.active = c.active;
  if constexpr (requires { options.rule; })
    options.rule = enumerator_of<InsideRule>("rule", c.rule, inside_rule_names.size());
  if constexpr (requires { options.max_distance; })
    options.max_distance = static_cast<decltype(options.max_distance)>(c.max_distance);
  if constexpr (requires { options.accuracy; }) options.accuracy = c.accuracy;
  return options;
}

}  // namespace raylanes::c

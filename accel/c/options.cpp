#include "options.hpp"

#include <raylanes/doubles.hpp>
#include <raylanes/scene.hpp>

namespace raylanes::c {

raylanes_build_options build_defaults() {
  const BuildOptions options;
  return {.size = sizeof(raylanes_build_options),
          .builder = static_cast<std::int32_t>(options.builder),
          .threads = options.threads,
          .optimize = options.optimize,
          .choose = options.choose,
          .rays = options.rays,
          .progress = nullptr,
          .progress_context = nullptr,
          .max_in_leaf = BoundedBuildOptions().max_in_leaf,
          .slack = BoundedBuildOptions().slack};
}

raylanes_ray_options ray_defaults() {
  const ListOptions options;
  return {.size = sizeof(raylanes_ray_options),
          .threads = options.threads,
          .facing = static_cast<std::int32_t>(options.facing),
          .path = nullptr,
          .active = nullptr,
          .skip = nullptr,
          .skip_stride = 0,
          .max_count = std::numeric_limits<std::size_t>::max(),
          .after = nullptr,
          .after_stride = 0,
          .mask = options.mask,
          .skip_to_instance = to_instance_of_hits,
          .filter = nullptr,
          .filter_context = nullptr,
          .progress = nullptr,
          .progress_context = nullptr,
          .masks = nullptr,
          .mask_count = 0,
          .filter_mask = TraceOptions().filter_mask,
          .unused = 0};
}

raylanes_point_options point_defaults() {
  const SignedDistanceOptionsD options;
  return {.size = sizeof(raylanes_point_options),
          .threads = options.threads,
          .rule = static_cast<std::int32_t>(options.rule),
          .path = nullptr,
          .active = nullptr,
          .max_distance = options.max_distance,
          .accuracy = WindingOptions().accuracy,
          .progress = nullptr,
          .progress_context = nullptr,
          .mask = ListOptions().mask,
          .unused = 0};
}

void require_options_size(std::size_t size, std::size_t known) {
  // Each eight bytes are a member, or two.
  if (size < sizeof size || size > known || size % 8 != 0)
    throw std::invalid_argument("options: a size of " + std::to_string(size) +
                                " bytes; allowed are multiples of 8 up to " + std::to_string(known));
}

Progress progress_of(raylanes_progress function, void* context) {
  if (function == nullptr) return {};
  return [=](double share) {
    if (function(context, share) != 0) throw Cancelled();
  };
}

std::span<const std::uint32_t> masks_of(const raylanes_ray_options& c) {
  if (c.masks == nullptr && c.mask_count > 0)
    throw std::invalid_argument("options: " + std::to_string(c.mask_count) +
                                " masks, and a null pointer to them");
  if (c.mask_count > std::numeric_limits<std::size_t>::max() / sizeof *c.masks)
    throw std::invalid_argument("options: masks reach beyond the address space");
  return {c.masks, c.mask_count};
}

void refuse_filter(const raylanes_ray_options& c) {
  if (c.filter != nullptr) throw std::invalid_argument("options: this call takes no filter");
}

BuildOptions build_options(const raylanes_build_options* given) {
  const raylanes_build_options c = completed(given, build_defaults());
  BuildOptions options;
  options.builder = enumerator_of<TreeBuilder>("builder", c.builder, tree_builder_names.size());
  options.threads = c.threads;
  options.optimize = c.optimize != 0;
  options.choose = c.choose != 0;
  options.rays = c.rays;
  options.progress = progress_of(c.progress, c.progress_context);
  return options;
}

BoundedBuildOptions bounded_build_options(const raylanes_build_options* given) {
  const raylanes_build_options c = completed(given, build_defaults());
  const BuildOptions options = build_options(&c);
  return {
      .builder = options.builder, .threads = options.threads, .max_in_leaf = c.max_in_leaf, .slack = c.slack};
}

namespace {

template <class Options>
raylanes_status init(Options* options, std::size_t size, const Options& defaults) {
  return status_of([&] {
    require_pointer("options", options);
    require_options_size(size, sizeof(Options));
    std::memcpy(static_cast<void*>(options), &defaults, size);
    std::memcpy(static_cast<void*>(options), &size, sizeof size);
  });
}

}  // namespace
}  // namespace raylanes::c

raylanes_status raylanes_init_build_options(raylanes_build_options* options, std::size_t size) {
  return raylanes::c::init(options, size, raylanes::c::build_defaults());
}

raylanes_status raylanes_init_ray_options(raylanes_ray_options* options, std::size_t size) {
  return raylanes::c::init(options, size, raylanes::c::ray_defaults());
}

raylanes_status raylanes_init_point_options(raylanes_point_options* options, std::size_t size) {
  return raylanes::c::init(options, size, raylanes::c::point_defaults());
}

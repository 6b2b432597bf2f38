#include "table/spheres.hpp"

#include <raylanes/spheres.hpp>

#include "quiet_floats.hpp"
#include "selected_row.hpp"
#include "table/kernel_table.hpp"

namespace raylanes {
namespace {

const SphereRow& row_of(const char* call, const SphereOptions& options) {
  return selected_row(
      call, options, [](const KernelTable& table) -> const auto& { return table.spheres; });
}

struct Pointers {
  const float* array[4];
  explicit Pointers(const SphereArrays& s) : array{s.centre[0], s.centre[1], s.centre[2], s.squared_radius} {}
};

struct Numbers {
  float number[4];
  explicit Numbers(const Sphere& s)
      : number{s.centre[0], s.centre[1], s.centre[2], signed_square(s.radius)} {}
};

}  // namespace

void hit_mask(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
              const SphereOptions& options) {
  const SphereRow& row = row_of("hit_mask", options);
  require_bits("hit_mask", bits.size(), spheres.size);
  const QuietFloats quiet;
  row.any_of_spheres(ray, Pointers(spheres).array, spheres.size, options.active, bits.data());
}

void hit_mask(const RayArrays& rays, const Sphere& sphere, std::span<std::uint8_t> bits,
              const SphereOptions& options) {
  const SphereRow& row = row_of("hit_mask", options);
  require_bits("hit_mask", bits.size(), rays.size);
  const QuietFloats quiet;
  row.any_of_rays(rays, Numbers(sphere).number, options.active, bits.data());
}

Hit closest_hit(const Ray& ray, const SphereArrays& spheres, const SphereOptions& options) {
  const SphereRow& row = row_of("closest_hit", options);
  require_nameable("closest_hit", spheres.size, "spheres");
  Hit nearest;
  const QuietFloats quiet;
  row.closest_of_spheres(ray, Pointers(spheres).array, spheres.size, options.active, nearest);
  return nearest;
}

void distances(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
               std::span<float> near, std::span<float> far, const SphereOptions& options) {
  const SphereRow& row = row_of("distances", options);
  require_pairs("distances", spheres.size, bits.size(), "near", near.size(), "far", far.size());
  const QuietFloats quiet;
  row.distances_of_spheres(ray, Pointers(spheres).array, spheres.size, options.active, bits.data(),
                           near.data(), far.data());
}

void distances(const RayArrays& rays, const Sphere& sphere, std::span<std::uint8_t> bits,
               std::span<float> near, std::span<float> far, const SphereOptions& options) {
  const SphereRow& row = row_of("distances", options);
  require_pairs("distances", rays.size, bits.size(), "near", near.size(), "far", far.size());
  const QuietFloats quiet;
  row.distances_of_rays(rays, Numbers(sphere).number, options.active, bits.data(), near.data(), far.data());
}

void line_hits(const Ray& ray, const SphereArrays& spheres, std::span<std::uint8_t> bits,
               const SphereOptions& options) {
  const SphereKernels& kernels = kernels_of(checked_path(options.path)).spheres;
  const auto line = checked_row("line_hits", "grade", kernels.line_of_spheres, options.grade);
  require_bits("line_hits", bits.size(), spheres.size);
  const QuietFloats quiet;
  line(ray, Pointers(spheres).array, spheres.size, options.active, bits.data());
}

}  // namespace raylanes

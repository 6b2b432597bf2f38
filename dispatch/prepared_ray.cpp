#include <raylanes/prepared_ray.hpp>

#include "checked.hpp"
#include "table/boxes.hpp"
#include "table/kernel_table.hpp"
#include "table/spheres.hpp"
#include "table/triangles.hpp"

namespace raylanes {

PreparedRay::PreparedRay(const Ray& ray, const Path* path) : ray_(ray) {
  const KernelTable& kernels = kernels_of(checked_path(path));
  boxes_ = kernels.boxes.hits;
  spheres_ = kernels.spheres.closest_among;
  triangles_ = kernels.triangles.closest_among;
  kernels.spheres.prepare(ray, among_);
}

void PreparedRay::refuse(std::size_t primitives) {
  throw std::invalid_argument("PreparedRay: " + std::to_string(primitives) +
                              " primitives; allowed are 0 to " + std::to_string(max_primitives));
}

void PreparedRay::refuse(std::size_t boxes, std::size_t entries) {
  if (boxes > max_primitives) refuse(boxes);
  refuse_size("hits", "entry", entries, "boxes", boxes);
}

}  // namespace raylanes

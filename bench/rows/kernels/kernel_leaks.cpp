#include "../../../dispatch/table/traversal.hpp"
#include "../../support/rays/aim.hpp"
#include "../../support/rays/leak_targets.hpp"
#include "../../support/scenes/shapes.hpp"
#include "kernel_survey.hpp"

namespace raylanes::bench {
namespace {

Mesh closed_mesh() {
  constexpr double semi_axes[3] = {3, 2, 1};
  Mesh mesh;
  append_icosphere(mesh, {0, 0, 0}, 1, 3);
  for (Float3& vertex : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) vertex[k] *= static_cast<float>(semi_axes[k]);
  return mesh;
}

// Rays to one target, in columns.
struct TargetRays {
  std::vector<float> column[8];
  RayArrays arrays() const {
    return {{column[0].data(), column[1].data(), column[2].data()},
            {column[3].data(), column[4].data(), column[5].data()},
            column[6].data(),
            column[7].data(),
            column[0].size()};
  }
};

void aim(const SharedApex& target, std::size_t count, SplitMix& random, TargetRays& rays) {
  for (auto& column : rays.column) column.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double along = target.is_corner ? 0 : random.uniform();
    const auto& [from, to, other] = target.triangle.corner;
    const Double3 point = add(scale(to_double(from), 1 - along), scale(to_double(to), along));
    const Ray ray = ray_towards(point_around(random, {0, 0, 0}, 0.4), point);
    for (std::size_t k = 0; k < 3; ++k)
      rays.column[k][i] = ray.origin[k], rays.column[3 + k][i] = ray.direction[k];
    rays.column[6][i] = ray.tmin, rays.column[7][i] = ray.tmax;
  }
}

std::uint64_t leaks_at(const Path& path, TriangleTest test, Grade grade, const SharedApex& target,
                       const TargetRays& rays, std::size_t count) {
  std::vector<std::uint8_t> stopped((count + 7) / 8), bits((count + 7) / 8);
  for (const Triangle& triangle : target.around) {
    hit_mask(rays.arrays(), triangle, bits, {.test = test, .grade = grade, .path = &path});
    for (std::size_t i = 0; i < bits.size(); ++i)
      stopped[i] = static_cast<std::uint8_t>(stopped[i] | bits[i]);
  }
  std::uint64_t leaks = 0;
  for (std::size_t i = 0; i < count; ++i) leaks += (stopped[i / 8] >> (i % 8) & 1u) == 0;
  return leaks;
}

}  // namespace

Leaks count_leaks(const std::vector<const Path*>& paths, std::size_t rays,
                  const std::function<bool(TriangleTest)>& chosen, const std::function<void(double)>& done) {
  const std::vector<SharedApex> targets = shared_points(closed_mesh());
  const std::size_t each = (rays + targets.size() - 1) / targets.size();
  Leaks leaks(paths.size(), std::vector<std::array<std::optional<double>, 2>>(std::size(triangle_tests)));
  SplitMix random(9);
  TargetRays aimed;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    aim(targets[k], each, random, aimed);
    for (std::size_t p = 0; p < paths.size(); ++p)
      for (const TriangleTestInfo& info : triangle_tests) {
        // directional wants rays of one direction; its decisions are moller_trumbore's.
        if (info.test == TriangleTest::directional || !chosen(info.test)) continue;
        for (const Grade grade : {Grade::reproducible, Grade::fast}) {
          std::optional<double>& sum =
              leaks[p][static_cast<std::size_t>(info.test)][static_cast<std::size_t>(grade)];
          sum = sum.value_or(0.0) +
                static_cast<double>(leaks_at(*paths[p], info.test, grade, targets[k], aimed, each));
        }
      }
    done(static_cast<double>(k + 1) / static_cast<double>(targets.size()));
  }
  for (auto& of_path : leaks)
    for (auto& of_form : of_path)
      for (auto& sum : of_form)
        if (sum) *sum *= 1e6 / static_cast<double>(each * targets.size());
  return leaks;
}

}  // namespace raylanes::bench

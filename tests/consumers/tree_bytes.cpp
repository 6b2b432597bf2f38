// Writes trees by the builders that sort and work on threads, and the closest points of some points: the same bytes by
// every build of the library.
#include <cstdint>
#include <iostream>
#include <vector>

#include <raylanes/bvh.hpp>
#include <raylanes/kdtree.hpp>

namespace {

std::vector<float> numbers(std::size_t count, std::uint32_t state) {
  std::vector<float> numbers(count);
  for (float& x : numbers) {
    state = state * 1664525u + 1013904223u;
    x = static_cast<float>(state >> 16) * 0x1p-16f;  // some of them equal
  }
  return numbers;
}

}  // namespace

int main() {
  using raylanes::TreeBuilder;
  const std::vector<float> vertices = numbers(std::size_t{3} * 60000, 1);
  std::vector<std::uint32_t> triangles(60000);
  for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = static_cast<std::uint32_t>(i);
  for (const TreeBuilder builder : {TreeBuilder::binned_sah, TreeBuilder::sweep_sah, TreeBuilder::morton})
    raylanes::Bvh(vertices, triangles, {.builder = builder, .threads = 2}).save(std::cout);
  const raylanes::KdTree tree(vertices, triangles, {.threads = 2});
  tree.save(std::cout);
  const std::vector<float> points = numbers(std::size_t{3} * 5000, 2);
  std::vector<raylanes::ClosestPoint> closest(5000);
  tree.closest_points(points, closest, {.threads = 2});
  std::cout.write(reinterpret_cast<const char*>(closest.data()),
                  static_cast<std::streamsize>(closest.size() * sizeof closest[0]));
}

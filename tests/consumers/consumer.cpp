// A program of someone who has installed the library: its headers, its pkg-config file, nothing of its source
// tree. Traces rays through a square and takes square roots; returns 1 if an answer is wrong.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include <raylanes/bvh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/roots.hpp>

namespace {

// Rays along +z at the unit square z = 2, whose diagonal x = y separates triangle 0 (below) from 1; every
// third ray passes beside it.
bool traces_a_square() {
  const std::vector<raylanes::Float3> vertices = {{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}};
  const std::vector<raylanes::Index3> triangles = {{0, 1, 2}, {0, 2, 3}};
  const raylanes::Bvh bvh(vertices, triangles);

  std::vector<raylanes::Ray> rays;
  for (int i = 0; i < 30; ++i) {
    const float x[] = {0.75f, 0.25f, 1.25f};
    rays.push_back({{x[i % 3], 0.5f, 0.0f}, 0.0f, {0.0f, 0.0f, 1.0f}, 100.0f});
  }
  const std::uint32_t expected[] = {0, 1, raylanes::no_primitive};
  std::vector<raylanes::Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  bvh.closest(rays, hits);
  bvh.occluded(rays, occluded);
  bool right = true;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool hit = i % 3 != 2;
    if (i < 3) std::printf("ray %zu: t %g, primitive %u\n", i, hits[i].t, hits[i].primitive);
    right = right && hits[i].primitive == expected[i % 3] && occluded[i] == (hit ? 1 : 0);
    right = right && (hits[i] ? hit : !hit);  // where infinities are taken for impossible, too
    right = right && (!hit || hits[i].t == 2.0f);
  }
  return right;
}

bool takes_square_roots() {
  const float x[] = {0.0f, 0.25f, 1.0f, 2.25f, 1e10f};
  const float expected[] = {0.0f, 0.5f, 1.0f, 1.5f, 1e5f};
  float y[5];
  raylanes::sqrt(x, y, raylanes::Accuracy::correctly_rounded);
  bool right = true;
  for (int i = 0; i < 5; ++i) right = right && y[i] == expected[i];
  return right;
}

}  // namespace

int main() {
  try {
    std::printf("path %s\n", raylanes::active_path().name);
    const bool traced = traces_a_square(), rooted = takes_square_roots();
    if (!traced) std::puts("WRONG: hits of the square");
    if (!rooted) std::puts("WRONG: square roots");
    return traced && rooted ? 0 : 1;
  } catch (const std::exception& error) {
    std::printf("WRONG: %s\n", error.what());
    return 1;
  }
}

// A program of someone who has installed the library: its headers, its pkg-config file, nothing of its source
// tree. Traces rays through a square, also when it has moved, from a file, and walking the tree by hand, and takes
// square roots; returns 1 if an answer is wrong.

#include <bit>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <sstream>
#include <vector>

#include <raylanes/boxes.hpp>
#include <raylanes/bvh.hpp>
#include <raylanes/kdtree.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/roots.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

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

// All triangles that a ray hits, as docs/motion.md has it.
std::size_t count_hits(const raylanes::BvhView& tree, const raylanes::Ray& ray) {
  std::size_t count = 0;
  std::vector<raylanes::TreeReference> open;
  if (tree.root != raylanes::empty_reference) open.push_back(tree.root);
  while (!open.empty()) {
    const raylanes::TreeReference at = open.back();
    open.pop_back();
    std::uint8_t bits = 0;
    if (raylanes::refers_to_leaf(at)) {
      const auto [block, size] = raylanes::leaf_of(at);
      const auto& n = tree.leaves[block].number;
      const raylanes::TriangleArrays leaf{{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}}, size};
      raylanes::hit_mask(ray, leaf, {&bits, 1});
      count += static_cast<std::size_t>(std::popcount(bits));
    } else {
      const raylanes::WideNode& node = tree.nodes[at];
      const raylanes::BoxArrays boxes{
          {node.lo[0], node.lo[1], node.lo[2]}, {node.hi[0], node.hi[1], node.hi[2]}, raylanes::tree_width};
      raylanes::hit_mask(ray, boxes, {&bits, 1});
      for (std::uint32_t hit = bits & node.occupied; hit != 0; hit &= hit - 1)
        open.push_back(node.child[std::countr_zero(hit)]);
    }
  }
  return count;
}

// Twenty squares, one behind the other, which then move away from the rays' origin.
bool follows_squares() {
  std::vector<raylanes::Float3> vertices;
  std::vector<raylanes::Index3> triangles;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const float z = static_cast<float>(i);
    vertices.insert(vertices.end(), {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}});
    triangles.insert(triangles.end(), {{4 * i, 4 * i + 1, 4 * i + 2}, {4 * i, 4 * i + 2, 4 * i + 3}});
  }
  raylanes::Bvh bvh(vertices, triangles);
  for (raylanes::Float3& vertex : vertices) vertex[2] += 10;
  bvh.refit(vertices, triangles);
  std::stringstream file;
  bvh.save(file);
  const raylanes::Bvh loaded = raylanes::Bvh::load(file);
  const raylanes::Ray ray{{0.75f, 0.5f, 5}, 0, {0, 0, 1}, 100};
  const raylanes::Hit nearest = loaded.closest(ray);
  return nearest && nearest.t == 5 && nearest.primitive == 0 && count_hits(loaded.view(), ray) == 20 &&
         bvh.decay() == 1;
}

// The same through the other tree, built and loaded.
bool walks_cells() {
  const std::vector<raylanes::Float3> vertices{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  const std::vector<raylanes::Index3> triangles{{0, 1, 2}};
  const raylanes::KdTree tree(vertices, triangles, {.builder = raylanes::KdBuilder::sah});
  std::stringstream file;
  tree.save(file);
  const raylanes::Ray ray{{0.25f, 0.25f, 0}, 0, {0, 0, 1}, 100};
  const raylanes::Hit hit = raylanes::KdTree::load(file).closest(ray);
  return hit && hit.t == 2 && tree.occluded(ray) && tree.view().nodes.size() == 1 &&
         tree.report().blocks == 1;
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
    const bool traced = traces_a_square(), followed = follows_squares(), walked = walks_cells(),
               rooted = takes_square_roots();
    if (!traced) std::puts("WRONG: hits of the square");
    if (!followed) std::puts("WRONG: hits of squares that moved");
    if (!walked) std::puts("WRONG: hits through cells");
    if (!rooted) std::puts("WRONG: square roots");
    return traced && followed && walked && rooted ? 0 : 1;
  } catch (const std::exception& error) {
    std::printf("WRONG: %s\n", error.what());
    return 1;
  }
}

// Primitives of the caller's and spheres, of any bits: what the fuzz target of scenes asks of their trees.
#pragma once

#include <raylanes/bounded_tree.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/sphere_tree.hpp>

#include "../fuzz/any_mesh.hpp"
#include "../support/same_bytes.hpp"
#include "scene_oracle.hpp"

namespace raylanes::testing {

// The triangles as primitives of the caller's, a ray at a time or a leaf at a time: the hits of their tree.
inline void expect_hits_of_boxes(Bytes& bytes, const Mesh& mesh, std::span<const Ray> rays,
                                 const VisitOptions& options) {
  std::vector<Box> boxes;
  for (const Index3& t : mesh.triangles) {
    const Triangle triangle = triangle_of(mesh.vertices, t);
    boxes.push_back({triangle.corner[0], triangle.corner[0]});
    for (const Float3& corner : triangle.corner)
      for (std::size_t k = 0; k < 3; ++k)
        boxes.back().lo[k] = std::min(boxes.back().lo[k], corner[k]),
        boxes.back().hi[k] = std::max(boxes.back().hi[k], corner[k]);
  }
  const BoundedTree tree(boxes, {.max_in_leaf = static_cast<std::uint32_t>(1 + bytes.below(8))});
  const auto test = [&](std::uint32_t primitive, const Ray& ray, Hit& hit) {
    const Triangle triangle = triangle_of(mesh.vertices, mesh.triangles[primitive]);
    TriangleArrays one{};
    for (std::size_t k = 0; k < 9; ++k) one.corner[k / 3][k % 3] = &triangle.corner[k / 3][k % 3];
    one.size = 1;
    hit = closest_hit(ray, one, {.path = &paths().front()});
    return static_cast<bool>(hit);
  };
  const auto leaf_test = [&](const LeafVisit& leaf) {
    for (const std::uint32_t number : leaf.rays)
      for (std::size_t k = 0; k < leaf.primitives.size(); ++k) {
        Hit hit;
        const std::uint32_t primitive = tree.order()[leaf.first + k];
        if (!test(primitive, leaf.ray[number], hit)) continue;
        hit.primitive = primitive;
        leaf.keep(number, hit);
      }
  };
  std::vector<Hit> one_by_one(rays.size()), by_leaves(rays.size());
  tree.closest(rays, one_by_one, test, options);
  tree.closest(rays, by_leaves, leaf_test, options);
  std::vector<Hit> behind(rays.size()), after_by_leaves(rays.size());
  VisitOptions second = options;
  second.after = one_by_one;
  tree.closest(rays, behind, test, second);
  tree.closest(rays, after_by_leaves, leaf_test, second);
  const Bvh triangles(mesh);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit expected = triangles.closest(rays[i], {.path = &paths().front()}),
              next = triangles.closest(rays[i], {.path = &paths().front(), .after = expected});
    if (!same_bytes(one_by_one[i], expected) || !same_bytes(by_leaves[i], expected) ||
        !same_bytes(behind[i], next) || !same_bytes(after_by_leaves[i], next))
      fail("boxes: ray " + std::to_string(i) + " on " + options.path->name);
  }
}

// A skipped sphere has one hit at most, the second of two; there are all hits of the others.
template <class Complain>
inline void expect_one_hit_skipped(const SphereTree& tree, const Ray& ray, std::size_t sphere,
                                   const VisitOptions& options, const Complain& complain) {
  std::vector<Hit> all, of_sphere, left;
  VisitOptions others = options;
  const auto skipped = static_cast<std::uint32_t>(sphere);
  for (Hit hit = tree.closest(ray, options); hit;
       others.after = all.back(), hit = tree.closest(ray, others)) {
    all.push_back(hit);
    if (hit.primitive == skipped) of_sphere.push_back(hit);
  }
  others = options;
  others.skip = skipped;
  for (Hit hit = tree.closest(ray, others); hit; others.after = left.back(), hit = tree.closest(ray, others))
    left.push_back(hit);
  if (of_sphere.size() == 2)
    std::erase_if(all, [&](const Hit& hit) { return same_bytes(hit, of_sphere[0]); });
  const auto is_same = [](const Hit& a, const Hit& b) { return same_bytes(a, b); };
  if (std::ranges::equal(all, left, is_same)) return;
  // A sphere with one hit within the segment may have the nearer one before it.
  std::erase_if(all, [&](const Hit& hit) { return hit.primitive == skipped; });
  if (of_sphere.size() != 1 || !std::ranges::equal(all, left, is_same)) complain();
}

// Spheres of any bits: peeled hits rise, the first ones are closest(), and rejecting each of them finds the next.
inline void expect_hits_of_spheres(Bytes& bytes, std::span<const Ray> rays, const VisitOptions& options) {
  std::vector<Sphere> spheres(bytes.below(20));
  Coordinates coordinates(bytes);
  for (Sphere& sphere : spheres) sphere = {{coordinates(), coordinates(), coordinates()}, coordinates()};
  const SphereTree tree(spheres);
  for (const Ray& ray : rays) {
    const auto complain = [&] { fail(std::string("spheres on ") + options.path->name); };
    if (!spheres.empty()) expect_one_hit_skipped(tree, ray, bytes.below(spheres.size()), options, complain);
    VisitOptions behind = options;
    Hit last = tree.closest(ray, options);
    std::size_t found = 0;
    const Hit none = tree.closest(
        ray, [&](const Hit&) { return ++found <= 2 * spheres.size(); }, options);
    if (none || tree.occluded(ray, options) != static_cast<bool>(last)) complain();
    for (; last; --found) {
      behind.after = last;
      const Hit next = tree.closest(ray, behind);
      if (found == 0 || (next && !comes_after(next, last))) return complain();
      last = next;
    }
    if (found != 0) complain();
  }
}

}  // namespace raylanes::testing

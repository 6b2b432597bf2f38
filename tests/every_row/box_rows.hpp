// The rows of trees over boxes: visits of leaves, and spheres in these.
#pragma once

#include "../../accel/scene/bounded_tree_arrays.hpp"
#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/spheres.hpp"
#include "../support/same_bytes.hpp"
#include "traced_rows.hpp"

namespace raylanes::testing {

// The rays that came to each leaf: one that nothing stops is at least at the leaves of its hits.
inline void check_visits(EveryRow& every, const QueryKernels& kernels, std::size_t bytes, bool share_origin) {
  if (!every.offers(kernels.visit)) return;
  const TreeView tree = small_view<float>();
  const std::vector<Ray> rays = some_rays<float>(share_origin ? Together::from_eye : Together::no);
  std::vector<Hit> hits(most);
  TraceCounters counters;
  TraceBatch closest;
  closest.rays = rays.data(), closest.size = most, closest.hits = hits.data(), closest.counters = &counters;
  kernels.closest_after(tree, closest);
  std::vector<std::set<std::uint32_t>> seen(most);
  Scratch scratch(Scratch::bytes_of<std::byte>(bytes));
  VisitBatch batch;
  batch.rays = rays.data(), batch.size = most, batch.scratch = scratch.take<std::byte>(bytes);
  batch.counters = &counters, batch.context = &seen, batch.share_origin = share_origin;
  batch.visit = [](void* context, const VisitedLeaf& leaf) {
    for (std::size_t k = 0; k < leaf.count; ++k)
      EXPECT_TRUE((*static_cast<decltype(seen)*>(context))[leaf.rays[k]].insert(leaf.first).second);
  };
  kernels.visit(tree, batch);
  const auto* const blocks = static_cast<const LeafBlock<9>*>(tree.blocks);
  for (std::size_t i = 0; i < most; ++i)
    EXPECT_TRUE(!hits[i] || std::ranges::any_of(seen[i],
                                                [&](std::uint32_t block) {
                                                  return std::ranges::count(blocks[block].primitive,
                                                                            hits[i].primitive) > 0;
                                                }))
        << "ray " << i;
  EXPECT_GT(std::ranges::count_if(hits, [](const Hit& hit) { return bool(hit); }), 3);
}

// Each ray alone: until nothing stops it, it is at the leaves of its hits, too; told to stop, at one.
inline void check_visits_of_rays(EveryRow& every, const QueryKernels& kernels) {
  if (!every.offers(kernels.visit_ray)) return;
  struct Seen {
    std::set<std::uint32_t> leaves;
    float answer;
  };
  const auto visit = [](void* context, std::uint32_t first, std::uint32_t) {
    EXPECT_TRUE(static_cast<Seen*>(context)->leaves.insert(first).second);
    return static_cast<Seen*>(context)->answer;
  };
  const TreeView tree = small_view<float>();
  for (const Ray& ray : some_rays<float>()) {
    Hit hit;
    TraceBatch closest;
    closest.rays = &ray, closest.size = 1, closest.hits = &hit;
    kernels.closest_after(tree, closest);
    Seen all{{}, infinity}, one{{}, -infinity};
    kernels.visit_ray(tree, ray, ray.tmax, visit, &all);
    kernels.visit_ray(tree, ray, ray.tmax, visit, &one);
    EXPECT_EQ(one.leaves.size(), std::min<std::size_t>(all.leaves.size(), 1));
    const auto* const blocks = static_cast<const LeafBlock<9>*>(tree.blocks);
    EXPECT_TRUE(!hit || std::ranges::any_of(all.leaves, [&](std::uint32_t block) {
      return std::ranges::count(blocks[block].primitive, hit.primitive) > 0;
    }));
  }
}

// Spheres in trees of leaves of one and of one leaf of eight, whose rows of numbers are the columns of the test.
// Some rays at a time at a leaf, against each ray's search in the tree of that leaf.
inline void check_visits_of_spheres(EveryRow& every, const QueryKernels& kernels, const TreeView& one_leaf,
                                    const SphereLeaves& spheres, std::uint32_t size) {
  if (!every.offers(kernels.visit_spheres)) return;
  std::vector<Ray> rays = some_rays<float>();
  std::erase_if(rays, [](const Ray& ray) {
    const auto& [x, y, z] = ray.direction;
    return !(std::abs(x) + std::abs(y) + std::abs(z) > 0 && ray.tmin <= ray.tmax);
  });
  std::vector<std::uint32_t> numbers(rays.size()), skip(rays.size(), no_primitive);
  std::iota(numbers.rbegin(), numbers.rend(), 0u);
  for (const bool skips : {false, true})
    for (const std::size_t together : {std::size_t{1}, std::size_t{2}, std::size_t{5}, rays.size()}) {
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      for (std::size_t k = 0; k < rays.size(); k += together) {
        SphereVisit leaf{0,
                         size,
                         numbers.data() + k,
                         std::min(together, rays.size() - k),
                         rays.data(),
                         hits.data(),
                         nullptr,
                         skips ? skip.data() : nullptr};
        kernels.visit_spheres(spheres, leaf);
        leaf.hits = nullptr, leaf.occluded = occluded.data();
        kernels.visit_spheres(spheres, leaf);
      }
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const SphereQuery asked{.end = rays[i].tmax, .skipped = skips ? skip[i] : no_primitive};
        EXPECT_TRUE(same_bytes(hits[i], kernels.closest_sphere(one_leaf, spheres, rays[i], asked))) << i;
        EXPECT_EQ(occluded[i], hits[i] ? 1 : 0) << i;
        if (!skips) skip[i] = hits[i].primitive;
      }
    }
}

inline void check_spheres(EveryRow& every, const QueryKernels& kernels) {
  if (!every.offers(kernels.closest_sphere)) return;
  constexpr std::size_t count = 8;
  float column[4][count];
  std::vector<Box> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float radius = 0.2f + 0.05f * static_cast<float>(i);
    column[3][i] = radius * radius;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float at = static_cast<float>((i * (axis + 2) * 7) % 11) / 5.5f - 1.0f;
      column[axis][i] = at, boxes[i].lo[axis] = at - 1.01f * radius, boxes[i].hi[axis] = at + 1.01f * radius;
    }
  }
  const float* const rows[4] = {column[0], column[1], column[2], column[3]};
  const BoundedTreeArrays singles = build_box_tree("spheres", boxes, {});
  std::vector<float> numbers(4 * count + sphere_room), in_one(4 * count + sphere_room);
  std::uint32_t ascending[count];
  for (std::uint32_t k = 0; k < count; ++k) {
    ascending[k] = k;
    for (std::size_t row = 0; row < 4; ++row)
      numbers[4 * k + row] = column[row][singles.order[k]], in_one[count * row + k] = column[row][k];
  }
  BoundedTreeArrays one_leaf;
  one_leaf.root = tree_reference({0, count}), one_leaf.bounds = singles.bounds;
  const SphereRow& of_all = EveryRow::scalar().spheres.row[0][0];
  TraceCounters counters;
  std::size_t hits = 0;
  for (const Ray& ray : some_rays<float>()) {
    Hit expected;
    of_all.closest_of_spheres(ray, rows, count, nullptr, expected);
    for (const auto& [tree, spheres] :
         {std::pair(singles.view(), SphereLeaves{numbers.data(), singles.order.data()}),
          std::pair(one_leaf.view(), SphereLeaves{in_one.data(), ascending})}) {
      const SphereQuery asked{.end = ray.tmax, .counters = &counters};
      EXPECT_TRUE(same_bytes(kernels.closest_sphere(tree, spheres, ray, asked), expected));
      SphereQuery any = asked;
      any.any = true;
      EXPECT_EQ(static_cast<bool>(kernels.closest_sphere(tree, spheres, ray, any)),
                static_cast<bool>(expected));
      if (!expected) continue;
      SphereQuery next = asked;
      next.after = &expected;
      const Hit second = kernels.closest_sphere(tree, spheres, ray, next);
      EXPECT_TRUE(comes_after(second, expected) || !second);
      next.after = nullptr, next.skipped = expected.primitive;
      EXPECT_FALSE(same_bytes(kernels.closest_sphere(tree, spheres, ray, next), expected) &&
                   ray.tmin == expected.t);
      ++hits;
    }
  }
  EXPECT_GT(hits, 4u);
  check_visits_of_spheres(every, kernels, one_leaf.view(), {in_one.data(), ascending}, count);
}

}  // namespace raylanes::testing

// Checks of fuzzed queries of rays and points, in trees over meshes of floats or of doubles.
#pragma once

#include <raylanes/numbers.hpp>

#include "../queries/summed_winding.hpp"
#include "../support/limited_memory.hpp"
#include "any_closest_crossings.hpp"

namespace raylanes::testing {

inline constexpr std::size_t max_queries = 24;

template <class Point>
bool is_finite(const Point& point) {
  return std::ranges::all_of(point, [](auto x) { return std::isfinite(x); });
}

template <class T>
struct ExpectedLists {
  std::vector<std::vector<HitOf<T>>> hits;
  std::vector<std::vector<CrossingOf<T>>> crossings;
};

template <class Tree, class AnyRay, class T = std::remove_const_t<decltype(AnyRay::tmin)>>
void expect_lists(const Tree& tree, const std::vector<AnyRay>& rays, const ExpectedLists<T>& expected,
                  const ListOptions& options) {
  const auto hits = tree.all_hits(rays, options);
  const auto crossings = tree.crossings(rays, options);
  static Fence fence(max_queries * sizeof(CrossingCount));
  const std::span<CrossingCount> counts(fence.last<CrossingCount>(rays.size()), rays.size());
  tree.count_crossings(rays, counts,
                       {.facing = options.facing,
                        .path = options.path,
                        .threads = options.threads,
                        .skip = options.skip,
                        .mask = options.mask,
                        .masks = options.masks});
  fence.expect_intact("counts");
  // Many rays of floats go together.
  constexpr std::size_t together = std::is_same_v<T, float> ? 1100 : 0;
  std::vector<AnyRay> many;
  for (std::size_t i = 0; i < together && !rays.empty() && options.max_count > 70; ++i)
    many.push_back(rays[i % rays.size()]);
  std::vector<std::uint32_t> skip_of_many;
  for (std::size_t i = 0; i < many.size() && options.skip.count > 0; ++i)
    skip_of_many.push_back(options.skip[i % rays.size()]);
  ListOptions of_many = options;
  of_many.skip = skip_of_many;
  const auto many_hits = tree.all_hits(many, of_many);
  const auto many_crossings = tree.crossings(many, of_many);
  for (std::size_t i = 0; i < many.size(); ++i)
    if (!same_bytes(many_hits[i], expected.hits[i % rays.size()]) ||
        !std::ranges::equal(many_crossings[i], expected.crossings[i % rays.size()]))
      fail(std::string(options.path->name) + ": ray " + std::to_string(i) + " of many");
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::string ray = std::string(options.path->name) + ": ray " + std::to_string(i) + ": ";
    const auto first = [&](const auto& list) {
      return std::min<std::size_t>(options.max_count, list.size());
    };
    if (!same_bytes(hits[i], std::span(expected.hits[i]).first(first(expected.hits[i]))))
      fail(ray + std::to_string(hits[i].size()) + " hits, by brute force " +
           std::to_string(expected.hits[i].size()));
    if (!std::ranges::equal(crossings[i],
                            std::span(expected.crossings[i]).first(first(expected.crossings[i]))))
      fail(ray + std::to_string(crossings[i].size()) + " crossings, by brute force " +
           std::to_string(expected.crossings[i].size()));
    CrossingCount count;
    for (const auto& crossing : expected.crossings[i]) ++count.crossings, count.winding += crossing.side;
    if (counts[i] != count) fail(ray + "counts differ");
  }
}

// All layers, one after the other, in place.
template <class Tree, class AnyRay, class Options, class T = std::remove_const_t<decltype(AnyRay::tmin)>>
void expect_hits_after(const Tree& tree, const std::vector<AnyRay>& rays, const ExpectedLists<T>& expected,
                       Options options) {
  static Fence fence(max_queries * sizeof(HitOf<T>));
  const std::span<HitOf<T>> hits(fence.last<HitOf<T>>(rays.size()), rays.size());
  std::fill(hits.begin(), hits.end(), HitOf<T>{-std::numeric_limits<T>::infinity(), 0, 0, 0});
  bool some = true;
  for (std::size_t layer = 0; some; ++layer) {
    options.after = hits;
    tree.closest(rays, hits, options);
    fence.expect_intact("next hits");
    some = false;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const HitOf<T> wanted = layer < expected.hits[i].size() ? expected.hits[i][layer] : HitOf<T>();
      if (!same_bytes(wanted, hits[i]))
        fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": next hit " +
             std::to_string(layer));
      some = some || hits[i];
    }
  }
}

// Numbers of any points: finite, at most the number of triangles in size, equal to sums over all triangles, and the
// same bytes on the path scalar.
template <class Tree, class AnyMesh, class AnyRay, class T = std::remove_const_t<decltype(AnyRay::tmin)>>
void expect_windings(const Tree& tree, const AnyMesh& mesh, const std::vector<AnyRay>& rays,
                     const WindingOptions& options, bool is_exact) {
  static Fence fence(max_queries * sizeof(T));
  const std::span<T> numbers(fence.last<T>(rays.size()), rays.size());
  const VertexRecords<T> points(rays.data(), rays.size(), sizeof(AnyRay));
  tree.winding_numbers(points, numbers, options);
  fence.expect_intact("winding numbers");
  std::vector<T> scalar(rays.size());
  tree.winding_numbers(points, scalar, {.accuracy = options.accuracy, .path = &paths().front()});
  if (is_exact && !same_bytes(numbers, scalar)) fail("winding numbers depend on the path");
  const auto most = static_cast<T>(static_cast<double>(mesh.triangles.size()) + options.accuracy + 1);
  const double edges = 3 * static_cast<double>(mesh.triangles.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& point = rays[i].origin;
    if (!(std::abs(numbers[i]) <= most)) fail("a winding number of too many turns");
    if (!is_finite(point) && numbers[i] != 0) fail("a point that is not finite has a winding number");
    if (!is_exact || !is_finite(point) || is_on_edge(mesh, point)) continue;
    // Near edges the sum has no digits.
    const SummedWinding sum(mesh, point);
    if (sum.error < 0x1p-40L && !(std::abs(static_cast<long double>(numbers[i]) - sum.number) <=
                                  bound_of_winding<T>(sum, options.accuracy, edges)))
      fail("point " + std::to_string(i) + " has not the winding number of the sum over all triangles");
  }
}

// Inactive elements lie behind the page that nobody may touch.
template <class Tree, class AnyRay, class T = std::remove_const_t<decltype(AnyRay::tmin)>>
void expect_active_alone(const Tree& tree, const std::vector<AnyRay>& rays, const Path* path,
                         InsideRule rule) {
  constexpr std::size_t behind = 120;
  const std::size_t all = rays.size() + behind;
  std::vector<std::uint8_t> mask(all / 8 + 1, 0);
  for (std::size_t i = 0; i < rays.size(); ++i)
    mask[i / 8] = static_cast<std::uint8_t>(mask[i / 8] | 1u << i % 8);
  static Fence ray_fence(max_queries * sizeof(AnyRay)),
      closest_fence(max_queries * sizeof(ClosestPointOf<T>)), hit_fence(max_queries * sizeof(HitOf<T>)),
      number_fence(max_queries * sizeof(T));
  AnyRay* const first = ray_fence.last<AnyRay>(rays.size());
  std::copy(rays.begin(), rays.end(), first);
  const RayRecords<AnyRay> view(first, all);
  const VertexRecords<T> points(first, all, sizeof(AnyRay));
  const std::span numbers(number_fence.last<T>(rays.size()), all);
  const LaneBits active = mask.data();
  tree.closest(view, HitRecords<HitOf<T>>(hit_fence.last<HitOf<T>>(rays.size()), all),
               {.path = path, .active = active});
  const auto hits = tree.all_hits(view, {.path = path, .active = active});
  if (hits.offsets[rays.size()] != hits.items.size()) fail("inactive rays have hits");
  tree.closest_points(points, {closest_fence.last<ClosestPointOf<T>>(rays.size()), all},
                      {.path = path, .active = active});
  tree.winding_numbers(points, numbers, {.path = path, .active = active});
  tree.signed_distances(points, numbers, {.rule = rule, .path = path, .active = active});
  number_fence.expect_intact("numbers of active points");
}

// Calls that run out of memory leave the tree as it is: later checks ask it.
template <class Tree, class AnyRay, class T = std::remove_const_t<decltype(AnyRay::tmin)>>
void run_out_of_memory(Bytes& bytes, const Tree& tree, const std::vector<AnyRay>& rays, InsideRule rule) {
  std::vector<T> numbers(rays.size());
  std::vector<CrossingCount> counts(rays.size());
  const VertexRecords<T> points(rays.data(), rays.size(), sizeof(AnyRay));
  runs_out(
      bytes.below(40), unlimited,
      [&] {
        tree.all_hits(rays), tree.crossings(rays);
        tree.winding_numbers(points, numbers);
        tree.signed_distances(points, numbers, {.rule = rule});
        tree.count_crossings(rays, counts);
      },
      bytes.chance(128));
}

// Triangles by any names: as the mesh has them, bit for bit, or NaN.
template <class Tree, class AnyMesh>
void expect_corners(const Tree& tree, const AnyMesh& mesh, const std::vector<std::uint32_t>& names) {
  using Point = typename decltype(AnyMesh::vertices)::value_type;
  std::vector<std::conditional_t<std::is_same_v<Point, Float3>, Triangle, TriangleD>> triangles(names.size());
  tree.corners(names, triangles);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto& found = triangles[k].corner;
    if (std::isnan(found[0][0])) continue;
    for (std::size_t i = 0; i < 3; ++i)
      if (names[k] >= mesh.triangles.size() ||
          !same_bytes(Point(found[i]), Point(mesh.vertices[mesh.triangles[names[k]][i]])))
        fail("corners of another triangle");
  }
}

}  // namespace raylanes::testing

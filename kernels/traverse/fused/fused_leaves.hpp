// The leaves of a tree for one ray: by the exact test, with the numbers of the hit it finds, or by a test that rounds.
#pragma once

#include "hit_numbers.hpp"

namespace raylanes {
namespace {

// For each major axis: the axes in the ray's order, the major one last, without keeping the winding.
inline constexpr std::uint32_t axes_by_major[3][4] = {{1, 2, 0, 3}, {2, 0, 1, 3}, {0, 1, 2, 3}};
// And where their numbers of the first corner are in a leaf, in floats.
inline constexpr std::ptrdiff_t rows_by_major[3][3] = {
    {tree_width, 2 * tree_width, 0}, {2 * tree_width, 0, tree_width}, {0, tree_width, 2 * tree_width}};

// The screen of single rays; docs/exact.md, parts 2 and 3.
class ExactLeaves {
  using V = NodeFloats;

 public:
  using Test = Exact<Grade::fast>;

  ExactLeaves(const TreeView& tree, const Ray& ray, const FusedRay& nodes)
      : tree_(tree), ray_(ray), nodes_(nodes), row_(rows_by_major[nodes.major]) {
    const auto* const numbers = reinterpret_cast<const float*>(&ray);
    const auto order = FloatBits<4>::load(axes_by_major[nodes.major]);
    Floats<4> o = permute(Floats<4>::load(numbers), order), d = permute(Floats<4>::load(numbers + 4), order);
    Floats<4> z = permute<2, 2, 2, 2>(d), slopes = d / -z;  // 1 / z is finite: see FusedRay
    o.store(origin_), d.store(direction_), slopes.store(shear_);
    bound_anywhere_ = EdgeBounds<Floats<1>>::bound_within(nodes.reach).raw;
  }

  // The edges alone say which triangles may be hit, and branches the rest: only tmax waits for the division.
  template <class Query>
  bool visit(TreeReference leaf, Query& query) const {
    V z[3];
    const auto edges = edges_of(leaf, z);
    std::uint32_t undecided = admitted_by(edges, leaf, query.sides);
    if (undecided == 0) return false;
    const std::uint32_t inside = bits(edges.certainly_inside());
    DepthBounds<V> t(edges, z[0], z[1], z[2], V(in_memory(*this).direction_[2]));
    alignas(32) float t_lo[tree_width], t_hi[tree_width];
    t.t_lo.store(t_lo), t.t_hi.store(t_hi);
    std::uint32_t unclear = 0;
    for (; undecided != 0; undecided &= undecided - 1) {
      const int lane = std::countr_zero(undecided);
      const float from = t_lo[lane], to = t_hi[lane];
      if (from > query.tmax || to < ray_.tmin) continue;
      if ((inside >> lane & 1u) != 0 && from > ray_.tmin && to < query.t_lo) [[likely]]
        query.keep(from, to, leaf_triangle_of(leaf, lane));
      else
        unclear |= 1u << lane;
    }
    if (unclear != 0) [[unlikely]] {
      static_cast<Candidate&>(query) =
          compared_exactly<ExactLeaves>(tree_, ray_, nodes_, leaf, unclear, query);
      return query.beside > max_beside;
    }
    return false;
  }
  template <class Query>
  requires(Query::only_decides && !asks<Query>) bool visit(TreeReference leaf, Query& query) const {
    V z[3];
    const auto edges = edges_of(leaf, z);
    std::uint32_t undecided = admitted_by(edges, leaf, query.sides);
    if (undecided == 0) return false;
    DepthBounds<V> t(edges, z[0], z[1], z[2], V(in_memory(*this).direction_[2]));
    V tmin(ray_.tmin), tmax(query.tmax);
    undecided &= ~bits((t.t_lo > tmax) | (t.t_hi < tmin));
    if (undecided == 0) return false;
    query.found = (undecided & bits(edges.certainly_inside() & (t.t_lo > tmin) & (t.t_hi < tmax))) != 0;
    if (query.found) [[likely]]
      return true;
    query.found = any_exact_hit(TreeTriangles(tree_), ray_, undecided, leaf_triangle_of(leaf, 0),
                                query.sides.facing, &query.beside);
    return query.found || query.beside > max_beside;
  }

  template <class Query>
  requires(asks<Query>) bool visit(TreeReference leaf, Query& query) const {
    V z[3];
    const auto edges = edges_of(leaf, z);
    std::uint32_t undecided = admitted_by(edges, leaf, query.sides);
    if (undecided == 0) return false;
    DepthBounds<V> t(edges, z[0], z[1], z[2], V(in_memory(*this).direction_[2]));
    V tmin(ray_.tmin), tmax(query.tmax);
    undecided &= ~bits((t.t_lo > tmax) | (t.t_hi < tmin));
    if (undecided == 0) return false;
    const std::uint32_t certain =
        undecided & bits(edges.certainly_inside() & (t.t_lo > tmin) & (t.t_hi < V(query.segment_end)));
    return query.ask(TreeTriangles(tree_), Verdict<V>{certain, undecided & ~certain, t.t_lo, t.t_hi, {}},
                     leaf_triangle_of(leaf, 0));
  }

  SignsOfWeights signs(TreeReference leaf) const {
    V z[3];
    return SignsOfWeights(edges_of(leaf, z));
  }

 private:
  // And the corners' distances along the major axis, mirrored.
  EdgeBounds<V> edges_of(TreeReference leaf, V (&z)[3]) const {
    const LeafBlock<9>& block = leaf_block<Test>(tree_, leaf);
    // Rows are indexed as one array of floats.
    const auto* const numbers = reinterpret_cast<const float*>(block.number);
    const float *const x = numbers + row_[0], *const y = numbers + row_[1], *const z_row = numbers + row_[2];
    const ExactLeaves& ray = in_memory(*this);
    Vec3<V> origin(V(ray.origin_[0]), V(ray.origin_[1]), V(ray.origin_[2]));
    const auto to_origin = [&](std::ptrdiff_t corner) {
      const auto number = [&](const float* row) { return V::load(row + corner * 3 * tree_width); };
      return Vec3<V>(origin.x - number(x), origin.y - number(y), origin.z - number(z_row));
    };
    Vec3<V> a = to_origin(0), b = to_origin(1), c = to_origin(2);
    z[0] = a.z, z[1] = b.z, z[2] = c.z;
    return EdgeBounds<V>(a, b, c, Shear<V>{V(ray.shear_[0]), V(ray.shear_[1])});
  }
  // Triangles that count and that the edges do not leave out, first by the bound of any triangle.
  // The order of axes mirrors triangles for a negative direction along the major one.
  template <class Sides>
  std::uint32_t admitted_by(const EdgeBounds<V>& edges, TreeReference leaf, Sides sides) const {
    const bool mirrored = ray_.direction[nodes_.major] < 0.0f;
    // NaN, which is not within a bound, stands in lanes without a triangle alone: docs/exact.md, part 2.
    V outside_by = sides.outside_by(edges, mirrored);
    if (bits(outside_by <= V(in_memory(*this).bound_anywhere_)) == 0) return 0;
    const std::uint32_t undecided = bits(outside_by <= edges.bound);
    if (undecided == 0) return 0;
    return sides.admitted(undecided, TreeTriangles(tree_), leaf_triangle_of(leaf, 0));
  }

  const TreeView& tree_;
  const Ray& ray_;
  const FusedRay& nodes_;
  const std::ptrdiff_t* row_;
  alignas(16) float origin_[4], direction_[4], shear_[4];  // in the ray's order of axes
  float bound_anywhere_;
};

// By another test, as where rays are not fused.
template <class Test>
class RoundedLeaves {
 public:
  RoundedLeaves(const TreeView& tree, const Ray& ray, const FusedRay& nodes)
      : tree_(tree), ray_(ray), prepared_(ray.origin, ray.direction, nodes.reach, ray.tmin) {}

  template <class Query>
  bool visit(TreeReference leaf, Query& query) const {
    NoCounters counters(query);
    return visit_leaf<Test>(tree_, leaf, ray_, prepared_, query, counters);
  }

 private:
  const TreeView& tree_;
  const Ray& ray_;
  const LeafRay<Test> prepared_;
};

template <class Test>
using FusedLeaves = std::conditional_t<screens<Test>, ExactLeaves, RoundedLeaves<Test>>;

}  // namespace
}  // namespace raylanes

// A few rays of one octant of directions through a tree together, as columns and without lists. The frustum around all
// rays is tested with a node's children, eight at a time. Children that it meets are tested with the rays, a vector at
// a time (Boulos, Wald, Shirley 2006: Geometric and Arithmetic Culling Methods for Entire Ray Packets).
#pragma once

#include "stream_columns.hpp"

namespace raylanes {
namespace {

class FewInStream {
 public:
  explicit FewInStream(StreamOctant<NoCounters>& of)
      : of_(of),
        tree_(of.tree_),
        vectors_((static_cast<std::uint32_t>(of.batch_size_) + stream_lanes - 1) / stream_lanes) {}

  // All rays of the batch; false if one is not streamable, or of another octant. rays: memory for them.
  [[gnu::noinline, gnu::flatten]] bool take(const OctantRays& rays) {
    StreamFloats farthest(0.0f);
    Limits limits[8];  // of reciprocals, origins, tmin and tmax
    for (std::uint32_t v = 0; v < vectors_; ++v)
      if (!take_vector(v * stream_lanes, rays, limits, farthest)) return false;
    of_.rays_ = rays, of_.rays_.size = static_cast<std::uint32_t>(of_.batch_size_);
    of_.rays_.first_tmax = columns_.tmax, of_.rays_.first_t_lo = columns_.t_lo, of_.rays_.step = 1;
    of_.columns_ = &columns_, of_.farthest_ = largest_lane(farthest);
    of_.padding_ = stream_padding(tree_, of_.farthest_, of_.needs_.rounding);
    columns_.frustum = OctantFrustum(limits, of_.octant_);
    return true;
  }

  [[gnu::noinline, gnu::flatten]] void trace() {
    Entry* top = stack_;
    *top++ = {tree_.root, 0.0f, ~std::uint64_t{0} >> (64 - of_.rays_.size)};
    do {
      Entry at = *--top;
      at.rays = going(at);
      if (at.rays == 0) continue;
      if (refers_to_leaf(at.reference))
        of_.calls_.visit_few(of_, at.reference, at.rays);
      else if (std::popcount(at.rays) < min_together)
        trace_singly(at);
      else
        visit_node(at, top);
    } while (top != stack_);
  }

 private:
  static constexpr int min_together = 3;
  struct Entry {
    TreeReference reference;
    float near;          // where the first ray may enter
    std::uint64_t rays;  // a bit each
  };

  // Lanes without a ray are as the last ray.
  bool take_vector(std::uint32_t first, const OctantRays& to, Limits (&limits)[8], StreamFloats& farthest) {
    const Ray* rays[stream_lanes];
    for (std::size_t lane = 0; lane < stream_lanes; ++lane)
      rays[lane] = of_.batch_rays_ + (first + lane < of_.batch_size_ ? first + lane : of_.batch_size_ - 1);
    const RayColumns columns(rays);
    const StreamableRays<stream_lanes> streamable(columns, tree_.bounds);
    if (first == 0) of_.octant_ = streamable.octant(0);
    if (!streamable.are_of(of_.octant_)) return false;
    StreamFloats packed[row_floats];
    pack_rays(vec3(columns.origin), vec3(columns.direction), StreamFloats(of_.needs_.scale), packed);
    packed[6] = of_.length_or_skipped(packed, first);
    for (int k = 0; k < row_floats - 1; ++k)
      streamable.row[k].store(columns_.row[k] + first), packed[k].store(columns_.packed[k] + first);
    streamable.row[7].store(columns_.tmax + first), streamable.row[7].store(columns_.t_lo + first);
    StreamBits(no_leaf_triangle).store(to.leaf_triangle + first);
    StreamBits::load(few_indices.of + first).store(to.number + first);
    const bool is_first = first == 0;
    for (int axis = 0; axis < 3; ++axis) {
      limits[axis].include(streamable.row[axis], is_first);
      limits[3 + axis].include(columns.origin[axis], is_first);
    }
    limits[6].include(streamable.row[6], is_first), limits[7].include(streamable.row[7], is_first);
    farthest = max(streamable.reach, farthest);
    return true;
  }
  static std::uint32_t lanes_of_vector(std::uint64_t rays, std::uint32_t v) {
    return static_cast<std::uint32_t>(rays >> v * stream_lanes) & first_lanes<stream_lanes>(stream_lanes);
  }
  // f(v, lanes) says which of the rays stay.
  template <class F>
  std::uint64_t filter(std::uint64_t rays, F f) const {
    std::uint64_t left = 0;
    for (std::uint32_t v = 0; v < vectors_; ++v)
      if (const std::uint32_t lanes = lanes_of_vector(rays, v); lanes != 0)
        left |= std::uint64_t{f(v * stream_lanes) & lanes} << v * stream_lanes;
    return left;
  }
  std::uint64_t going(const Entry& at) const {
    return filter(at.rays, [&](std::uint32_t first) {
      return bits(StreamFloats::load(columns_.tmax + first) >= StreamFloats(at.near));
    });
  }

  void visit_node(const Entry& at, Entry*& top) {
    const WideNode& node = tree_.nodes[at.reference];
    OctantNode planes(node, of_.octant_, of_.padding_);
    float entry[tree_width];
    Entry* const base = top;
    for (std::uint32_t children = columns_.frustum.boxes_met(planes, entry) & node.occupied; children != 0;
         children &= children - 1) {
      const int child = std::countr_zero(children);
      const Entry entering{node.child[child], entry[child], rays_in(planes, child, at.rays)};
      if (entering.rays == 0) continue;
      Entry* place = top++;
      for (; place != base && place[-1].near < entering.near; --place) *place = place[-1];
      *place = entering;
      raylanes::prefetch<OfCorners>(tree_, entering.reference);
    }
  }
  std::uint64_t rays_in(const OctantNode& planes, int child, std::uint64_t rays) const {
    return filter(rays, [&](std::uint32_t first) {
      const auto column = [&](int k) { return StreamFloats::load(columns_.row[k] + first); };
      const auto distance = [&](const float(&plane)[3][tree_width], int axis) {
        return multiply_add<Grade::fast>(StreamFloats(plane[axis][child]), column(axis), column(3 + axis));
      };
      StreamFloats in = max(max(distance(planes.near, 0), distance(planes.near, 1)),
                            max(distance(planes.near, 2), column(6)));
      StreamFloats out = min(min(distance(planes.far, 0), distance(planes.far, 1)),
                             min(distance(planes.far, 2), StreamFloats::load(columns_.tmax + first)));
      return bits(in <= out);
    });
  }

  void trace_singly(const Entry& at) {
    ListEntry list[min_together];
    std::uint32_t size = 0;
    for (std::uint64_t rays = at.rays; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rays));
      columns_.store_row(of_.rays_, i), list[size++] = i;
    }
    of_.calls_.trace_singly(of_, at.reference, list, size);
  }

  StreamOctant<NoCounters>& of_;
  const TreeView& tree_;
  const std::uint32_t vectors_;
  StreamColumns columns_;
  Entry stack_[max_stack];
};

}  // namespace
}  // namespace raylanes

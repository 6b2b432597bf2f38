// A ray along an axis from its origin to infinity: it meets a box exactly if two coordinates of its origin are in it,
// and the box does not end behind the third. Comparisons of floats, nothing is rounded.
#pragma once

#include "../traverse/single.hpp"

namespace raylanes {
namespace {

template <int L>
class AxisNodeTest {
 public:
  explicit AxisNodeTest(const Ray& ray) {
    const int axis = ray.direction[0] != 0.0f ? 0 : ray.direction[1] != 0.0f ? 1 : 2;
    forward_ = ray.direction[axis];
    begin_ = ray.origin[axis] * forward_;
    last_ = plane_at(axis, forward_ > 0.0f);
    for (int k = 0; k < 2; ++k) {
      const int across = (axis + 1 + k) % 3;
      across_[k] = ray.origin[across];
      low_[k] = plane_at(across, false), high_[k] = plane_at(across, true);
    }
  }

  // As NodeTest::children_hit; in any order, and none is behind the end.
  std::uint32_t children_hit(const WideNode& node, float, float (&entry)[tree_width]) const {
    std::uint32_t hit = 0;
    for (int first = 0; first < tree_width; first += L) {
      using V = Floats<L>;
      const auto planes = [&](int at) { return V::load(planes_of(node, at) + first); };
      V x(across_[0]), y(across_[1]);
      auto inside = (planes(low_[0]) <= x) & (x <= planes(high_[0])) & (planes(low_[1]) <= y) &
                    (y <= planes(high_[1])) & (V(begin_) <= planes(last_) * V(forward_));
      V(0.0f).store(entry + first);
      hit |= bits(inside) << first;
    }
    return hit & node.occupied;
  }

 private:
  float across_[2], begin_, forward_;
  int low_[2], high_[2], last_;
};

// Many rays come to no leaf: what leaves need is prepared there.
struct WalksAlongAxes {
  template <class Test, class Query, class Counters>
  static void walk(const TreeView& tree, const Ray& ray, Query& query, Counters& counters) {
    const AxisNodeTest<node_lanes> boxes(ray);
    walk_nodes(tree, boxes, query, counters, [&](TreeReference leaf) {
      const LeafRay<Test> prepared(ray, tree.bounds);
      return visit_leaf<Test>(tree, leaf, ray, prepared, query, counters);
    });
  }
};

}  // namespace
}  // namespace raylanes

// The closest point among the instances of a scene that are in no common tree.
#pragma once

#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/placed_triangle.hpp"
#include "../../../dispatch/table/points.hpp"
#include "../scene_parts.hpp"

namespace raylanes {

template <class T>
bool is_finite(const std::array<T, 3>& point) {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

// Throws std::invalid_argument unless all instances that the mask sees consist of triangles.
void require_triangles_seen(const char* call, const SceneParts& scene, std::uint32_t mask);
// The tree of an instance of triangles; null if it is empty.
const TreeView* tree_of(const SceneParts& scene, const Instance& instance);

// A closest point of a common tree, as one of the scene.
inline SceneClosestPoint in_common(const CommonTree& tree, const ClosestPoint& found) {
  if (!found) return {};
  const TriangleOwner& owner = tree.numbers().owners.of(found.primitive);
  return {found.distance_squared,        found.point,    found.u,       found.v,
          found.primitive - owner.first, owner.geometry, owner.instance};
}

// A search of closest points, checked.
struct ScenePointQuery {
  const SceneParts& scene;
  const PointKernels& kernels;
  std::uint32_t mask;
  double max_distance;
  TraceCounters* counters;

  // The closest point of a tree in the scene's space.
  ClosestPoint closest_in(const TreeView& tree, const Float3& point, double most) const;
};

// Whether a closest point comes before another one of another instance. None comes before nothing.
inline bool is_nearer(const SceneClosestPoint& a, const SceneClosestPoint& b) {
  return a.distance_squared < b.distance_squared ||
         (a.distance_squared == b.distance_squared && a.instance < b.instance);
}

// Searches through the boxes of instances, and in each instance through its nodes, nearest first (Hjaltason, Samet
// 1999). One object a thread, for any number of points.
class SceneSearch {
 public:
  explicit SceneSearch(const ScenePointQuery& query) : query_(query) {}
  // Replaces the closest point by that of an instance, if it comes before.
  void find(const Float3& point, SceneClosestPoint& closest);

 private:
  using Planes = float[3][tree_width];  // of the boxes of a node
  // A tree whose boxes are near to a point or not. Along each axis a box is d from `at`, less `error`. In the scene the
  // square of its distance to the point is at least the sum of weight·d².
  struct Tree {
    const WideNode* nodes;
    const void* blocks;          // null: that of a top level
    const std::uint32_t* order;  // of a top level
    const Instance* instance;
    std::uint32_t number;
    double at[3], error[3], weight[3];

    double distance(const Box& box) const;
    void distances(const Planes& lo, const Planes& hi, double (&squares)[tree_width]) const;
  };
  // A node or a leaf to be searched.
  struct Waiting {
    double square;
    std::uint32_t tree;
    TreeReference from;
    bool operator<(const Waiting& other) const { return square > other.square; }
  };

  void enter_top(const TopLevel& top);
  void enter(std::uint32_t number, double square);
  void add_tree(const Tree& tree, TreeReference root, double square);
  void wait(const Waiting& entry);
  Waiting nearest_waiting();
  void search(Waiting next);
  void search_top_leaf(const Waiting& entry);
  void search_leaf(const Tree& tree, LeafReference leaf);
  void search_triangle(const Tree& tree, const LeafBlock<9>& block, std::size_t lane);
  void search_as_it_stands(const Instance& instance, std::uint32_t number, const TreeView& tree);
  bool may_be_nearer(double square) const { return square <= limit_; }
  void keep(const SceneClosestPoint& found);

  ScenePointQuery query_;
  double point_[3] = {}, largest_ = 0.0;  // and its largest coordinate
  Float3 given_{};
  SceneClosestPoint best_;
  double limit_ = 0.0;
  std::vector<Tree> trees_;
  std::vector<Waiting> waiting_;
};

}  // namespace raylanes

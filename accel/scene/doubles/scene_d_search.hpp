// The closest point among the instances of a scene of doubles.
#pragma once

#include "scene_d_parts.hpp"

namespace raylanes {

// Searches through the common trees, then through the boxes of other instances and in each through its nodes, nearest
// first. One object a thread, for any number of points.
class SceneSearchD {
 public:
  SceneSearchD(const SceneDParts& scene, const DoubleRayKernels& kernels, const ClosestPointOptionsD& options)
      : scene_(scene), kernels_(kernels), mask_(options.mask), max_distance_(options.max_distance) {}
  SceneClosestPointD closest(const Double3& point);

 private:
  // A node or leaf of an instance, or of the boxes of instances, that is at least so far away.
  struct Waiting {
    double least;
    std::uint32_t instance;  // no_part: of the boxes
    TreeReference from;
    bool operator<(const Waiting& other) const { return least > other.least; }
  };

  void search_tree(const BvhDArrays& tree, const MemberNumbers& numbers);
  void enter(std::uint32_t number, double least);
  void wait(const Waiting& entry);
  void search(const Waiting& entry);
  void search_leaf(std::uint32_t number, const BvhDArrays& tree, LeafReference leaf);
  void keep(const SceneClosestPointD& found);
  double distance_to(const Double3& lo, const Double3& hi) const;
  BoxD moved(const InstanceD& instance, const BvhDArrays& tree, const WideNode& node,
             std::size_t child) const;

  const SceneDParts& scene_;
  const DoubleRayKernels& kernels_;
  std::uint32_t mask_;
  double max_distance_;
  Double3 point_{};
  double limit_ = 0;  // nothing farther away is of use
  SceneClosestPointD best_;
  std::vector<Waiting> waiting_;
};

}  // namespace raylanes

// The types of calls of trees by the number of the trees, beside the plain data of <raylanes/numbers.hpp>.
#pragma once

#include <type_traits>

#include <raylanes/doubles.hpp>
#include <raylanes/kdtree.hpp>
#include <raylanes/numbers.hpp>

namespace raylanes::python {

template <class T>
struct CallTypesOf;
template <>
struct CallTypesOf<float> {
  using Tree = TriangleTree;
  using Crossing = raylanes::Crossing;
  using Options = TraceOptions;
  using ClosestOptions = ClosestPointOptions;
  using DistanceOptions = SignedDistanceOptions;
};
template <>
struct CallTypesOf<double> {
  using Tree = BvhD;
  using Crossing = CrossingD;
  using Options = TraceOptionsD;
  using ClosestOptions = ClosestPointOptionsD;
  using DistanceOptions = SignedDistanceOptionsD;
};

// The base of all trees with these numbers.
template <class T>
using TreeOf = typename CallTypesOf<T>::Tree;

// The numbers of a kind of trees.
template <class Tree>
using NumberOf = std::conditional_t<std::is_same_v<Tree, BvhD>, double, float>;

}  // namespace raylanes::python

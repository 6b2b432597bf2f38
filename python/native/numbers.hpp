// The types of trees of floats and of doubles, by their number.
#pragma once

#include <type_traits>

#include <raylanes/doubles.hpp>
#include <raylanes/kdtree.hpp>

namespace raylanes::python {

template <class T>
struct TypesOf;
template <>
struct TypesOf<float> {
  using Tree = TriangleTree;
  using Ray = raylanes::Ray;
  using Hit = raylanes::Hit;
  using Crossing = raylanes::Crossing;
  using Ends = SegmentEnds;
  using Options = TraceOptions;
  using ClosestPoint = raylanes::ClosestPoint;
  using ClosestOptions = ClosestPointOptions;
  using DistanceOptions = SignedDistanceOptions;
};
template <>
struct TypesOf<double> {
  using Tree = BvhD;
  using Ray = RayD;
  using Hit = HitD;
  using Crossing = CrossingD;
  using Ends = SegmentEndsD;
  using Options = TraceOptionsD;
  using ClosestPoint = ClosestPointD;
  using ClosestOptions = ClosestPointOptionsD;
  using DistanceOptions = SignedDistanceOptionsD;
};

// The base of all trees with these numbers.
template <class T>
using TreeOf = typename TypesOf<T>::Tree;
template <class T>
using RayOf = typename TypesOf<T>::Ray;
template <class T>
using HitOf = typename TypesOf<T>::Hit;

// The numbers of a kind of trees.
template <class Tree>
using NumberOf = std::conditional_t<std::is_same_v<Tree, BvhD>, double, float>;

}  // namespace raylanes::python

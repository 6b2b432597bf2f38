// The plain data of rays and points by the kind of their numbers, for code that serves floats and doubles.
#pragma once

#include <array>

#include <raylanes/points.hpp>
#include <raylanes/types.hpp>

namespace raylanes {

template <class T>
struct TypesOf;
template <>
struct TypesOf<float> {
  using Ray = raylanes::Ray;
  using RayArrays = raylanes::RayArrays;
  using Hit = raylanes::Hit;
  using Box = raylanes::Box;
  using ClosestPoint = raylanes::ClosestPoint;
};
template <>
struct TypesOf<double> {
  using Ray = RayD;
  using RayArrays = RayArraysD;
  using Hit = HitD;
  using Box = BoxD;
  using ClosestPoint = ClosestPointD;
};

template <class T>
using PointOf = std::array<T, 3>;
template <class T>
using RayOf = typename TypesOf<T>::Ray;
template <class T>
using RayArraysOf = typename TypesOf<T>::RayArrays;
template <class T>
using HitOf = typename TypesOf<T>::Hit;
template <class T>
using BoxOf = typename TypesOf<T>::Box;
template <class T>
using ClosestPointOf = typename TypesOf<T>::ClosestPoint;

}  // namespace raylanes

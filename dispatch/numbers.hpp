// The plain data of rays by the kind of their numbers, for code that serves floats and doubles.
#pragma once

#include <array>

#include <raylanes/double_types.hpp>

namespace raylanes {

template <class T>
struct TypesOf;
template <>
struct TypesOf<float> {
  using Ray = raylanes::Ray;
  using RayArrays = raylanes::RayArrays;
  using Hit = raylanes::Hit;
  using Box = raylanes::Box;
};
template <>
struct TypesOf<double> {
  using Ray = RayD;
  using RayArrays = RayArraysD;
  using Hit = HitD;
  using Box = BoxD;
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

}  // namespace raylanes

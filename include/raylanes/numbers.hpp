// Rays, hits and points by the kind of their numbers: for code that serves floats and doubles.
#pragma once

#include <array>

#include <raylanes/points.hpp>
#include <raylanes/types.hpp>

namespace raylanes {

/// The plain data of a kind of number: float or double.
template <class T>
struct TypesOf;
/// The plain data of floats.
template <>
struct TypesOf<float> {
  using Ray = raylanes::Ray;                    ///< a ray
  using RayArrays = raylanes::RayArrays;        ///< rays as one array per number
  using Hit = raylanes::Hit;                    ///< a hit
  using Box = raylanes::Box;                    ///< a box
  using ClosestPoint = raylanes::ClosestPoint;  ///< a closest point
};
/// The plain data of doubles.
template <>
struct TypesOf<double> {
  using Ray = RayD;                    ///< a ray
  using RayArrays = RayArraysD;        ///< rays as one array per number
  using Hit = HitD;                    ///< a hit
  using Box = BoxD;                    ///< a box
  using ClosestPoint = ClosestPointD;  ///< a closest point
};

/// Three coordinates.
template <class T>
using PointOf = std::array<T, 3>;
/// A ray: Ray or RayD.
template <class T>
using RayOf = typename TypesOf<T>::Ray;
/// Rays as one array per number: RayArrays or RayArraysD.
template <class T>
using RayArraysOf = typename TypesOf<T>::RayArrays;
/// A hit: Hit or HitD.
template <class T>
using HitOf = typename TypesOf<T>::Hit;
/// A box: Box or BoxD.
template <class T>
using BoxOf = typename TypesOf<T>::Box;
/// A closest point: ClosestPoint or ClosestPointD.
template <class T>
using ClosestPointOf = typename TypesOf<T>::ClosestPoint;

}  // namespace raylanes

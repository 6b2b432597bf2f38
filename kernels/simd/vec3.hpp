// Three registers as a vector, and the products of vectors in the arithmetic of a grade.
#pragma once

#include "vocabulary.hpp"

namespace raylanes {
namespace {

template <class V>
struct Vec3 {
  V x, y, z;

  Vec3() = default;
  Vec3(V a, V b, V c) : x(a), y(b), z(c) {}
  // Number by number: g++ 12 keeps a copy of the whole in memory.
  Vec3(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
  Vec3& operator=(const Vec3& v) {
    x = v.x, y = v.y, z = v.z;
    return *this;
  }
};

template <class V>
inline Vec3<V> vec3(const V* xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}
template <int N>
inline void store_xyz(const Vec3<Lanes<float, N>>& v, float (*xyz)[N]) {
  v.x.store(xyz[0]), v.y.store(xyz[1]), v.z.store(xyz[2]);
}
template <int N>
inline Vec3<Lanes<float, N>> load_xyz(const float (*xyz)[N]) {
  using V = Lanes<float, N>;
  return {V::load(xyz[0]), V::load(xyz[1]), V::load(xyz[2])};
}
template <class V>
inline Vec3<V> operator+(const Vec3<V>& a, const Vec3<V>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
inline Vec3<V> operator-(const Vec3<V>& a, const Vec3<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
inline Vec3<V> operator-(const Vec3<V>& a) {
  return {-a.x, -a.y, -a.z};
}

// The operations of a grade: a kernel inherits them and calls them by their names.
template <Grade grade>
struct Arithmetic {
  template <class V>
  static V dot(const Vec3<V>& a, const Vec3<V>& b) {
    return multiply_add<grade>(a.z, b.z, multiply_add<grade>(a.y, b.y, a.x * b.x));
  }
  template <class V>
  static Vec3<V> cross(const Vec3<V>& a, const Vec3<V>& b) {
    return {multiply_add<grade>(a.y, b.z, -(a.z * b.y)), multiply_add<grade>(a.z, b.x, -(a.x * b.z)),
            multiply_add<grade>(a.x, b.y, -(a.y * b.x))};
  }
};

// The sign bit of x, to be moved to other numbers with `flip`.
template <class T, int N>
inline Lanes<typename BitsOf<T>::type, N> sign_of(Lanes<T, N> x) {
  using Bits = typename BitsOf<T>::type;
  return as<Bits>(x) & Lanes<Bits, N>(static_cast<Bits>(~(~Bits{0} >> 1)));
}
template <class T, int N>
inline Lanes<T, N> flip(Lanes<T, N> x, Lanes<typename BitsOf<T>::type, N> sign) {
  return as<T>(as<typename BitsOf<T>::type>(x) ^ sign);
}

}  // namespace
}  // namespace raylanes

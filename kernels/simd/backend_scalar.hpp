// The vocabulary with one lane: plain C++, the reference for every other back end, and part of each of them.
// Its estimates are the instructions that every processor of the platform has.
#pragma once

#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "registers/one_estimate.hpp"

namespace raylanes {
namespace {

template <class T>
struct Mask<T, 1> {
  bool raw;
  static Mask first(std::size_t count) { return {count > 0}; }
  static Mask from_bits(std::uint32_t b) { return {(b & 1u) != 0}; }
  friend Mask operator&(Mask a, Mask b) { return {a.raw && b.raw}; }
  friend Mask operator|(Mask a, Mask b) { return {a.raw || b.raw}; }
  Mask operator~() const { return {!raw}; }
  friend bool any(Mask m) { return m.raw; }
  friend bool all(Mask m) { return m.raw; }
  friend std::uint32_t bits(Mask m) { return m.raw ? 1u : 0u; }
};

template <class T>
struct Lanes<T, 1> {
  using M = Mask<T, 1>;
  T raw;

  Lanes() = default;
  Lanes(T x) : raw(x) {}
  static Lanes load(const T* p) { return *p; }
  void store(T* p) const { *p = raw; }
  static Lanes load(const T* p, M m, Lanes filler) { return m.raw ? load(p) : filler; }
  void store(T* p, M m) const {
    if (m.raw) store(p);
  }
  static Lanes load(const T* p, std::size_t count, Lanes filler) { return load(p, M::first(count), filler); }
  void store(T* p, std::size_t count) const { store(p, M::first(count)); }

  friend Lanes operator+(Lanes a, Lanes b) { return a.raw + b.raw; }
  friend Lanes operator-(Lanes a, Lanes b) { return a.raw - b.raw; }
  friend Lanes operator*(Lanes a, Lanes b) { return a.raw * b.raw; }
  friend Lanes operator/(Lanes a, Lanes b) { return a.raw / b.raw; }
  Lanes operator-() const { return -raw; }
  friend Lanes operator&(Lanes a, Lanes b) { return a.raw & b.raw; }
  friend Lanes operator|(Lanes a, Lanes b) { return a.raw | b.raw; }
  friend Lanes operator^(Lanes a, Lanes b) { return a.raw ^ b.raw; }

  friend M operator<(Lanes a, Lanes b) { return {a.raw < b.raw}; }
  friend M operator<=(Lanes a, Lanes b) { return {a.raw <= b.raw}; }
  friend M operator>(Lanes a, Lanes b) { return {a.raw > b.raw}; }
  friend M operator>=(Lanes a, Lanes b) { return {a.raw >= b.raw}; }
  friend M operator==(Lanes a, Lanes b) { return {a.raw == b.raw}; }

  friend Lanes min(Lanes a, Lanes b) { return a.raw < b.raw ? a : b; }
  friend Lanes max(Lanes a, Lanes b) { return a.raw > b.raw ? a : b; }
  friend Lanes select(M m, Lanes a, Lanes b) { return m.raw ? a : b; }
  friend Lanes select_negative(Lanes s, Lanes a, Lanes b) { return std::signbit(s.raw) ? a : b; }
  friend Lanes sqrt(Lanes a) { return std::sqrt(a.raw); }
  friend Lanes abs(Lanes a) { return std::fabs(a.raw); }
  friend Lanes rsqrt_estimate(Lanes a) { return static_cast<T>(one_rsqrt(static_cast<float>(a.raw))); }
  friend Lanes reciprocal_estimate(Lanes a) {
    return static_cast<T>(one_reciprocal(static_cast<float>(a.raw)));
  }
};

template <int half>
inline Lanes<double, 1> to_doubles(Lanes<float, 1> a) {
  return static_cast<double>(a.raw);
}
inline Lanes<float, 1> to_floats(Lanes<double, 1> a) {
  return static_cast<float>(a.raw);
}
template <class To, class From>
inline Lanes<To, 1> as(Lanes<From, 1> a) {
  return std::bit_cast<To>(a.raw);
}
template <int K, class T>
inline Lanes<T, 1> shift_left(Lanes<T, 1> a) {
  return static_cast<T>(a.raw << K);
}
template <int K, class T>
inline Lanes<T, 1> shift_right(Lanes<T, 1> a) {
  return static_cast<T>(a.raw >> K);
}

template <class T, int columns>
inline void load_rows(const void* const (&rows)[1], Lanes<T, 1> (&out)[columns]) {
  T row[columns];
  std::memcpy(row, rows[0], sizeof row);
  for (int k = 0; k < columns; ++k) out[k] = row[k];
}
template <int columns>
inline void store_rows(void* const (&rows)[1], const Lanes<float, 1> (&in)[columns]) {
  float row[columns];
  for (int k = 0; k < columns; ++k) row[k] = in[k].raw;
  std::memcpy(rows[0], row, sizeof row);
}
inline int compress_store(std::uint32_t* p, Mask<float, 1> m, Lanes<std::uint32_t, 1> words) {
  *p = words.raw;
  return m.raw ? 1 : 0;
}

}  // namespace
}  // namespace raylanes

// The vocabulary that every kernel is written in: lanes, masks and about 25 operations on them, with one
// meaning on every path. A back end (one file) spells it for a library; an operation enters only when a
// kernel uses it, and tests/simd holds each to plain scalar code on every path.
//
//   Lanes<T, N>   N lanes of T: float, double, and the unsigned integers of their width (their bits)
//   Mask<T, N>    one truth value per lane of a Lanes<T, N>
//
//   Lanes<T, N>(x)               all lanes x
//   load(p), a.store(p)          N values, any alignment
//   load(p, m, b), a.store(p, m) the values at the lanes of m, elsewhere lanes of b; float and double. Lanes that
//                                m leaves out may lie on a page that does not exist
//   load(p, n, b), a.store(p, n) the same for the first n <= N lanes
//   a + b, a - b, a * b, a / b   rounded to nearest
//   sqrt(a)                      correctly rounded
//   -a, abs(a)                   flips, clears the sign bit, of NaN too
//   min(a, b), max(a, b)         a < b ? a : b, a > b ? a : b: the second operand where one is NaN or both are
//                                zeros
//   fused(a, b, c)               a·b + c rounded once; exists only where has_fma
//   rsqrt_estimate(a)            1/sqrt(a) within 1.5·2^-12 for 2^-126 <= a <= 2^125, NaN for NaN; the bits
//                                differ between processors; where estimates_span_doubles, of all normal doubles
//   reciprocal_estimate(a)       1/a so, for such |a|
//   to_doubles<half>(a)          half the lanes of floats, the lower (0) or the upper (1), as doubles; the one there is
//   to_floats(low, high)         all of them, rounded; of one lane to_floats(a)
//   a < b, <=, >, >=, ==         false where an operand is NaN
//   m & n, m | n, ~m             of masks
//   any(m), all(m), bits(m)      lane i in bit i
//   Mask::first(n)               the first n <= N lanes;  Mask::from_bits(b)   lane i from bit i
//   select(m, a, b)              m ? a : b
//   select_negative(s, a, b)     a where the sign bit of s is set, of a zero or NaN too, else b; float only
//   as<To>(a)                    the same bits
//   shift_left<K>, shift_right<K>   zeros enter
//   load_rows(p, a)              four or eight floats at each of N places, in records of any type: number k of place i
//                                becomes lane i of a[k]; or eight doubles
//   store_rows(p, a)             and back
//   load_strips(p, a)            eight floats of each of N records, four after each other from each of N / 4 places on:
//                                lane i is record row_in_strip<N>(i) from place strip_of_lane<N>(i); of 4 lanes or more
//   store_strips(p, a)           four floats of each so, and back
//   compress_store(p, m, a)      the words of the lanes of m, packed, at p, where N are written; returns their number
//   integers: + - & | ^          modulo 2^width; max of unsigned numbers
//
// On paths with eight lanes or more and FMA (has_node_lanes), for single rays:
//   four_floats(a, b, c, d)      four lanes from four numbers; four_doubles so
//   permute<i, j, k, l>(a)       lanes i, j, k, l of four floats or doubles
//   permute(a, order)            lane order[i] of four floats or eight words, modulo the lanes
//   blend<bits>(a, b)            lane i of b where bit i is set, else of a; of four floats or doubles
//   eight_of_lane<i>(a)          lane i of four floats in eight lanes
//   to_four_doubles(a)           four floats as doubles, to_four_floats(a) back, rounded
//   four_sums(a, b, c, d)        of four doubles each: (a[0] + a[1]) + (a[2] + a[3]), the same of b, c, d
//   three_columns(a, b, c, d, x) lane k of four doubles each become x[k], for the first three lanes
//   min_unsigned(a)              the least of eight words
//   sort_descending_signed(a)    eight words as signed numbers, the largest first
//   in_memory(object)            the same object: its members are read from memory at each use
//
// Everything lives in an unnamed namespace: an object compiled for AVX2 must not share a function with
// baseline code through the linker.
// Kernels do not call their local lanes, masks, vectors and rays const: g++ 12 takes the call that makes such an object
// for a store to constant memory. It then keeps the object on the stack ("store to a read-only decl" in the file that
// -fdump-tree-sra-details writes).
#pragma once

#include <cstddef>
#include <cstdint>

#include <raylanes/types.hpp>

// The table of a unit's functions, by the name of the path: the only symbol that leaves the object.
#define RAYLANES_UNIT_TABLE(Kernels, name, ...) \
  namespace detail::RAYLANES_PATH_NAME {        \
  extern constinit const Kernels name;          \
  constinit const Kernels name{__VA_ARGS__};    \
  }

namespace raylanes {
namespace {

template <class T, int N>
struct Lanes;
template <class T, int N>
struct Mask;

inline constexpr int row_floats = 8;

// Strips of four rows that follow each other: which strip and which row of it a lane is, as columns take fewest moves.
template <int N>
constexpr int strip_of_lane(int lane) {
  return N == 16 ? lane % 4 : lane / 4;
}
template <int N>
constexpr int row_in_strip(int lane) {
  return N == 16 ? lane / 4 : lane % 4;
}

template <class T>
struct BitsOf;
template <>
struct BitsOf<float> {
  using type = std::uint32_t;
};
template <>
struct BitsOf<double> {
  using type = std::uint64_t;
};

// The bits of the first n <= N lanes, as Mask::first(n) has them.
template <int N>
constexpr std::uint32_t first_lanes(std::size_t n) {
  return n < std::size_t{N} ? (1u << n) - 1u : (2u << (N - 1)) - 1u;
}

// Bit i for lane i.
template <class Word>
inline constexpr Word bit_of_lane[16] = {1,        1u << 1,  1u << 2,  1u << 3, 1u << 4,  1u << 5,
                                         1u << 6,  1u << 7,  1u << 8,  1u << 9, 1u << 10, 1u << 11,
                                         1u << 12, 1u << 13, 1u << 14, 1u << 15};

}  // namespace
}  // namespace raylanes

// The build seam: one back end per translation unit, chosen by the build (see the paths in meson.build).
// One lane is plain C++ on all of them.
#include "backend_scalar.hpp"
#if defined(RAYLANES_BACKEND_SCALAR)
#include "backend_one_lane.hpp"
#elif defined(RAYLANES_BACKEND_XSIMD)
#include "backend_xsimd.hpp"
#elif defined(RAYLANES_BACKEND_HIGHWAY)
#include "backend_highway.hpp"
#else
#error "compile with one of RAYLANES_BACKEND_SCALAR, RAYLANES_BACKEND_XSIMD, RAYLANES_BACKEND_HIGHWAY"
#endif

#include "derived.hpp"
#if defined(__AVX2__) && defined(__FMA__)
#include "registers/node_lanes.hpp"
#endif

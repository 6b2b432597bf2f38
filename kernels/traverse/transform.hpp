// Rays in another space, by doubles, rounded once.
#pragma once

#include "../exact/edge_bounds.hpp"
#include "../ray/ray_columns.hpp"

namespace raylanes {
namespace {

// Half the lanes of a row of the map, whose columns are stored one after the other: the products of floats and doubles,
// each rounded, added from left to right.
template <int half, int N>
inline auto mapped_half(const double* row, const Vec3<Floats<N>>& p, bool is_point) {
  using V = decltype(to_doubles<half>(p.x));
  V linear = (V(row[0]) * to_doubles<half>(p.x) + V(row[3]) * to_doubles<half>(p.y)) +
             V(row[6]) * to_doubles<half>(p.z);
  return is_point ? linear + V(row[9]) : linear;
}
template <int N>
inline Floats<N> mapped(const double* row, const Vec3<Floats<N>>& p, bool is_point) {
  if constexpr (N == 1)
    return to_floats(mapped_half<0>(row, p, is_point));
  else
    return to_floats(mapped_half<0>(row, p, is_point), mapped_half<1>(row, p, is_point));
}

// A register of rays.
inline void map_register(const void* const (&from)[native_lanes], const double* map,
                         void* const (&to)[native_lanes]) {
  using V = Floats<native_lanes>;
  V c[row_floats];
  load_rows(from, c);
  Vec3<V> origin(c[0], c[1], c[2]), direction(c[4], c[5], c[6]);
  for (int axis = 0; axis < 3; ++axis) {
    c[axis] = mapped(map + axis, origin, true);
    c[4 + axis] = mapped(map + axis, direction, false);
  }
  // A direction of subnormals has lost its digits: it is none.
  auto is_none = largest_magnitude(c[4], c[5], c[6]) < V(0x1p-126f);
  for (int axis = 0; axis < 3; ++axis) c[4 + axis] = select(is_none, V(0.0f), c[4 + axis]);
  store_rows(to, c);
}

// As QueryKernels has it.
[[gnu::noinline, maybe_unused]] void map_rays(const Ray* rays, const std::uint32_t* numbers, std::size_t size,
                                              const double* map, Ray* out) {
  const void* from[native_lanes];
  void* to[native_lanes];
  std::size_t first = 0;
  if (numbers == nullptr)  // places that the compiler knows
    for (; size - first >= native_lanes; first += native_lanes) {
      for (std::size_t lane = 0; lane < native_lanes; ++lane)
        from[lane] = rays + first + lane, to[lane] = out + first + lane;
      map_register(from, map, to);
    }
  Ray spare;
  for (; first < size; first += native_lanes) {
    for (std::size_t lane = 0; lane < native_lanes; ++lane) {
      const std::size_t i = first + lane < size ? first + lane : size - 1;
      from[lane] = rays + (numbers != nullptr ? numbers[i] : i);
      to[lane] = first + lane < size ? out + i : &spare;
    }
    map_register(from, map, to);
  }
}

}  // namespace
}  // namespace raylanes

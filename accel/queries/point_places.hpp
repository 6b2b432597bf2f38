// The places of points, by the crossings of a ray from each along an axis: towards the side of the box that is nearest,
// where little is in the way; of points in a line along an axis by the crossings of that line.
#pragma once

#include "lists.hpp"

namespace raylanes {

// The directions of rays, by the sides of a box that they go to. With a length of 4 any crossing of finite numbers has
// a finite t: the ray goes to infinity.
template <class T>
inline constexpr PointOf<T> directions_to_sides[] = {{-4, 0, 0}, {4, 0, 0},  {0, -4, 0},
                                                     {0, 4, 0},  {0, 0, -4}, {0, 0, 4}};

// The side of a box that is nearest to a point; if the point is outside, a side that a ray from it to there goes away
// from the box by. Without a branch on which side it is: neighbours differ.
struct NearestSide {
  std::size_t side = 0;
  bool inside = true;

  template <class T>
  NearestSide(const std::array<T, 3>& point, const BoxOf<T>& box) {
    T nearest = std::numeric_limits<T>::infinity();
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t axis = k / 2;
      const T way = k % 2 == 0 ? point[axis] - box.lo[axis] : box.hi[axis] - point[axis];
      const bool is_nearer = way < nearest;
      inside = inside & (way >= 0);  // NaN is not
      nearest = is_nearer ? way : nearest, side = is_nearer ? k : side;
    }
  }
};

// The points whose rays are asked for.
template <class T>
struct Points {
  using Ray = RayOf<T>;
  VertexRecords<T> view;
  const BoxOf<T>& bounds;
  LaneBits active;

  const Ray* in_place() const { return nullptr; }
  bool takes_part(std::size_t i) const { return raylanes::takes_part(active, i); }
  bool takes_all() const { return active == nullptr; }
  // The first active point from i on; view.count if there is none.
  std::size_t active_from(std::size_t i) const {
    while (i < view.count && !takes_part(i)) ++i;
    return i;
  }
  // The last active point before i; i if there is none.
  std::size_t active_before(std::size_t i) const {
    std::size_t k = i;
    while (k > 0 && !takes_part(k - 1)) --k;
    return k > 0 ? k - 1 : i;
  }
};

// The place of a point: what locate() and winding_numbers() need of the triangles that its ray crosses.
struct PointPlace {
  std::int32_t
      halves;  // twice the crossings of its ray, by sum_of_sides(); those at the point itself count half
  std::uint16_t side;  // that its ray goes to; outside_box: it has none, and crosses nothing
  bool is_on;          // whether a triangle holds it
};
inline constexpr std::uint16_t outside_box = 6;

// By the list of a point's own ray, which stops at_origin: then crossings are not known.
template <class T>
[[gnu::always_inline]] inline PointPlace place_by_own_ray(std::span<ListEntryOf<T>> list,
                                                          std::uint16_t side) {
  if (!list.empty() && list.back().side == 0) return {0, side, true};
  return {2 * sum_of_sides<T>(list.size() < 2 ? list : distinct(list)), side, false};
}

// Calls take(first, places) for some of the points from `begin` to `end` at a time, in order: their places, anything
// for inactive ones. Lists by the maker are of sides and stop at_origin. Unless counts_on, points on triangles have no
// crossings. For the part of one thread.
template <class T>
void each_places(const ListMaker<T>& maker, const Points<T>& points, std::size_t begin, std::size_t end,
                 bool counts_on, TraceCounters* counters,
                 const std::function<void(std::size_t first, std::span<const PointPlace> places)>& take);

}  // namespace raylanes

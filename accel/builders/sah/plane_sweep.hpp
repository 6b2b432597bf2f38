// The best plane among all between neighbouring centres of references (MacDonald, Booth 1990).
#pragma once

#include "../in_place.hpp"

namespace raylanes {

// Centres below it go left.
struct Plane {
  float cost = infinite_float;  // of both sides
  std::size_t axis = 0;
  float at = 0.0f;
};

// A Room(count) has for each reference
//   void set(i, place): where its centre is; then sort(), and
//   std::size_t at(rank): the number of the one of that rank
//   right_costs[rank], and Room::cost(box, count) for a side of a plane.
template <class Room>
class PlaneSweep {
 public:
  explicit PlaneSweep(std::span<const Reference> references)
      : references_(references), room_(references.size()) {}

  // Puts a plane across that axis into `best` if one costs less.
  void try_axis(std::size_t axis, Plane& best) {
    const std::size_t count = references_.size();
    for (std::size_t i = 0; i < count; ++i) room_.set(i, place(references_[i], axis));
    room_.sort();
    Box4 box = empty_four_box;
    for (std::size_t i = count; i-- > 1;) {
      extend(box, at(i).box);
      room_.right_costs[i] = Room::cost(box, count - i);
    }
    box = empty_four_box;
    for (std::size_t i = 1; i < count; ++i) {
      extend(box, at(i - 1).box);
      const float cost = Room::cost(box, i) + room_.right_costs[i];
      if (cost < best.cost && place(at(i - 1), axis) < place(at(i), axis))
        best = {cost, axis, place(at(i), axis)};
    }
  }

 private:
  const Reference& at(std::size_t rank) const { return references_[room_.at(rank)]; }

  std::span<const Reference> references_;
  Room room_;
};

}  // namespace raylanes

#include "../../batch/sort_keys.hpp"
#include "../in_place.hpp"

namespace raylanes {
namespace {

// Smaller numbers of the same order as the floats, which are no NaN.
std::uint64_t ordered_bits(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

struct Plane {
  float cost = infinite_float;
  std::size_t axis = 0;
  float at = 0.0f;  // centres below it go left
};

// The best plane between two of the references sorted by their centres along an axis.
class Sweep {
 public:
  explicit Sweep(std::span<const Reference> references)
      : references_(references), keys_(references.size()), right_costs_(references.size()) {}

  void try_axis(std::size_t axis, Plane& best) {
    for (std::size_t i = 0; i < keys_.size(); ++i)
      keys_[i] = ordered_bits(place(references_[i], axis)) << 32 | i;
    sort_keys(keys_.part(0, keys_.size()));
    Box4 box = empty_four_box;
    for (std::size_t i = keys_.size(); i-- > 1;) {
      extend(box, at(i).box);
      right_costs_[i] = cost_of_side(box, keys_.size() - i);
    }
    box = empty_four_box;
    for (std::size_t i = 1; i < keys_.size(); ++i) {
      extend(box, at(i - 1).box);
      const float cost = cost_of_side(box, i) + right_costs_[i];
      const bool between_two = keys_[i - 1] >> 32 != keys_[i] >> 32;
      if (between_two && cost < best.cost) best = {cost, axis, place(at(i), axis)};
    }
  }

  static std::size_t bytes(std::size_t references) {
    return references * (sizeof(std::uint64_t) + sizeof(float));
  }

 private:
  const Reference& at(std::size_t i) const { return references_[keys_[i] & 0xffffffffu]; }

  std::span<const Reference> references_;
  Array<std::uint64_t> keys_;
  Array<float> right_costs_;
};

class SweepSah : public InPlace {
 public:
  SweepSah(Array<Reference> references, MemoryMeter& memory)
      : InPlace(std::move(references), memory), memory_(memory) {}

  bool split(const Part& part, int depth, int, Part& left, Part& right) {
    if (part.count <= max_in_leaf) return false;
    Plane best;
    if (depth < last_split_depth) {
      const HeldMemory held(memory_, Sweep::bytes(part.count));
      Sweep sweep(of(part));
      for (std::size_t axis = 0; axis < 3; ++axis) sweep.try_axis(axis, best);
    }
    const auto is_below = [&](Vec4 at) { return place(at, best.axis) < best.at; };
    if (best.cost == infinite_float || !partition(part, is_below, left, right)) halve(part, left, right);
    return true;
  }

 private:
  MemoryMeter& memory_;
};

}  // namespace

BinaryTree build_sweep_sah(BuildInput input) {
  return build_in_place<SweepSah>(input);
}

}  // namespace raylanes

#include "../../batch/sort_keys.hpp"
#include "plane_sweep.hpp"

namespace raylanes {
namespace {

struct RoomForMany {
  Array<std::uint64_t> keys;
  Array<float> right_costs;

  explicit RoomForMany(std::size_t count) : keys(count), right_costs(count) {}
  void set(std::size_t i, float place) {
    const auto bits = std::bit_cast<std::uint32_t>(place);
    // Numbers of the same order as the floats, which are no NaN.
    const std::uint64_t ordered = (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
    keys[i] = ordered << 32 | i;
  }
  void sort() { sort_keys(keys.part(0, keys.size())); }
  std::size_t at(std::size_t rank) const { return keys[rank] & 0xffffffffu; }
  static float cost(const Box4& side, std::size_t count) { return cost_of_side(side, count); }
  static std::size_t bytes(std::size_t count) { return count * (sizeof(std::uint64_t) + sizeof(float)); }
};

class SweepSah : public InPlace {
 public:
  SweepSah(Array<Reference> references, MemoryMeter& memory)
      : InPlace(std::move(references), memory), memory_(memory) {}

  bool split(const Part& part, int depth, int, Part& left, Part& right) {
    if (part.count <= max_in_leaf) return false;
    Plane best;
    if (depth < last_split_depth) {
      const HeldMemory held(memory_, RoomForMany::bytes(part.count));
      PlaneSweep<RoomForMany> sweep(of(part));
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

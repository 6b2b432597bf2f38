#include "object_bins.hpp"
#include "plane_sweep.hpp"

namespace raylanes {
namespace {

// Up to so many references are divided by the best of all planes: so leaves are fuller than by bins.
constexpr std::size_t max_swept = 32;

class RoomForFew {
 public:
  float right_costs[max_swept];

  explicit RoomForFew(std::size_t count) : count_(count) {
    for (Vec4& four : places_) four = Vec4{} + infinite_float;
  }
  void set(std::size_t i, float place) { places_[i / 4][i % 4] = place; }
  // A rank is how many come before: no branch, which would be guessed wrongly half the time.
  void sort() {
    constexpr Vec4i earlier[4] = {{0, 0, 0, 0}, {-1, 0, 0, 0}, {-1, -1, 0, 0}, {-1, -1, -1, 0}};
    const std::size_t fours = (count_ + 3) / 4;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t own = i / 4;
      const Vec4 place = Vec4{} + places_[own][i % 4];
      Vec4i before = (places_[own] < place) | ((places_[own] == place) & earlier[i % 4]);
      for (std::size_t k = 0; k < own; ++k) before += places_[k] <= place;
      for (std::size_t k = own + 1; k < fours; ++k) before += places_[k] < place;
      by_rank_[-(before[0] + before[1] + before[2] + before[3])] = static_cast<std::uint8_t>(i);
    }
  }
  std::size_t at(std::size_t rank) const { return by_rank_[rank]; }
  // Half by leaves and half by triangles, which streams and packets test one at a time.
  static float cost(const Box4& side, std::size_t count) {
    const std::size_t lanes = (count + tree_width - 1) / tree_width * tree_width;
    return half_area(side) * static_cast<float>(lanes + count);
  }

 private:
  std::size_t count_;
  Vec4 places_[max_swept / 4];
  std::uint8_t by_rank_[max_swept];
};

struct BinnedSah : InPlace {
  using InPlace::InPlace;

  bool split(const Part& part, int depth, int threads, Part& left, Part& right) {
    if (part.count <= max_in_leaf) return false;
    if (depth >= last_split_depth || !divide_by_area(part, threads, left, right)) halve(part, left, right);
    return true;
  }

 private:
  bool divide_by_area(const Part& part, int threads, Part& left, Part& right) {
    if (part.count <= tree_width) return divide_few(part, left, right);
    if (part.count <= max_swept) return divide_some(part, left, right);
    const Binning binning(part.centres, part.count);
    const BinBorder border = best_border(of(part), binning, threads);
    if (border.cost == infinite_float) return false;
    const auto is_below = [&](Vec4 at) { return binning.is_below(at, border); };
    return partition(part, is_below, {border.left, border.right}, left, right);
  }

  bool divide_some(const Part& part, Part& left, Part& right) {
    Plane best;
    PlaneSweep<RoomForFew> sweep(of(part));
    for (std::size_t axis = 0; axis < 3; ++axis) sweep.try_axis(axis, best);
    if (best.cost == infinite_float) return false;
    return partition(
        part, [=](Vec4 at) { return place(at, best.axis) < best.at; }, left, right);
  }

  // Divides a part that may become one leaf at the middle of its centres: bins would cost more than they gain.
  bool divide_few(const Part& part, Part& left, Part& right) {
    const std::size_t axis = longest_axis(part.centres);
    const float middle = centre(part.centres)[axis];
    return partition(
        part, [=](Vec4 at) { return place(at, axis) < middle; }, left, right);
  }
};

}  // namespace

BinaryTree build_binned_sah(BuildInput input) {
  return build_in_place<BinnedSah>(input);
}

}  // namespace raylanes

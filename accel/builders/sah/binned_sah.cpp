#include "object_bins.hpp"

namespace raylanes {
namespace {

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
    const Binning binning(part.centres, part.count);
    const BinBorder border = best_border(of(part), binning, threads);
    if (border.cost == infinite_float) return false;
    const auto is_below = [&](Vec4 at) { return binning.is_below(at, border); };
    return partition(part, is_below, {border.left, border.right}, left, right);
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

#include "in_place.hpp"

namespace raylanes {
namespace {

struct EqualPartition : InPlace {
  using InPlace::InPlace;

  bool split(const Part& part, int depth, int, Part& left, Part& right) {
    if (part.count <= max_in_leaf) return false;
    const std::size_t axis = longest_axis(part.box);
    const float middle = centre(part.box)[axis];
    const auto is_below = [=](Vec4 at) { return place(at, axis) < middle; };
    if (depth >= last_split_depth || !partition(part, is_below, left, right)) halve(part, left, right);
    return true;
  }
};

}  // namespace

BinaryTree build_equal_partition(BuildInput input) {
  return build_in_place<EqualPartition>(input);
}

}  // namespace raylanes

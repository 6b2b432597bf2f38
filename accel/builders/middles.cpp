// Builders that cut at a middle: of the box, or of the references in order.

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

struct Median : InPlace {
  using InPlace::InPlace;

  bool split(const Part& part, int, int, Part& left, Part& right) {
    if (part.count <= max_in_leaf) return false;
    const std::size_t axis = longest_axis(part.box);
    const std::span<Reference> list = of(part);
    // Equal centres by number: the halves are the same however the list is sorted.
    const auto is_before = [axis](const Reference& a, const Reference& b) {
      const float at_a = place(a, axis), at_b = place(b, axis);
      return at_a < at_b || (at_a == at_b && a.primitive() < b.primitive());
    };
    std::nth_element(list.begin(), list.begin() + part.count / 2, list.end(), is_before);
    halve(part, left, right);
    return true;
  }
};

}  // namespace

BinaryTree build_equal_partition(BuildInput input) {
  return build_in_place<EqualPartition>(input);
}

BinaryTree build_median(BuildInput input) {
  return build_in_place<Median>(input);
}

}  // namespace raylanes

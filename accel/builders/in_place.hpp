// Splits that move references about in their array.
#pragma once

#include "top_down.hpp"

namespace raylanes {

// The number of an axis along which a box is longest; NaN and overflow choose some.
inline std::size_t longest_axis(const Box4& box) {
  const Vec4 extent = box.hi - box.lo;
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (extent[axis] > extent[longest]) longest = axis;
  return longest;
}

// For order: the centre along an axis, that of an empty box before all others.
inline float place(Vec4 centre, std::size_t axis) {
  const float at = centre[axis];
  return at == at ? at : -infinite_float;
}
inline float place(const Reference& reference, std::size_t axis) {
  return place(centre(reference.box), axis);
}

class InPlace {
 public:
  InPlace(Array<Reference> references, MemoryMeter& memory)
      : references_(std::move(references)), held_(memory, references_.bytes()) {}

  std::size_t size() const { return references_.size(); }
  std::uint32_t primitive(std::size_t position) const { return references_[position].primitive(); }
  void let_go() {
    references_ = {};
    held_.release();
  }
  std::span<Reference> of(const Part& part) { return references_.part(part.begin, part.count); }

  // The first of them, or all, with their boxes.
  Part measured(std::size_t count, int threads) const {
    constexpr std::size_t grain = 1 << 14;
    Part part = empty_part(0);
    part.count = part.capacity = static_cast<std::uint32_t>(count);
    std::mutex mutex;
    in_parallel(count, grain, threads, [&](std::size_t begin, std::size_t end) {
      Part mine = empty_part(0);
      for (std::size_t i = begin; i < end; ++i) include(mine, references_[i]);
      const std::lock_guard lock(mutex);
      extend(part.box, mine.box);
      extend(part.centres, mine.centres);
    });
    return part;
  }

  // The first `left_count` go left, in the order in which they lie.
  void divide(const Part& part, std::uint32_t left_count, Part& left, Part& right) {
    left = empty_part(part.begin);
    right = empty_part(part.begin + left_count);
    const std::span<Reference> list = of(part);
    for (const Reference& reference : list.first(left_count)) include(left, reference);
    for (const Reference& reference : list.subspan(left_count)) include(right, reference);
    left.capacity = left.count, right.capacity = right.count;
  }
  void halve(const Part& part, Part& left, Part& right) { divide(part, part.count / 2, left, right); }

  // References whose centres `goes_left` takes go left. Returns false and makes no parts if this separates nothing.
  template <class GoesLeft>
  bool partition(const Part& part, const GoesLeft& goes_left, Part& left, Part& right) {
    Box4 boxes[2], centres[2];
    const std::uint32_t left_count = partition_centres(part, goes_left, centres);
    if (left_count == 0 || left_count == part.count) return false;
    const std::span<const Reference> list = of(part);
    boxes[0] = box_of(list.first(left_count)), boxes[1] = box_of(list.subspan(left_count));
    make_parts(part, left_count, boxes, centres, left, right);
    return true;
  }
  // The same partition if the boxes of both sides are known.
  template <class GoesLeft>
  bool partition(const Part& part, const GoesLeft& goes_left, const Box4 (&boxes)[2], Part& left,
                 Part& right) {
    Box4 centres[2];
    const std::uint32_t left_count = partition_centres(part, goes_left, centres);
    if (left_count == 0 || left_count == part.count) return false;
    make_parts(part, left_count, boxes, centres, left, right);
    return true;
  }

 private:
  static Part empty_part(std::uint32_t begin) { return {begin, 0, 0, empty_four_box, empty_four_box}; }
  static Box4 box_of(std::span<const Reference> list) {
    Box4 box = empty_four_box;
    for (const Reference& reference : list) extend(box, reference.box);
    return box;
  }

  // Returns how many go left, and the boxes around the centres of both sides. Without a branch on where a reference
  // goes: half of them would be guessed wrongly.
  template <class GoesLeft>
  std::uint32_t partition_centres(const Part& part, const GoesLeft& goes_left, Box4 (&centres)[2]) {
    Box4 left = empty_four_box, right = empty_four_box;
    Reference* const list = references_.data() + part.begin;
    std::uint32_t left_count = 0;
    for (std::uint32_t i = 0; i < part.count; ++i) {
      const Reference reference = list[i];
      const Vec4 at = centre(reference.box);
      const bool goes = goes_left(at);
      const Vec4i to_left = Vec4i{} - static_cast<std::int32_t>(goes);
      left.lo = least(to_left ? at : empty_four_box.lo, left.lo);
      left.hi = greatest(to_left ? at : empty_four_box.hi, left.hi);
      right.lo = least(to_left ? empty_four_box.lo : at, right.lo);
      right.hi = greatest(to_left ? empty_four_box.hi : at, right.hi);
      list[i] = list[left_count];
      list[left_count] = reference;
      left_count += goes;
    }
    centres[0] = left, centres[1] = right;
    return left_count;
  }

  static void make_parts(const Part& part, std::uint32_t left_count, const Box4 (&boxes)[2],
                         const Box4 (&centres)[2], Part& left, Part& right) {
    const std::uint32_t right_count = part.count - left_count;
    left = {part.begin, left_count, left_count, boxes[0], centres[0]};
    right = {part.begin + left_count, right_count, right_count, boxes[1], centres[1]};
  }

  static void include(Part& part, const Reference& reference) {
    extend(part.box, reference.box);
    extend(part.centres, centre(reference.box));
    ++part.count;
  }

  Array<Reference> references_;
  HeldMemory held_;
};

// Builds by a splitter that is an InPlace with a split of its own.
template <class Splitter>
BinaryTree build_in_place(BuildInput& input) {
  Splitter splitter(std::move(input.references), input.run.memory);
  const Part root = splitter.measured(splitter.size(), input.run.threads);
  return TopDown(splitter, splitter.size(), input).build(root);
}

}  // namespace raylanes

// Rays of doubles that are traced together, as rays of floats in the frame of the tree.
#pragma once

#include "double_search.hpp"

namespace raylanes {
namespace {

// t as it is in the frame, at least. Not NaN.
template <class V>
inline V rounded_up_in_frame(V t, V scale) {
  return min(multiply_add<Grade::fast>(t * scale, V(1.0 + 0x1p-22), V(0x1p-120)), V(0x1p127));
}

struct DoublesTogether : TraceBatch {
  const DoubleTreeView* tree;
  const RayD* doubles;
  HitD* hits;

  DoublesTogether(const DoubleTreeView& of, const DoubleBatch& batch)
      : tree(&of), doubles(batch.rays), hits(batch.hits) {
    size = batch.size, scratch = batch.scratch, occluded = batch.occluded;
    facing = batch.facing, skip = batch.skip;
  }

  bool only_decides() const { return occluded != nullptr; }
  void trace_single(std::size_t number) const {
    const RayD& ray = doubles[number];
    const std::uint32_t skipped = skipped_by(*this, number);
    if (only_decides())
      occluded[number] = hits_any(*tree, ray, DoubleHitRule(facing, skipped)) ? 1 : 0;
    else
      hits[number] = closest_double_of_ray(*tree, ray, facing, skipped);
  }
};

}  // namespace
}  // namespace raylanes

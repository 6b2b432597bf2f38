// Inputs to time intersection loops on.
#pragma once

#include <new>

#include <raylanes/types.hpp>

#include "../../support/scenes/splitmix.hpp"
#include "../../support/std.hpp"

namespace raylanes::bench {

// Few enough for the first-level cache: 13 columns of 512 floats are 26 KB.
inline constexpr std::size_t timed_primitives = 512;

// Columns begin at a cache line, as a user in a hurry would have them: no load straddles two lines.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};
using Column = std::vector<float, CacheLineAllocator<float>>;
using ColumnList = std::vector<Column>;

// A soup around a ray. The columns serve triangles, boxes, spheres and rays.
class KernelInputs {
 public:
  KernelInputs() {
    SplitMix random(5);
    const auto fill = [&](Column& column, double lo, double hi) {
      column.resize(timed_primitives);
      for (float& x : column) x = static_cast<float>(lo + (hi - lo) * random.uniform());
    };
    for (auto& column : corners_) fill(column, -1, 1);
    for (auto& column : rays_) fill(column, -0.1, 0.1);
    for (std::size_t i = 0; i < timed_primitives; ++i) {
      rays_[2][i] -= 3, rays_[5][i] += 1, rays_[6][i] = 0;
      rays_[7][i] = std::numeric_limits<float>::infinity();
    }
    boxes_ = {corners_[0], corners_[1], corners_[2], corners_[3], corners_[4], corners_[5]};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < timed_primitives; ++i)
        if (boxes_[k][i] > boxes_[3 + k][i]) std::swap(boxes_[k][i], boxes_[3 + k][i]);
    spheres_ = {corners_[0], corners_[1], corners_[2], corners_[3]};
    for (float& square : spheres_[3]) square *= square * 0.2f;
    for (auto& output : output_) output.resize(timed_primitives);
    bits_.resize(timed_primitives / 8);
  }

  Ray ray() const { return {{0.1f, 0.2f, -3}, 0, {0.01f, 0.02f, 1}, std::numeric_limits<float>::infinity()}; }
  RayArrays rays() const {
    return {{rays_[0].data(), rays_[1].data(), rays_[2].data()},
            {rays_[3].data(), rays_[4].data(), rays_[5].data()},
            rays_[6].data(),
            rays_[7].data(),
            timed_primitives};
  }
  static std::vector<const float*> pointers(const ColumnList& columns) {
    std::vector<const float*> all;
    for (const auto& column : columns) all.push_back(column.data());
    return all;
  }
  const ColumnList& corners() const { return corners_; }
  const ColumnList& boxes() const { return boxes_; }
  const ColumnList& spheres() const { return spheres_; }
  std::uint8_t* bits() { return bits_.data(); }
  float* output(std::size_t k) { return output_[k].data(); }

 private:
  Column rays_[8], output_[3];
  ColumnList corners_{9}, boxes_, spheres_;
  std::vector<std::uint8_t> bits_;
};

// One primitive of columns, as the loops for many rays take it.
inline std::vector<float> first_of(const ColumnList& columns) {
  std::vector<float> one;
  for (const auto& column : columns) one.push_back(column[0]);
  return one;
}

}  // namespace raylanes::bench

// Rays, triangles and boxes as the kernels take them, every column an array of its own that
// notices writes around it.
#pragma once

#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "../../dispatch/table.hpp"
#include "guarded_array.hpp"

namespace raylanes::testing {

// Floats by column and row.
class FloatColumns {
 public:
  FloatColumns(std::size_t columns, std::size_t rows, Place place);
  float* operator[](std::size_t column) { return columns_[column].data(); }
  // True while nothing around the columns has changed.
  bool are_intact();

 private:
  std::deque<GuardedArray<float>> columns_;
};

class RayColumns {
 public:
  explicit RayColumns(std::span<const Ray> rays, Place place = Place::unguarded);
  RayArrays arrays();
  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  FloatColumns columns_;
};

class TriangleColumns {
 public:
  explicit TriangleColumns(std::span<const Triangle> triangles, Place place = Place::unguarded);
  TriangleArrays arrays();
  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  FloatColumns columns_;
};

class BoxColumns {
 public:
  explicit BoxColumns(std::span<const Box> boxes, Place place = Place::unguarded);
  BoxArrays arrays();
  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  FloatColumns columns_;
};

// One row of the results; equality is that of the bits.
struct TriangleResult {
  float t, u, v;
  std::uint32_t hit;
  friend bool operator==(const TriangleResult& a, const TriangleResult& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  }
};
struct BoxResult {
  float entry, exit;
  std::uint32_t hit;
  friend bool operator==(const BoxResult& a, const BoxResult& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  }
};
inline constexpr std::uint32_t hit_flag = 0xffffffffu;
inline constexpr TriangleResult triangle_missed{std::numeric_limits<float>::infinity(), 0, 0, 0};
inline constexpr BoxResult box_missed{std::numeric_limits<float>::infinity(),
                                      -std::numeric_limits<float>::infinity(), 0};

// Bit i of the answers to a yes/no query, and of a mask of active lanes.
inline bool is_set(std::span<const std::uint8_t> bits, std::size_t i) {
  return (bits[i / 8] >> (i % 8) & 1u) != 0;
}

class TriangleHitColumns {
 public:
  explicit TriangleHitColumns(std::size_t rows, Place place = Place::unguarded)
      : rows_(rows), floats_(3, rows, place), bits_((rows + 7) / 8, place) {}
  TriangleHits hits() {
    return {{bits_.data(), bits_.size()}, {floats_[0], rows_}, {floats_[1], rows_}, {floats_[2], rows_}};
  }
  TriangleResult operator[](std::size_t i) {
    return {floats_[0][i], floats_[1][i], floats_[2][i],
            is_set({bits_.data(), bits_.size()}, i) ? hit_flag : 0};
  }
  bool are_intact() { return floats_.are_intact() && bits_.is_intact(); }

 private:
  std::size_t rows_;
  FloatColumns floats_;
  GuardedArray<std::uint8_t> bits_;
};

// Two floats and a yes or no for each of some elements: intervals of boxes, distances of spheres.
class IntervalColumns {
 public:
  explicit IntervalColumns(std::size_t rows, Place place = Place::unguarded)
      : rows_(rows), floats_(2, rows, place), bits_((rows + 7) / 8, place) {}
  float* from() { return floats_[0]; }
  float* to() { return floats_[1]; }
  std::uint8_t* bits() { return bits_.data(); }
  bool is_hit(std::size_t i) { return is_set({bits_.data(), bits_.size()}, i); }
  BoxResult operator[](std::size_t i) { return {floats_[0][i], floats_[1][i], is_hit(i) ? hit_flag : 0}; }
  // True while nothing around the arrays has changed, nor a bit behind the last.
  bool are_intact();

 private:
  std::size_t rows_;
  FloatColumns floats_;
  GuardedArray<std::uint8_t> bits_;
};

}  // namespace raylanes::testing

// Rays, triangles and boxes as the kernels take them, every column an array of its own that
// notices writes around it.
#pragma once

#include <deque>

#include <raylanes/boxes.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../bench/support/oracles/exact_sphere.hpp"
#include "../../dispatch/table/rows.hpp"
#include "guarded_array.hpp"
#include "random_input.hpp"
#include "same_bytes.hpp"

namespace raylanes::testing {

// Floats by column and row.
class FloatColumns {
 public:
  FloatColumns(std::size_t columns, std::size_t rows, Place place) {
    for (std::size_t i = 0; i < columns; ++i) columns_.emplace_back(rows, place);
  }
  float* operator[](std::size_t column) { return columns_[column].data(); }
  // True while nothing around the columns has changed.
  bool are_intact() {
    return std::ranges::all_of(columns_, [](GuardedArray<float>& column) { return column.is_intact(); });
  }

 private:
  std::deque<GuardedArray<float>> columns_;
};

// The numbers of an element, in the order of the kernels' arrays.
inline std::array<float, 8> numbers_of(const Ray& ray) {
  const Float3 &o = ray.origin, &d = ray.direction;
  return {o[0], o[1], o[2], d[0], d[1], d[2], ray.tmin, ray.tmax};
}
inline std::array<float, 9> numbers_of(const Triangle& triangle) {
  const auto& [a, b, c] = triangle.corner;
  return {a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]};
}
inline std::array<float, 6> numbers_of(const Box& box) {
  return {box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]};
}
inline std::array<float, 4> numbers_of(const oracle::Sphere& sphere) {
  return std::to_array(sphere.value);
}

// The same arrays as the public calls take them.
inline RayArrays arrays_of(const Ray*, Soa p, std::size_t size) {
  return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, p[6], p[7], size};
}
inline TriangleArrays arrays_of(const Triangle*, Soa p, std::size_t size) {
  return {{{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}}, size};
}
inline BoxArrays arrays_of(const Box*, Soa p, std::size_t size) {
  return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, size};
}
inline SphereArrays arrays_of(const oracle::Sphere*, Soa p, std::size_t size) {
  return {{p[0], p[1], p[2]}, p[3], size};
}

// Elements as one array per number.
template <class Element>
class Columns {
 public:
  explicit Columns(std::span<const Element> elements, Place place = Place::unguarded)
      : size_(elements.size()), columns_(numbers_of(Element{}).size(), size_, place) {
    for (std::size_t k = 0; k < numbers_of(Element{}).size(); ++k) {
      for (std::size_t i = 0; i < size_; ++i) columns_[k][i] = numbers_of(elements[i])[k];
      pointers_.push_back(columns_[k]);
    }
  }
  const std::vector<const float*>& pointers() const { return pointers_; }
  Soa soa() const { return pointers_.data(); }
  auto arrays() const { return arrays_of(static_cast<const Element*>(nullptr), soa(), size_); }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  FloatColumns columns_;
  std::vector<const float*> pointers_;
};
using RayColumns = Columns<Ray>;
using TriangleColumns = Columns<Triangle>;
using BoxColumns = Columns<Box>;
using SphereColumns = Columns<oracle::Sphere>;

// One row of the results; equality is that of the bits.
struct TriangleResult {
  float t, u, v;
  std::uint32_t hit;
  friend bool operator==(const TriangleResult& a, const TriangleResult& b) { return same_bytes(a, b); }
};
struct IntervalResult {
  float from, to;
  std::uint32_t hit;
  friend bool operator==(const IntervalResult& a, const IntervalResult& b) { return same_bytes(a, b); }
};
inline constexpr std::uint32_t hit_flag = 0xffffffffu;
inline constexpr TriangleResult triangle_missed{std::numeric_limits<float>::infinity(), 0, 0, 0};
inline constexpr IntervalResult interval_missed{std::numeric_limits<float>::infinity(),
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
  IntervalResult operator[](std::size_t i) {
    return {floats_[0][i], floats_[1][i], is_hit(i) ? hit_flag : 0};
  }
  // True while nothing around the arrays has changed, nor a bit behind the last.
  bool are_intact() {
    IntervalColumns untouched(rows_);
    bool intact = floats_.are_intact() && bits_.is_intact();
    for (std::size_t i = rows_; i < 8 * bits_.size(); ++i)
      intact = intact && is_hit(i) == untouched.is_hit(i);
    return intact;
  }

 private:
  std::size_t rows_;
  FloatColumns floats_;
  GuardedArray<std::uint8_t> bits_;
};

// check(inputs(n, place), place, active) for any length up to `most`, beside both guards, without a mask and with all
// of them; ends with the first fatal failure.
template <class Inputs, class Check>
void for_all_masks(std::size_t most, const Inputs& inputs, const Check& check) {
  Random random(206);
  for (const Place place : {Place::before_guard, Place::after_guard})
    for (std::size_t n = 0; n <= most; ++n) {
      auto in = inputs(n, place);
      check(in, place, LaneBits(nullptr));
      for (const std::vector<std::uint8_t>& mask : masks_for(n, random)) {
        GuardedArray<std::uint8_t> guarded(mask.size(), place);
        guarded.fill(mask);
        check(in, place, LaneBits(guarded.data()));
      }
      if (::testing::Test::HasFatalFailure()) return;
    }
}

}  // namespace raylanes::testing

// Helpers that the fuzz targets share.
#pragma once

#include <raylanes/paths.hpp>
#include <raylanes/triangles.hpp>

#include "../simd/float_control.hpp"
#include "bytes.hpp"
#include "targets.hpp"

namespace raylanes::testing {

// A test that trees take.
inline TriangleTest any_tree_test(Bytes& bytes) {
  return static_cast<TriangleTest>(bytes.below(tree_test_names.size()));
}

// The paths of this machine, asked once.
inline const std::vector<const Path*>& fuzzed_paths() {
  static const std::vector<const Path*> here = [] {
    std::vector<const Path*> all;
    for (const Path& path : paths())
      if (supported(path)) all.push_back(&path);
    return all;
  }();
  return here;
}

// Rounding as IEEE 754 has it, or with results and operands that are subnormal taken for zero; put back at
// the end. Fails if what was called in between changed it.
class Rounding {
 public:
  explicit Rounding(bool flush) : before_(float_control()), set_(flush ? before_ | flush_to_zero : before_) {
    set_float_control(set_);
  }
  ~Rounding() {
    const std::uint64_t now = float_control();
    set_float_control(before_);
    if (now != set_) fail("the floating-point control register was changed");
  }
  Rounding(const Rounding&) = delete;
  Rounding& operator=(const Rounding&) = delete;

 private:
  std::uint64_t before_, set_;
};

// Coordinates in one of several styles: any bits, or so that rays meet things: on a lattice, ordinary ones
// about 1, and those with a few odd ones among them.
class Coordinates {
 public:
  explicit Coordinates(Bytes& bytes) : bytes_(bytes), style_(bytes.below(4)) {}
  float operator()() {
    if (style_ == 0 || (style_ == 3 && bytes_.chance(24))) return bytes_.number<float>();
    if (style_ == 1) return static_cast<float>(static_cast<int>(bytes_.below(9)) - 4) / 2;
    return static_cast<float>(static_cast<std::int16_t>(bytes_.word<std::uint16_t>())) * 0x1p-14f;
  }

 private:
  Bytes& bytes_;
  std::size_t style_;
};

// Equal bits, one NaN being like another.
template <class T>
bool same(T a, T b) {
  return (a == b && std::signbit(a) == std::signbit(b)) || (std::isnan(a) && std::isnan(b));
}

}  // namespace raylanes::testing

// What the library answers to the fixed inputs, as hashes of the bits. The adapter between inputs that stay
// and an interface that may change: only its .cpp files name kernels.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/points.hpp>

namespace raylanes::testing {

// FNV-1a over 32-bit words (Fowler, Noll, Vo). One NaN is like another: IEEE 754 leaves their bits open.
class Hash {
 public:
  void add(std::uint32_t word) { state_ = (state_ ^ word) * 0x100000001b3u; }
  void add(float x) { add(std::isnan(x) ? 0x7fc00000u : std::bit_cast<std::uint32_t>(x)); }
  void add(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(std::isnan(x) ? std::nan("") : x);
    add(static_cast<std::uint32_t>(bits));
    add(static_cast<std::uint32_t>(bits >> 32));
  }
  void add(std::span<const std::uint8_t> bits) {
    for (const std::uint8_t byte : bits) add(std::uint32_t{byte});
  }
  void add(const Hit& hit) { add(hit.t), add(hit.u), add(hit.v), add(hit.primitive); }
  void add(const ClosestPoint& closest) {
    add(closest.distance_squared), add(closest.u), add(closest.v), add(closest.primitive);
    for (const float x : closest.point) add(x);
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

// By the name of what was asked: "sqrt hardware", "triangle watertight 1xN".
using Hashes = std::map<std::string, std::uint64_t>;

// Every reproducible root, and every triangle, box, sphere and point test of the reproducible grade, on one path.
Hashes hashes_of_roots(const Path& path);
Hashes hashes_of_tests(const Path& path);

// Closest and any hits of rays through both trees over the mesh, in each mode, for each path: "NAME exact stream bvh";
// and what is beyond the nearest hit: "NAME lists bvh", "NAME points bvh".
std::vector<Hashes> hashes_of_tree(const std::vector<const Path*>& paths, const std::string& name,
                                   const Mesh& mesh, const Float3& eye);

}  // namespace raylanes::testing

// What the library answers to the fixed inputs, as hashes of the bits. The adapter between inputs that stay
// and an interface that may change: only its .cpp names kernels.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>

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
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

// By the name of what was asked: "sqrt hardware", "triangle watertight 1xN".
using Hashes = std::map<std::string, std::uint64_t>;

// Every reproducible root, and every triangle, box and sphere test of the reproducible grade, on one path.
Hashes hashes_of_roots(const Path& path);
Hashes hashes_of_tests(const Path& path);

// Closest and any hits of rays through both trees over the mesh, in each mode, for each path: "NAME exact stream bvh".
std::vector<Hashes> hashes_of_tree(const std::vector<const Path*>& paths, const std::string& name,
                                   const Mesh& mesh, const Float3& eye);

}  // namespace raylanes::testing

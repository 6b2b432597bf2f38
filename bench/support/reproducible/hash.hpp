// Hashes of answers, by their bits.
#pragma once

#include "../std.hpp"

namespace raylanes::bench {

// FNV-1a over 32-bit words (Fowler, Noll, Vo). One NaN is like another: IEEE 754 leaves their bits open.
class Hash {
 public:
  void add(std::uint32_t word) { state_ = (state_ ^ word) * 0x100000001b3u; }
  void add(float x) { add(std::isnan(x) ? 0x7fc00000u : std::bit_cast<std::uint32_t>(x)); }
  void add(double x) {
    const auto bits = std::isnan(x) ? 0x7ff8000000000000u : std::bit_cast<std::uint64_t>(x);
    add(static_cast<std::uint32_t>(bits));
    add(static_cast<std::uint32_t>(bits >> 32));
  }
  void add(std::span<const std::uint8_t> bits) {
    for (const std::uint8_t byte : bits) add(std::uint32_t{byte});
  }
  // Hits of any kind, and closest points.
  template <class Found>
  requires requires(const Found& found) { found.primitive; }
  void add(const Found& found) {
    if constexpr (requires { found.t; })
      add(found.t);
    else
      add(found.distance_squared);
    add(found.u), add(found.v), add(found.primitive);
    if constexpr (requires { found.point; })
      for (const auto x : found.point) add(x);
    if constexpr (requires { found.distance; }) add(found.distance);
  }
  void add_hash(std::uint64_t hash) {
    add(static_cast<std::uint32_t>(hash));
    add(static_cast<std::uint32_t>(hash >> 32));
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

// Hashes by the name of the query: "sqrt hardware", "triangle watertight 1xN".
using Hashes = std::map<std::string, std::uint64_t>;

}  // namespace raylanes::bench

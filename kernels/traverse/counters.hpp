// The counts of a walk: none, at no cost, or those that TraceCounters holds.
#pragma once

#include <cstdint>

#include <raylanes/traversal.hpp>

namespace raylanes {
namespace {

// Tests come as the bits of a mask, one for each ray or child that takes part, and in so many registers.
struct NoCounters {
  template <class Batch>
  explicit NoCounters(const Batch&) {}
  void node() const {}
  void leaf() const {}
  void boxes(std::uint32_t, int = 1) const {}
  void triangles(std::uint32_t, int = 1) const {}
  void frusta(std::uint32_t, int = 1) const {}
  void hits(std::uint32_t) const {}
  void undecided(std::uint32_t) const {}
};

class CountTests {
 public:
  template <class Batch>
  explicit CountTests(const Batch& batch) : to_(*batch.counters) {}
  void node() const { ++to_.nodes; }
  void leaf() const { ++to_.leaves; }
  void boxes(std::uint32_t tests, int registers = 1) const { add(to_.box_tests, tests, registers); }
  void triangles(std::uint32_t tests, int registers = 1) const { add(to_.triangle_tests, tests, registers); }
  void frusta(std::uint32_t tests, int registers = 1) const { add(to_.frustum_tests, tests, registers); }
  void hits(std::uint32_t lanes) const { add(to_.hits, lanes, 0); }
  void undecided(std::uint32_t lanes) const { add(to_.undecided, lanes, 0); }

 private:
  // One by one: std::popcount is a call of libgcc where the processor has no instruction for it.
  void add(std::uint64_t& sum, std::uint32_t lanes, int registers) const {
    to_.registers += static_cast<std::uint64_t>(registers);
    for (; lanes != 0; lanes &= lanes - 1) ++sum;
  }

  TraceCounters& to_;
};

}  // namespace
}  // namespace raylanes

// What a walk counts: nothing, at no cost, or what TraceCounters holds.
#pragma once

#include <cstdint>

#include <raylanes/traversal.hpp>

namespace raylanes {
namespace {

struct NoCounters {
  void node() const {}
  void leaf(int) const {}
  void hits(std::uint32_t) const {}
};

struct CountTests {
  TraceCounters& counters;

  void node() const { ++counters.nodes; }
  void leaf(int triangles) const {
    ++counters.leaves;
    counters.triangles += static_cast<std::uint64_t>(triangles);
  }
  // One by one: std::popcount is a call of libgcc where the processor has no instruction for it.
  void hits(std::uint32_t lanes) const {
    for (; lanes != 0; lanes &= lanes - 1) ++counters.hits;
  }
};

}  // namespace
}  // namespace raylanes

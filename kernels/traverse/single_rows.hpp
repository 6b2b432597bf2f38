// The rows of single rays, counted or not.
#pragma once

#include "../../dispatch/table.hpp"
#include "../triangle/all_tests.hpp"
#include "one_by_one.hpp"

namespace raylanes {
namespace {

// Large packets, streams and walks of planes have code of thousands of bytes a test, so only the tests that gain most
// by them are offered.
using BatchTests = TestList<Exact, Watertight, MollerTrumbore>;

constexpr std::size_t no_scratch(std::size_t) {
  return 0;
}

template <class Walk, class Counters>
struct SingleRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_single<Walk, Test, Counters>, any_single<Walk, Test, Counters>, no_scratch};
  }
};

}  // namespace
}  // namespace raylanes

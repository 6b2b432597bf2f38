// The traversals of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "../../dispatch/table.hpp"
#include "../triangle/all_tests.hpp"
#include "large_packet/batch.hpp"
#include "packet.hpp"
#include "single.hpp"
#include "streams.hpp"

namespace raylanes {
namespace {

constexpr std::size_t no_scratch(std::size_t) {
  return 0;
}

struct SingleRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_single<Test>, any_single<Test>, no_scratch};
  }
};
// Packets and streams have code of thousands of bytes a test, so only the tests that gain most by them are offered.
using BatchTests = TestList<Exact, Watertight, MollerTrumbore>;
struct PacketRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_packet<Test>, any_packet<Test>, [](std::size_t) { return packet_scratch_bytes; }};
  }
};
struct LargePacketRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_large_packet<Test>, any_large_packet<Test>,
            [](std::size_t) { return sizeof(LargePacketScratch<Test, SharedPoint::origin>); }};
  }
};
struct BundleRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {trace_bundles<Test, false>, trace_bundles<Test, true>,
            [](std::size_t) { return sizeof(LargePacketScratch<Test, SharedPoint::none>); }};
  }
};
struct StreamRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_stream<Test>, any_stream<Test>, OctantScratch::bytes};
  }
};

constexpr TraversalKernels all_modes() {
  TraversalKernels kernels{};
  kernels.mode[static_cast<std::size_t>(TraversalMode::single)] =
      rows_of<TraversalRows>(TriangleTests{}, SingleRows());
  kernels.mode[static_cast<std::size_t>(TraversalMode::packet)] =
      rows_of<TraversalRows>(BatchTests{}, PacketRows());
  kernels.mode[static_cast<std::size_t>(TraversalMode::large_packet)] =
      rows_of<TraversalRows>(BatchTests{}, LargePacketRows());
  kernels.mode[static_cast<std::size_t>(TraversalMode::bundle)] =
      rows_of<TraversalRows>(BatchTests{}, BundleRows());
  kernels.mode[static_cast<std::size_t>(TraversalMode::stream)] =
      rows_of<TraversalRows>(BatchTests{}, StreamRows());
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const TraversalKernels traversal;
constinit const TraversalKernels traversal = all_modes();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes

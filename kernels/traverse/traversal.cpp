// The traversals of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "../../dispatch/table.hpp"
#include "../triangle/all_tests.hpp"
#include "packet.hpp"
#include "single.hpp"

namespace raylanes {
namespace {

struct SingleRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_single<Test>, any_single<Test>, 0, 0};
  }
};
// Packets have code of thousands of bytes a test, so only the tests that gain most by them are offered.
using PacketTests = TestList<Exact, Watertight, MollerTrumbore>;
struct PacketRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_packet<Test>, any_packet<Test>, packet_scratch_bytes, 0};
  }
};

constexpr TraversalKernels all_modes() {
  TraversalKernels kernels{};
  kernels.mode[static_cast<std::size_t>(TraversalMode::single)] =
      rows_of<TraversalRows>(TriangleTests{}, SingleRows());
  kernels.mode[static_cast<std::size_t>(TraversalMode::packet)] =
      rows_of<TraversalRows>(PacketTests{}, PacketRows());
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const TraversalKernels traversal;
constinit const TraversalKernels traversal = all_modes();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes

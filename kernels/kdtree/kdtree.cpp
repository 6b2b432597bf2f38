// The traversals of k-d trees of one path: compiled once per path with its flags and back end; the table is the only
// symbol that leaves the object.
#include "../../dispatch/table.hpp"
#include "../triangle/all_tests.hpp"
#include "packet.hpp"
#include "single.hpp"

namespace raylanes {
namespace {

constexpr std::size_t no_scratch(std::size_t) {
  return 0;
}

struct SingleRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_single<InCells<Test>>, any_single<InCells<Test>>, no_scratch};
  }
};
struct PacketRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_packet<InCells<Test>>, any_packet<InCells<Test>>,
            [](std::size_t) { return kd_packet_scratch_bytes; }};
  }
};

// Modes without rows walk eights of cells as they walk the nodes of a BVH: by its rows.
constexpr KdKernels all_modes() {
  KdKernels kernels{};
  kernels.mode[static_cast<std::size_t>(TraversalMode::single)] =
      rows_of<TraversalRows>(TriangleTests{}, SingleRows());
  kernels.mode[static_cast<std::size_t>(TraversalMode::packet)] =
      rows_of<TraversalRows>(TestList<Exact, Watertight, MollerTrumbore>{}, PacketRows());
  return kernels;
}

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const KdKernels kdtree;
constinit const KdKernels kdtree = all_modes();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes

// Compiled once per path with the flags and the back end of its kernels.
#include "../../dispatch/table/traversal.hpp"
#include "../../kernels/exact/exact_test.hpp"
#include "../../kernels/traverse/single.hpp"
#include "ablated.hpp"

namespace raylanes {
namespace {

template <bool front_to_back, bool culls>
struct Ablated : ClosestCandidate {
  const float tmax_of_ray;

  explicit Ablated(const Ray& ray) : ClosestCandidate(ray), tmax_of_ray(finite_tmax(ray.tmax)) {}
  float box_tmax() const { return culls ? tmax : tmax_of_ray; }
  static bool is_behind(const Entry& entry, const Ablated& query) {
    return culls && NearestFirst::is_behind(entry, query);
  }
  static Entry descend(Entry*& top, const WideNode& node, std::uint32_t children,
                       const float (&t)[tree_width]) {
    if constexpr (front_to_back) return NearestFirst::descend(top, node, children, t);
    for (; children != 0; children &= children - 1) {
      const int child = std::countr_zero(children);
      *top++ = {node.child[child], t[child]};
    }
    return *--top;
  }
};

template <bool front_to_back, bool culls>
void closest(const TreeView& tree, const TraceBatch& batch) {
  using Query = Ablated<front_to_back, culls>;
  hits_of_some<1>(TreeTriangles(tree), batch, 0, [&](std::size_t i) {
    return closest_candidate<WalksNodes, Exact<Grade::reproducible>, Query>(tree, batch.rays[i],
                                                                            CountTests(batch), BothSides());
  });
}

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_ABLATED_OF(path) RAYLANES_JOIN(path, _ablated)

extern constinit const bench::AblatedSearches RAYLANES_ABLATED_OF(RAYLANES_PATH_NAME);
constinit const bench::AblatedSearches RAYLANES_ABLATED_OF(RAYLANES_PATH_NAME) = {
    {{closest<false, false>, closest<false, true>}, {closest<true, false>, closest<true, true>}}};

}  // namespace detail
}  // namespace raylanes

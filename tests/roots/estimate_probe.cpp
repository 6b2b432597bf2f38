// Compiled once per path with the flags and the back end of its kernels: their text, with estimates of the test's
// choice. The table is the only symbol that leaves the object.
#include "estimate_probe.hpp"

#include "../../kernels/roots/domain_check.hpp"
#include "../../kernels/roots/reciprocal_methods.hpp"

namespace raylanes {
namespace {

constexpr int lanes = native_lanes, registers = 4, numbers = lanes * registers;
using V = Lanes<float, lanes>;
using Registers = Lockstep<V, registers>;

// The estimate that a method gets instead of the instruction's result.
Registers estimate;
inline Registers rsqrt_estimate(const Registers&) {
  return estimate;
}
inline Registers reciprocal_estimate(const Registers&) {
  return estimate;
}

template <class M>
Extent sweep(float x, float low, float high) {
  const auto first = std::bit_cast<std::uint32_t>(low), last = std::bit_cast<std::uint32_t>(high);
  std::uint32_t start[numbers];
  for (int i = 0; i < numbers; ++i) start[i] = first + static_cast<std::uint32_t>(i);
  const Registers a = ValueTraits<Registers>::number(x);
  Registers least = ValueTraits<Registers>::number(no_limit<float>), greatest;
  for (int i = 0; i < registers; ++i) greatest.part[i] = V(-no_limit<float>);
  for (std::uint32_t step = 0; step <= last - first; step += numbers) {
    for (int i = 0; i < registers; ++i)
      estimate.part[i] = min(as<float>(BitsLike<V>::load(start + i * lanes) + BitsLike<V>(step)), V(high));
    const Registers y = root_of<M>(a);
    for (int i = 0; i < registers; ++i) {
      least.part[i] = min(least.part[i], y.part[i]);
      greatest.part[i] = max(greatest.part[i], y.part[i]);
    }
  }
  float ends[2][numbers];
  for (int i = 0; i < registers; ++i)
    least.part[i].store(ends[0] + i * lanes), greatest.part[i].store(ends[1] + i * lanes);
  Extent extent{ends[0][0], ends[1][0]};
  for (int i = 1; i < numbers; ++i)
    extent = {ends[0][i] < extent.least ? ends[0][i] : extent.least,
              ends[1][i] > extent.greatest ? ends[1][i] : extent.greatest};
  return extent;
}

template <class M>
constexpr SweptMethod swept(SweptMethod::Function function) {
  return {function, static_cast<std::size_t>(M::id), sweep<M>};
}

constexpr SweptMethod methods[] = {
    swept<Estimate>(SweptMethod::square_root),
    swept<EstimateResidual<1>>(SweptMethod::square_root),
    swept<EstimateResidual<2>>(SweptMethod::square_root),
    swept<Goldschmidt>(SweptMethod::square_root),
    swept<ReciprocalRootEstimate>(SweptMethod::reciprocal_root),
    swept<ReciprocalRootNewton>(SweptMethod::reciprocal_root),
    swept<ReciprocalRootCorrected>(SweptMethod::reciprocal_root),
    swept<ReciprocalEstimate>(SweptMethod::reciprocal),
    swept<ReciprocalNewton>(SweptMethod::reciprocal),
    swept<ReciprocalResidual>(SweptMethod::reciprocal),
};

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_ESTIMATES_OF(path) RAYLANES_JOIN(path, _estimates)

extern constinit const EstimateTable RAYLANES_ESTIMATES_OF(RAYLANES_PATH_NAME);
constinit const EstimateTable RAYLANES_ESTIMATES_OF(RAYLANES_PATH_NAME) = {methods, std::size(methods),
                                                                           estimate_error<float>, has_fma};

}  // namespace detail
}  // namespace raylanes

// Compiled once per path with the flags of its kernels and -ffast-math. The table is the only symbol that leaves the
// object.
#include "short_probe.hpp"

#include <raylanes/roots.hpp>

namespace raylanes {
namespace {

#define RAYLANES_CALL(function, T)                                               \
  [](const T* x, T* y, std::size_t n, std::uint8_t accuracy) {                   \
    function(std::span(x, n), std::span(y, n), static_cast<Accuracy>(accuracy)); \
  }

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_SHORT_CALLS_OF(path) RAYLANES_JOIN(path, _short_calls)

extern constinit const ShortCalls RAYLANES_SHORT_CALLS_OF(RAYLANES_PATH_NAME);
constinit const ShortCalls RAYLANES_SHORT_CALLS_OF(RAYLANES_PATH_NAME) = {
    {RAYLANES_CALL(sqrt, float), RAYLANES_CALL(rsqrt, float), RAYLANES_CALL(reciprocal, float)},
    {RAYLANES_CALL(sqrt, double), RAYLANES_CALL(rsqrt, double), RAYLANES_CALL(reciprocal, double)}};

}  // namespace detail
}  // namespace raylanes

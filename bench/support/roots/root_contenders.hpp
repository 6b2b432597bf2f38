// Methods of roots that the library does not have: no ISA path has them on its front of error and time. `raylanes
// roots` judges and times them beside the library's. Plain types only, as units of ISA paths include this.
#pragma once

#include <iterator>

#include "../../../dispatch/table/roots.hpp"

namespace raylanes::bench {

inline constexpr RootPromise sqrt_contenders[] = {
    {"weighted_1", true, 3638.0, 3638.0}, {"weighted_2", true, 1.2, 1.2},
    {"halley", true, 118.0, 118.0},       {"polynomial_1", true, 9460.0, 9460.0},
    {"polynomial_3", true, 11.5, 11.5},   {"polynomial_2_residual", false, 0.507, 1.1},
    {"estimate_newton", false, 5.0, 5.5},
};
inline constexpr RootPromise rsqrt_contenders[] = {{"quake_1", true, 29400.0, 29400.0}};

// The functions of one path, in the order of the promises.
struct RootContenders {
  ArrayFunction<float> sqrt[std::size(sqrt_contenders)];
  ArrayFunction<float> rsqrt[std::size(rsqrt_contenders)];
};

}  // namespace raylanes::bench

// Faults of emulated processors that the tests see for themselves and step around, aloud.
#pragma once

#include <xmmintrin.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "../../dispatch/table.hpp"
#include "supported_paths.hpp"

namespace raylanes::testing {

// Whether RSQRT14 is wrong for odd powers of two, as in the emulator Bochs 2.7, which takes that of 2 for 1.
// Tests then leave out exact powers of two. The first call says so. An estimate that is wrong on a path
// without AVX-512 is no such fault, but a bug that the tests shall find.
inline bool has_wrong_estimates() {
  static const bool wrong = [] {
    for (const Path* path : supported_paths()) {
      if (!path->required.contains({CpuFeature::avx512f})) continue;
      const std::vector<float> x(256, 2.0f);
      std::vector<float> y(x.size());
      path->kernels.roots.rsqrt.by[static_cast<std::size_t>(RsqrtMethod::estimate)](x.data(), y.data(),
                                                                                 x.size());
      if (std::fabs(y[0] * std::sqrt(2.0f) - 1.0f) < 0x1p-10f) continue;
      std::fprintf(stderr, "SKIPPED powers of two: %s estimates 1/sqrt(2) as %g, a fault of the emulator\n",
                   path->name, static_cast<double>(y[0]));
      return true;
    }
    return false;
  }();
  return wrong;
}

// Whether RSQRTPS computes with subnormals, which processors take for zeros, as Intel's manual has it; the
// emulator QEMU 7.2 does. Roots of subnormals by the estimate are then no better than those of other numbers,
// and tests leave them out. The first call says so.
inline bool estimates_subnormals() {
  static const bool wrong = [] {
    const volatile float subnormal = 0x1p-140f;
    if (std::isinf(_mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(subnormal))))) return false;
    std::fprintf(stderr, "SKIPPED subnormals: RSQRTPS computes with them, a fault of the emulator\n");
    return true;
  }();
  return wrong;
}

}  // namespace raylanes::testing

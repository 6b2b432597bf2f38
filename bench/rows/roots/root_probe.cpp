// Compiled once per path with the flags and the back end of its kernels.
#include "root_probe.hpp"

#include "../../../kernels/simd/vocabulary.hpp"

#if defined(RAYLANES_BACKEND_XSIMD)
#include <sleef.h>
#endif

namespace raylanes {
namespace {

// Left to the compiler, which may make vectors of it.
void plain_loop(const float* x, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) y[i] = __builtin_sqrtf(x[i]);
}

// One value at a time, with any compiler.
void single_loop(const float* x, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    float a = x[i];
    __asm__ volatile("" : "+x"(a));
    y[i] = __builtin_sqrtf(a);
  }
}

#if defined(RAYLANES_BACKEND_XSIMD)
using Batch = xsimd::batch<float, Arch<float, native_lanes>>;

template <class F>
inline void each_batch(const float* x, float* y, std::size_t n, F f) {
  for (std::size_t i = 0; i + native_lanes <= n; i += native_lanes)
    f(Batch::load_unaligned(x + i)).store_unaligned(y + i);
}
void xsimd_sqrt(const float* x, float* y, std::size_t n) {
  each_batch(x, y, n, [](Batch a) { return xsimd::sqrt(a); });
}
#if !defined(__AVX512F__)  // xsimd 8.1.0: does not compile there
void xsimd_rsqrt(const float* x, float* y, std::size_t n) {
  each_batch(x, y, n, [](Batch a) { return a * xsimd::rsqrt(a); });
}
#endif
#if defined(__AVX512F__)
#define RAYLANES_SLEEF(bound) Sleef_sqrtf16_##bound##avx512f
#elif defined(__AVX2__)
#define RAYLANES_SLEEF(bound) Sleef_sqrtf8_##bound##avx2
#elif defined(__AVX__)
#define RAYLANES_SLEEF(bound) Sleef_sqrtf8_##bound##avx
#else
#define RAYLANES_SLEEF(bound) Sleef_sqrtf4_##bound##sse2
#endif
void sleef_u05(const float* x, float* y, std::size_t n) {
  each_batch(x, y, n, [](Batch a) { return Batch(RAYLANES_SLEEF(u05)(a.data)); });
}
void sleef_u35(const float* x, float* y, std::size_t n) {
  each_batch(x, y, n, [](Batch a) { return Batch(RAYLANES_SLEEF(u35)(a.data)); });
}
constexpr bench::RootContender contenders[] = {
    {"compiler_loop", 0.5, plain_loop},   {"one_at_a_time", 0.5, single_loop},
    {"xsimd_sqrt", 0.5, xsimd_sqrt},
#if !defined(__AVX512F__)
    {"xsimd_rsqrt", 8192.0, xsimd_rsqrt},
#endif
    {"sleef_u05", 0.6, sleef_u05},        {"sleef_u35", 3.5, sleef_u35}};
#elif defined(RAYLANES_BACKEND_HIGHWAY)
template <class F>
inline void each_vector(const float* x, float* y, std::size_t n, F f) {
  const hn::FixedTag<float, native_lanes> d;
  for (std::size_t i = 0; i + native_lanes <= n; i += native_lanes)
    hn::StoreU(f(hn::LoadU(d, x + i)), d, y + i);
}
void highway_sqrt(const float* x, float* y, std::size_t n) {
  each_vector(x, y, n, [](auto a) { return hn::Sqrt(a); });
}
void highway_rsqrt(const float* x, float* y, std::size_t n) {
  each_vector(x, y, n, [](auto a) { return hn::Mul(a, hn::ApproximateReciprocalSqrt(a)); });
}
constexpr bench::RootContender contenders[] = {{"compiler_loop", 0.5, plain_loop},
                                               {"one_at_a_time", 0.5, single_loop},
                                               {"highway_sqrt", 0.5, highway_sqrt},
                                               {"highway_rsqrt", 8192.0, highway_rsqrt}};
#else
constexpr bench::RootContender contenders[] = {{"compiler_loop", 0.5, plain_loop},
                                               {"one_at_a_time", 0.5, single_loop}};
#endif

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_PROBE_OF(path) RAYLANES_JOIN(path, _roots)

extern constinit const bench::RootProbe RAYLANES_PROBE_OF(RAYLANES_PATH_NAME);
constinit const bench::RootProbe RAYLANES_PROBE_OF(RAYLANES_PATH_NAME) = {
    contenders, sizeof(contenders) / sizeof(contenders[0])};

}  // namespace detail
}  // namespace raylanes

// Compiled once per path with the flags and the back end of its kernels.
#include "course_roots.hpp"

#include "../../../kernels/roots/domain_check.hpp"
#include "../../../kernels/roots/sqrt_methods.hpp"

namespace raylanes {
namespace {

// An empty statement that claims to change the value keeps a compiler from making vectors of what is to be one value
// at a time.
inline float kept_single(float x) {
#if defined(__SSE2__)
  __asm__ volatile("" : "+x"(x));
#else
  __asm__ volatile("" : "+m"(x));
#endif
  return x;
}

inline float classic_root_of_one(float x) {
  return with_special_values<Classic<2>>(Lanes<float, 1>(x)).raw;
}

[[gnu::flatten]] void one_at_a_time(const float* x, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) y[i] = classic_root_of_one(kept_single(x[i]));
}

[[gnu::flatten]] void four_a_loop(const float* x, float* y, std::size_t n) {
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    y[i] = classic_root_of_one(kept_single(x[i]));
    y[i + 1] = classic_root_of_one(kept_single(x[i + 1]));
    y[i + 2] = classic_root_of_one(kept_single(x[i + 2]));
    y[i + 3] = classic_root_of_one(kept_single(x[i + 3]));
  }
  for (; i < n; ++i) y[i] = classic_root_of_one(kept_single(x[i]));
}

// Left to the compiler, which makes vectors of it or not.
[[gnu::flatten]] void arrays_of_four(const float* x, float* y, std::size_t n) {
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    float a[4], s[4];
    for (int k = 0; k < 4; ++k) a[k] = x[i + static_cast<std::size_t>(k)];
    for (int k = 0; k < 4; ++k) s[k] = classic_root_of_one(a[k]);
    for (int k = 0; k < 4; ++k) y[i + static_cast<std::size_t>(k)] = s[k];
  }
  for (; i < n; ++i) y[i] = classic_root_of_one(x[i]);
}

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_COURSE_OF(path) RAYLANES_JOIN(path, _course_roots)

extern constinit const bench::CourseRoots RAYLANES_COURSE_OF(RAYLANES_PATH_NAME);
constinit const bench::CourseRoots RAYLANES_COURSE_OF(RAYLANES_PATH_NAME) = {
    {{"classic_2_one_at_a_time", one_at_a_time},
     {"classic_2_four_a_loop", four_a_loop},
     {"classic_2_arrays_of_four", arrays_of_four}}};

}  // namespace detail
}  // namespace raylanes

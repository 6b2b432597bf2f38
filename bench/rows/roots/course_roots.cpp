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

template <int Steps>
inline float classic_root_of_one(float x) {
  return with_special_values<Classic<Steps>>(Lanes<float, 1>(x)).raw;
}

template <int Steps>
[[gnu::flatten]] void one_at_a_time(const float* x, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) y[i] = classic_root_of_one<Steps>(kept_single(x[i]));
}

template <int Steps>
[[gnu::flatten]] void four_a_loop(const float* x, float* y, std::size_t n) {
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    y[i] = classic_root_of_one<Steps>(kept_single(x[i]));
    y[i + 1] = classic_root_of_one<Steps>(kept_single(x[i + 1]));
    y[i + 2] = classic_root_of_one<Steps>(kept_single(x[i + 2]));
    y[i + 3] = classic_root_of_one<Steps>(kept_single(x[i + 3]));
  }
  for (; i < n; ++i) y[i] = classic_root_of_one<Steps>(kept_single(x[i]));
}

// Left to the compiler, which makes vectors of it or not.
template <int Steps>
[[gnu::flatten]] void arrays_of_four(const float* x, float* y, std::size_t n) {
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    float a[4], s[4];
    for (int k = 0; k < 4; ++k) a[k] = x[i + static_cast<std::size_t>(k)];
    for (int k = 0; k < 4; ++k) s[k] = classic_root_of_one<Steps>(a[k]);
    for (int k = 0; k < 4; ++k) y[i + static_cast<std::size_t>(k)] = s[k];
  }
  for (; i < n; ++i) y[i] = classic_root_of_one<Steps>(x[i]);
}

constexpr bench::CourseRoot rows[] = {
    {"classic_0_one_at_a_time", "classic_0", one_at_a_time<0>},
    {"classic_1_one_at_a_time", "classic_1", one_at_a_time<1>},
    {"classic_2_one_at_a_time", "classic_2", one_at_a_time<2>},
    {"classic_3_one_at_a_time", "classic_3", one_at_a_time<3>},
    {"classic_0_four_a_loop", "classic_0", four_a_loop<0>},
    {"classic_1_four_a_loop", "classic_1", four_a_loop<1>},
    {"classic_2_four_a_loop", "classic_2", four_a_loop<2>},
    {"classic_3_four_a_loop", "classic_3", four_a_loop<3>},
    {"classic_0_arrays_of_four", "classic_0", arrays_of_four<0>},
    {"classic_1_arrays_of_four", "classic_1", arrays_of_four<1>},
    {"classic_2_arrays_of_four", "classic_2", arrays_of_four<2>},
    {"classic_3_arrays_of_four", "classic_3", arrays_of_four<3>},
};

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_COURSE_OF(path) RAYLANES_JOIN(path, _course_roots)

extern constinit const bench::CourseRoots RAYLANES_COURSE_OF(RAYLANES_PATH_NAME);
constinit const bench::CourseRoots RAYLANES_COURSE_OF(RAYLANES_PATH_NAME) = {rows,
                                                                             sizeof(rows) / sizeof(rows[0])};

}  // namespace detail
}  // namespace raylanes

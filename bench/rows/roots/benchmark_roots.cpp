#include "benchmark_roots.hpp"

#include <benchmark/benchmark.h>

#include <random>

#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/roots.hpp"
#include "../../support/roots/root_survey.hpp"
#include "../../support/rulers/of_path.hpp"
#include "course_roots.hpp"
#include "root_probe.hpp"

namespace raylanes {

// Defined in the objects of root_probe.cpp and course_roots.cpp; the build lists the paths.
namespace detail {
#define RAYLANES_DECLARE(path)                \
  extern const bench::RootProbe path##_roots; \
  extern const bench::CourseRoots path##_course_roots;
RAYLANES_EACH_PATH(RAYLANES_DECLARE)
}  // namespace detail

namespace bench {
namespace {

#define RAYLANES_PROBE(path) &detail::path##_roots,
const RootProbe* const all_probes[] = {RAYLANES_EACH_PATH(RAYLANES_PROBE)};

#define RAYLANES_COURSE(path) &detail::path##_course_roots,
const CourseRoots* const all_course_roots[] = {RAYLANES_EACH_PATH(RAYLANES_COURSE)};

template <class T>
struct Subject {
  ArrayFunction<T> function;
  double (*exact)(double);
  double max_ulp;
};

template <class T>
void run_row(benchmark::State& state, const Subject<T>& subject, std::size_t n) {
  const AlignedArrays<T> arrays(n);
  T *const x = arrays.in, *const y = arrays.out;
  std::mt19937 random(1);
  std::uniform_real_distribution<T> uniform(T(1e-3), T(1e3));
  for (std::size_t i = 0; i < n; ++i) x[i] = uniform(random);
  subject.function(x, y, n);
  // The bound in ULP, and one more for `exact`, as a relative error: an ULP is at most epsilon of the result.
  const double bound = (subject.max_ulp + 1) * static_cast<double>(std::numeric_limits<T>::epsilon());
  for (std::size_t i = 0; i < n; ++i) {
    const double exact = subject.exact(static_cast<double>(x[i]));
    if (!(std::fabs(static_cast<double>(y[i]) - exact) <= bound * exact))
      return state.SkipWithError("wrong result");
  }
  time_calls(state, n, [&] { subject.function(x, y, n); });
}

template <class T>
void add_row(const std::string& name, const Subject<T>& subject) {
  // In and out: first-level cache, second, third, memory.
  for (const std::size_t n :
       {first_level_roots, std::size_t{1} << 15, std::size_t{1} << 20, std::size_t{1} << 24})
    benchmark::RegisterBenchmark((name + '/' + std::to_string(n)).c_str(),
                                 [subject, n](benchmark::State& state) { run_row(state, subject, n); });
}

template <class T, class Method, std::size_t count>
void add_methods(const char* function, const Path& path, const RootRows<T, Method, count>& rows,
                 const std::array<RootMethodInfo<Method>, count>& methods, double (*exact)(double)) {
  for (std::size_t m = 0; m < count; ++m) {
    const RootPromise& promise = methods[m].promise;
    const double bound = path.has_fma() ? promise.max_ulp : promise.max_ulp_without_fma;
    add_row(std::string(function) + '/' + std::string(promise.name) + '/' + path.name,
            Subject<T>{rows.by[m], exact, bound});
  }
}

double root(double a) {
  return std::sqrt(a);
}
double reciprocal_root(double a) {
  return 1.0 / std::sqrt(a);
}
double inverse(double a) {
  return 1.0 / a;
}

// Beside the methods for floats.
void add_rows_of(const Path& path) {
  const RootKernels& roots = kernels_of(path).roots;
  add_methods("double_sqrt", path, roots.double_sqrt, double_sqrt_methods, root);
  add_methods("double_rsqrt", path, roots.double_rsqrt, double_rsqrt_methods, reciprocal_root);
  add_methods("double_reciprocal", path, roots.double_reciprocal, double_reciprocal_methods, inverse);
  constexpr RootPromise classic = sqrt_methods[static_cast<std::size_t>(SqrtMethod::classic_2)].promise;
  for (const CourseRoot& form : of_path(path, all_course_roots).form)
    add_row(std::string("sqrt/") + form.name + '/' + path.name,
            Subject<float>{form.run, root, classic.max_ulp});
  const RootProbe& probe = of_path(path, all_probes);
  for (std::size_t i = 0; i < probe.contender_count; ++i)
    add_row(std::string("sqrt/") + probe.contenders[i].name + '/' + path.name,
            Subject<float>{probe.contenders[i].run, root, probe.contenders[i].max_ulp});
}

}  // namespace

void register_root_rows(std::span<const Path* const> paths) {
  double (*const exact[])(double) = {root, reciprocal_root, inverse};
  for (const RootRow& row : all_root_rows(paths))
    add_row(
        name_of(row.function) + '/' + std::string(row.promise().name) + '/' + row.path->name,
        Subject<float>{row.kernel(), exact[static_cast<std::size_t>(row.function)], row.max_ulp_promised()});
  for (const Path* path : paths) add_rows_of(*path);
}

}  // namespace bench
}  // namespace raylanes

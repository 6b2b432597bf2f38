// Every root on any path against the scalar one, and calls that take short arrays inline: same bits in the
// reproducible methods, and nothing is read or written outside the arrays.
#include <raylanes/roots.hpp>

#include "../../../dispatch/hardest_roots.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/roots.hpp"
#include "../bytes.hpp"
#include "../fence.hpp"
#include "../support.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t max_roots = 2000;

// One root on the path and on the scalar one.
template <class T>
struct Root {
  const RootPromise& promise;
  ArrayFunction<T> function, scalar;
};

template <class T>
void run(Bytes& bytes, const Root<T>& root, const Path& path) {
  static Fence inputs(max_roots * sizeof(T)), outputs(max_roots * sizeof(T)), expected(max_roots * sizeof(T));
  const std::size_t n = bytes.chance(230) ? bytes.below(41) : bytes.below(max_roots + 1);
  const bool in_place = bytes.chance(64), flush = bytes.chance(96);
  T* const x = inputs.last<T>(n);
  T* const y = in_place ? x : outputs.last<T>(n);
  T* const y_scalar = expected.last<T>(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = bytes.number<T>();
  {
    const Rounding rounding(flush);
    root.scalar(x, y_scalar, n);
    root.function(x, y, n);
  }
  inputs.expect_intact("the arguments of a root");
  if (!in_place) outputs.expect_intact("roots");
  if (!root.promise.reproducible) return;
  for (std::size_t i = 0; i < n; ++i)
    if (!same(y[i], y_scalar[i]))
      fail(std::string(path.name) + ' ' + std::string(root.promise.name) +
           (flush ? " with FTZ and DAZ" : "") + ": root " + std::to_string(i) + " of " + std::to_string(n) +
           " is " + std::to_string(y[i]) + ", on scalar " + std::to_string(y_scalar[i]));
}

template <class T, class Method, std::size_t count>
void run_one_of(Bytes& bytes, const Path& path, RootRows<T, Method, count> RootKernels::*function,
                const std::array<RootMethodInfo<Method>, count>& methods) {
  const std::size_t i = bytes.below(count);
  ArrayFunction<T> row = (kernels_of(path).roots.*function).by[i];
  if constexpr (std::is_same_v<Method, SqrtMethod>)
    row = fastest_sqrt(kernels_of(path).roots, static_cast<SqrtMethod>(i), bytes.chance(128));
  run<T>(bytes, {methods[i].promise, row, (kernels_of(paths().front()).roots.*function).by[i]}, path);
}

// Calls take few numbers inline; correctly rounded they are as the instruction has them.
template <class T, class Method>
void run_call(Bytes& bytes, const Path& path, ArrayFunction<T> call, const ArrayFunction<T>* of_scalar,
              Method instruction) {
  const RootPromise& promise = sqrt_methods[static_cast<std::size_t>(SqrtMethod::hardware)].promise;
  run<T>(bytes, {promise, call, of_scalar[static_cast<std::size_t>(instruction)]}, path);
}
template <class T>
void take_roots(const T* x, T* y, std::size_t n) {
  sqrt(std::span(x, n), std::span(y, n));
}
template <class T>
void take_reciprocals(const T* x, T* y, std::size_t n) {
  reciprocal(std::span(x, n), std::span(y, n));
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_roots(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  const Path& path = *bytes.pick(fuzzed_paths());
  const std::size_t kind = bytes.below(10);
  const RootKernels& scalar = kernels_of(paths().front()).roots;
  const auto run_one = [&](auto... root) { run_one_of(bytes, path, root...); };
  kind == 0   ? run_one(&RootKernels::sqrt, sqrt_methods)
  : kind == 1 ? run_one(&RootKernels::rsqrt, rsqrt_methods)
  : kind == 2 ? run_one(&RootKernels::reciprocal, reciprocal_methods)
  : kind == 3 ? run_one(&RootKernels::double_sqrt, double_sqrt_methods)
  : kind == 4 ? run_one(&RootKernels::double_rsqrt, double_rsqrt_methods)
  : kind == 5 ? run_one(&RootKernels::double_reciprocal, double_reciprocal_methods)
  : kind == 6 ? run_call(bytes, path, take_roots<float>, scalar.sqrt.by, SqrtMethod::hardware)
  : kind == 7 ? run_call(bytes, path, take_roots<double>, scalar.double_sqrt.by, DoubleSqrtMethod::hardware)
  : kind == 8
      ? run_call(bytes, path, take_reciprocals<float>, scalar.reciprocal.by, ReciprocalMethod::hardware)
      : run_call(bytes, path, take_reciprocals<double>, scalar.double_reciprocal.by,
                 DoubleReciprocalMethod::hardware);
  return 0;
}

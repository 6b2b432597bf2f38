// Every root on any path against the scalar one: same bits in the reproducible methods, and nothing is read
// or written outside the arrays.
#include <string>

#include "../../dispatch/table.hpp"
#include "bytes.hpp"
#include "fence.hpp"
#include "support.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t most_roots = 2000;

template <class T>
using Function = void (*)(const T*, T*, std::size_t);

// One root on the path and on the scalar one.
template <class T>
struct Root {
  const RootMethod& method;
  Function<T> function, scalar;
};

template <class T>
void run(Bytes& bytes, const Root<T>& root, const Path& path) {
  static Fence inputs(most_roots * sizeof(T)), outputs(most_roots * sizeof(T)),
      expected(most_roots * sizeof(T));
  const std::size_t n = bytes.chance(230) ? bytes.below(41) : bytes.below(most_roots + 1);
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
  if (!root.method.reproducible) return;
  for (std::size_t i = 0; i < n; ++i)
    if (!same(y[i], y_scalar[i]))
      fail(std::string(path.name) + ' ' + std::string(root.method.name) + (flush ? " with FTZ and DAZ" : "") +
           ": root " + std::to_string(i) + " of " + std::to_string(n) + " is " + std::to_string(y[i]) +
           ", on scalar " + std::to_string(y_scalar[i]));
}

template <class T, class Methods, class Kernels>
void run_one_of(Bytes& bytes, const Path& path, const Methods& methods, const Kernels& kernels,
                const Kernels& scalar) {
  const std::size_t i = bytes.below(methods.size());
  run<T>(bytes, {methods[i], kernels[i], scalar[i]}, path);
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_roots(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  const Path& path = *bytes.pick(fuzzed_paths());
  const SquareRootKernels &kernels = path.kernels.roots, &scalar = paths().front().kernels.roots;
  switch (bytes.below(4)) {
    case 0:
      run_one_of<float>(bytes, path, sqrt_methods, kernels.sqrt, scalar.sqrt);
      break;
    case 1:
      run_one_of<float>(bytes, path, rsqrt_methods, kernels.rsqrt, scalar.rsqrt);
      break;
    case 2:
      run_one_of<float>(bytes, path, reciprocal_methods, kernels.reciprocal, scalar.reciprocal);
      break;
    default:
      run_one_of<double>(bytes, path, double_sqrt_methods, kernels.sqrt_double, scalar.sqrt_double);
  }
  return 0;
}

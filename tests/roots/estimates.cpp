// Methods of floats with every estimate that the manuals allow, not only the processor's own. In [1, 4), and
// reciprocals in [1, 2): elsewhere in a method's domain all is the same times a power of two.
#include <raylanes/roots.hpp>

#include "../../bench/support/rulers/of_path.hpp"
#include "../../dispatch/hardest_roots.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "../dispatch/recorded_machines.hpp"
#include "../support/level.hpp"
#include "../support/random_input.hpp"
#include "estimate_probe.hpp"
#include "root_inputs.hpp"
#include "rounded_root.hpp"

namespace raylanes {

// Defined in the probe objects; the build lists the paths.
namespace detail {
#define RAYLANES_DECLARE(path) extern const EstimateTable path##_estimates;
RAYLANES_EACH_PATH(RAYLANES_DECLARE)
}  // namespace detail

namespace testing {
namespace {

#define RAYLANES_ESTIMATES(path) &detail::path##_estimates,
constexpr const EstimateTable* all_estimates[] = {RAYLANES_EACH_PATH(RAYLANES_ESTIMATES)};

const EstimateTable& estimates_of(const Path& path) {
  return of_path(path, all_estimates);
}

// The widest of the paths that share the same source of roots.
std::vector<const Path*> different_paths() {
  std::vector<const Path*> different;
  for (const Path* path : supported_paths()) {
    std::erase_if(different, [&](const Path* other) {
      const EstimateTable &a = estimates_of(*path), &b = estimates_of(*other);
      return a.error == b.error && a.has_fma == b.has_fma;
    });
    different.push_back(path);
  }
  return different;
}

// The results with all floats as estimates whose relative error is at most `error`, or so little more that a double
// does not tell.
Extent swept(const SweptMethod& method, float x, double error) {
  const double a = x, exact = method.function == SweptMethod::reciprocal ? 1 / a : 1 / std::sqrt(a);
  error *= 1 + 0x1p-40;
  const double ends[] = {exact * (1 - error), exact * (1 + error)};
  auto low = static_cast<float>(ends[0]), high = static_cast<float>(ends[1]);
  if (low < ends[0]) low = std::nextafter(low, HUGE_VALF);
  if (high > ends[1]) high = std::nextafter(high, 0.0f);
  return method.sweep(x, low, high);
}

// A method with its promise, as a row of the table.
NamedRoot<float> row_of(const SweptMethod& method, const Path& path) {
  const std::size_t before = method.function == SweptMethod::square_root ? 0
                             : method.function == SweptMethod::reciprocal_root
                                 ? sqrt_methods.size()
                                 : sqrt_methods.size() + rsqrt_methods.size();
  return roots_of<float>(path)[before + method.method];
}

// The relative error that the tightest accuracy served by the method allows; infinite if it serves none.
double allowed_error(const SweptMethod& method, const Path& path) {
  const RootKernels& roots = kernels_of(path).roots;
  for (const AccuracyInfo& info : accuracies) {
    const auto a = static_cast<std::size_t>(info.accuracy);
    const std::string_view serves =
        method.function == SweptMethod::square_root
            ? sqrt_methods[static_cast<std::size_t>(roots.sqrt.within[a])].promise.name
        : method.function == SweptMethod::reciprocal_root
            ? rsqrt_methods[static_cast<std::size_t>(roots.rsqrt.within[a])].promise.name
            : reciprocal_methods[static_cast<std::size_t>(roots.reciprocal.within[a])].promise.name;
    const std::string_view name = row_of(method, path).promise->name;
    if (serves == name || serves == std::string(name) + "_beside_hardware")
      return info.max_ulp > 0 ? info.max_ulp * 0x1p-23 : info.max_relative_error;
  }
  return HUGE_VAL;
}

// Those at the ends of the binades and some at random.
std::vector<float> tried_numbers(bool reciprocal) {
  const std::uint32_t one = 0x3f800000, end = one + (reciprocal ? 1 : 2) * min_normal;
  std::vector<float> x;
  for (std::uint32_t offset = 0; offset < by_level(8u, 64u, 256u); ++offset)
    for (const std::uint32_t bits : {one + offset, one + min_normal - 1 - offset, end - 1 - offset})
      x.push_back(from_bits(bits));
  Random random(31);
  for (int i = 0; i < by_level(50, 2000, 100000); ++i)
    x.push_back(from_bits(static_cast<std::uint64_t>(random.real(one, end))));
  return x;
}

TEST(RootEstimates, that_are_documented_keep_the_promised_bounds) {
  for (const Path* path : different_paths()) {
    const EstimateTable& table = estimates_of(*path);
    for (std::size_t m = 0; m < table.count; ++m) {
      const SweptMethod& method = table.methods[m];
      const NamedRoot<float> root = row_of(method, *path);
      Worst worst;
      for (const float x : tried_numbers(root.is_reciprocal())) {
        const Extent y = swept(method, x, table.error);
        for (const float end : {y.least, y.greatest}) measure_one(end, root.exact(x), worst);
      }
      EXPECT_LE(worst.ulp, root.max_ulp()) << root.name;
      EXPECT_LE(worst.relative, allowed_error(method, *path)) << root.name;
    }
  }
}

// Checks the kernels' assumptions about this processor's estimates, which the sweeps above take for granted.
TEST(RootEstimates, of_this_processor_are_as_good_as_the_path_assumes) {
  for (const Path* path : supported_paths()) {
    const auto check = [&](bool reciprocal, ArrayFunction<float> estimate) {
      const std::vector<float> x = tried_numbers(reciprocal);
      std::vector<float> y(x.size());
      estimate(x.data(), y.data(), x.size());
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double a = x[i], exact = reciprocal ? 1 / a : 1 / std::sqrt(a);
        ASSERT_LE(std::fabs(y[i] / exact - 1), estimates_of(*path).error) << path->name << ' ' << x[i];
      }
    };
    const RootKernels& roots = kernels_of(*path).roots;
    check(false, roots.rsqrt.by[static_cast<std::size_t>(RsqrtMethod::estimate)]);
    check(true, roots.reciprocal.by[static_cast<std::size_t>(ReciprocalMethod::estimate)]);
  }
}

// Numbers whose roots lie within 2^-42 of themselves from the middle of two floats. A middle is M·2^-24, M odd and of
// 25 bits, where M² and a number of 24 bits, scaled, differ by 2^-41·M² at most.
std::vector<float> numbers_with_roots_near_middles() {
  std::vector<float> found;
  for (std::uint64_t middle = (1 << 24) + 1; middle < 1 << 25; middle += 2) {
    const std::uint64_t square = middle * middle, reach = (square >> 41) + 1;
    const int k = square < std::uint64_t{1} << 49 ? 25 : 26;
    const std::uint64_t unit = std::uint64_t{1} << k, nearest = (square + unit / 2) >> k;
    if ((square + reach) % unit <= 2 * reach)
      found.push_back(static_cast<float>(std::ldexp(static_cast<double>(nearest), k - 48)));
  }
  return found;
}

const SweptMethod& goldschmidt_of(const Path& path) {
  const EstimateTable& table = estimates_of(path);
  return *std::find_if(table.methods, table.methods + table.count, [](const SweptMethod& m) {
    return m.function == SweptMethod::square_root &&
           m.method == static_cast<std::size_t>(SqrtMethod::goldschmidt);
  });
}

// The floats whose root some estimate within `error` gets wrong.
std::vector<float> wrong_roots(const Path& path, const std::vector<float>& x, double error) {
  std::vector<float> wrong;
  std::copy_if(x.begin(), x.end(), std::back_inserter(wrong), [&](float a) {
    const Extent y = swept(goldschmidt_of(path), a, error);
    return !is_rounded_root(y.least, a) || !is_rounded_root(y.greatest, a);
  });
  return wrong;
}

// Before its last rounding the result is within 2^-42 (tests/proofs/roots.gappa): for all other numbers it lies on the
// root's side of every middle of two floats, so that they are rounded to the same.
TEST(RootEstimates, that_are_documented_give_goldschmidt_the_rounded_root_of_all_but_the_hardest) {
  const std::vector<float> x = numbers_with_roots_near_middles(),
                           hardest(std::begin(hardest_roots), std::end(hardest_roots));
  EXPECT_EQ(x.size(), 94u);
  for (const Path* path : supported_paths()) {
    const EstimateTable& table = estimates_of(*path);
    const bool may_fail = table.has_fma && table.error > 0x1p-14;
    EXPECT_EQ(wrong_roots(*path, x, table.error), may_fail ? hardest : std::vector<float>()) << path->name;
    const std::size_t beyond = wrong_roots(*path, x, 16 * table.error).size();
    EXPECT_EQ(beyond > hardest.size(), table.has_fma) << path->name;
  }
}

// A path as it is, but for a Goldschmidt's root that is off by a bit for one of the hardest.
template <int wrong>
void root_off_by_a_bit(const float* x, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    y[i] = std::sqrt(x[i]);
    if (x[i] == hardest_roots[wrong]) y[i] = std::nextafter(y[i], 0.0f);
  }
}
template <int wrong>
void check_replaced_by_the_instruction() {
  static RootKernels roots = kernels_of(paths().front()).roots;
  for (const SqrtMethod method : {SqrtMethod::goldschmidt, SqrtMethod::goldschmidt_beside_hardware}) {
    roots.sqrt.by[static_cast<std::size_t>(method)] = root_off_by_a_bit<wrong>;
    EXPECT_EQ(kept_method(roots, method), SqrtMethod::hardware);
  }
  roots.sqrt.within[0] = SqrtMethod::goldschmidt_beside_hardware;
  EXPECT_EQ(kept_method(roots, SqrtMethod::classic_2), SqrtMethod::classic_2);
  const Path& front = paths().front();
  const KernelTable kernels = with_roots(kernels_of(front), roots);
  const Path path =
      PathKernels::make(front.name, front.isa, front.library, front.lanes, front.required, kernels);
  float y[std::size(hardest_roots)];
  raylanes::sqrt(std::span<const float>(hardest_roots), std::span<float>(y), Accuracy::correctly_rounded,
                 &path);
  for (std::size_t i = 0; i < std::size(y); ++i) EXPECT_EQ(y[i], std::sqrt(hardest_roots[i]));
}

// Zen 4 alone; with any other vendor, family or set of features the registers are as wide as they look.
TEST(RootMix, is_that_of_two_passes_on_named_processors_alone) {
  for (const Recorded& machine : recorded_machines)
    EXPECT_EQ(splits_512_bits(machine.registers), std::string(machine.cpu) == "Ryzen 5 7600X (Zen 4)")
        << machine.cpu;
  const CpuidRegisters zen4 = registers_of("Ryzen 5 7600X");
  const auto with = [&](auto change) {
    CpuidRegisters machine = zen4;
    change(machine);
    return splits_512_bits(machine);
  };
  EXPECT_TRUE(with([](CpuidRegisters& m) { m.leaf1_eax = 0x00a10f11; })) << "EPYC 9004";
  EXPECT_FALSE(with([](CpuidRegisters& m) { m.leaf1_eax = 0x00b40f40; })) << "family 1Ah, Zen 5";
  EXPECT_FALSE(with([](CpuidRegisters& m) { m.leaf1_eax = 0x00a60912; }))
      << "family 9, whatever is behind it";
  EXPECT_FALSE(with([](CpuidRegisters& m) { m.leaf0_ebx = intel; }));
  EXPECT_FALSE(with([](CpuidRegisters& m) { m.xcr0 = 0x7; })) << "the system saves no registers of 512 bits";
  EXPECT_FALSE(splits_512_bits({}));
  EXPECT_FALSE(splits_512_bits(everything()));
  EXPECT_EQ(machine_splits_512_bits(), splits_512_bits(read_cpuid()));
}

TEST(RootMix, changes_one_method_on_wide_paths) {
  for (const Path& path : paths()) {
    const RootKernels& roots = kernels_of(path).roots;
    for (std::size_t m = 0; m < sqrt_methods.size(); ++m) {
      const auto method = static_cast<SqrtMethod>(m);
      const bool has_choice =
          method == SqrtMethod::goldschmidt_beside_hardware && roots.sqrt_in_two_passes != nullptr;
      EXPECT_EQ(fastest_sqrt(roots, method, false), roots.sqrt.by[m]) << path.name;
      EXPECT_EQ(fastest_sqrt(roots, method, true), has_choice ? roots.sqrt_in_two_passes : roots.sqrt.by[m])
          << path.name;
    }
    EXPECT_EQ(roots.sqrt_in_two_passes != nullptr, path.lanes == 16) << path.name;
    EXPECT_NE(roots.sqrt_in_two_passes,
              roots.sqrt.by[static_cast<std::size_t>(SqrtMethod::goldschmidt_beside_hardware)])
        << path.name;
  }
}

// The accuracies that take the faster, tighter root where 512 bits take two passes; on all other machines the table's.
TEST(RootMix, serves_one_ulp_by_the_faster_root) {
  for (const Path& path : paths()) {
    const RootKernels& roots = kernels_of(path).roots;
    for (const AccuracyInfo& info : accuracies) {
      const SqrtMethod usual = roots.sqrt.within[static_cast<std::size_t>(info.accuracy)];
      const bool has_choice = path.lanes == 16 && (info.accuracy == Accuracy::within_1_ulp ||
                                                   info.accuracy == Accuracy::within_2_ulp ||
                                                   info.accuracy == Accuracy::within_2_to_minus_44);
      EXPECT_EQ(serving_sqrt(roots, info.accuracy, false), usual) << path.name << ' ' << info.name;
      EXPECT_EQ(serving_sqrt(roots, info.accuracy, true),
                has_choice ? SqrtMethod::goldschmidt_beside_hardware : usual)
          << path.name << ' ' << info.name;
    }
  }
}

TEST(RootEstimates, that_fail_on_this_machine_leave_the_root_to_the_instruction) {
  check_replaced_by_the_instruction<0>();
  check_replaced_by_the_instruction<16>();
  for (const Path* path : supported_paths())
    EXPECT_EQ(kept_method(kernels_of(*path).roots, SqrtMethod::goldschmidt), SqrtMethod::goldschmidt)
        << path->name;
}

}  // namespace
}  // namespace testing
}  // namespace raylanes

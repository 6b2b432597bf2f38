// Every method of roots on every path, judged over all floats (at level exhaustive) or blocks of them by
// the judge of `raylanes roots`; and that this judge notices what is wrong.
#include "../../bench/support/roots/double_survey.hpp"
#include "../../bench/support/roots/root_survey.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "root_inputs.hpp"

namespace raylanes::testing {
namespace {

using bench::JudgedDoubleRoot;
using bench::RootAccuracy;
using bench::RootFunction;
using bench::RootRow;

struct Judged {
  RootRow row;
  RootAccuracy accuracy;

  std::string name() const {
    return std::string(row.path->name) + ' ' +
           std::string(bench::root_function_names[static_cast<std::size_t>(row.function)]) + ' ' +
           std::string(row.promise().name);
  }
};

std::vector<Judged> judge(const std::vector<RootRow>& rows, std::uint32_t stride) {
  const std::vector<RootAccuracy> accuracies = bench::survey_roots(rows, stride, {});
  std::vector<Judged> judged;
  for (std::size_t i = 0; i < rows.size(); ++i) judged.push_back({rows[i], accuracies[i]});
  return judged;
}

// All rows, judged once for all tests.
const std::vector<Judged>& all_judged() {
  static const std::vector<Judged> judged = [] {
    std::vector<RootRow> rows;
    for (const RootFunction function : {RootFunction::sqrt, RootFunction::rsqrt, RootFunction::reciprocal})
      for (std::size_t m = 0; m < bench::method_count(function); ++m)
        for (const Path* path : supported_paths()) rows.push_back({function, m, path});
    return judge(rows, exhaustive() ? 1 : (quick() ? 1u << 19 : 509));
  }();
  return judged;
}

// Emulated, the ends of the ranges alone.
TEST(RootSurvey, covers_all_inputs_if_asked_to) {
  const std::uint64_t least = std::uint64_t{1} << (exhaustive() ? 32 : (quick() ? 16 : 23));
  for (const Judged& j : all_judged()) EXPECT_GE(j.accuracy.inputs, least) << j.name();
}

TEST(RootSurvey, finds_every_promise_kept) {
  for (const Judged& j : all_judged()) {
    EXPECT_LE(j.accuracy.max_ulp, j.row.max_ulp_promised())
        << j.name() << " at 0x" << std::hex << j.accuracy.max_ulp_at;
    if (!j.row.promise().unchecked) {
      EXPECT_EQ(j.accuracy.wrong_specials, 0u) << j.name();
    }
  }
}

TEST(RootSurvey, finds_correct_rounding_and_order_where_promised) {
  for (const Judged& j : all_judged()) {
    if (j.row.promise().max_ulp != 0.5) continue;
    EXPECT_EQ(j.accuracy.correctly_rounded, j.accuracy.inputs) << j.name();
    EXPECT_EQ(j.accuracy.monotony_violations, 0u) << j.name();
  }
}

TEST(RootSurvey, finds_the_same_bits_on_all_paths) {
  std::map<std::string, std::uint64_t> hashes;  // of the reproducible methods
  for (const Judged& j : all_judged()) {
    if (!j.row.promise().reproducible) continue;
    const std::string method(j.row.promise().name);
    const auto function = static_cast<std::size_t>(j.row.function);
    const auto [known, is_new] =
        hashes.try_emplace(std::string(bench::root_function_names[function]) + method, j.accuracy.hash);
    EXPECT_EQ(known->second, j.accuracy.hash) << j.name();
  }
}

TEST(RootSurvey, finds_each_accuracy_kept_by_the_method_that_serves_it) {
  for (const Judged& j : all_judged())
    for (const AccuracyInfo& info : accuracies) {
      if (!j.row.serves(info.accuracy)) continue;
      if (info.max_ulp > 0 || info.accuracy == Accuracy::within_2_to_minus_44)  // which floats cannot keep
        EXPECT_LE(j.accuracy.max_ulp, info.max_ulp > 0 ? info.max_ulp : 1.0)
            << j.name() << " for " << info.name;
      else
        EXPECT_LE(j.accuracy.max_relative_error(), info.max_relative_error)
            << j.name() << " for " << info.name;
    }
}

// NaN for a negative number is right, and says nothing of a method.
TEST(RootSurvey, counts_correct_rounding_among_positive_numbers) {
  for (const Judged& j : all_judged()) {
    EXPECT_LT(j.accuracy.positive_inputs, j.accuracy.inputs);
    EXPECT_GE(j.accuracy.positive_inputs, j.accuracy.inputs / 3) << j.name();
    // Rounds 62 % of normal numbers correctly. Subnormals go to the instruction.
    if (j.row.promise().name == "classic_2") {
      const std::uint64_t others = j.accuracy.positive_inputs - j.accuracy.normal_inputs;
      EXPECT_LT((j.accuracy.positive_correctly_rounded - others) * 3, j.accuracy.normal_inputs * 2)
          << j.name();
    }
    if (j.row.promise().max_ulp == 0.5) {
      EXPECT_EQ(j.accuracy.positive_correctly_rounded, j.accuracy.positive_inputs) << j.name();
    }
  }
}

// --- The judge: the hardware's roots with one fault, in a block that is always judged.
template <std::uint32_t input, std::uint32_t output>
void faulty_root(const float* x, float* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) y[i] = to_bits(x[i]) == input ? from_bits(output) : std::sqrt(x[i]);
}

RootAccuracy judged_fault(ArrayFunction<float> function) {
  constexpr auto hardware = static_cast<std::size_t>(SqrtMethod::hardware);
  const KernelTable& right = kernels_of(paths().front());
  RootKernels roots = right.roots;
  roots.sqrt.by[hardware] = function;
  const KernelTable faulty = with_roots(right, roots);
  const Path path = PathKernels::make("faulty", "scalar", "none", 1, {}, faulty);
  return judge({{RootFunction::sqrt, hardware, &path}}, 1u << 19)[0].accuracy;
}

TEST(RootJudge, finds_nothing_wrong_with_the_hardware) {
  const RootAccuracy a = judged_fault(faulty_root<0, 0>);
  EXPECT_LE(a.max_ulp, 0.5);
  EXPECT_EQ(a.wrong_specials + a.monotony_violations, 0u);
  EXPECT_EQ(a.correctly_rounded, a.inputs);
}

TEST(RootJudge, notices_a_root_that_is_too_large) {
  constexpr std::uint32_t input = 0x00800005, root = 0x20000002;
  const RootAccuracy right = judged_fault(faulty_root<0, 0>), a = judged_fault(faulty_root<input, root + 3>);
  EXPECT_GT(a.max_ulp, 1.0);
  EXPECT_EQ(a.max_ulp_at, input);
  EXPECT_EQ(a.correctly_rounded, a.inputs - 1);
  EXPECT_EQ(a.monotony_violations, 1u);
  EXPECT_NE(a.hash, right.hash);
}

TEST(RootJudge, notices_nan_and_infinity_for_a_number) {
  for (const RootAccuracy& a : {judged_fault(faulty_root<0x7f7fffff, 0xffc00000>),
                                judged_fault(faulty_root<0x7f7fffff, infinity_bits>)}) {
    EXPECT_EQ(a.max_ulp, HUGE_VAL);
    EXPECT_EQ(a.max_ulp_at, 0x7f7fffffu);
    EXPECT_EQ(a.correctly_rounded, a.inputs - 1);
  }
}

TEST(RootJudge, notices_wrong_special_values) {
  EXPECT_EQ(judged_fault(faulty_root<0x80000000, 0>).wrong_specials, 1u);
  EXPECT_EQ(judged_fault(faulty_root<1, 0>).wrong_specials, 1u);
  EXPECT_EQ(judged_fault(faulty_root<infinity_bits, 0x7f7fffff>).wrong_specials, 1u);
  EXPECT_EQ(judged_fault(faulty_root<0x7f800001, infinity_bits>).wrong_specials, 1u);
  EXPECT_EQ(judged_fault(faulty_root<0xff800000, 0>).wrong_specials, 1u);
}

TEST(DoubleSurvey, finds_promises_kept_and_broken) {
  const Path* const path = &paths().front();
  const std::vector<JudgedDoubleRoot> rows = bench::judged_double_roots(std::span(&path, 1), 2000);
  for (const JudgedDoubleRoot& row : rows) {
    EXPECT_TRUE(row.keeps_promise()) << row.function() << ' ' << row.method() << ' ' << row.largest_ulp;
    if (row.method() == "hardware" && row.function() != "double_rsqrt") {
      EXPECT_EQ(row.rounded_correctly, row.inputs) << row.function();
    }
    JudgedDoubleRoot worse = row;
    worse.largest_ulp = 2 * row.max_ulp_promised();
    EXPECT_FALSE(worse.keeps_promise());
    worse = row, worse.specials_ok = false;
    EXPECT_FALSE(worse.keeps_promise());
  }
}

}  // namespace
}  // namespace raylanes::testing

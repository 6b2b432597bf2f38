// Holds the yes/no loops, one ray over N primitives, to their instructions a vector, on every supported path with
// fused multiply-add (without it each multiply-add is two instructions). For the release build.
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <string_view>

#include "../../bench/survey/kernel_rows.hpp"

namespace raylanes::bench {
namespace {

constexpr std::string_view paths_with_budgets[] = {"avx2", "avx2-highway", "avx512", "avx512-highway"};

struct BudgetRow {
  std::string_view kernel, test;
  int instructions[std::size(paths_with_budgets)];
};

// What a test may take is 12, 25, 25, 19 and 28 operations a vector, its loads folded into them. An executed vector
// also has 4 instructions of loop control (two indices, comparison, jump) and the loads and
// copies that do not fold; all three kinds were read off the compiled loops of g++ 12 and add up to what is counted:
//   line          12 operations                     + 4 + 1, 2, 0, 1
//   boxes         24 (avx512: 22) operations        + 4 + 9, 9, 8, 8
//   directional   18 (avx512: 16) operations        + 4 + 9, 9, 8, 8
//   triangle      29 (avx512: 26) operations        + 4 + 5, 5, 6, 9
// Two of the triangle's are the comparison with the largest finite t, since an infinite one is a miss (avx512: one).
constexpr BudgetRow budgets[] = {{"sphere", "line", {17, 18, 16, 17}},
                                 {"box", "conservative", {37, 37, 34, 36}},
                                 {"box", "plain", {37, 37, 34, 36}},
                                 {"box", "directional", {31, 31, 28, 30}},
                                 {"triangle", "directional", {38, 38, 36, 39}}};

const BudgetRow* budget_of(const KernelRow& row) {
  if (row.grade != Grade::fast || row.form != "1xN" || row.query != "any") return nullptr;
  for (const BudgetRow& budget : budgets)
    if (row.kernel == budget.kernel && row.test == budget.test) return &budget;
  return nullptr;
}

KernelRows rows_of(const Path& path, KernelInputs& inputs, const KernelAccuracy& not_judged) {
  KernelRows rows;
  for (std::size_t i = 0; i < std::size(box_tests); ++i)
    add_box_rows(rows, path, static_cast<BoxTest>(i), Grade::fast, inputs, not_judged);
  add_triangle_rows(rows, path, TriangleTest::directional, Grade::fast, inputs, not_judged, {});
  add_line_row(rows, path, Grade::fast, inputs, not_judged);
  std::erase_if(rows, [](const KernelRow& row) { return budget_of(row) == nullptr; });
  return rows;
}

// Whether all rows of a path keep their budgets.
bool check(const Path& path) {
  const auto column = std::find(std::begin(paths_with_budgets), std::end(paths_with_budgets), path.name);
  if (column == std::end(paths_with_budgets)) {
    std::printf("%s: has no budgets\n", path.name);
    return false;
  }
  KernelInputs inputs;
  const KernelAccuracy not_judged{};
  KernelRows rows = rows_of(path, inputs, not_judged);
  count_instructions(rows);
  bool kept = rows.size() == std::size(budgets);
  for (const KernelRow& row : rows) {
    const int budget = budget_of(row)->instructions[column - std::begin(paths_with_budgets)];
    const double counted = row.instructions.value_or(0) * path.lanes;
    const bool good = row.instructions && counted <= budget;
    std::printf("%s %s/%s: %g instructions a vector, budget %d: %s\n", path.name, row.kernel.c_str(),
                row.test.c_str(), counted, budget, good ? "good" : "OVER");
    kept = kept && good;
  }
  return kept;
}

}  // namespace
}  // namespace raylanes::bench

int main() {
  using namespace raylanes;
  constexpr int skipped = 77;
  if (!bench::instructions_per_primitive([](std::size_t) {}, 1)) {
    std::puts("SKIPPED: counting instructions, ptrace is not permitted here");
    return skipped;
  }
  bool kept = true, any = false;
  for (const Path& path : paths())
    if (supported(path) && path.has_fma()) any = true, kept = bench::check(path) && kept;
  if (!any) std::puts("SKIPPED: no path with fused multiply-add is supported here");
  return any ? !kept : skipped;
}

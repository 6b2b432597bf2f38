// Holds the yes/no loops, one ray over N primitives, to their instructions a vector, on every supported path with
// fused multiply-add (without it each multiply-add is two instructions). On every path registers of which some lanes
// take no part may have no more instructions than whole ones, and prepared calls with one ray have fewer than others.
// For the release build.
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <limits>
#include <string_view>

#include <raylanes/bvh.hpp>

#include "../../bench/rows/kernels/kernel_rows.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/triangles.hpp"

namespace raylanes::bench {
namespace {

constexpr std::string_view paths_with_budgets[] = {"avx2", "avx2-highway", "avx512", "avx512-highway"};

struct BudgetRow {
  std::string_view kernel, test;
  int instructions[std::size(paths_with_budgets)];
};

// The budgets of the tests are 12, 25, 25, 19 and 28 operations a vector, loads folded into them. An executed vector
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

// Rays × one triangle by the default test where lanes of a register take no part: as a fence, at most thrice the
// instructions of as many registers in which all do. Lanes that went to integers would cost thousands each.
class SomeLanes {
 public:
  explicit SomeLanes(const Path& path) : path_(path), kernels_(kernels_of(path).triangles.row[0][0]) {
    static_assert(triangle_tests[0].test == TriangleOptions{}.test);
    for (std::size_t i = 0; i < most; i += 2) nan_x_[i] = std::numeric_limits<float>::quiet_NaN();
    std::fill(mask_, std::end(mask_), std::uint8_t{0x55});
  }
  // A triangle at that height, which all rays hit, or all miss.
  bool check(float z, bool closest) {
    const float triangle[] = {-9, -9, z, 9, -9, z, 0, 9, z};
    RayArrays rays = inputs_.rays(), with_nan = rays;
    with_nan.origin[0] = nan_x_;
    const double whole = count(rays, most, triangle, nullptr, closest) / most;
    bool kept = true;
    for (const auto& [name, in, n, active] :
         {Case{"one ray", rays, 1, nullptr}, Case{"17 rays", rays, 17, nullptr},
          Case{"every second ray", rays, most, mask_},
          Case{"every second one NaN", with_nan, most, nullptr}}) {
      const auto lanes = static_cast<std::size_t>(path_.lanes), registers = (n + lanes - 1) / lanes;
      const double budget = 3 * whole * static_cast<double>(registers * lanes);
      const double counted = count(in, n, triangle, active, closest);
      const bool good = counted > 0 && counted <= budget;
      std::printf("%s triangle/exact, %s, %s, %s: %g instructions, budget %g: %s\n", path_.name,
                  closest ? "closest" : "any", z > 0 ? "hit" : "missed", name, counted, budget,
                  good ? "good" : "OVER");
      kept = kept && good;
    }
    return kept;
  }

 private:
  static constexpr std::size_t most = 32;
  struct Case {
    const char* name;
    const RayArrays& rays;
    std::size_t n;
    LaneBits active;
  };
  double count(RayArrays rays, std::size_t n, const float* triangle, LaneBits active, bool closest) {
    rays.size = n;
    const auto calls = [&](std::size_t times) {
      for (; times > 0; --times)
        if (closest)
          kernels_.closest_of_rays(rays, triangle, active, inputs_.bits(), inputs_.output(0),
                                   inputs_.output(1), inputs_.output(2));
        else
          kernels_.any_of_rays(rays, triangle, active, inputs_.bits());
    };
    return instructions_per_primitive(calls, 1).value_or(0);
  }

  const Path& path_;
  const TriangleRow& kernels_;
  KernelInputs inputs_;
  float nan_x_[most]{};
  std::uint8_t mask_[most / 8];
};

bool check_some_lanes(const Path& path) {
  SomeLanes some(path);
  bool kept = true;
  for (const float z : {-9.0f, 9.0f})
    for (const bool closest : {false, true}) kept = some.check(z, closest) && kept;
  return kept;
}

// Calls with one ray that are prepared ask for no traps, path and kernel: that takes more than 20 instructions.
bool check_prepared_calls(const Path& path) {
  constexpr double least_saved = 20;
  const Float3 corners[] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const Index3 triangle[] = {{0, 1, 2}};
  const Bvh bvh(corners, triangle);
  force_path(path.name);
  const auto calls = bvh.calls();
  const Ray ray{.origin = {0, 0, -2}, .direction = {0.125f, 0.0625f, 1}};
  std::size_t hits = 0;
  const auto count = [&](const auto& call) {
    const auto repeat = [&](std::size_t times) {
      for (; times > 0; --times) hits += call() ? 1u : 0u;
    };
    return instructions_per_primitive(repeat, 1).value_or(0);
  };
  bool kept = true;
  const auto compare = [&](const char* call, double plain, double prepared) {
    const bool good = prepared > 0 && prepared + least_saved <= plain;
    std::printf("%s %s of one ray: %g instructions, prepared %g: %s\n", path.name, call, plain, prepared,
                good ? "good" : "OVER");
    kept = kept && good;
  };
  compare("closest", count([&] { return static_cast<bool>(bvh.closest(ray)); }),
          count([&] { return static_cast<bool>(calls.closest(ray)); }));
  compare("occluded", count([&] { return bvh.occluded(ray); }), count([&] { return calls.occluded(ray); }));
  unforce_path();
  // A child process has counted.
  return kept && calls.closest(ray) && calls.occluded(ray);
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
  bool kept = true;
  for (const Path& path : paths())
    if (supported(path))
      kept = bench::check_some_lanes(path) && bench::check_prepared_calls(path) &&
             (!path.has_fma() || bench::check(path)) && kept;
  return !kept;
}

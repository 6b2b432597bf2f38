#include "root_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <tuple>

namespace raylanes::bench {
namespace {

// Input and output together fill less than the first-level cache.
constexpr std::size_t timed_elements = 3072;
constexpr int calls_per_timing = 32;

bool is_hardware(const RootRow& row) {
  return row.promise().name == "hardware";
}

void compare(RootResult& result, const std::vector<RootResult>& all) {
  result.pareto = true;
  for (const RootResult& other : all) {
    if (other.row.path != result.row.path || other.row.function != result.row.function) continue;
    if (is_hardware(other.row)) result.ratio_to_hardware = speed_ratio(result.timing, other.timing).median;
    const bool no_worse = other.accuracy.max_ulp <= result.accuracy.max_ulp &&
                          other.elements_per_second >= result.elements_per_second;
    const bool better = other.accuracy.max_ulp < result.accuracy.max_ulp ||
                        other.elements_per_second > result.elements_per_second;
    if (no_worse && better) result.pareto = false;
  }
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::string hexadecimal(const char* format, unsigned long long bits) {
  char text[24];
  std::snprintf(text, sizeof text, format, bits);
  return text;
}

// So many that an error above half an ULP does not look like half an ULP: 0.5 is correctly rounded, 0.50001 is not.
int digits_of(double max_ulp) {
  int digits = 4;
  for (double unit = 1e-4; max_ulp > 0.5 && max_ulp < 0.5 + unit / 2 && digits < 9; unit /= 10) ++digits;
  return digits;
}

}  // namespace

std::vector<std::string> RootResult::accuracies_served() const {
  std::vector<std::string> served;
  for (const AccuracyInfo& info : accuracies)
    if (row.serves(info.accuracy)) served.emplace_back(info.name);
  return served;
}

void measure_roots(std::vector<RootResult>& results, double seconds) {
  // Aligned to lines of the cache, as arrays for speed are.
  alignas(64) static float x[timed_elements], y[timed_elements];
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-20.0f, 20.0f);
  for (std::size_t i = 0; i < timed_elements; ++i) x[i] = std::exp2(exponent(random));
  std::vector<std::function<void()>> contenders;
  for (const RootResult& result : results)
    contenders.push_back([kernel = result.row.kernel()] {
      for (int i = 0; i < calls_per_timing; ++i) kernel(x, y, timed_elements);
    });
  const std::vector<Timing> timings = take_turns(contenders, {seconds});
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].timing = timings[i];
    results[i].elements_per_second =
        static_cast<double>(timed_elements) * calls_per_timing / timings[i].median_seconds;
  }
  for (RootResult& result : results) compare(result, results);
}

RowTable table_of(const std::vector<RootResult>& results) {
  RowTable table;
  for (const RootResult& r : results) {
    const RootAccuracy& a = r.accuracy;
    table.begin({{"grade", grade_names[r.row.promise().reproducible ? 0 : 1]},
                 {"isa", r.row.path->isa},
                 {"inputs", a.inputs},
                 {"max_ulp_promised", r.row.max_ulp_promised()},
                 {"max_relative_error", a.max_relative_error()},
                 {"correctly_rounded_normal", share(a.normal_correctly_rounded, a.normal_inputs)},
                 {"unchecked", r.row.promise().unchecked},
                 {"specials_ok", a.wrong_specials == 0},
                 {"serves", r.accuracies_served()},
                 {"elements_per_second", r.elements_per_second}});
    table.add("function", "function", name_of(r.row.function))
        .add("method", "method", std::string(r.row.promise().name))
        .add("path", "path", r.row.path->name)
        .add("max ULP", "max_ulp", a.max_ulp, digits_of(a.max_ulp))
        .add("ns", "", r.nanoseconds())
        .add("× hardware", "ratio_to_hardware", r.ratio_to_hardware)
        .add("front", "pareto", r.pareto, r.pareto ? "*" : "")
        .add("promise", "", r.keeps_promise() ? "kept" : "BROKEN")
        .add("rounded", "correctly_rounded", share(a.positive_correctly_rounded, a.positive_inputs), 6)
        .add("max ULP at", "max_ulp_at", hexadecimal("0x%08llx", a.max_ulp_at))
        .add("disorder", "monotony_violations", std::size_t{a.monotony_violations})
        .add("rel. error from", "least_relative_error", a.least_relative_error)
        .add("to", "greatest_relative_error", a.greatest_relative_error)
        .add("RMS", "rms_relative_error", a.root_mean_square(), 2)
        .add("hash", "hash", hexadecimal("%016llx", a.hash));
  }
  return table;
}

std::string inputs_judged(const std::vector<RootResult>& results) {
  return std::to_string(results.front().accuracy.inputs) + " of 4294967296 inputs";
}

RowTable accuracies_of(const std::vector<RootResult>& results) {
  struct Served {
    const RootResult* result;
    const AccuracyInfo* info;
    auto order() const { return std::tuple(result->row.path, result->row.function, info->accuracy); }
  };
  std::vector<Served> all;
  for (const RootResult& r : results)
    for (const AccuracyInfo& info : accuracies)
      if (r.row.serves(info.accuracy)) all.push_back({&r, &info});
  std::ranges::sort(all, {}, &Served::order);
  RowTable table;
  for (const auto& [r, info] : all) {
    table.begin();
    table.add("path", "", r->row.path->name)
        .add("function", "", name_of(r->row.function))
        .add("accuracy", "", std::string(info->name))
        .add("ns", "", r->nanoseconds())
        .add("× hardware", "", r->ratio_to_hardware)
        .add("max ULP", "", r->accuracy.max_ulp, digits_of(r->accuracy.max_ulp))
        .add("served by", "", std::string(r->row.promise().name))
        .add("max rel. error", "", r->accuracy.max_relative_error());
  }
  return table;
}

}  // namespace raylanes::bench

#include "root_rows.hpp"

#include <cstdio>

namespace raylanes::bench {
namespace {

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::string hexadecimal(const char* format, unsigned long long bits) {
  char text[24];
  std::snprintf(text, sizeof text, format, bits);
  return text;
}

int digits_of(double max_ulp) {
  int digits = 4;
  for (double unit = 1e-4; max_ulp > 0.5 && max_ulp < 0.5 + unit / 2 && digits < 9; unit /= 10) ++digits;
  return digits;
}

std::vector<std::string> RootResult::accuracies_served() const {
  std::vector<std::string> served;
  for (const AccuracyInfo& info : accuracies)
    if (row.serves(info.accuracy)) served.emplace_back(info.name);
  return served;
}

void measure_roots(std::vector<RootResult>& results, double seconds) {
  time_roots<float>(results, seconds, [](const RootResult& result) { return result.row.kernel(); });
  rank_roots(results);
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

}  // namespace raylanes::bench

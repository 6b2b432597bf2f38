#include "root_rows.hpp"

namespace raylanes::bench {
namespace {

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

int digits_of(double max_ulp) {
  int digits = 4;
  for (double unit = 1e-4; max_ulp > 0.5 && max_ulp < 0.5 + unit / 2 && digits < 9; unit /= 10) ++digits;
  return digits;
}

std::string power_of_two(double relative_error) {
  char text[16] = "0";
  if (relative_error > 0) std::snprintf(text, sizeof text, "2^%.2f", std::log2(relative_error));
  return text;
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
        .add("promised", "max_ulp_promised", r.max_ulp_promised(), digits_of(r.max_ulp_promised()))
        .add("ns", "", r.nanoseconds())
        .add("× hardware", "ratio_to_hardware", r.ratio_to_hardware)
        .add("front", "pareto", r.pareto, r.pareto ? "*" : "")
        .add("promise", "", r.keeps_promise() ? "kept" : "BROKEN")
        .add("rounded", "correctly_rounded", share(a.positive_correctly_rounded, a.positive_inputs), 6)
        .add("max ULP at", "max_ulp_at", hexadecimal("0x%08llx", a.max_ulp_at))
        .add("disorder", "monotony_violations", std::size_t{a.monotony_violations})
        .add("max rel. error", "", power_of_two(a.max_relative_error()))
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

std::vector<DoubleRootRow> measured_roots(const std::vector<JudgedDoubleRoot>& judged, double seconds) {
  std::vector<DoubleRootRow> rows;
  for (const JudgedDoubleRoot& root : judged) rows.push_back({root, {}});
  time_roots<double>(rows, seconds, [](const DoubleRootRow& row) { return row.kernel; });
  rank_roots(rows);
  return rows;
}

RowTable table_of(const std::vector<DoubleRootRow>& rows) {
  RowTable table;
  for (const DoubleRootRow& row : rows) {
    std::vector<std::string> served;
    for (const Accuracy accuracy : row.served)
      served.emplace_back(accuracies[static_cast<std::size_t>(accuracy)].name);
    table.begin(
        {{"function", row.function()},
         {"method", std::string(row.method())},
         {"grade", grade_names[row.promise->reproducible ? 0 : 1]},
         {"path", row.on_path->name},
         {"isa", row.on_path->isa},
         {"inputs", row.inputs},
         {"max_ulp", row.largest_ulp},
         {"max_ulp_at", hexadecimal("0x%016llx", std::bit_cast<std::uint64_t>(row.largest_ulp_at))},
         {"max_ulp_promised", row.max_ulp_promised()},
         {"max_relative_error", row.largest_relative_error},
         {"correctly_rounded", static_cast<double>(row.rounded_correctly) / static_cast<double>(row.inputs)},
         {"unchecked", row.promise->unchecked},
         {"specials_ok", row.specials_ok},
         {"serves", served},
         {"elements_per_second", row.elements_per_second},
         {"ratio_to_hardware", row.ratio_to_hardware},
         {"pareto", row.pareto}});
  }
  return table;
}

}  // namespace raylanes::bench

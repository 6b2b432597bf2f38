#include "trace_means.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "output.hpp"

namespace raylanes::bench {
namespace {

double geometric_mean(const std::vector<double>& ratios) {
  double logarithms = 0.0;
  for (const double ratio : ratios) logarithms += std::log(ratio);
  return std::exp(logarithms / static_cast<double>(ratios.size()));
}

}  // namespace

void TraceMeans::add(const std::vector<TraceRow>& rows) {
  for (const TraceRow& row : rows) {
    if (!row.ratio || !row.test) continue;
    const std::vector<std::string> name{
        name_of(row.rays), row.path,
        row.build,         std::string(triangle_test_names[static_cast<std::size_t>(*row.test)]),
        row.mode,          row.batch == 0 ? "" : std::to_string(row.batch)};
    Ratios& ratios = ratios_[name];
    ratios.to_best.push_back(row.ratio->median);
    ratios.to_single.push_back(row.ratio_to_single->median);
    ratios.to_robust.push_back(row.ratio_to_robust->median);
  }
}

void TraceMeans::print() const {
  const auto is_of_several = [](const auto& entry) { return entry.second.to_best.size() > 1; };
  if (std::none_of(ratios_.begin(), ratios_.end(), is_of_several)) return;
  std::vector<std::vector<std::string>> table{{"rays", "path", "build", "test", "mode", "batch", "scenes",
                                               "× Embree best", "least", "× its single", "× its robust"}};
  for (const auto& [name, ratios] : ratios_) {
    std::vector<std::string> cells = name;
    cells.push_back(std::to_string(ratios.to_best.size()));
    cells.push_back(significant(geometric_mean(ratios.to_best), 3));
    cells.push_back(significant(*std::min_element(ratios.to_best.begin(), ratios.to_best.end()), 3));
    cells.push_back(significant(geometric_mean(ratios.to_single), 3));
    cells.push_back(significant(geometric_mean(ratios.to_robust), 3));
    table.push_back(std::move(cells));
  }
  std::cout << "\ngeometric means of the ratios to Embree, and the least of a scene\n";
  print_table(table);
}

}  // namespace raylanes::bench

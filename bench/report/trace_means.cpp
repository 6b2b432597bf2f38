#include "trace_means.hpp"

#include <algorithm>
#include <iostream>

#include "row_table.hpp"

namespace raylanes::bench {
void TraceMeans::add(const std::vector<TraceRow>& rows) {
  for (const TraceRow& row : rows) {
    if (!row.ratio || !row.test) continue;
    const std::vector<std::string> name{name_of(row.rays),
                                        row.path,
                                        std::string(triangle_test_names[static_cast<std::size_t>(*row.test)]),
                                        row.mode,
                                        row.batch == 0 ? "" : std::to_string(row.batch),
                                        row.build};
    Ratios& ratios = ratios_[name];
    ratios.to_best.push_back(row.ratio->median);
    ratios.to_single.push_back(row.ratio_to_single->median);
    ratios.to_robust.push_back(row.ratio_to_robust->median);
  }
}

void TraceMeans::print(const std::vector<std::string>& shown) const {
  const auto is_of_several = [](const auto& entry) { return entry.second.to_best.size() > 1; };
  if (std::none_of(ratios_.begin(), ratios_.end(), is_of_several)) return;
  constexpr const char* columns[] = {"rays", "path", "test", "mode", "batch"};
  RowTable table;
  for (const auto& [name, ratios] : ratios_) {
    table.begin();
    for (std::size_t i = 0; i < std::size(columns); ++i) table.add(columns[i], "", name[i]);
    table.add("scenes", "", ratios.to_best.size())
        .add("× Embree", "", geometric_mean(ratios.to_best))
        .add("min", "", *std::min_element(ratios.to_best.begin(), ratios.to_best.end()))
        .add("× single", "", geometric_mean(ratios.to_single))
        .add("× robust", "", geometric_mean(ratios.to_robust))
        .add("build", "", name.back());
  }
  std::cout << "\ngeometric means over the scenes of the ratios to Embree, and the smallest ratio\n";
  table.print(shown);
}

}  // namespace raylanes::bench

#include "double_root_rows.hpp"

#include <bit>

namespace raylanes::bench {

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

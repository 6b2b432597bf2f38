#include "count_tables.hpp"

namespace raylanes::bench {
namespace {

// A counter by its key in JSON and its column.
struct CounterName {
  std::uint64_t TraceCounters::*counter;
  const char *key, *column;
};
constexpr CounterName counter_names[] = {
    {&TraceCounters::box_tests, "box_tests_per_ray", "boxes"},
    {&TraceCounters::triangle_tests, "triangle_tests_per_ray", "triangles"},
    {&TraceCounters::hits, "triangle_hits_per_ray", "found"},
    {&TraceCounters::nodes, "nodes_per_ray", "nodes"},
    {&TraceCounters::leaves, "leaves_per_ray", "leaves"},
    {&TraceCounters::undecided, "undecided_tests_per_ray", "undecided"},
    {&TraceCounters::frustum_tests, "frustum_tests_per_ray", "frusta"},
    {&TraceCounters::registers, "registers_per_ray", "vectors"}};

Json keys_of(const CountedRays& counted) {
  Json json{{"rays", name_of(counted.kind)}, {"ray_count", counted.rays}, {"hits", counted.hits}};
  add_counts(json, counted);
  return json;
}

// How many tests the rays of kind i take in a row, divided by the first row's number.
double tests_by_first(const std::vector<TreeCounts>& rows, const TreeCounts& row, std::size_t i) {
  return static_cast<double>(row.rays[i].counters.triangle_tests) /
         static_cast<double>(std::max<std::uint64_t>(1, rows[0].rays[i].counters.triangle_tests));
}

}  // namespace

void add_counts(Json& json, const CountedRays& counted) {
  for (const CounterName& name : counter_names) json[name.key] = counted.per_ray(name.counter);
  json["triangle_tests_per_hit"] = counted.triangle_tests_per_hit();
}

RowTable counts_of(const std::vector<TraceRow>& rows) {
  RowTable table;
  for (const TraceRow& row : rows) {
    if (!row.counted) continue;
    table.begin();
    table.add("rays", "", name_of(row.rays))
        .add("path", "", row.path)
        .add("test", "", std::string(triangle_test_names[static_cast<std::size_t>(*row.test)]))
        .add("mode", "", row.mode)
        .add("batch", "", {}, row.batch == 0 ? "" : std::to_string(row.batch));
    table.add("tests/hit", "", row.counted->triangle_tests_per_hit());
    for (const CounterName& name : counter_names)
      table.add(name.column + std::string("/ray"), "", row.counted->per_ray(name.counter));
  }
  return table;
}

RowTable means_of(const std::vector<TraceRow>& rows) {
  struct Ratios {
    std::vector<double> to_best, to_single, to_robust;
  };
  std::map<std::vector<std::string>, Ratios> named;  // by the cells that name a row
  bool is_of_several = false;
  for (const TraceRow& row : rows) {
    if (!row.ratio || !row.test) continue;
    Ratios& ratios = named[{name_of(row.rays), row.path,
                            std::string(triangle_test_names[static_cast<std::size_t>(*row.test)]), row.mode,
                            row.batch == 0 ? "" : std::to_string(row.batch), row.build}];
    is_of_several = is_of_several || !ratios.to_best.empty();
    ratios.to_best.push_back(row.ratio->median);
    ratios.to_single.push_back(row.ratio_to_single->median);
    ratios.to_robust.push_back(row.ratio_to_robust->median);
  }
  RowTable table;
  constexpr const char* columns[] = {"rays", "path", "test", "mode", "batch"};
  for (const auto& [name, ratios] : named) {
    if (!is_of_several) break;
    table.begin();
    for (std::size_t i = 0; i < std::size(columns); ++i) table.add(columns[i], "", name[i]);
    table.add("scenes", "", ratios.to_best.size())
        .add("× Embree", "", geometric_mean(ratios.to_best))
        .add("min", "", *std::min_element(ratios.to_best.begin(), ratios.to_best.end()))
        .add("× single", "", geometric_mean(ratios.to_single))
        .add("× robust", "", geometric_mean(ratios.to_robust))
        .add("build", "", name.back());
  }
  return table;
}

RowTable table_of(const std::vector<TreeCounts>& rows) {
  RowTable table;
  for (const TreeCounts& row : rows) {
    const TreeReport& r = row.report;
    const double triangles = static_cast<double>(std::max<std::size_t>(1, r.triangles));
    table.begin();
    table.add("builder", "", name_of(row.kind));
    for (std::size_t i = 0; i < row.rays.size(); ++i) {
      const CountedRays& counted = row.rays[i];
      const std::string set = name_of(counted.kind);
      table.add(set + " tests", "", counted.per_ray(&TraceCounters::triangle_tests))
          .add("× 1st", "", tests_by_first(rows, row, i));
      Json keys = keys_of(counted);
      keys["counted_seconds"] = counted.seconds;
      table.keys()["rays"].push_back(keys);
    }
    table.add("SAH", "", r.sah_cost, 4)
        .add("bytes/t", "", static_cast<double>(r.bytes) / triangles)
        .add_seconds("build ms", "",
                     r.boxes_seconds + r.tree_seconds + r.optimize_seconds + r.layout_seconds);
    for (const CountedRays& counted : row.rays) {
      const std::string set = name_of(counted.kind);
      table.add(set + " tests/hit", "", counted.triangle_tests_per_hit())
          .add(set + " boxes/ray", "", counted.per_ray(&TraceCounters::box_tests))
          .add(set + " s", "", counted.seconds);
    }
  }
  return table;
}

}  // namespace raylanes::bench

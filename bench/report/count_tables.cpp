#include "count_tables.hpp"

#include <algorithm>
#include <string>

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

std::string walk_name(const TreeCounts& row) {
  if (row.front_to_back && row.culls) return "front to back, culled";
  return row.front_to_back ? "front to back" : row.culls ? "culled" : "neither";
}

Json keys_of(const CountedRays& counted) {
  Json json{{"rays", name_of(counted.kind)}, {"ray_count", counted.rays}, {"hits", counted.hits}};
  add_counts(json, counted);
  return json;
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

RowTable table_of(const std::vector<TreeCounts>& rows) {
  RowTable table;
  for (const TreeCounts& row : rows) {
    const TreeReport& r = row.report;
    const double triangles = static_cast<double>(std::max<std::size_t>(1, r.triangles));
    table.begin({{"front_to_back", row.front_to_back}, {"culls", row.culls}});
    table.add("builder", "", name_of(row.kind)).add("single rays", "", walk_name(row));
    for (std::size_t i = 0; i < row.rays.size(); ++i) {
      const CountedRays& counted = row.rays[i];
      const std::string set = name_of(counted.kind);
      table.add(set + " tests", "", counted.per_ray(&TraceCounters::triangle_tests))
          .add("× fewer", "", fewer_triangle_tests(rows[0].rays[i], counted));
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

void add_rows(RowTable& table, const std::vector<ExperimentRow>& rows, const Json& keys) {
  for (const ExperimentRow& row : rows) {
    table.begin(keys);
    table.add("tree", "tree", row.tree)
        .add("build", "build", row.build)
        .add_seconds("build ms", "build_seconds", row.build_seconds)
        .add("MB", "bytes", row.bytes, significant(1e-6 * static_cast<double>(row.bytes), 3));
    for (std::size_t i = 0; i < row.rays.size(); ++i) {
      const ExperimentRow::Rays &rays = row.rays[i], &without = rows[0].rays[i];
      const std::string set = name_of(rays.counted.kind);
      const double tests = rays.counted.per_ray(&TraceCounters::triangle_tests);
      table.add(set + " tests", "", tests)
          .add("× fewer", "", without.counted.per_ray(&TraceCounters::triangle_tests) / std::max(tests, 1e-9))
          .add("ns", "", 1e9 * rays.single_seconds);
      Json of_set = keys_of(rays.counted);
      of_set.update({{"single_seconds_per_ray", rays.single_seconds},
                     {"lone_seconds_per_ray", rays.lone_seconds},
                     {"batch_seconds_per_ray", rays.batch_seconds},
                     {"times_faster", without.single_seconds / rays.single_seconds}});
      table.keys()["rays"].push_back(of_set);
    }
    for (const ExperimentRow::Rays& rays : row.rays) {
      const std::string set = name_of(rays.counted.kind);
      table.add(set + " ns in a batch", "", 1e9 * rays.batch_seconds)
          .add(set + " ns of a call", "", 1e9 * rays.lone_seconds)
          .add(set + " tests/hit", "", rays.counted.triangle_tests_per_hit())
          .add(set + " hits found/ray", "", rays.counted.per_ray(&TraceCounters::hits))
          .add(set + " planes or nodes/ray", "", rays.counted.per_ray(&TraceCounters::nodes));
    }
  }
}

}  // namespace raylanes::bench

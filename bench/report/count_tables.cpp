#include "count_tables.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <utility>

namespace raylanes::bench {
namespace {

// A counter by its key in JSON and its column.
struct CounterName {
  std::uint64_t TraceCounters::*counter;
  const char *key, *column;
};
constexpr CounterName counter_names[] = {
    {&TraceCounters::box_tests, "box_tests_per_ray", "box tests/ray"},
    {&TraceCounters::triangle_tests, "triangle_tests_per_ray", "triangle tests/ray"},
    {&TraceCounters::nodes, "nodes_per_ray", "nodes/ray"},
    {&TraceCounters::leaves, "leaves_per_ray", "leaves/ray"},
    {&TraceCounters::frustum_tests, "frustum_tests_per_ray", "frustum tests/ray"},
    {&TraceCounters::registers, "registers_per_ray", "registers/ray"},
    {&TraceCounters::hits, "triangle_hits_per_ray", "hits found/ray"},
    {&TraceCounters::undecided, "undecided_tests_per_ray", "undecided/ray"}};

std::string walk_name(const TreeCounts& row) {
  if (row.front_to_back && row.culls) return "front to back, culled";
  return row.front_to_back ? "front to back" : row.culls ? "culled" : "neither";
}

}  // namespace

void add_counts(Json& json, const CountedRays& counted) {
  for (const CounterName& name : counter_names) json[name.key] = counted.per_ray(name.counter);
  json["triangle_tests_per_hit"] = counted.triangle_tests_per_hit();
}

void print_counts(const std::vector<TraceRow>& rows) {
  std::vector<std::vector<std::string>> table{{"rays", "path", "test", "mode", "batch"}};
  for (const CounterName& name : counter_names) table[0].push_back(name.column);
  table[0].push_back("triangle tests/hit");
  for (const TraceRow& row : rows) {
    if (!row.counted) continue;
    table.push_back({name_of(row.rays), row.path,
                     std::string(triangle_test_names[static_cast<std::size_t>(*row.test)]), row.mode,
                     row.batch == 0 ? "" : std::to_string(row.batch)});
    for (const CounterName& name : counter_names)
      table.back().push_back(significant(row.counted->per_ray(name.counter), 3));
    table.back().push_back(significant(row.counted->triangle_tests_per_hit(), 3));
  }
  if (table.size() > 1) print_table(table);
}

void print_counts(const std::vector<TreeCounts>& rows) {
  std::vector<std::vector<std::string>> table{{"builder", "single rays", "SAH", "bytes/t", "build ms"}};
  for (const CountedRays& counted : rows[0].rays)
    for (const char* column : {" tests/ray", "/hit", " boxes/ray", " × fewer", " s"})
      table[0].push_back((std::string_view(column).front() == '/' ? "" : name_of(counted.kind)) + column);
  for (const TreeCounts& row : rows) {
    const TreeReport& r = row.report;
    const double triangles = static_cast<double>(std::max<std::size_t>(1, r.triangles));
    table.push_back(
        {name_of(row.kind), walk_name(row), significant(r.sah_cost, 4),
         significant(static_cast<double>(r.bytes) / triangles, 3),
         significant(1e3 * (r.boxes_seconds + r.tree_seconds + r.optimize_seconds + r.layout_seconds), 3)});
    for (std::size_t i = 0; i < row.rays.size(); ++i) {
      const CountedRays& counted = row.rays[i];
      for (const double x : {counted.per_ray(&TraceCounters::triangle_tests),
                             counted.triangle_tests_per_hit(), counted.per_ray(&TraceCounters::box_tests),
                             fewer_triangle_tests(rows[0].rays[i], counted), counted.seconds})
        table.back().push_back(significant(x, 3));
    }
  }
  std::cout << "triangle tests; × fewer than the first row makes, s of the counted calls\n";
  print_table(table);
}

Json to_json(const TreeCounts& row) {
  Json json{{"front_to_back", row.front_to_back}, {"culls", row.culls}};
  for (const CountedRays& counted : row.rays) {
    Json& rays = json["rays"].emplace_back(Json{{"rays", name_of(counted.kind)},
                                                {"ray_count", counted.rays},
                                                {"hits", counted.hits},
                                                {"counted_seconds", counted.seconds}});
    add_counts(rays, counted);
  }
  return json;
}

void print_experiment(const std::vector<ExperimentRow>& rows) {
  constexpr const char* columns[] = {" tests/ray", "/hit",        " hits found/ray",  " planes or nodes/ray",
                                     " × fewer",   " ns: single", "automatic, 1 ray", "all rays"};
  std::vector<std::vector<std::string>> table{{"tree", "build", "build ms", "MB"}};
  for (const ExperimentRow::Rays& rays : rows[0].rays)
    for (const std::string_view column : columns)
      table[0].push_back((column[0] == ' ' ? name_of(rays.counted.kind) : "") + std::string(column));
  for (const ExperimentRow& row : rows) {
    table.push_back({row.tree, row.build, significant(1e3 * row.build_seconds, 3),
                     significant(1e-6 * static_cast<double>(row.bytes), 3)});
    for (std::size_t i = 0; i < row.rays.size(); ++i) {
      const ExperimentRow::Rays &rays = row.rays[i], &without = rows[0].rays[i];
      const double tests = rays.counted.per_ray(&TraceCounters::triangle_tests);
      for (const double x :
           {tests, rays.counted.triangle_tests_per_hit(), rays.counted.per_ray(&TraceCounters::hits),
            rays.counted.per_ray(&TraceCounters::nodes),
            without.counted.per_ray(&TraceCounters::triangle_tests) / std::max(tests, 1e-9),
            1e9 * rays.single_seconds, 1e9 * rays.lone_seconds, 1e9 * rays.batch_seconds})
        table.back().push_back(significant(x, 3));
    }
  }
  std::cout << "trees of both kinds, and none: counts of single rays, ns a ray\n";
  print_table(table);
}

Json to_json(const ExperimentRow& row, const ExperimentRow& without_tree) {
  Json json{
      {"tree", row.tree}, {"build", row.build}, {"build_seconds", row.build_seconds}, {"bytes", row.bytes}};
  for (std::size_t i = 0; i < row.rays.size(); ++i) {
    const ExperimentRow::Rays &rays = row.rays[i], &without = without_tree.rays[i];
    Json& of_set =
        json["rays"].emplace_back(Json{{"rays", name_of(rays.counted.kind)},
                                       {"ray_count", rays.counted.rays},
                                       {"hits", rays.counted.hits},
                                       {"single_seconds_per_ray", rays.single_seconds},
                                       {"lone_seconds_per_ray", rays.lone_seconds},
                                       {"batch_seconds_per_ray", rays.batch_seconds},
                                       {"times_faster", without.single_seconds / rays.single_seconds}});
    add_counts(of_set, rays.counted);
  }
  return json;
}

}  // namespace raylanes::bench

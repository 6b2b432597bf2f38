// raylanes trees --stages: what trees take from their mesh to their file and back.
#include <iostream>

#include "../contenders/embree/embree_contender.hpp"
#include "../contenders/stages.hpp"
#include "../report/row_table.hpp"
#include "trees.hpp"

namespace raylanes::bench {
namespace {

void add(RowTable& table, const Scene& scene, const StageRow& row, const StagesOptions& options) {
  const auto triangles = static_cast<double>(std::max<std::size_t>(1, scene.mesh.triangles.size()));
  const auto each = [&](std::uint64_t bytes) {
    return significant(static_cast<double>(bytes) / triangles, 3);
  };
  const auto add_stage = [&](const char* column, const char* key, const std::optional<double>& seconds) {
    table.only_if(seconds.has_value()).add_seconds(column, key, seconds.value_or(0));
  };
  table.begin({{"scene", scene.name},
               {"triangles", scene.mesh.triangles.size()},
               {"threads", options.threads},
               {"rounds", options.rounds}});
  table.add("", "contender", row.contender)
      .add("builder", "build", row.builder,
           row.contender == "raylanes" ? row.builder : "Embree: " + row.builder)
      .add_seconds("build ms", "build_seconds", row.build_seconds)
      .add_median("× Embree", "build_ratio_to_embree", row.build_ratio)
      .add("peak B/t", "build_peak_bytes", row.build_peak, each(row.build_peak))
      .add("held B/t", "held_bytes", row.held, each(row.held));
  add_stage("refit ms", "refit_seconds", row.refit_seconds);
  table.only_if(true).add_median("× Embree's", "refit_ratio_to_embree", row.refit_ratio);
  add_stage("save ms", "save_seconds", row.save_seconds);
  add_stage("load ms", "load_seconds", row.load_seconds);
  table.only_if(row.load_seconds.has_value())
      .add("load peak B/t", "load_peak_bytes", row.load_peak, each(row.load_peak))
      .add("file B/t", "file_bytes", row.file_bytes, each(row.file_bytes))
      .only_if(true)
      .add_spread(row.spread);
}

}  // namespace

void run_stages(const TreesCommandOptions& options) {
  force_path(options.one_path().name);
  StagesOptions parsed{
      .threads = options.threads, .rounds = options.rounds, .against_embree = !options.against.empty()};
  for (const TreeBuilder builder : options.builders) parsed.builders.push_back({builder, options.optimize});
  if (parsed.builders.empty())
    parsed.builders = {{TreeBuilder::binned_sah, options.optimize}, {TreeBuilder::morton, options.optimize}};
  RowTable table, example;
  add(example, Scene{}, {}, parsed);
  options.check_output(example);
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    const Scene scene = options.load(name);
    std::cout << '\n'
              << scene_line(scene)
              << "B/t: bytes a triangle beside the mesh; × Embree: speed of building by that of its medium "
                 "quality,\nof morton by its low quality, and speed of refitting by that of its refit\n";
    for (const StageRow& row : measure_stages(scene, parsed)) add(table, scene, row, parsed);
    table.print(options.columns);
  }
  if (parsed.against_embree) std::cout << embree_note() << '\n';
  options.finish(table);
}

}  // namespace raylanes::bench

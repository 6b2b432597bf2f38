// raylanes trees --frames: trees that follow a mesh in motion.
#include <iostream>

#include "../contenders/embree/embree_contender.hpp"
#include "../report/row_table.hpp"
#include "trees.hpp"

namespace raylanes::bench {
namespace {

Json keys_of(const Sequence& sequence, const SequenceOptions& options) {
  return {{"sequence", sequence.name},
          {"triangles", sequence.frames[0].triangles.size()},
          {"path", options.path->name},
          {"threads", options.threads}};
}

void add_rays(RowTable& table, const std::string& kind, std::size_t rays, double seconds) {
  table.keys()[kind + "_rays"] = rays;
  table.add(kind + " Mrays/s", kind + "_seconds", seconds,
            rays > 0 ? significant(1e-6 * static_cast<double>(rays) / seconds, 3) : "");
}

void add(RowTable& table, const FrameRow& row) {
  table.add("frame", "frame", row.frame)
      .add("policy", "policy", row.policy)
      .add("tree", "built", row.is_built, row.is_built ? "built" : "refitted")
      .add_seconds("update ms", "update_seconds", row.update_seconds);
  add_rays(table, "primary", row.primary_rays, row.primary_seconds);
  add_rays(table, "diffuse", row.diffuse_rays, row.diffuse_seconds);
  table.add_seconds("total ms", "total_seconds", row.total_seconds())
      .add("decay", "decay", row.decay)
      .add("SAH cost", "sah_cost", row.sah_cost);
}

void add(RowTable& table, const PolicyRow& row, int rounds) {
  const Quartiles& total = row.total_seconds;
  table.add("policy", "policy", row.policy)
      .add("frames", "frames", row.frames)
      .add("builds", "builds", row.builds)
      .add("", "rounds", rounds)
      .add_seconds("update ms", "", row.update_seconds)
      .add("primary Mrays/s", "", row.primary_mrays)
      .add("diffuse Mrays/s", "", row.diffuse_mrays)
      .add_seconds("total ms", "total_seconds", total.median)
      .add("half within", "total_seconds_quartiles", {total.first, total.third},
           milliseconds(total.first) + "…" + milliseconds(total.third))
      .add("× better fixed time", "", {}, ratio_cell(row.ratio_to_best_fixed));
  if (row.ratio_to_best_fixed) table.keys()["ratio_to_best_fixed"] = row.ratio_to_best_fixed->median;
}

Json compared_refits(const Sequence& sequence, int rounds) {
  const RefitTimes times = refit_beside_embree(sequence, rounds);
  const std::size_t triangles = sequence.frames[0].triangles.size();
  std::cout << "refit, one thread: " << milliseconds(quartiles_of(times.ours).median) << " ms, Embree's "
            << milliseconds(quartiles_of(times.embree).median) << " ms, × Embree's speed "
            << ratio_cell(times.ratio) << " (" << spread_cell(times.ratio) << "); " << triangles
            << " triangles\n"
            << embree_note() << '\n';
  Json rows = Json::array();
  for (std::size_t i = 0; i < times.ours.size(); ++i)
    rows.push_back({{"sequence", sequence.name},
                    {"triangles", triangles},
                    {"frame", i + 1},
                    {"refit_seconds", times.ours[i]},
                    {"embree_refit_seconds", times.embree[i]},
                    {"embree_note", embree_note()}});
  return rows;
}

}  // namespace

void run_frames(const TreesCommandOptions& options) {
  SequenceOptions parsed{.policies = options.policies,
                         .path = &options.one_path(),
                         .threads = options.threads,
                         .rounds = options.rounds};
  std::tie(parsed.width, parsed.height) = options.resolution();
  Sequence sequence = load_sequence(options.scenes, options.copies);
  if (!options.camera.empty()) sequence.camera = parse_camera(options.camera, sequence.camera);
  RowTable frames, policies, example;
  example.begin(keys_of(sequence, parsed));
  add(example, PolicyRow{}, 0);
  options.check_output(example);
  std::cout << machine_line() << '\n';
  const SequenceTrace traced = trace_sequence(sequence, parsed);
  std::cout << '\n'
            << sequence.name << ": " << sequence.frames.size() << " frames of "
            << sequence.frames[0].triangles.size() << " triangles, " << options.size << ", "
            << parsed.path->name << '\n';
  for (const FrameRow& row : traced.frames) frames.begin(keys_of(sequence, parsed)), add(frames, row);
  for (const PolicyRow& row : traced.policies)
    policies.begin(keys_of(sequence, parsed)), add(policies, row, parsed.rounds);
  std::cout << "all frames but the first, medians of frames and rounds:\n";
  policies.print(options.columns);
  std::cout << "all policies give the same bytes; " << traced.checked
            << " hits are those of exact arithmetic over all triangles" << std::endl;
  Json rows = frames.rows();
  append(rows, policies.rows());
  if (options.is_against("embree")) append(rows, compared_refits(sequence, parsed.rounds));
  options.finish(policies, rows, "");
}

}  // namespace raylanes::bench

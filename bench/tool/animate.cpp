#include <iostream>
#include <memory>

#include "../contenders/embree/embree_contender.hpp"
#include "../report/output.hpp"
#include "../support/readers/sequence.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct AnimateOptions {
  SequenceOptions sequence{.policies = {MotionPolicy::refit, MotionPolicy::rebuild, MotionPolicy::automatic}};
  std::vector<std::string> frames;
  std::string size = "256x256";
  std::string camera, path, json;
  std::size_t copies = 1;
  bool against_embree = false, shows_frames = false;
};

std::string mrays_cell(std::size_t rays, double seconds) {
  return rays > 0 ? significant(1e-6 * static_cast<double>(rays) / seconds, 3) : "";
}

void print_frames(const std::vector<FrameRow>& rows) {
  std::vector<std::vector<std::string>> table{{"frame", "policy", "tree", "update ms", "primary Mrays/s",
                                               "diffuse Mrays/s", "total ms", "decay", "SAH cost"}};
  for (const FrameRow& row : rows)
    table.push_back({std::to_string(row.frame), row.policy, row.is_built ? "built" : "refitted",
                     milliseconds(row.update_seconds), mrays_cell(row.primary_rays, row.primary_seconds),
                     mrays_cell(row.diffuse_rays, row.diffuse_seconds), milliseconds(row.total_seconds()),
                     significant(row.decay, 3), significant(row.sah_cost, 3)});
  print_table(table);
}

void print_policies(const std::vector<PolicyRow>& rows) {
  std::vector<std::vector<std::string>> table{{"policy", "frames", "builds", "update ms", "primary Mrays/s",
                                               "diffuse Mrays/s", "total ms", "half within",
                                               "× better fixed policy's time"}};
  for (const PolicyRow& row : rows) {
    const Quartiles& total = row.total_seconds;
    table.push_back({row.policy, std::to_string(row.frames), std::to_string(row.builds),
                     milliseconds(row.update_seconds), significant(row.primary_mrays, 3),
                     significant(row.diffuse_mrays, 3), milliseconds(total.median),
                     milliseconds(total.first) + "…" + milliseconds(total.third),
                     row.ratio_to_best_fixed ? significant(row.ratio_to_best_fixed->median, 3) : ""});
  }
  print_table(table);
}

void print_refits(const RefitTimes& times, std::size_t triangles) {
  std::cout << "refit, one thread: " << milliseconds(quartiles_of(times.ours).median) << " ms, Embree's "
            << milliseconds(quartiles_of(times.embree).median) << " ms, × Embree's speed "
            << significant(times.ratio.median, 3) << " (" << significant(times.ratio.first, 3) << "…"
            << significant(times.ratio.third, 3) << "); " << triangles << " triangles\n"
            << embree_note() << '\n';
}

Json to_json(const AnimateOptions& options, const Sequence& sequence, const FrameRow& row) {
  return {{"sequence", sequence.name},
          {"triangles", sequence.frames[0].triangles.size()},
          {"path", active_path().name},
          {"threads", options.sequence.threads},
          {"frame", row.frame},
          {"policy", row.policy},
          {"built", row.is_built},
          {"update_seconds", row.update_seconds},
          {"primary_rays", row.primary_rays},
          {"primary_seconds", row.primary_seconds},
          {"diffuse_rays", row.diffuse_rays},
          {"diffuse_seconds", row.diffuse_seconds},
          {"total_seconds", row.total_seconds()},
          {"decay", row.decay},
          {"sah_cost", row.sah_cost}};
}

Json to_json(const AnimateOptions& options, const Sequence& sequence, const PolicyRow& row) {
  const Quartiles& total = row.total_seconds;
  Json json{{"sequence", sequence.name},     {"triangles", sequence.frames[0].triangles.size()},
            {"path", active_path().name},    {"threads", options.sequence.threads},
            {"policy", row.policy},          {"frames", row.frames},
            {"builds", row.builds},          {"rounds", options.sequence.rounds},
            {"total_seconds", total.median}, {"total_seconds_quartiles", {total.first, total.third}}};
  if (row.ratio_to_best_fixed) json["ratio_to_best_fixed"] = row.ratio_to_best_fixed->median;
  return json;
}

Json to_json(const Sequence& sequence, const RefitTimes& times, std::size_t at) {
  return {{"sequence", sequence.name},
          {"triangles", sequence.frames[0].triangles.size()},
          {"frame", at + 1},
          {"refit_seconds", times.ours[at]},
          {"embree_refit_seconds", times.embree[at]},
          {"embree_note", embree_note()}};
}

void run(AnimateOptions options) {
  if (!options.path.empty()) force_path(options.path);
  std::tie(options.sequence.width, options.sequence.height) = parse_size(options.size);
  Sequence sequence = load_sequence(options.frames, options.copies);
  if (!options.camera.empty()) sequence.camera = parse_camera(options.camera, sequence.camera);
  std::cout << machine_line() << '\n';
  const SequenceTrace traced = trace_sequence(sequence, options.sequence);
  std::cout << '\n'
            << sequence.name << ": " << sequence.frames.size() << " frames of "
            << sequence.frames[0].triangles.size() << " triangles, " << options.size << ", "
            << active_path().name << '\n';
  if (options.shows_frames) print_frames(traced.frames);
  std::cout << "all frames but the first, medians of frames and rounds:\n";
  print_policies(traced.policies);
  std::cout << "all policies give the same bytes; " << traced.checked
            << " hits are those of exact arithmetic over all triangles" << std::endl;
  Json json = Json::array();
  for (const FrameRow& row : traced.frames) json.push_back(to_json(options, sequence, row));
  for (const PolicyRow& row : traced.policies) json.push_back(to_json(options, sequence, row));
  if (options.against_embree) {
    const RefitTimes times = refit_beside_embree(sequence, options.sequence.rounds);
    print_refits(times, sequence.frames[0].triangles.size());
    for (std::size_t i = 0; i < times.ours.size(); ++i) json.push_back(to_json(sequence, times, i));
  }
  if (!options.json.empty()) write_json(options.json, json);
}

}  // namespace

void add_animate_command(CLI::App& tool) {
  const auto options = std::make_shared<AnimateOptions>();
  CLI::App* command = tool.add_subcommand(
      "animate", "follow a mesh in motion: refit its tree, or build it anew, and trace it");
  command->add_option("FRAME", options->frames, "mesh files in order, all with as many triangles")
      ->required();
  command->add_option("--json", options->json, "also write the rows to this file");
  command->add_option("--path", options->path, "path to trace with (default: the active one)");
  SequenceOptions& sequence = options->sequence;
  add_choices(*command, "--policy", sequence.policies, motion_policy_names,
              "refit, rebuild, auto, or several with commas (default all)");
  command->add_option("--size", options->size, "picture, WIDTHxHEIGHT (default 256x256)");
  command->add_option("--threads", sequence.threads, "threads (0: one per core; default 1)")
      ->check(CLI::Range(0, 1024));
  command->add_option("--rounds", sequence.rounds, "times to run the sequence (default 3)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--copies", options->copies, "so many meshes side by side (default 1)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--camera", options->camera, "eye and look-at point: ex,ey,ez,ax,ay,az");
  command->add_flag("--each", options->shows_frames, "print a row for each frame, too; JSON has them anyway");
  command->add_option("--against", "embree: its refit of the same frames, one thread each")
      ->check(CLI::IsMember({"embree"}))
      ->each([options](const std::string&) { options->against_embree = true; });
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench

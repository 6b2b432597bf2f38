#include "scene_trees.hpp"

#include <list>

#include "../support/rulers/progress.hpp"
#include "contenders.hpp"

namespace raylanes::bench {
namespace {

constexpr std::array embree_builds{EmbreeBuild::low, EmbreeBuild::medium, EmbreeBuild::high};

double total_seconds(const TreeReport& report) {
  return report.boxes_seconds + report.tree_seconds + report.optimize_seconds + report.layout_seconds;
}

class Comparison {
 public:
  Comparison(const Scene& scene, const SceneTreesOptions& options) : scene_(scene), options_(options) {}

  SceneTrees run() {
    time_builds();
    trace();
    result_.verdict = result_.sound ? "all trees gave the same bytes" : "WRONG ANSWERS:" + complaints_;
    return std::move(result_);
  }

 private:
  BuildOptions build_options(const TreeKind& kind) const {
    return {.builder = kind.builder, .threads = options_.trace.threads, .optimize = kind.optimize};
  }

  double build_ours(const TreeKind& kind, std::vector<TreeReport>& reports) const {
    Bvh bvh;
    const double seconds = seconds_of([&] { bvh = Bvh(scene_.mesh, build_options(kind)); });
    reports.push_back(bvh.report());
    return seconds;
  }

  void time_builds() {
    const Mesh& mesh = scene_.mesh;
    std::vector<std::vector<TreeReport>> reports(options_.builders.size());
    std::vector<std::function<double()>> work;
    for (std::size_t i = 0; i < options_.builders.size(); ++i)
      work.push_back([this, i, &reports] { return build_ours(options_.builders[i], reports[i]); });
    if (options_.against_embree)
      for (const EmbreeBuild build : embree_builds)
        work.push_back([&mesh, build] {
          return EmbreeContender(mesh.vertices, mesh.triangles, "", build).build_seconds();
        });
    ProgressLine progress(scene_.name + ": building");
    const std::vector<Timing> timings =
        take_timed_turns(work, {options_.seconds, 3}, [&](double share) { progress.update(share); });
    for (std::size_t i = 0; i < timings.size(); ++i) {
      TreeRow row;
      const bool is_ours = i < options_.builders.size();
      row.contender = is_ours ? "raylanes" : "embree";
      row.builder =
          is_ours ? name_of(options_.builders[i])
                  : embree_build_names[static_cast<std::size_t>(embree_builds[i - options_.builders.size()])];
      row.build_seconds = timings[i].median_seconds, row.spread = timings[i].spread;
      row.rounds = timings[i].seconds.size();
      row.mtris_per_second = static_cast<double>(mesh.triangles.size()) * 1e-6 / row.build_seconds;
      if (is_ours) row.report = report_nearest(reports[i], row.build_seconds);
      for (std::size_t k = options_.builders.size(); is_ours && k < timings.size(); ++k)
        row.to_embree.push_back(speed_ratio(timings[i], timings[k]));
      result_.rows.push_back(std::move(row));
    }
  }

  static TreeReport report_nearest(const std::vector<TreeReport>& reports, double seconds) {
    return *std::min_element(reports.begin(), reports.end(), [&](const TreeReport& a, const TreeReport& b) {
      return std::fabs(total_seconds(a) - seconds) < std::fabs(total_seconds(b) - seconds);
    });
  }

  void trace() {
    std::list<BuiltTree> trees;
    std::vector<Contender> contenders;
    for (const TreeKind& kind : options_.builders) {
      trees.push_back({kind, Bvh(scene_.mesh, build_options(kind))});
      contenders.push_back(our_contender(trees.back().bvh, options_.trace));
    }
    const Workload workload(scene_, trees.front().bvh, options_.width, options_.height);
    if (options_.counts) result_.counts = count_trees(trees, workload, options_.ray_sets, options_.trace);
    if (options_.counts_pixels) count_all_pixels(trees, workload);
    for (const RayKind kind : options_.ray_sets) race(workload.rays(kind), kind, contenders);
  }

  void count_all_pixels(const std::list<BuiltTree>& trees, const Workload& workload) {
    result_.heat = {{"triangle tests", {}}, {"box tests", {}}};
    for (const BuiltTree& tree : trees) {
      PixelTests pixels = count_pixels(tree.bvh, workload.primary(), {.path = options_.trace.path});
      result_.heat[0].panels.push_back({name_of(tree.kind), std::move(pixels.triangles)});
      result_.heat[1].panels.push_back({name_of(tree.kind), std::move(pixels.boxes)});
    }
  }

  void race(const RaySet& set, RayKind kind, const std::vector<Contender>& contenders) {
    Answers first(set), answers(set);
    contenders[0].trace(set, first);
    std::vector<std::function<void()>> work;
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      contenders[i].trace(set, answers);
      if (!answers.same_bytes(first)) {
        result_.sound = false;
        complaints_ += "\n  " + set.name + ": " + result_.rows[i].builder + " gave other bytes than " +
                       result_.rows[0].builder;
      }
      work.push_back([&, i] { contenders[i].trace(set, answers); });
    }
    ProgressLine progress(scene_.name + ": tracing " + set.name);
    const std::vector<Timing> timings =
        take_turns(work, {options_.seconds}, [&](double share) { progress.update(share); });
    for (std::size_t i = 0; i < timings.size(); ++i)
      result_.rows[i].traces.push_back(
          {kind, static_cast<double>(set.rays.size()) * 1e-6 / timings[i].median_seconds, timings[i].spread,
           speed_ratio(timings[i], timings[0])});
  }

  const Scene& scene_;
  const SceneTreesOptions& options_;
  SceneTrees result_;
  std::string complaints_;
};

}  // namespace

SceneTrees compare_trees(const Scene& scene, const SceneTreesOptions& options) {
  return Comparison(scene, options).run();
}

}  // namespace raylanes::bench

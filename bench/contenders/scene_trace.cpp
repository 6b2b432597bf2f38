#include "scene_trace.hpp"

#include <chrono>
#include <map>
#include <memory>

#include "../report/image.hpp"
#include "../report/output.hpp"
#include "../report/progress.hpp"
#include "../survey/measure.hpp"

namespace raylanes::bench {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

oracle::Form form_of(TriangleTest test) {
  return test == TriangleTest::watertight ? oracle::Form::sheared : oracle::Form::moller_trumbore;
}

// Everything known while one scene is traced.
class Tracer {
 public:
  Tracer(Scene scene, const SceneTraceOptions& options) : options_(options) {
    result_.scene = std::move(scene);
    build();
    workload_ = std::make_unique<Workload>(result_.scene, *bvh_, options.width, options.height);
  }

  SceneTrace run() {
    paint();
    for (const std::string& name : options_.ray_sets) trace_set(workload_->rays(name));
    conclude();
    return std::move(result_);
  }

 private:
  // A contender with its answers, and the row it fills.
  struct Entry {
    Contender contender;
    Answers answers;
    TraceRow row;
    const Path* path;  // null for Embree
  };

  bool must_be_reproducible() const {
    return options_.trace.grade == Grade::reproducible && options_.trace.test == TriangleTest::watertight;
  }

  void build() {
    const Mesh& mesh = result_.scene.mesh;
    ProgressLine progress(result_.scene.name + ": building");
    const auto start = std::chrono::steady_clock::now();
    bvh_ = std::make_unique<Bvh>(mesh.vertices, mesh.triangles, [&](double done) { progress.update(done); });
    build_seconds_ = seconds_since(start);
    result_.summary = result_.scene.name + ": " + std::to_string(mesh.triangles.size()) +
                      " triangles, built in " + significant(build_seconds_, 3) + " s, " +
                      significant(static_cast<double>(bvh_->bytes()) / (1024.0 * 1024.0), 3) + " MiB";
  }

  void paint() {
    const RaySet shadow = workload_->rays("shadow");
    std::vector<std::uint8_t> occluded(shadow.rays.size());
    bvh_->occluded(shadow.rays, occluded);
    result_.picture =
        shade(result_.scene, workload_->primary(), workload_->primary_hits(), occluded, workload_->light());
  }

  void trace_set(const RaySet& set) {
    std::vector<Entry> entries;
    std::map<std::string, std::unique_ptr<EmbreeContender>> embrees;
    for (const Path* path : options_.paths) add_ours(entries, set, *path);
    if (options_.against_embree)
      for (const Path* path : options_.paths) add_embree(entries, embrees, set, *path);
    check(entries, set);
    time(entries, set);
    rate(entries);
    for (Entry& entry : entries) result_.rows.push_back(std::move(entry.row));
  }

  TraceRow new_row(const RaySet& set, const std::string& path, const std::string& isa) const {
    TraceRow row;
    row.rays = set.name;
    row.query = set.query;
    row.ray_count = set.rays.size();
    row.path = path;
    row.isa = isa;
    return row;
  }

  void add_ours(std::vector<Entry>& entries, const RaySet& set, const Path& path) {
    TraceOptions trace = options_.trace;
    trace.path = &path;
    for (Contender& contender : our_contenders(*bvh_, trace, options_.modes)) {
      TraceRow row = new_row(set, path.name, path.isa);
      row.contender = "raylanes";
      row.mode = contender.mode;
      row.build = "binned_sah";
      row.build_seconds = build_seconds_;
      row.bytes = bvh_->bytes();
      entries.push_back({std::move(contender), Answers(set), std::move(row), &path});
    }
  }

  // Once per instruction set; the scalar path has no counterpart in Embree.
  void add_embree(std::vector<Entry>& entries,
                  std::map<std::string, std::unique_ptr<EmbreeContender>>& embrees, const RaySet& set,
                  const Path& path) {
    const std::string isa = path.isa;
    if (isa == "scalar" || embrees.contains(isa)) return;
    const Mesh& mesh = result_.scene.mesh;
    auto embree = std::make_unique<EmbreeContender>(mesh.vertices, mesh.triangles, isa);
    for (Contender& contender : embree_contenders(*embree)) {
      TraceRow row = new_row(set, "embree-" + isa, isa);
      row.contender = "embree";
      row.mode = contender.mode;
      row.build = "medium";
      row.build_seconds = embree->build_seconds();
      entries.push_back({std::move(contender), Answers(set), std::move(row), nullptr});
    }
    embrees[isa] = std::move(embree);
  }

  void check(std::vector<Entry>& entries, const RaySet& set) {
    for (Entry& entry : entries) {
      entry.contender.trace(set, entry.answers);
      entry.row.hits = entry.answers.hit_count();
    }
    const Entry& first = entries.front();
    const Entry* embree = nullptr;
    for (const Entry& entry : entries)
      if (entry.path == nullptr && entry.row.mode == "single") embree = &entry;
    for (Entry& entry : entries) {
      if (entry.path == nullptr) continue;
      const bool same = entry.answers.same_bytes(first.answers);
      if (!same && must_be_reproducible()) {
        differing_.push_back(set.name + " " + entry.row.path + " " + entry.row.mode);
        result_.sound = false;
      }
      if (embree == nullptr) continue;
      entry.row.agreement =
          same && &entry != &first
              ? first.row.agreement
              : compare_answers(result_.scene, set, entry.answers, embree->answers, entry.contender,
                                form_of(options_.trace.test), embree->contender);
      result_.sound = result_.sound && entry.row.agreement->ours_wrong == 0;
    }
  }

  void time(std::vector<Entry>& entries, const RaySet& set) {
    std::vector<std::function<void()>> work;
    for (Entry& entry : entries) work.push_back([&] { entry.contender.trace(set, entry.answers); });
    const std::vector<Timing> timings = take_turns(work, {options_.seconds});
    for (std::size_t i = 0; i < entries.size(); ++i) {
      entries[i].row.mrays_per_second =
          static_cast<double>(set.rays.size()) * 1e-6 / timings[i].median_seconds;
      entries[i].row.spread = timings[i].spread;
    }
  }

  // Ours against Embree on the same instruction set: its best mode, and its single rays.
  static void rate(std::vector<Entry>& entries) {
    std::map<std::string, double> best, single;
    for (const Entry& entry : entries) {
      if (entry.path != nullptr) continue;
      best[entry.row.isa] = std::max(best[entry.row.isa], entry.row.mrays_per_second);
      if (entry.row.mode == "single") single[entry.row.isa] = entry.row.mrays_per_second;
    }
    for (Entry& entry : entries) {
      if (entry.path == nullptr || !best.contains(entry.row.isa)) continue;
      entry.row.ratio = entry.row.mrays_per_second / best[entry.row.isa];
      entry.row.ratio_to_single = entry.row.mrays_per_second / single[entry.row.isa];
    }
  }

  void conclude() {
    if (!differing_.empty()) {
      result_.verdict = "DIFFERENT BYTES:";
      for (const std::string& who : differing_) result_.verdict += " [" + who + "]";
    } else if (must_be_reproducible() && options_.paths.size() * options_.modes.size() > 1) {
      result_.verdict = "all paths and modes gave the same bytes";
    }
  }

  const SceneTraceOptions& options_;
  SceneTrace result_;
  std::unique_ptr<Bvh> bvh_;
  double build_seconds_ = 0.0;
  std::unique_ptr<Workload> workload_;
  std::vector<std::string> differing_;
};

}  // namespace

SceneTrace trace_scene(Scene scene, const SceneTraceOptions& options) {
  return Tracer(std::move(scene), options).run();
}

}  // namespace raylanes::bench

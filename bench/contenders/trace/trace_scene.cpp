#include "trace_scene.hpp"

#include <list>

#include "../../report/output.hpp"
#include "../../rows/tree_counts.hpp"
#include "../../support/pictures/image.hpp"
#include "../../support/readers/printable.hpp"
#include "../../support/rulers/progress.hpp"
#include "../scene_contenders.hpp"
#include "answer_check.hpp"

namespace raylanes::bench {
namespace {

oracle::Form form_of(TriangleTest test) {
  return test == TriangleTest::exact        ? oracle::Form::exact
         : test == TriangleTest::watertight ? oracle::Form::sheared
                                            : oracle::Form::moller_trumbore;
}

// Embree's builds that are traced.
constexpr std::array traced_embree_builds{EmbreeBuild::medium, EmbreeBuild::high, EmbreeBuild::robust};

// Everything known while one scene is traced.
class Tracer {
 public:
  Tracer(Scene scene, const SceneTraceOptions& options) : options_(options) {
    result_.scene = std::move(scene);
    parts_ = cut();
    result_.parts = parts_.first.size();
    build();
    workload_ = std::make_unique<Workload>(result_.scene, *bvh_, options.width, options.height, options.order,
                                           options.samples);
    reference_ = our_contender(*bvh_, {});
    check_.emplace(result_.scene, tree(), reference_, options.trace);
    if (options.against_scene) add_scene();
    if (options.against_user) user_.emplace(result_.scene.mesh, *bvh_);
    if (std::find(options_.tests.begin(), options_.tests.end(), TriangleTest::exact) != options_.tests.end())
      undecided_lanes_.emplace(result_.scene.mesh);
  }

  SceneTrace run() {
    paint();
    std::vector<Question> questions;
    for (const RayKind kind : options_.ray_sets) questions.push_back(ask(kind));
    const std::vector<std::vector<const Path*>> groups = groups_of_paths();
    ProgressLine progress(result_.scene.name + ": timing");
    std::size_t done = 0;
    for (const auto& group : groups) {
      const std::list<NamedEmbree> embrees = embrees_for(group);
      for (const Question& question : questions) {
        const double steps = static_cast<double>(groups.size() * questions.size());
        race(question, group, embrees,
             [&](double share) { progress.update((static_cast<double>(done) + share) / steps); });
        ++done;
      }
    }
    // The entries by ray set, in the order of contenders.
    std::stable_sort(result_.rows.begin(), result_.rows.end(),
                     [](const TraceRow& a, const TraceRow& b) { return a.rays < b.rays; });
    conclude();
    return std::move(result_);
  }

 private:
  using Progress = std::function<void(double)>;
  struct NamedEmbree {
    std::string name;
    EmbreeBuild build;
    std::unique_ptr<EmbreeContender> embree;
  };

  Parts cut() {
    Scene& scene = result_.scene;
    if (options_.by_groups && !scene.nodes.places.empty())
      return parts_of_nodes(scene.mesh, scene.groups, scene.nodes);
    if (options_.by_groups) return parts_of_groups(scene.mesh, scene.groups);
    return options_.parts == 1 ? parts_of_groups(scene.mesh, {}) : cut_into_parts(scene.mesh, options_.parts);
  }
  bool has_parts() const { return parts_.first.size() > 1; }

  void add_scene() {
    scenes_.emplace(parts_);
    if (!has_parts()) return;
    const auto [first, next] = seconds_of_a_move(parts_);
    result_.summary += "\n" + std::to_string(parts_.first.size()) +
                       " parts; update() after one of them moved: " + significant(1e3 * first, 3) +
                       " ms, then " + significant(1e3 * next, 3) + " ms";
  }

  // A BVH makes the rays, and the answers that a k-d tree is held to.
  void build() {
    const Mesh& mesh = result_.scene.mesh;
    ProgressLine progress(result_.scene.name + ": building");
    const Progress report = [&](double done) { progress.update(done); };
    build_seconds_ = seconds_of([&] {
      bvh_ = std::make_unique<Bvh>(mesh, BuildOptions{.progress = report,
                                                      .builder = options_.builder,
                                                      .optimize = options_.optimize,
                                                      .choose = options_.tree == TreeFamily::automatic});
    });
    if (options_.tree == TreeFamily::kdtree)
      build_seconds_ = seconds_of([&] {
        kdtree_ = std::make_unique<KdTree>(
            mesh, KdBuildOptions{.progress = report, .builder = options_.kd_builder});
      });
    bytes_ = kdtree_ ? kdtree_->bytes() : bvh_->bytes();
    result_.summary = printable(result_.scene.name) + ": " + std::to_string(mesh.triangles.size()) +
                      " triangles, built in " + significant(build_seconds_, 3) + " s, " +
                      significant(static_cast<double>(bytes_) / (1024.0 * 1024.0), 3) + " MiB";
    const TreeReport built = bvh_->report();
    if (!built.choice.empty()) result_.summary += "\nchosen: " + built.choice;
    result_.build = kdtree_ ? std::string(kd_builder_names[static_cast<std::size_t>(options_.kd_builder)])
                            : name_of(TreeKind{built.builder, built.optimized});
  }
  // The tree that is traced.
  const TriangleTree& tree() const { return kdtree_ ? static_cast<const TriangleTree&>(*kdtree_) : *bvh_; }

  void paint() {
    const Workload by_rows(result_.scene, *bvh_, options_.width, options_.height, PixelOrder::rows,
                           options_.samples);
    const RaySet shadow = by_rows.rays(RayKind::shadow);
    std::vector<std::uint8_t> occluded(shadow.rays.size());
    bvh_->occluded(shadow.rays, occluded);
    result_.picture = shade(result_.scene, by_rows.primary(), by_rows.primary_hits(), occluded,
                            by_rows.light(), options_.samples);
    if (options_.counts_pixels)
      result_.pixels =
          count_pixels(tree(), primary_rays(result_.scene.camera, options_.width, options_.height),
                       {.test = options_.tests[0], .path = options_.paths[0]});
  }

  Question ask(RayKind kind) const {
    RaySet set = workload_->rays(kind);
    Answers answers(set);
    reference_.trace(set, answers);
    const std::optional<UndecidedLanes> open = count_undecided(set.rays);
    return {kind, std::move(set), std::move(answers), open};
  }

  // Counts undecided lanes of some of the rays. Nothing without the exact test.
  std::optional<UndecidedLanes> count_undecided(const std::vector<Ray>& rays) const {
    if (!undecided_lanes_) return {};
    constexpr std::size_t counted_rays = 20000;
    std::vector<Ray> some;
    for (std::size_t i = 0; i < rays.size(); i += rays.size() / counted_rays + 1) some.push_back(rays[i]);
    return undecided_lanes_->count(some);
  }

  // The paths that are compared by rounds: all paths, or beside Embree the paths of one instruction set, which saves
  // memory.
  std::vector<std::vector<const Path*>> groups_of_paths() const {
    std::vector<std::vector<const Path*>> groups;
    for (const Path* path : options_.paths) {
      const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
        return !options_.against_embree || std::string_view(group[0]->isa) == path->isa;
      });
      if (same == groups.end())
        groups.push_back({path});
      else
        same->push_back(path);
    }
    return groups;
  }

  // None for the scalar path: Embree has no counterpart.
  std::list<NamedEmbree> embrees_for(const std::vector<const Path*>& group) const {
    std::list<NamedEmbree> embrees;
    const std::string isa = group[0]->isa;
    if (!options_.against_embree || isa == "scalar") return embrees;
    for (const EmbreeBuild build : traced_embree_builds) {
      embrees.push_back({"embree", build, std::make_unique<EmbreeContender>(parts_, false, isa, build)});
      if (has_parts())
        embrees.push_back(
            {"embree_instances", build, std::make_unique<EmbreeContender>(parts_, true, isa, build)});
    }
    return embrees;
  }

  TraceRow new_row(const Question& question, const Contender& contender) const {
    TraceRow row;
    row.rays = question.kind;
    row.query = question.set.query;
    row.ray_count = question.set.rays.size();
    row.mode = contender.mode;
    return row;
  }

  Entry our_entry(Contender contender, const Question& question, const Path& path, TriangleTest test,
                  std::size_t batch) const {
    TraceRow row = new_row(question, contender);
    row.test = test, row.batch = batch;
    if (test == TriangleTest::exact) row.open = question.open;
    row.contender = "raylanes", row.path = path.name, row.isa = path.isa;
    row.build = result_.build;
    row.build_seconds = build_seconds_, row.bytes = bytes_;
    return {std::move(contender), form_of(test), std::move(row)};
  }

  void add_ours(std::vector<Entry>& entries, const Question& question, const Path& path) {
    TraceOptions trace = options_.trace;
    trace.path = &path;
    for (const TriangleTest test : options_.tests)
      for (const TraversalMode mode : options_.modes)
        for (const std::size_t batch : options_.batches) {
          trace.test = test, trace.mode = mode;
          entries.push_back(
              our_entry(our_contender(tree(), trace, batch, options_.skips), question, path, test, batch));
          if (options_.counts) count_ours(entries.back(), question, trace);
        }
  }
  void add_caller(std::vector<Entry>& entries, const Question& question, const Path& path) {
    TraceOptions trace = options_.trace;
    trace.path = &path;
    for (const TriangleTest test : options_.tests) {
      trace.test = test;
      entries.push_back(our_entry(our_caller(tree(), trace, options_.skips), question, path, test, 1));
    }
  }
  void add_scenes(std::vector<Entry>& entries, const Question& question, const Path& path) const {
    std::vector<NamedContender> named;
    const auto add = [&](std::vector<NamedContender> more) {
      std::move(more.begin(), more.end(), std::back_inserter(named));
    };
    if (scenes_) add(scenes_->ways(path, false));
    if (scenes_ && options_.calls) add(scenes_->ways(path, true));
    if (user_ && question.set.query == Query::closest) add(user_->ways(path));
    for (NamedContender& one : named) {
      Entry entry = our_entry(std::move(one.way), question, path, TriangleTest::exact, 0);
      entry.row.contender = one.name, entry.row.test = {}, entry.row.open = {};
      entry.row.batch = entry.is_call() ? 1 : 0, entry.is_exact = one.is_exact;
      entries.push_back(std::move(entry));
    }
  }
  void count_ours(Entry& entry, const Question& question, const TraceOptions& trace) {
    Answers answers(question.set), plain(question.set);
    entry.row.counted = count(tree(), question.set, question.kind, trace, answers, entry.row.batch);
    entry.contender.trace(question.set, plain);
    if (!answers.same_bytes(plain)) check_->complain(entry, "other bytes when counted");
  }

  const std::vector<std::size_t>& streams() const {
    return options_.streams.empty() ? options_.batches : options_.streams;
  }
  void add_embree(std::vector<Entry>& entries, const Question& question, const std::string& isa,
                  const NamedEmbree& named) const {
    const auto& [name, build, embree] = named;
    const bool is_robust = build == EmbreeBuild::robust;
    std::vector<Contender> contenders;
    const std::vector<std::size_t> all_at_once{0};
    const bool are_sized = options_.batches != all_at_once;
    if (!options_.modes.empty())
      contenders =
          embree_contenders(*embree, are_scattered(question.kind), is_robust ? all_at_once : streams());
    if (options_.calls)
      for (Contender& caller : embree_callers(*embree)) contenders.push_back(std::move(caller));
    // Debian's Embree 3.13 does not return from packets of any-hit rays through instances with AVX-512.
    if (name == "embree_instances" && question.set.query == Query::any)
      std::erase_if(contenders, [](const Contender& c) { return c.mode.starts_with("packet"); });
    for (Contender& contender : contenders) {
      TraceRow row = new_row(question, contender);
      row.batch = are_sized || contender.mode.starts_with("call") ? contender.batch : 0;
      row.contender = name, row.path = "embree-" + isa, row.isa = isa;
      row.build = embree_build_names[static_cast<std::size_t>(build)],
      row.build_seconds = embree->build_seconds();
      entries.push_back({std::move(contender),
                         is_robust ? oracle::Form::embree_robust : oracle::Form::embree_fast,
                         std::move(row)});
    }
  }

  // Checks, times and rates one group on one ray set.
  void race(const Question& question, const std::vector<const Path*>& group,
            const std::list<NamedEmbree>& embrees, const Progress& progress) {
    std::vector<Entry> entries;
    for (const Path* path : group) {
      add_ours(entries, question, *path);
      if (options_.calls) add_caller(entries, question, *path);
      add_scenes(entries, question, *path);
    }
    for (const NamedEmbree& embree : embrees) add_embree(entries, question, group[0]->isa, embree);
    check_->check(entries, question);
    Answers answers(question.set);
    std::vector<std::function<double()>> work;
    for (const Entry& entry : entries)
      work.push_back([&, &contender = entry.contender] {
        if (options_.warm) contender.trace(question.set, answers);
        return contender.is_packed() ? contender.timed(question.set, answers)
                                     : seconds_of([&] { contender.trace(question.set, answers); });
      });
    const std::vector<Timing> timings = take_timed_turns(work, {options_.seconds}, progress);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      entries[i].timing = timings[i];
      entries[i].row.mrays_per_second =
          static_cast<double>(question.set.rays.size()) * 1e-6 / timings[i].median_seconds;
      entries[i].row.spread = timings[i].spread;
      for (const double seconds : timings[i].seconds)
        entries[i].row.rounds_mrays_per_second.push_back(
            1e-6 * static_cast<double>(question.set.rays.size()) / seconds);
    }
    rate(entries);
    for (Entry& entry : entries) result_.rows.push_back(std::move(entry.row));
  }

  void conclude() {
    result_.sound = check_->complaints().empty();
    if (!result_.sound) {
      result_.verdict = "WRONG ANSWERS:";
      for (const std::string& complaint : check_->complaints()) result_.verdict += "\n  " + complaint;
    } else if (options_.tests == std::vector{TriangleTest::exact} &&
               options_.paths.size() * (options_.modes.size() + (options_.calls ? 1 : 0)) > 1) {
      result_.verdict = "all paths and modes gave the same bytes";
    }
  }

  const SceneTraceOptions& options_;
  SceneTrace result_;
  std::unique_ptr<Bvh> bvh_;
  std::unique_ptr<KdTree> kdtree_;  // null: the BVH is traced
  double build_seconds_ = 0.0;
  std::size_t bytes_ = 0;
  std::unique_ptr<Workload> workload_;
  std::optional<UndecidedLaneCounter> undecided_lanes_;
  Parts parts_;  // at least one, all of the mesh
  std::optional<SceneContenders> scenes_;
  std::optional<UserContenders> user_;
  Contender reference_;  // single rays with all that is the default
  std::optional<AnswerCheck> check_;
};

}  // namespace

SceneTrace trace_scene(Scene scene, const SceneTraceOptions& options) {
  return Tracer(std::move(scene), options).run();
}

}  // namespace raylanes::bench

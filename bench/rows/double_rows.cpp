#include "double_rows.hpp"

#include "../contenders/rivals.hpp"
#include "../support/rays/aim.hpp"

namespace raylanes::bench {
namespace {

struct DoubleSet {
  std::string name;
  Query query;
  std::vector<RayD> rays;
  std::vector<Ray> floats;  // the same rays, or none
};

oracle::DoubleMesh moved(const Mesh& mesh, double offset) {
  oracle::DoubleMesh moved{{}, mesh.triangles};
  for (const auto& [x, y, z] : mesh.vertices)
    moved.vertices.push_back(
        {static_cast<double>(x) + offset, static_cast<double>(y) + offset, static_cast<double>(z) + offset});
  return moved;
}

DoubleSet moved(const RaySet& set, double offset) {
  DoubleSet moved{set.name, set.query, {}, offset == 0 ? set.rays : std::vector<Ray>{}};
  for (const Ray& ray : set.rays) {
    RayD& to = moved.rays.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      to.origin[k] = static_cast<double>(ray.origin[k]) + offset;
      to.direction[k] = static_cast<double>(ray.direction[k]);
    }
    to.tmin = static_cast<double>(ray.tmin), to.tmax = static_cast<double>(ray.tmax);
  }
  return moved;
}

DoubleSet towards_edges(const oracle::DoubleMesh& mesh, const BoxD& bounds, std::size_t count) {
  DoubleSet set{"edges", Query::closest, {}, {}};
  SplitMix random(1);
  Double3 middle;
  double half = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    middle[k] = bounds.lo[k] + (bounds.hi[k] - bounds.lo[k]) / 2;
    half = std::max(half, bounds.hi[k] - bounds.lo[k]);
  }
  for (std::size_t i = 0; i < count && !mesh.triangles.empty(); ++i) {
    const auto number =
        static_cast<std::size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()));
    const auto side = static_cast<std::size_t>(3 * random.uniform());
    const Index3& corners = mesh.triangles[number];
    const Double3 &a = mesh.vertices[corners[side]], &b = mesh.vertices[corners[(side + 1) % 3]];
    const double share = random.uniform();
    RayD ray{.origin = point_around(random, middle, 2 * half)};
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = a[k] + share * (b[k] - a[k]) - ray.origin[k];
    set.rays.push_back(ray);
  }
  return set;
}

template <class OneHit>
struct AnswersIn {
  explicit AnswersIn(const DoubleSet& set)
      : hits(set.query == Query::closest ? set.rays.size() : 0),
        occluded(set.query == Query::closest ? 0 : set.rays.size()) {}
  std::vector<OneHit> hits;
  std::vector<std::uint8_t> occluded;
};
using DoubleAnswers = AnswersIn<HitD>;

struct Work {
  DoubleRow row;
  std::shared_ptr<DoubleAnswers> answers;
  std::function<void()> run;
};

// One ray set by all contenders.
class Race {
 public:
  Race(const oracle::DoubleMesh& mesh, const BvhD& tree, const DoubleSet& set)
      : mesh_(mesh), tree_(tree), set_(set) {}

  void add_ours(const Path* path) {
    add_tree("raylanes", tree_, set_.rays, TraceOptionsD{.path = path},
             [](DoubleAnswers& to) -> DoubleAnswers& { return to; });
  }
  // The same rays through a tree of floats, whose answers nobody judges here.
  void add_floats(const Bvh& floats, const Path* path) {
    const auto answers = std::make_shared<AnswersIn<Hit>>(set_);
    add_tree("floats", floats, set_.floats, TraceOptions{.path = path},
             [answers](DoubleAnswers&) -> AnswersIn<Hit>& { return *answers; });
  }
  void add_embree(const EmbreeDoubles& embree) {
    add("embree", "best", "call", [this, &embree](DoubleAnswers& to) {
      if (set_.query == Query::closest)
        embree.closest(set_.rays, to.hits);
      else
        embree.occluded(set_.rays, to.occluded);
    });
  }
  void add_cgal(const CgalDoubles& cgal) {
    add("cgal", "", "call", [this, &cgal](DoubleAnswers& to) { cgal.closest(set_.rays, to.hits); });
  }

  std::vector<DoubleRow> run(const Budget& budget, std::size_t judged) {
    std::vector<std::function<void()>> calls;
    for (const Work& work : works_) calls.push_back(work.run);
    const std::vector<Timing> timings = take_turns(calls, budget);
    judge(judged);
    std::vector<DoubleRow> rows;
    for (std::size_t k = 0; k < works_.size(); ++k) {
      DoubleRow row = works_[k].row;
      row.mrays_per_second = 1e-6 * static_cast<double>(row.ray_count) / timings[k].median_seconds;
      row.spread = timings[k].spread;
      for (std::size_t other = 0; row.contender == "raylanes" && other < works_.size(); ++other) {
        const DoubleRow& of = works_[other].row;
        if (of.contender == "embree") row.ratio = speed_ratio(timings[k], timings[other]);
        if (of.contender == "floats" && of.path == row.path && of.mode == row.mode)
          row.ratio_to_floats = speed_ratio(timings[k], timings[other]);
      }
      rows.push_back(std::move(row));
    }
    return rows;
  }

 private:
  // A call for each ray, and a batch. answers_in() picks the answers in the numbers of the tree.
  template <class Tree, class Rays, class Options, class AnswersOf>
  void add_tree(const char* contender, const Tree& tree, const Rays& rays, const Options& options,
                const AnswersOf& answers_in) {
    add(contender, options.path->name, "call", [=, &tree, &rays](DoubleAnswers& all) {
      auto& to = answers_in(all);
      for (std::size_t i = 0; i < to.hits.size(); ++i) to.hits[i] = tree.closest(rays[i], options);
      for (std::size_t i = 0; i < to.occluded.size(); ++i)
        to.occluded[i] = tree.occluded(rays[i], options) ? 1 : 0;
    });
    add(contender, options.path->name, "batch", [=, this, &tree, &rays](DoubleAnswers& all) {
      auto& to = answers_in(all);
      if (set_.query == Query::closest)
        tree.closest(rays, to.hits, options);
      else
        tree.occluded(rays, to.occluded, options);
    });
  }
  void add(const std::string& contender, const std::string& path, const std::string& mode,
           const std::function<void(DoubleAnswers&)>& trace) {
    const std::size_t count = set_.rays.size();
    const auto answers = std::make_shared<DoubleAnswers>(set_);
    works_.push_back(
        {{.rays = set_.name, .contender = contender, .path = path, .mode = mode, .ray_count = count},
         answers,
         [=] { trace(*answers); }});
  }

  // The answer to ray i: a triangle or none; to any hit 0 or none.
  std::uint32_t said(const Work& work, std::size_t i) const {
    if (set_.query == Query::closest) return work.answers->hits[i].primitive;
    return work.answers->occluded[i] != 0 ? 0 : no_primitive;
  }
  double exact_t(std::size_t i, std::uint32_t triangle) const {
    const auto hit = oracle::exact_hit(set_.rays[i], oracle::corners_of(mesh_, triangle)).hit;
    return hit ? hit.t : std::numeric_limits<double>::infinity();
  }
  // The nearest of the triangles that contenders name; `looks_everywhere`: of all. To rays that ask for
  // any hit, the tree names one if it finds any.
  double nearest_t(std::size_t i, bool looks_everywhere) const {
    double nearest = std::numeric_limits<double>::infinity();
    const auto look_at = [&](std::uint32_t triangle) {
      if (triangle != no_primitive) nearest = std::min(nearest, exact_t(i, triangle));
    };
    const std::uint32_t named =
        set_.query == Query::any ? tree_.closest(set_.rays[i]).primitive : no_primitive;
    if (looks_everywhere || (set_.query == Query::any && named == no_primitive)) {
      const auto hits = oracle::exact_hits(mesh_, set_.rays[i]);
      return hits.empty() ? nearest : hits[0].t;
    }
    look_at(named);
    for (const Work& work : works_)
      if (set_.query == Query::closest && work.row.contender != "floats") look_at(said(work, i));
    return nearest;
  }
  // Whether the answer is not the nearest hit. Each of those with equal t is right.
  bool is_wrong(const Work& work, std::size_t i, double nearest) const {
    const std::uint32_t triangle = said(work, i);
    if (triangle == no_primitive) return nearest < std::numeric_limits<double>::infinity();
    const double t = set_.query == Query::closest ? exact_t(i, triangle) : nearest;
    return !(t < std::numeric_limits<double>::infinity()) || t > nearest;
  }
  // Exact arithmetic is asked where contenders differ, and of some more rays.
  void judge(std::size_t judged) {
    const std::size_t step = std::max<std::size_t>(1, set_.rays.size() / std::max<std::size_t>(1, judged));
    for (std::size_t i = 0; i < set_.rays.size(); ++i) {
      bool differ = false;
      for (Work& work : works_) {
        if (work.row.contender == "floats") continue;
        work.row.hits += said(work, i) != no_primitive ? 1 : 0;
        differ = differ || said(work, i) != said(works_[0], i);
      }
      if (!differ && i % step != 0) continue;
      const double nearest = nearest_t(i, i % step == 0);
      for (Work& work : works_)
        if (work.row.contender != "floats") work.row.wrong += is_wrong(work, i, nearest) ? 1 : 0;
    }
  }

  const oracle::DoubleMesh& mesh_;
  const BvhD& tree_;
  const DoubleSet& set_;
  std::vector<Work> works_;
};

}  // namespace

std::vector<DoubleRow> double_rows(const Scene& scene, const DoubleOptions& options) {
  const Bvh floats(scene.mesh);
  const Workload workload(scene, floats, options.width, options.height);
  const oracle::DoubleMesh mesh = moved(scene.mesh, options.offset);
  const BvhD tree(mesh.vertices, mesh.triangles);
  std::unique_ptr<EmbreeDoubles> embree;
  std::unique_ptr<CgalDoubles> cgal;
  if (options.against_embree) embree = std::make_unique<EmbreeDoubles>(mesh);
  if (options.against_cgal) cgal = std::make_unique<CgalDoubles>(mesh);

  std::vector<DoubleSet> sets;
  for (const RayKind kind : options.ray_sets) sets.push_back(moved(workload.rays(kind), options.offset));
  sets.push_back(towards_edges(mesh, tree.bounds(), workload.primary().size()));
  std::vector<DoubleRow> rows;
  for (const DoubleSet& set : sets) {
    if (set.rays.empty()) continue;
    Race race(mesh, tree, set);
    for (const Path* path : options.paths) {
      race.add_ours(path);
      if (!set.floats.empty()) race.add_floats(floats, path);
    }
    if (embree) race.add_embree(*embree);
    // Its rays begin at 0 and have no end.
    const auto is_whole = [](const RayD& ray) {
      return ray.tmin == 0 && !(ray.tmax < std::numeric_limits<double>::infinity());
    };
    if (cgal && set.query == Query::closest && std::all_of(set.rays.begin(), set.rays.end(), is_whole))
      race.add_cgal(*cgal);
    for (DoubleRow& row : race.run({options.seconds, 3}, options.judged)) {
      row.offset = options.offset;
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace raylanes::bench

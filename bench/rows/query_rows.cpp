#include "query_rows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "../contenders/embree/embree_contender.hpp"
#include "../contenders/rivals.hpp"
#include "../support/oracles/exact_crossings.hpp"

namespace raylanes::bench {
namespace {

// A contender's work, and how many items ray i has after it.
struct Work {
  QueryRow row;
  std::function<void()> run;
  std::function<std::size_t(std::size_t)> items_of;
};

// One query on a ray set, by all contenders.
class Race {
 public:
  Race(const Scene& scene, const Bvh& bvh, const RaySet& set, const QueryOptions& options)
      : scene_(scene), bvh_(bvh), rays_(set.rays), name_(set.name), options_(options) {}

  void add_ours(ListQuery query, const Path* path) {
    const ListOptions how{.path = path, .threads = options_.threads};
    const auto name = std::string(list_query_names[static_cast<std::size_t>(query)]);
    if (query == ListQuery::all) {
      const auto lists = std::make_shared<RayLists<Hit>>();
      add({{name, name_, "raylanes", path->name, rays_.size()},
           [=, this] { *lists = bvh_.all_hits(rays_, how); },
           [=](std::size_t i) { return (*lists)[i].size(); }});
    } else if (query == ListQuery::crossings) {
      const auto lists = std::make_shared<RayLists<Crossing>>();
      add({{name, name_, "raylanes", path->name, rays_.size()},
           [=, this] { *lists = bvh_.crossings(rays_, how); },
           [=](std::size_t i) { return (*lists)[i].size(); }});
    } else {
      const auto counts = std::make_shared<std::vector<CrossingCount>>(rays_.size());
      add({{name, name_, "raylanes", path->name, rays_.size()},
           [=, this] { bvh_.count_crossings(rays_, *counts, how); },
           [=](std::size_t i) { return std::size_t{(*counts)[i].crossings}; }});
    }
  }
  void add_embree() {
    const auto embree = std::make_shared<EmbreeContender>(scene_.mesh.vertices, scene_.mesh.triangles, "",
                                                          EmbreeBuild::filtered);
    const auto lists = std::make_shared<RayLists<Hit>>();
    add({{"all", name_, "embree filter, robust", "best", rays_.size()},
         [=, this] { embree->all_hits(rays_, *lists); },
         [=](std::size_t i) { return (*lists)[i].size(); }});
  }
  void add_cgal() {
    const auto cgal = std::make_shared<CgalContender>(scene_.mesh.vertices, scene_.mesh.triangles);
    const auto some = std::make_shared<std::vector<Ray>>();
    constexpr std::size_t most = 2000;
    const std::size_t step = std::max<std::size_t>(1, rays_.size() / most);
    for (std::size_t i = 0; i < rays_.size(); i += step) some->push_back(rays_[i]);
    const auto counts = std::make_shared<std::vector<std::uint32_t>>(some->size());
    add({{"all", name_, "CGAL all_intersections", "", some->size()},
         [=] { cgal->count_hits(*some, *counts); },
         [=](std::size_t i) { return i % step == 0 ? std::size_t{(*counts)[i / step]} : none; }});
  }

  std::vector<QueryRow> run() {
    std::vector<std::function<void()>> calls;
    for (const Work& work : works_) calls.push_back(work.run);
    const std::vector<Timing> timings = take_turns(calls, {options_.seconds, 3});
    const auto per_ray = [&](std::size_t k) {
      Timing timing = timings[k];
      for (double& seconds : timing.seconds) seconds /= static_cast<double>(works_[k].row.ray_count);
      return timing;
    };
    std::vector<QueryRow> rows;
    for (std::size_t k = 0; k < works_.size(); ++k) {
      QueryRow row = works_[k].row;
      row.mrays_per_second = 1e-6 * static_cast<double>(row.ray_count) / timings[k].median_seconds;
      // The last of ours is the best path.
      if (k > 0 && row.contender != "raylanes" && row.query == works_[ours_].row.query)
        row.ratio = speed_ratio(per_ray(ours_), per_ray(k));
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        const std::size_t items = works_[k].items_of(i);
        row.items += items == none ? 0 : items;
      }
      judge(works_[k], row);
      rows.push_back(row);
    }
    return rows;
  }

 private:
  static constexpr std::size_t none = ~std::size_t{0};

  void add(Work work) {
    if (work.row.contender == "raylanes" && (works_.empty() || works_[ours_].row.query == work.row.query))
      ours_ = works_.size();
    works_.push_back(std::move(work));
  }
  // Rays that rational numbers look at, the same for all contenders.
  void judge(const Work& work, QueryRow& row) {
    const std::size_t step =
        std::max<std::size_t>(1, rays_.size() / std::max<std::size_t>(1, options_.judged));
    for (std::size_t i = 0; i < rays_.size(); i += step) {
      const std::size_t items = work.items_of(i);
      if (items == none) continue;
      ++row.judged;
      auto& known = work.row.query == "all" ? hits_ : crossings_;
      if (known.size() <= i / step)
        known.push_back(
            work.row.query == "all"
                ? oracle::all_exact_hits(scene_.mesh.vertices, scene_.mesh.triangles, rays_[i]).size()
                : oracle::exact_crossings(scene_.mesh.vertices, scene_.mesh.triangles, rays_[i]).size());
      row.wrong += known[i / step] == items ? 0 : 1;
    }
  }

  const Scene& scene_;
  const Bvh& bvh_;
  const std::vector<Ray>& rays_;
  std::string name_;
  const QueryOptions& options_;
  std::vector<Work> works_;
  std::size_t ours_ = 0;
  std::vector<std::size_t> hits_, crossings_;  // of judged rays
};

}  // namespace

std::vector<QueryRow> query_rows(const Scene& scene, const QueryOptions& options) {
  const Bvh bvh(scene.mesh);
  const Workload workload(scene, bvh, options.width, options.height);
  std::vector<QueryRow> rows;
  for (const RayKind kind : options.ray_sets) {
    const RaySet set = workload.rays(kind);
    if (set.rays.empty()) continue;
    Race race(scene, bvh, set, options);
    for (const ListQuery query : options.queries)
      for (const Path* path : options.paths) race.add_ours(query, path);
    if (options.against_embree) race.add_embree();
    // Its rays have no end.
    if (options.against_cgal && std::isinf(set.rays[0].tmax)) race.add_cgal();
    for (QueryRow& row : race.run()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace raylanes::bench

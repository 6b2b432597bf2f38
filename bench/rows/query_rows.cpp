#include "query_rows.hpp"

#include "../contenders/rivals.hpp"
#include "../support/oracles/exact_rays.hpp"
#include "../support/oracles/exact_sphere.hpp"
#include "../support/scenes/vector3.hpp"

namespace raylanes::bench {
namespace {

// The shares of triangles that filters reject, in percent; or a filter that cuts leaves out of pairs of triangles.
constexpr unsigned rejected_percent[] = {0, 50, 90, of_alpha};
std::string kept_name(unsigned percent) {
  return percent == of_alpha ? "kept, leaves cut out" : "kept, " + std::to_string(percent) + " % rejected";
}
unsigned share_of(unsigned percent) {
  return percent == of_alpha ? of_alpha : 256 * percent / 100;
}

// A sphere for each triangle, at its centroid, as large as half of it.
std::vector<Sphere> spheres_of(const Mesh& mesh) {
  std::vector<Sphere> spheres;
  for (const Index3& corners : mesh.triangles) {
    Double3 v[3], centre{};
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = to_double(mesh.vertices[corners[k]]), centre = add(centre, scale(v[k], 1.0 / 3));
    const double area = length(cross(subtract(v[1], v[0]), subtract(v[2], v[0]))) / 2;
    spheres.push_back({to_float(centre), static_cast<float>(std::sqrt(area / (2 * std::numbers::pi)))});
  }
  return spheres;
}

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
      : scene_(scene),
        bvh_(bvh),
        rays_(set.rays),
        only_decides_(set.query == Query::any),
        name_(set.name),
        options_(options) {}

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
  // The nearest hit, or any for rays that ask for that, that a filter keeps: one ray a call, and as a batch.
  void add_kept(unsigned percent, const Path* path) {
    const unsigned share = share_of(percent);
    const auto rejects = [=](const Hit& hit) { return is_rejected(hit, share); };
    const auto rejects_of_batch = [=](std::size_t, const Hit& hit) { return is_rejected(hit, share); };
    const TraceOptions one{.path = path}, many{.path = path, .threads = options_.threads};
    const auto found = std::make_shared<std::vector<std::uint8_t>>(rays_.size());
    const auto hits = std::make_shared<std::vector<Hit>>(rays_.size());
    const auto found_by = [=](std::size_t i) { return std::size_t{(*found)[i]}; };
    add({{kept_name(percent), name_, "raylanes", path->name, rays_.size()},
         [=, this] {
           for (std::size_t i = 0; i < rays_.size(); ++i)
             (*found)[i] = only_decides_ ? bvh_.occluded(rays_[i], rejects, one)
                                         : static_cast<bool>(bvh_.closest(rays_[i], rejects, one));
         },
         found_by});
    add({{kept_name(percent), name_, "raylanes, a batch", path->name, rays_.size()},
         [=, this] {
           if (only_decides_) return bvh_.occluded(rays_, *found, rejects_of_batch, many);
           bvh_.closest(rays_, *hits, rejects_of_batch, many);
           for (std::size_t i = 0; i < rays_.size(); ++i) (*found)[i] = (*hits)[i] ? 1 : 0;
         },
         found_by});
  }
  void add_embree_kept(unsigned percent) {
    const auto embree = std::make_shared<EmbreeFilters>(scene_.mesh, false);
    const auto found = std::make_shared<std::vector<std::uint8_t>>(rays_.size());
    add({{kept_name(percent), name_, "embree filter", "best", rays_.size()},
         [=, this] { embree->keep(rays_, only_decides_, share_of(percent), *found); },
         [=](std::size_t i) { return std::size_t{(*found)[i]}; }});
  }
  // Spheres as the library has them, or as primitives of the caller's with a test of their own.
  void add_spheres(bool are_own, const Path* path) {
    are_own ? add_both(name_of(are_own), path, boxes(), test_) : add_both(name_of(are_own), path, tree());
  }
  void add_embree_spheres(bool are_own) {
    const auto embree = std::make_shared<EmbreeSpheres>(spheres_, are_own);
    for (const bool in_packets : {false, true}) {
      if (in_packets && are_own) continue;  // tests of packets are other programs
      const auto found = std::make_shared<std::vector<std::uint8_t>>(rays_.size());
      const auto hits = std::make_shared<std::vector<Hit>>(rays_.size());
      add({{name_of(are_own), name_, in_packets ? "embree, packets of 16" : "embree", "best", rays_.size()},
           [=, this] {
             if (only_decides_) return embree->occluded(rays_, *found, in_packets);
             embree->closest(rays_, *hits, in_packets);
             for (std::size_t i = 0; i < rays_.size(); ++i) (*found)[i] = (*hits)[i] ? 1 : 0;
           },
           [=](std::size_t i) { return std::size_t{(*found)[i]}; }});
    }
  }
  void add_embree() {
    const auto embree = std::make_shared<EmbreeFilters>(scene_.mesh, true);
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
      const std::size_t ours = ours_of(row.query);
      if (row.contender != "raylanes" && ours < works_.size())
        row.ratio = speed_ratio(per_ray(ours), per_ray(k));
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

  void add(Work work) { works_.push_back(std::move(work)); }
  static std::string name_of(bool are_own) { return are_own ? "own spheres" : "spheres"; }
  const SphereTree& tree() {
    if (!tree_) tree_.emplace(spheres_);
    return *tree_;
  }
  const BoundedTree& boxes() {
    if (boxes_) return *boxes_;
    std::vector<Box> boxes;
    for (const Sphere& sphere : spheres_) {
      const Float3& at = sphere.centre;
      const auto moved = [&](float by) { return Float3{at[0] + by, at[1] + by, at[2] + by}; };
      boxes.push_back({moved(-sphere.radius), moved(sphere.radius)});
    }
    return boxes_.emplace(boxes);
  }
  // Calls and batches of a tree, with or without a test.
  template <class Tree, class... Test>
  void add_both(const std::string& name, const Path* path, const Tree& spheres, const Test&... test) {
    const VisitOptions one{.path = path}, many{.path = path, .threads = options_.threads};
    const auto found = std::make_shared<std::vector<std::uint8_t>>(rays_.size());
    const auto hits = std::make_shared<std::vector<Hit>>(rays_.size());
    const auto found_by = [=](std::size_t i) { return std::size_t{(*found)[i]}; };
    add({{name, name_, "raylanes", path->name, rays_.size()},
         [=, this, &spheres, &test...] {
           for (std::size_t i = 0; i < rays_.size(); ++i)
             (*found)[i] = only_decides_ ? spheres.occluded(rays_[i], test..., one)
                                         : static_cast<bool>(spheres.closest(rays_[i], test..., one));
         },
         found_by});
    add({{name, name_, "raylanes, a batch", path->name, rays_.size()},
         [=, this, &spheres, &test...] {
           if (only_decides_) return spheres.occluded(rays_, *found, test..., many);
           spheres.closest(rays_, *hits, test..., many);
           for (std::size_t i = 0; i < rays_.size(); ++i) (*found)[i] = (*hits)[i] ? 1 : 0;
         },
         found_by});
  }
  // The number of works if there is none.
  std::size_t ours_of(const std::string& query) const {
    std::size_t ours = works_.size();
    for (std::size_t k = 0; k < works_.size(); ++k)
      if (works_[k].row.query == query && works_[k].row.contender == "raylanes") ours = k;
    return ours;
  }
  // Rays that rational numbers look at, the same for all contenders.
  void judge(const Work& work, QueryRow& row) {
    const std::size_t step =
        std::max<std::size_t>(1, rays_.size() / std::max<std::size_t>(1, options_.judged));
    for (std::size_t i = 0; i < rays_.size(); i += step) {
      const std::size_t items = work.items_of(i);
      if (items == none) continue;
      std::vector<std::size_t>& known = known_[work.row.query];
      if (known.size() <= i / step) known.push_back(exact_items(work.row.query, rays_[i]));
      if (known[i / step] == none) continue;
      ++row.judged;
      row.wrong += known[i / step] == items ? 0 : 1;
    }
  }

  std::size_t exact_items(const std::string& query, const Ray& ray) const {
    const Mesh& mesh = scene_.mesh;
    const bool counts_crossings = query == "crossings" || query == "count";
    if (counts_crossings) return oracle::exact_crossings(mesh, ray).size();
    if (query.ends_with("spheres")) return exact_spheres(ray);
    const std::vector<Hit> hits = oracle::exact_hits(mesh, ray);
    for (const unsigned percent : rejected_percent)
      if (query == kept_name(percent))
        return std::ranges::all_of(
                   hits, [&](const Hit& hit) { return is_rejected(hit, share_of(percent)); })
                   ? 0
                   : 1;
    return hits.size();
  }

  // Whether the ray meets a sphere; `none` if floats may say otherwise.
  std::size_t exact_spheres(const Ray& ray) const {
    bool is_clear = true;
    const Double3 origin = to_double(ray.origin), direction = to_double(ray.direction);
    for (const auto& [centre, radius] : spheres_) {
      const Double3 to_centre = subtract(to_double(centre), origin);
      const double beside = length(cross(to_centre, direction)) / length(direction);
      if (beside > 1.01 * double{radius} + 0x1p-8 * length(to_centre)) continue;
      const auto exact = oracle::exact_sphere(ray, {centre[0], centre[1], centre[2], radius * radius});
      const bool is_near = std::abs(exact.free) <= 0x1p-18 * (exact.distance * exact.distance);
      if (exact.hit && !is_near) return 1;
      is_clear = is_clear && !is_near;
    }
    return is_clear ? 0 : none;
  }

  const Scene& scene_;
  const Bvh& bvh_;
  const std::vector<Ray>& rays_;
  const bool only_decides_;
  std::string name_;
  const QueryOptions& options_;
  const std::vector<Sphere> spheres_ = spheres_of(scene_.mesh);
  struct OwnTest {
    const std::vector<Sphere>& spheres;
    bool operator()(std::uint32_t primitive, const Ray& ray, Hit& hit) const {
      return meets(spheres[primitive], ray, hit);
    }
  };
  OwnTest test_{spheres_};
  std::optional<SphereTree> tree_;
  std::optional<BoundedTree> boxes_;
  std::vector<Work> works_;
  std::map<std::string, std::vector<std::size_t>> known_;  // items of judged rays, by query
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
    const auto makes_lists = [](ListQuery query) { return query < ListQuery::kept; };
    const bool lists = std::ranges::any_of(options.queries, makes_lists);
    for (const ListQuery query : options.queries)
      for (const Path* path : options.paths)
        if (makes_lists(query)) race.add_ours(query, path);
    if (options.against_embree && lists) race.add_embree();
    for (const unsigned percent : rejected_percent) {
      if (!std::ranges::count(options.queries, ListQuery::kept)) break;
      for (const Path* path : options.paths) race.add_kept(percent, path);
      if (options.against_embree) race.add_embree_kept(percent);
    }
    for (const ListQuery query : {ListQuery::spheres, ListQuery::own}) {
      if (!std::ranges::count(options.queries, query)) continue;
      for (const Path* path : options.paths) race.add_spheres(query == ListQuery::own, path);
      if (options.against_embree) race.add_embree_spheres(query == ListQuery::own);
    }
    // Its rays have no end.
    if (options.against_cgal && std::isinf(set.rays[0].tmax)) race.add_cgal();
    for (QueryRow& row : race.run()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace raylanes::bench

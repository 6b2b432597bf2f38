#include "scene_rows.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <stdexcept>

#include <raylanes/scene.hpp>

#include "user_triangles.hpp"

namespace raylanes::bench {
namespace {

// Calls of one ray each, of so many of the rays.
constexpr std::size_t max_lone_rays = 1 << 16;
// Of rays whose triangle floats may decide wrongly: those near edges.
constexpr double max_others = 0.01;

// A quarter turn about y: rays turned alike are exactly those that they were in the part's space.
constexpr Transform quarter_turn{{{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}}};
Ray turned(Ray ray) {
  for (Float3* const v : {&ray.origin, &ray.direction}) *v = {(*v)[2], (*v)[1], -(*v)[0]};
  return ray;
}

// Who traces, into what, and what answers must be.
struct Way {
  std::string name;
  std::size_t rays, of;  // of: the way of the tree that times are compared to
  std::function<void(std::span<Hit>)> trace;
  bool is_exact;
  std::function<void()> timed;  // if it is not that
};

class Race {
 public:
  Race(const Mesh& mesh, const Bvh& bvh, const RaySet& set, const Path* path)
      : bvh_(bvh), user_(mesh), rays_(set.rays), hits_(rays_.size()), found_(rays_.size()) {
    scene_.place(scene_.add(Bvh(mesh)));
    turned_scene_.place(turned_scene_.add(Bvh(mesh)), quarter_turn);
    scene_.update(), turned_scene_.update();
    std::ranges::transform(rays_, std::back_inserter(turned_), turned);
    const std::span<const Ray> all(rays_), some = all.first(std::min(rays_.size(), max_lone_rays));
    const TraceOptions options{.path = path}, streams{.mode = TraversalMode::stream, .path = path};
    const VisitOptions visit{.path = path};
    add("tree", all.size(), 0, true, [=, this](auto hits) { bvh_.closest(all, hits, options); });
    add("tree, streams", all.size(), 0, true, [=, this](auto hits) { bvh_.closest(all, hits, streams); });
    add("own test, a leaf at a time", all.size(), 0, false,
        [=, this](auto hits) { user_.closest_by_leaves(all, hits, visit); });
    add("own test, a ray at a time", all.size(), 0, false,
        [=, this](auto hits) { user_.closest_by_rays(all, hits, visit); });
    // Which have no hits to be checked.
    add("visits that test nothing", all.size(), 0, true,
        [=, this](auto hits) { bvh_.closest(all, hits, options); });
    ways_.back().timed = [=, this] { user_.visit_leaves(all, found_, visit); };
    add_scene("scene of one", scene_, all, options);
    add_scene("scene of one, turned", turned_scene_, turned_, options);
    const std::size_t lone = ways_.size();
    add("tree, a ray a call", some.size(), lone, true, [=, this](auto hits) {
      for (std::size_t i = 0; i < some.size(); ++i) hits[i] = bvh_.closest(some[i], options);
    });
    add_lone("scene, a ray a call", scene_, some, lone, options);
    add_lone("turned scene, a ray a call", turned_scene_, std::span(turned_).first(some.size()), lone,
             options);
  }

  std::vector<SceneRow> run(RayKind kind, double seconds) {
    std::vector<SceneRow> rows;
    ways_[0].trace(hits_);
    std::vector<std::function<void()>> work;
    for (Way& way : ways_) {
      rows.push_back(checked(way, kind));
      if (!way.timed) way.timed = [&way, this] { way.trace(found_); };
      work.push_back(way.timed);
    }
    const std::vector<Timing> timings = take_turns(work, {seconds, 5});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].ns_per_ray = 1e9 * timings[i].median_seconds / static_cast<double>(ways_[i].rays);
      rows[i].spread = timings[i].spread, rows[i].rounds = timings[i].seconds.size();
      rows[i].times_the_tree = speed_ratio(timings[ways_[i].of], timings[i]);
    }
    return rows;
  }

 private:
  using Trace = std::function<void(std::span<Hit>)>;

  void add(std::string name, std::size_t rays, std::size_t of, bool is_exact, Trace trace) {
    ways_.push_back({std::move(name), rays, of, std::move(trace), is_exact, {}});
  }
  // Into hits of its own; those are told apart only where they are checked.
  void add_scene(std::string name, const raylanes::Scene& scene, std::span<const Ray> rays,
                 const TraceOptions& options) {
    scene_hits_.resize(rays.size());
    add(std::move(name), rays.size(), 0, true, [=, this, &scene](auto hits) {
      scene.closest(rays, scene_hits_, options);
      for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = alone(scene_hits_[i]);
    });
    ways_.back().timed = [=, this, &scene] { scene.closest(rays, scene_hits_, options); };
  }
  void add_lone(std::string name, const raylanes::Scene& scene, std::span<const Ray> rays, std::size_t of,
                const TraceOptions& options) {
    add(std::move(name), rays.size(), of, true, [=, &scene](auto hits) {
      for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = alone(scene.closest(rays[i], options));
    });
  }
  static Hit alone(const SceneHit& hit) { return {hit.t, hit.u, hit.v, hit.primitive}; }

  SceneRow checked(const Way& way, RayKind kind) {
    SceneRow row{kind, way.name};
    way.trace(found_);
    std::size_t others = 0;
    for (std::size_t i = 0; i < way.rays; ++i) others += found_[i].primitive != hits_[i].primitive ? 1 : 0;
    const double share =
        static_cast<double>(others) / static_cast<double>(std::max<std::size_t>(1, way.rays));
    row.other_per_million = 1e6 * share;
    row.sound = way.is_exact ? std::memcmp(found_.data(), hits_.data(), way.rays * sizeof(Hit)) == 0
                             : share <= max_others;
    return row;
  }

  const Bvh& bvh_;
  const UserTriangles user_;
  const std::vector<Ray>& rays_;
  raylanes::Scene scene_, turned_scene_;
  std::vector<Ray> turned_;
  std::vector<Hit> hits_, found_;  // the tree's; those of whoever traces
  std::vector<SceneHit> scene_hits_;
  std::vector<Way> ways_;
};

}  // namespace

std::vector<SceneRow> measure_scenes(const Scene& scene, const SceneRowsOptions& options) {
  const Bvh bvh(scene.mesh);
  const Workload workload(scene, bvh, options.width, options.height);
  std::vector<SceneRow> rows;
  for (const RayKind kind : options.ray_sets) {
    const RaySet set = workload.rays(kind);
    if (set.rays.empty()) continue;
    if (set.query != Query::closest)
      throw std::invalid_argument("--rays: " + name_of(kind) + " rays ask for any hit, not for the nearest");
    for (SceneRow& row : Race(scene.mesh, bvh, set, options.path).run(kind, options.seconds))
      rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace raylanes::bench

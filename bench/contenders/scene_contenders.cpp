#include "scene_contenders.hpp"

#include "../support/rulers/measure.hpp"

namespace raylanes::bench {
namespace {

constexpr Transform quarter_turn{{{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}}};
Ray turned(Ray ray) {
  for (Float3* const v : {&ray.origin, &ray.direction}) *v = {(*v)[2], (*v)[1], -(*v)[0]};
  return ray;
}

// One call for each ray: without options if these are the defaults of the active path.
template <class Each>
void call_each(const TraceOptions& options, const Each& each) {
  if (options.path == &active_path())
    each();
  else
    each(options);
}

// Traces into hits of a scene, and renumbers them by the whole mesh after the clock has stopped.
class SceneTracer {
 public:
  SceneTracer(const raylanes::Scene& scene, const std::vector<std::uint32_t>& first, bool calls,
              const Path& path)
      : scene_(scene), first_(first), calls_(calls), options_{.path = &path} {}

  double operator()(const RaySet& set, Answers& answers) {
    return set.query == Query::closest ? closest(set.rays, answers.hits) : any(set.rays, answers.occluded);
  }

 private:
  double closest(std::span<const Ray> rays, std::span<Hit> out) {
    hits_.resize(rays.size());
    const double seconds = seconds_of([&] {
      if (!calls_) return scene_.closest(rays, hits_, options_);
      call_each(options_, [&](const auto&... options) {
        for (std::size_t i = 0; i < rays.size(); ++i) hits_[i] = scene_.closest(rays[i], options...);
      });
    });
    std::ranges::transform(hits_, out.begin(), [&](const SceneHit& hit) {
      return Hit{hit.t, hit.u, hit.v, hit ? first_[hit.instance] + hit.primitive : no_primitive};
    });
    return seconds;
  }
  double any(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const {
    return seconds_of([&] {
      if (!calls_) return scene_.occluded(rays, occluded, options_);
      call_each(options_, [&](const auto&... options) {
        for (std::size_t i = 0; i < rays.size(); ++i)
          occluded[i] = scene_.occluded(rays[i], options...) ? 1 : 0;
      });
    });
  }

  const raylanes::Scene& scene_;
  const std::vector<std::uint32_t>& first_;
  bool calls_;
  TraceOptions options_;
  std::vector<SceneHit> hits_;
};

Contender timed_contender(const char* mode, std::function<double(const RaySet&, Answers&)> timed) {
  return {mode, timed, timed};
}

}  // namespace

SceneContenders::SceneContenders(const Parts& parts)
    : first_(parts.first), is_exact_(!parts.has_transforms()) {
  for (const Mesh& mesh : parts.shared_meshes()) {
    const auto tree = std::make_shared<const Bvh>(mesh);
    scene_.add(tree), other_.add(tree);
  }
  for (std::uint32_t i = 0; i < first_.size(); ++i)
    for (raylanes::Scene* const scene : {&scene_, &other_})
      scene->place(parts.place(i).mesh, parts.place(i).transform);
  if (first_.size() == 1) other_.move(0, quarter_turn);
  for (std::uint32_t i = 0; i < first_.size(); ++i) other_.set_moving(i);
  scene_.update(), other_.update();
}

std::vector<NamedContender> SceneContenders::ways(const Path& path, bool calls) const {
  const char* const mode = calls ? "call" : "automatic";
  const auto straight = std::make_shared<SceneTracer>(scene_, first_, calls, path);
  const auto other = std::make_shared<SceneTracer>(other_, first_, calls, path);
  const auto around = [other](const RaySet& set, Answers& answers) {
    RaySet moved{set.name, set.query, set.rays};
    for (Ray& ray : moved.rays) ray = turned(ray);
    return (*other)(moved, answers);
  };
  const auto by = [](const auto& tracer) {
    return [tracer](const RaySet& set, Answers& answers) { return (*tracer)(set, answers); };
  };
  const bool is_one = first_.size() == 1;
  return {{"scene", timed_contender(mode, by(straight)), is_exact_},
          {is_one ? "scene_turned" : "scene_moving",
           is_one ? timed_contender(mode, around) : timed_contender(mode, by(other)), is_exact_}};
}

std::pair<double, double> seconds_of_a_move(const Parts& parts) {
  raylanes::Scene scene;
  for (const Mesh& mesh : parts.shared_meshes()) scene.add(Bvh(mesh));
  for (std::uint32_t i = 0; i < parts.first.size(); ++i)
    scene.place(parts.place(i).mesh, parts.place(i).transform);
  scene.update();
  const auto last = static_cast<std::uint32_t>(parts.first.size() - 1);
  const auto move = [&](float by) {
    Transform moved = parts.place(last).transform;
    moved.row[0][3] += by;
    scene.move(last, moved);
    return seconds_of([&] { scene.update(); });
  };
  const double first = move(1);
  return {first, move(0)};
}

std::vector<NamedContender> UserContenders::ways(const Path& path) const {
  const VisitOptions visit{.path = &path};
  const auto by_leaves = [=, this](const RaySet& set, Answers& answers) {
    user_.closest_by_leaves(set.rays, answers.hits, visit);
  };
  const auto by_rays = [=, this](const RaySet& set, Answers& answers) {
    user_.closest_by_rays(set.rays, answers.hits, visit);
  };
  // Nothing is hit, so the tree answers after the clock has stopped.
  const auto visits = [=, this](const RaySet& set, Answers& answers) {
    const double seconds = seconds_of([&] { user_.visit_leaves(set.rays, answers.hits, visit); });
    bvh_.closest(set.rays, answers.hits, {.path = &path});
    return seconds;
  };
  return {{"user_leaves", {"automatic", by_leaves}, false},
          {"user_rays", {"automatic", by_rays}, false},
          {"user_visits", timed_contender("automatic", visits), true}};
}

}  // namespace raylanes::bench

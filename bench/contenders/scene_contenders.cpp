#include "scene_contenders.hpp"

#include <algorithm>

#include "../support/rulers/measure.hpp"

namespace raylanes::bench {
namespace {

constexpr Transform quarter_turn{{{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}}};
Ray turned(Ray ray) {
  for (Float3* const v : {&ray.origin, &ray.direction}) *v = {(*v)[2], (*v)[1], -(*v)[0]};
  return ray;
}

// Into hits of a scene, which become the tree's after the clock has stopped.
double trace(const raylanes::Scene& scene, std::span<const Ray> rays, bool calls, const TraceOptions& options,
             std::vector<SceneHit>& hits, Answers& answers) {
  hits.resize(rays.size());
  const double seconds = seconds_of([&] {
    if (calls)
      for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = scene.closest(rays[i], options);
    else
      scene.closest(rays, hits, options);
  });
  std::ranges::transform(hits, answers.hits.begin(), [](const SceneHit& hit) {
    return Hit{hit.t, hit.u, hit.v, hit.primitive};
  });
  return seconds;
}

Contender timed_contender(const char* mode, std::function<double(const RaySet&, Answers&)> timed) {
  return {mode, timed, timed};
}

}  // namespace

SceneContenders::SceneContenders(const Mesh& mesh, const Bvh& bvh) : bvh_(bvh), user_(mesh) {
  scene_.place(scene_.add(Bvh(mesh)));
  turned_.place(turned_.add(Bvh(mesh)), quarter_turn);
  scene_.update(), turned_.update();
}

std::vector<NamedContender> SceneContenders::scenes(const Path& path, bool calls) const {
  const char* const mode = calls ? "call" : "automatic";
  const TraceOptions options{.path = &path};
  const auto hits = std::make_shared<std::vector<SceneHit>>();
  const auto straight = [=, this](const RaySet& set, Answers& answers) {
    return trace(scene_, set.rays, calls, options, *hits, answers);
  };
  const auto around = [=, this](const RaySet& set, Answers& answers) {
    std::vector<Ray> rays(set.rays.size());
    std::ranges::transform(set.rays, rays.begin(), turned);
    return trace(turned_, rays, calls, options, *hits, answers);
  };
  return {{"scene", timed_contender(mode, straight), true},
          {"scene_turned", timed_contender(mode, around), true}};
}

std::vector<NamedContender> SceneContenders::user(const Path& path) const {
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

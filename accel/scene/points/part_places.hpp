// Points and the parts of a scene that contain them: the trees of parts locate points in the spaces of instances.
#pragma once

#include <raylanes/scene.hpp>

#include "../../batch/checked_call.hpp"
#include "../../batch/in_parallel.hpp"
#include "../doubles/scene_d_parts.hpp"
#include "../scene_parts.hpp"

namespace raylanes {

// A point, by its number among those that are located together, inside an instance or on its surface.
struct PartPlace {
  std::uint32_t point, instance;
  bool is_on;
};

// Calls visit(instance) for each instance that the mask sees, in no order.
template <class Visit>
void each_seen(const SceneParts& scene, std::uint32_t mask, const Visit& visit) {
  const auto look_at = [&](std::uint32_t number) {
    if ((scene.instances[number].mask & mask) != 0) visit(number);
  };
  for (const TopLevel& top : scene.tops) std::ranges::for_each(top.tree.order, look_at);
  for (const auto& tree : scene.commons)
    if (scene.sees(*tree, mask))
      for (const Member& member : tree->members)
        if (member.instance != no_part && !member.is_struck) visit(member.instance);
}

// In scenes of doubles.
template <class Visit>
void each_seen(const SceneDParts& scene, std::uint32_t mask, const Visit& visit) {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
    if ((scene.instances[i].mask & mask) != 0 && scene.boxes[i].lo[0] <= scene.boxes[i].hi[0]) visit(i);
}

// The tree of a part of triangles, built on several threads if there is none yet.
inline const Bvh& tree_of_part(const SceneParts& scene, std::uint32_t instance, int threads) {
  return *scene.geometries[scene.instances[instance].geometry]->built(threads);
}
inline const BvhD& tree_of_part(const SceneDParts& scene, std::uint32_t instance, int) {
  return *scene.geometries[scene.instances[instance].geometry]->tree;
}
// Scenes of doubles consist of triangles.
inline void require_triangles_seen(const char*, const SceneDParts& scene, std::uint32_t) {
  require_current(scene.is_current);
}

// The places of points, so many at a time. Which points are located together depends on nothing but their order: in
// open meshes locations depend on neighbours.
// `Parts`: SceneParts or SceneDParts.
template <class Parts>
class PartPlaces {
  using Points = VertexRecords<typename Parts::Number>;

 public:
  // Throws as PointQueries<Scene>::locate().
  PartPlaces(const char* call, const Parts& scene, const LocateOptions& options);

  // Calls take(begin, end, places) for some of the points at a time, also if there are none. Places are of points that
  // an instance contains, which count from `begin`, instance by instance.
  template <class Take>
  void each(const Points& points, LaneBits active, const Take& take) {
    std::size_t first = 0;
    do {
      Points some = points;
      some.count = std::min(at_once_, points.count - first);
      if (first > 0) some.first = points.address(first);
      const StepProgress step = StepProgress::of(options_.progress, first, some.count, points.count);
      take(first, first + some.count,
           find(some, active != nullptr ? active + first / 8 : nullptr, step.get()));
      first += some.count;
    } while (first < points.count);
  }

 private:
  std::span<const PartPlace> find(const Points& points, LaneBits active, const Progress* progress);
  struct Task {
    std::uint32_t instance;
    std::size_t begin, end;  // of candidates_
  };

  struct Candidate {
    std::uint32_t instance, point;
  };

  void look_at(const Points& points, LaneBits active, std::size_t begin, std::size_t end,
               std::vector<Candidate>& found) const;
  void sort(std::span<const std::vector<Candidate>> found);
  void locate(const Task& task, const Points& points, TraceCounters* counters);

  const Parts& scene_;
  const LocateOptions& options_;
  std::size_t at_once_;                    // a multiple of 8
  std::vector<std::uint32_t> seen_;        // by the rule winding: all
  std::vector<std::uint32_t> candidates_;  // the points that may be in an instance, instance by instance
  std::vector<Location> locations_;        // of these
  std::vector<Task> tasks_;
  std::vector<PartPlace> places_;
};

// As PointQueries<Scene>::locate(), where one location counts more than another one.
template <class Parts, class T>
void find_places(const char* name, const Parts& scene, const VertexRecords<T>& points,
                 std::span<Location> locations, const LocateOptions& options, Location counts_more) {
  const CheckedPoints<T> call(name, points, "locations", locations, options.active);
  PartPlaces places(name, scene, options);
  places.each(points, call.active, [&](std::size_t begin, std::size_t end, std::span<const PartPlace> found) {
    for (std::size_t i = begin; i < end; ++i)
      if (takes_part(call.active, i)) locations[i] = Location::outside;
    for (const PartPlace& place : found) {
      Location& location = locations[begin + place.point];
      if (location != counts_more) location = place.is_on ? Location::on : Location::inside;
    }
  });
}

// As PointQueries<Scene>::winding_numbers().
template <class Parts, class T>
void sum_winding_numbers(const Parts& scene, const VertexRecords<T>& points, std::span<T> numbers,
                         const WindingOptions& options);

}  // namespace raylanes

// Trees and their queries. Arrays are looked at with the GIL, the library works without.
#pragma once

#include <memory>
#include <sstream>
#include <stdexcept>

#include <raylanes/kdtree.hpp>

#include "names.hpp"
#include "numpy_arrays.hpp"
#include "threads.hpp"
#include "without_gil.hpp"

namespace raylanes::python {

// A tree that Python's threads and copies share. A query keeps the state that it begins with. No state changes that
// another thread or copy may see: a refit makes a new one. The pointer is read and replaced with the GIL held.
struct SharedTree {
  std::shared_ptr<TriangleTree> state;
  std::size_t left_out = 0;       // triangles that the build left out
  bool looked_for_holes = false;  // see found_holes()
};

template <class Tree>
struct SharedTreeOf : SharedTree {
  explicit SharedTreeOf(std::shared_ptr<TriangleTree> of) : SharedTree{std::move(of)} {}
  explicit SharedTreeOf(Tree&& tree) : SharedTree{std::make_shared<Tree>(std::move(tree))} {}
};

template <class Tree>
const Tree& tree_in(const SharedTreeOf<Tree>&, const TriangleTree& state) {
  return static_cast<const Tree&>(state);
}
inline const TriangleTree& tree_in(const SharedTree&, const TriangleTree& state) {
  return state;
}

// Work on a tree, without the GIL. At the end of the interpreter Python may free `shared` meanwhile, not the state.
template <class Shared, class Work>
auto query(const Shared& shared, const Work& work) {
  const std::shared_ptr<const TriangleTree> state = shared.state;
  const WithoutGil others_run;
  return work(tree_in(shared, *state));
}

// How rays are traced: (test, grade, mode, hint, path, threads, facing), as the Python text passes it on; strings live
// as long as the tuple.
inline TraceOptions trace_options(const py::tuple& how, const py::object& active, std::size_t rays) {
  const auto text = [&](std::size_t i) {
    const char* const utf8 = PyUnicode_AsUTF8(py::object(how[i]).ptr());
    return utf8 != nullptr ? utf8 : throw py::error_already_set();
  };
  TraceOptions options;
  options.test = named<TriangleTest>("test", triangle_test_names, text(0));
  options.grade = named<Grade>("grade", grade_names, text(1));
  options.mode = named<TraversalMode>("mode", traversal_mode_names, text(2));
  options.hint = named<BatchHint>("hint", batch_hint_names, text(3));
  options.path = path_named(py::object(how[4]).is_none() ? nullptr : text(4));
  options.threads = usable_threads(how[5].cast<int>());
  options.facing = named<Facing>("facing", facing_names, text(6));
  options.active = bits_of(active, rays);
  return options;
}

// The others have a path, threads and active elements at most.
template <class Options>
Options plain_options(const char* path, int threads, const py::object& active, std::size_t elements) {
  Options options;
  options.path = path_named(path);
  options.threads = usable_threads(threads);
  options.active = bits_of(active, elements);
  return options;
}

inline void closest(const SharedTree& shared, const py::array& rays, const py::array& hits,
                    const py::tuple& how, const py::object& active, const py::object& after) {
  const RayView from = rays_of(rays);
  const HitView to = hits_of(hits);
  TraceOptions options = trace_options(how, active, from.count);
  if (!after.is_none()) {
    const Rows rows = rows_of(after.cast<py::array>(), sizeof(Hit));
    options.after = {rows.first, rows.count, rows.stride};
  }
  query(shared, [&](const TriangleTree& tree) { tree.closest(from, to, options); });
}

inline void occluded(const SharedTree& shared, const py::array& rays, const py::array& answers,
                     const py::tuple& how, const py::object& active) {
  const RayView from = rays_of(rays);
  const auto to = span_of<std::uint8_t>(answers);
  const TraceOptions options = trace_options(how, active, from.count);
  query(shared, [&](const TriangleTree& tree) { tree.occluded(from, to, options); });
}

inline void occluded_from(const SharedTree& shared, const Float3& from, const py::array& points,
                          const py::array& answers, const std::array<float, 2>& ends, const py::tuple& how,
                          const py::object& active) {
  const VertexView to_points = vertices_of(points);
  const auto to = span_of<std::uint8_t>(answers);
  const TraceOptions options = trace_options(how, active, to_points.count);
  query(shared, [&](const TriangleTree& tree) {
    tree.occluded_from(from, to_points, to, {ends[0], ends[1]}, options);
  });
}

// Offsets and items, as bytes.
template <auto list>
py::tuple lists(const SharedTree& shared, const py::array& rays, std::uint32_t max_count, const char* facing,
                const char* path, int threads, const py::object& active) {
  const RayView from = rays_of(rays);
  auto options = plain_options<ListOptions>(path, threads, active, from.count);
  options.max_count = max_count;
  options.facing = named<Facing>("facing", facing_names, facing);
  auto found = query(shared, [&](const TriangleTree& tree) { return (tree.*list)(from, options); });
  return py::make_tuple(bytes_kept(std::move(found.offsets)), bytes_kept(std::move(found.items)));
}

inline void count_crossings(const SharedTree& shared, const py::array& rays, const py::array& counts,
                            const char* facing, const char* path, int threads, const py::object& active) {
  const RayView from = rays_of(rays);
  const auto to = span_of<CrossingCount>(counts);
  auto options = plain_options<ListOptions>(path, threads, active, from.count);
  options.facing = named<Facing>("facing", facing_names, facing);
  query(shared, [&](const TriangleTree& tree) { tree.count_crossings(from, to, options); });
}

inline void locate(const SharedTree& shared, const py::array& points, const py::array& locations,
                   const char* rule, const char* path, int threads, const py::object& active) {
  const VertexView from = vertices_of(points);
  const auto bytes = span_of<std::uint8_t>(locations);
  const std::span<Location> to(reinterpret_cast<Location*>(bytes.data()), bytes.size());
  auto options = plain_options<LocateOptions>(path, threads, active, from.count);
  options.rule = named<InsideRule>("rule", inside_rule_names, rule);
  query(shared, [&](const TriangleTree& tree) { tree.locate(from, to, options); });
}

inline void winding_numbers(const SharedTree& shared, const py::array& points, const py::array& numbers,
                            double accuracy, const char* path, int threads, const py::object& active) {
  const VertexView from = vertices_of(points);
  const auto to = span_of<float>(numbers);
  auto options = plain_options<WindingOptions>(path, threads, active, from.count);
  options.accuracy = accuracy;
  query(shared, [&](const TriangleTree& tree) { tree.winding_numbers(from, to, options); });
}

inline void closest_points(const SharedTree& shared, const py::array& points, const py::array& answers,
                           float max_distance, const char* path, int threads, const py::object& active) {
  const VertexView from = vertices_of(points);
  const auto to = span_of<ClosestPoint>(answers);
  auto options = plain_options<ClosestPointOptions>(path, threads, active, from.count);
  options.max_distance = max_distance;
  query(shared, [&](const TriangleTree& tree) { tree.closest_points(from, to, options); });
}

inline void signed_distances(const SharedTree& shared, const py::array& points, const py::array& distances,
                             const char* rule, float max_distance, const char* path, int threads,
                             const py::object& active) {
  const VertexView from = vertices_of(points);
  const auto to = span_of<float>(distances);
  auto options = plain_options<SignedDistanceOptions>(path, threads, active, from.count);
  options.rule = named<InsideRule>("rule", inside_rule_names, rule);
  options.max_distance = max_distance;
  query(shared, [&](const TriangleTree& tree) { tree.signed_distances(from, to, options); });
}

}  // namespace raylanes::python

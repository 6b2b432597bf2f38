// Trees and their queries. Arrays are looked at with the GIL, the library works without.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <raylanes/stretches.hpp>

#include "filters.hpp"
#include "listener.hpp"
#include "names.hpp"
#include "numpy_arrays.hpp"
#include "threads.hpp"
#include "without_gil.hpp"

namespace raylanes::python {

// A tree that Python's threads and copies share. A query keeps the state that it begins with. No state changes that
// another thread or copy may see: a refit makes a new one. The pointer is read and replaced with the GIL held.
template <class T>
struct SharedTree {
  using Number = T;
  using Hit = HitOf<T>;
  using ClosestPoint = ClosestPointOf<T>;
  std::shared_ptr<TreeOf<T>> state;
  std::size_t left_out = 0;       // triangles that the build left out
  bool looked_for_holes = false;  // see found_holes()
  bool looked_for_sides = false;  // see found_inside_out()
};

template <class Tree>
struct SharedTreeOf : SharedTree<NumberOf<Tree>> {
  using Object = Tree;
  using State = TreeOf<NumberOf<Tree>>;
  explicit SharedTreeOf(Tree&& tree)
      : SharedTree<NumberOf<Tree>>{std::shared_ptr<State>(std::make_shared<Tree>(std::move(tree)))} {}
};

template <class Tree>
const Tree& tree_in(const SharedTreeOf<Tree>&, const TreeOf<NumberOf<Tree>>& state) {
  return static_cast<const Tree&>(state);
}
template <class T>
const TreeOf<T>& tree_in(const SharedTree<T>&, const TreeOf<T>& state) {
  return state;
}

// Work on a tree or a scene, without the GIL. At the end of the interpreter Python may free `shared` meanwhile, not the
// state.
template <class Shared, class Work>
auto query(const Shared& shared, Listener& listener, const Work& work) {
  const auto state = shared.state;
  return listener.without_gil([&] { return work(tree_in(shared, std::as_const(*state))); });
}
template <class Shared, class Work>
auto query(const Shared& shared, const Work& work) {
  Listener nobody;
  return query(shared, nobody, work);
}
// A query of so many rays or points of which Python hears: work(tree, options).
template <class Shared, class Options, class Work>
auto query(const Shared& shared, Options options, const py::object& progress, std::size_t elements,
           const Work& work) {
  Listener listener(progress, elements);
  options.progress = listener.progress();
  return query(shared, listener, [&](const auto& tree) { return work(tree, options); });
}

// The same with a filter, if the Python function is not None: work(tree, options, filter...).
template <class AnyHit, class Shared, class Options, class Work>
void filtered_query(const Shared& shared, Options options, const py::object& progress, std::size_t elements,
                    const py::object& filter, const Work& work) {
  Listener listener(progress, elements);
  options.progress = listener.progress();
  query(shared, listener, [&](const auto& tree) {
    if (filter.is_none())
      work(tree, options);
    else
      work(tree, options, filter_by<AnyHit>(filter, listener));
  });
}

inline void take(TraceOptions& options, const TraceOptions& given) {
  options = given;
}
// Modes, grades and hints change no hit of the exact test, and trees of doubles have none.
inline void take(TraceOptionsD& options, const TraceOptions& given) {
  if (given.test != TriangleTest::exact)
    throw std::invalid_argument(
        "test: float64 has \"exact\" alone; a tree or scene made with dtype=numpy.float32 has the others");
  options.path = given.path, options.threads = given.threads;
  options.facing = given.facing, options.active = given.active, options.skip = given.skip;
  options.mask = given.mask, options.masks = given.masks, options.filter_mask = given.filter_mask;
}

// The primitives that rays skip: a row of one index each, or of two: with the instance.
inline PrimitiveView skips_of(const py::object& rows) {
  if (rows.is_none()) return {};
  const auto array = rows.cast<py::array>();
  constexpr int index = sizeof(std::uint32_t);
  const auto columns = array.ndim() == 2 ? static_cast<std::size_t>(array.shape(1)) : 1;
  return {array.data(), static_cast<std::size_t>(array.shape(0)), columns * index,
          columns == 2 ? std::ptrdiff_t{index} : 0};
}

// The masks of triangles: None, or the mask of the call, the words, and the mask of its filter. For the instances of
// a scene the mask of the call alone.
template <class Options>
void set_masks(Options& options, const py::object& masks) {
  if (masks.is_none()) return;
  if (PyLong_Check(masks.ptr()) != 0) {
    options.mask = masks.cast<std::uint32_t>();
    return;
  }
  const auto all = masks.cast<py::tuple>();
  options.mask = all[0].cast<std::uint32_t>();
  const auto words = all[1].cast<py::array>();
  options.masks = {static_cast<const std::uint32_t*>(words.data()), static_cast<std::size_t>(words.size())};
  if constexpr (requires { options.filter_mask; }) options.filter_mask = all[2].cast<std::uint32_t>();
}

// The hits after which rays look for the next; None: none.
template <class AnyHit>
HitRecords<AnyHit> hits_after(const py::object& after) {
  if (after.is_none()) return {};
  const Rows rows = rows_of(after.cast<py::array>(), sizeof(AnyHit));
  return {rows.first, rows.count, rows.stride};
}

// How rays are traced, as the Python text passes it on: a tuple that has each of these at its number. The module tells
// their names, with which the text compares its own. Strings and arrays live as long as the tuple.
enum How : std::size_t {
  how_test,
  how_grade,
  how_mode,
  how_hint,
  how_path,
  how_threads,
  how_facing,
  how_progress,
  how_skip,
  how_masks
};
inline constexpr std::array<const char*, 10> how_names{"test",    "grade",  "mode",     "hint", "path",
                                                       "threads", "facing", "progress", "skip", "masks"};

template <class T>
typename CallTypesOf<T>::Options trace_options(const py::tuple& how, const py::object& active,
                                               std::size_t rays) {
  const auto text = [&](How what) {
    const char* const utf8 = PyUnicode_AsUTF8(py::object(how[what]).ptr());
    return utf8 != nullptr ? utf8 : throw py::error_already_set();
  };
  TraceOptions options;
  options.test = named<TriangleTest>("test", tree_test_names, text(how_test));
  options.grade = named<Grade>("grade", grade_names, text(how_grade));
  options.mode = named<TraversalMode>("mode", traversal_mode_names, text(how_mode));
  options.hint = named<BatchHint>("hint", batch_hint_names, text(how_hint));
  options.path = path_named(py::object(how[how_path]).is_none() ? nullptr : text(how_path));
  options.threads = usable_threads(how[how_threads].cast<int>());
  options.facing = named<Facing>("facing", facing_names, text(how_facing));
  options.active = bits_of(active, rays), options.skip = skips_of(how[how_skip]);
  set_masks(options, how[how_masks]);
  typename CallTypesOf<T>::Options taken;
  take(taken, options);
  return taken;
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

// The numbers and the hits of a shared tree or scene.
template <class Shared>
using NumberIn = typename Shared::Number;
template <class Shared>
using HitIn = typename Shared::Hit;

template <class Shared>
void closest(const Shared& shared, const py::object& rays, const py::array& hits, const py::tuple& how,
             const py::object& active, const py::object& after, const py::object& filter) {
  const RaysOf<NumberIn<Shared>> from(rays);
  const auto to = writable_records_of<HitIn<Shared>>(hits);
  auto options = trace_options<NumberIn<Shared>>(how, active, from.count);
  options.after = hits_after<HitIn<Shared>>(after);
  filtered_query<HitIn<Shared>>(shared, options, how[how_progress], from.count, filter,
                           [&](const auto& tree, const auto& heard, const auto&... filters) {
                             tree.closest(from, to, filters..., heard);
                           });
}

template <class Shared>
void closest_crossing(const Shared& shared, const py::object& rays, const py::array& hits,
                      const py::tuple& how, const py::object& active, const py::object& after) {
  const RaysOf<NumberIn<Shared>> from(rays);
  const auto to = writable_records_of<HitIn<Shared>>(hits);
  auto options = trace_options<NumberIn<Shared>>(how, active, from.count);
  options.after = hits_after<HitIn<Shared>>(after);
  query(shared, options, how[how_progress], from.count,
        [&](const auto& tree, const auto& heard) { tree.closest_crossing(from, to, heard); });
}

template <class Shared>
void occluded(const Shared& shared, const py::object& rays, const py::array& occluded,
              const py::tuple& how, const py::object& active, const py::object& filter) {
  const RaysOf<NumberIn<Shared>> from(rays);
  const auto to = span_of<std::uint8_t>(occluded);
  const auto options = trace_options<NumberIn<Shared>>(how, active, from.count);
  filtered_query<HitIn<Shared>>(shared, options, how[how_progress], from.count, filter,
                           [&](const auto& tree, const auto& heard, const auto&... filters) {
                             tree.occluded(from, to, filters..., heard);
                           });
}

// Segments with these ends, from points to one; or rays from the points, in a direction if there are no ends.
template <class T>
using Ends = std::optional<std::array<T, 2>>;

template <class Shared>
void occluded_from(const Shared& shared, const std::array<NumberIn<Shared>, 3>& from, const py::array& points,
                   const py::array& occluded, const Ends<NumberIn<Shared>>& ends, const py::tuple& how,
                   const py::object& active, const py::object& filter) {
  const auto to_points = vertices_of<NumberIn<Shared>>(points);
  const auto to = span_of<std::uint8_t>(occluded);
  const auto options = trace_options<NumberIn<Shared>>(how, active, to_points.count);
  filtered_query<HitIn<Shared>>(
      shared, options, how[how_progress], to_points.count, filter,
      [&](const auto& tree, const auto& heard, const auto&... filters) {
        if (ends)
          tree.occluded_from(from, to_points, to, filters..., {(*ends)[0], (*ends)[1]}, heard);
        else
          tree.occluded_towards(from, to_points, to, filters..., heard);
      });
}

// The corners of triangles by index, as rows of nine numbers.
template <class T>
void corners(const SharedTree<T>& shared, const py::array& primitives, const py::array& to) {
  using TriangleNumbers = std::conditional_t<std::is_same_v<T, double>, TriangleD, Triangle>;
  const auto names = span_of<std::uint32_t>(primitives);
  const std::span triangles(reinterpret_cast<TriangleNumbers*>(span_of<T>(to).data()), names.size());
  query(shared, [&](const TreeOf<T>& tree) { tree.corners(names, triangles); });
}

// Offsets and items, as bytes.
template <class Shared, auto list>
py::tuple lists(const Shared& shared, const py::object& rays, std::uint32_t max_count, const char* facing,
                const char* path, int threads, const py::object& active, const py::object& progress,
                const py::object& skip, const py::object& masks) {
  const RaysOf<NumberIn<Shared>> from(rays);
  auto options = plain_options<ListOptions>(path, threads, active, from.count);
  options.max_count = max_count;
  options.facing = named<Facing>("facing", facing_names, facing), options.skip = skips_of(skip);
  set_masks(options, masks);
  auto found = query(shared, options, progress, from.count, [&](const auto& tree, const auto& heard) {
    return std::invoke(list, tree, from, heard);
  });
  return py::make_tuple(bytes_kept(std::move(found.offsets)), bytes_kept(std::move(found.items)));
}

template <class Shared>
void count_crossings(const Shared& shared, const py::object& rays, const py::array& counts,
                     const char* facing, const char* path, int threads, const py::object& active,
                     const py::object& progress, const py::object& skip, const py::object& masks) {
  const RaysOf<NumberIn<Shared>> from(rays);
  const auto to = span_of<CrossingCount>(counts);
  auto options = plain_options<ListOptions>(path, threads, active, from.count);
  options.facing = named<Facing>("facing", facing_names, facing), options.skip = skips_of(skip);
  set_masks(options, masks);
  query(shared, options, progress, from.count,
        [&](const auto& tree, const auto& heard) { tree.count_crossings(from, to, heard); });
}

// Binds the calls with rays of a class, whose C++ class is Object.
template <class Object, class Shared>
void def_ray_calls(py::class_<Shared>& of) {
  using Rays = RayRecords<RayOf<NumberIn<Shared>>>;
  using Crossings = RayLists<typename raylanes::detail::QueryTypes<Object>::Crossing>;
  using Stretches = decltype(stretches(std::declval<const Object&>(), Rays()));
  constexpr RayLists<HitIn<Shared>> (SurfaceQueries<Object>::*hits)(Rays, const ListOptions&) const =
      &Object::all_hits;
  constexpr Crossings (SurfaceQueries<Object>::*crossings)(Rays, const ListOptions&) const =
      &Object::crossings;
  constexpr Stretches (*within)(const Object&, Rays, const ListOptions&) = &stretches;
  of.def("closest", closest<Shared>)
      .def("closest_crossing", closest_crossing<Shared>)
      .def("occluded", occluded<Shared>)
      .def("occluded_from", occluded_from<Shared>)
      .def("all_hits", lists<Shared, hits>)
      .def("crossings", lists<Shared, crossings>)
      .def("stretches", lists<Shared, within>)
      .def("count_crossings", count_crossings<Shared>);
}

// Calls with points. Mask: that of a query of scenes, or nothing.
template <class Shared, class... Mask>
void locate(const Shared& shared, const py::array& points, const py::array& locations, const char* rule,
            const char* path, int threads, const py::object& active, const py::object& progress,
            Mask... mask) {
  const auto from = vertices_of<NumberIn<Shared>>(points);
  const auto bytes = span_of<std::uint8_t>(locations);
  const std::span<Location> to(reinterpret_cast<Location*>(bytes.data()), bytes.size());
  auto options = plain_options<LocateOptions>(path, threads, active, from.count);
  options.rule = named<InsideRule>("rule", inside_rule_names, rule);
  ((options.mask = mask), ...);
  query(shared, options, progress, from.count,
        [&](const auto& tree, const auto& heard) { tree.locate(from, to, heard); });
}

template <class Shared, class... Mask>
void winding_numbers(const Shared& shared, const py::array& points, const py::array& numbers, double accuracy,
                     const char* path, int threads, const py::object& active, const py::object& progress,
                     Mask... mask) {
  const auto from = vertices_of<NumberIn<Shared>>(points);
  const auto to = span_of<NumberIn<Shared>>(numbers);
  auto options = plain_options<WindingOptions>(path, threads, active, from.count);
  options.accuracy = accuracy;
  ((options.mask = mask), ...);
  query(shared, options, progress, from.count,
        [&](const auto& tree, const auto& heard) { tree.winding_numbers(from, to, heard); });
}

template <class Shared, class... Mask>
void closest_points(const Shared& shared, const py::array& points, const py::array& answers,
                    NumberIn<Shared> max_distance, const char* path, int threads,
                    const py::object& active, const py::object& progress, Mask... mask) {
  const auto from = vertices_of<NumberIn<Shared>>(points);
  const auto to = span_of<typename Shared::ClosestPoint>(answers);
  auto options = plain_options<typename CallTypesOf<NumberIn<Shared>>::ClosestOptions>(
      path, threads, active, from.count);
  options.max_distance = max_distance;
  ((options.mask = mask), ...);
  query(shared, options, progress, from.count,
        [&](const auto& tree, const auto& heard) { tree.closest_points(from, to, heard); });
}

template <class Shared, class... Mask>
void signed_distances(const Shared& shared, const py::array& points, const py::array& distances,
                      const char* rule, NumberIn<Shared> max_distance, const char* path, int threads,
                      const py::object& active, const py::object& progress, Mask... mask) {
  const auto from = vertices_of<NumberIn<Shared>>(points);
  const auto to = span_of<NumberIn<Shared>>(distances);
  auto options = plain_options<typename CallTypesOf<NumberIn<Shared>>::DistanceOptions>(
      path, threads, active, from.count);
  options.rule = named<InsideRule>("rule", inside_rule_names, rule);
  options.max_distance = max_distance;
  ((options.mask = mask), ...);
  query(shared, options, progress, from.count,
        [&](const auto& tree, const auto& heard) { tree.signed_distances(from, to, heard); });
}

}  // namespace raylanes::python

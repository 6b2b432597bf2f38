#include <pybind11/stl.h>

#include <raylanes/stretches.hpp>

#include "module.hpp"
#include "scene_states.hpp"

namespace raylanes::python {
namespace {

template <class S>
using NumberIn = typename SharedScene<S>::Number;
template <class S>
using HitIn = typename raylanes::detail::QueryTypes<S>::Hit;

template <class S>
void closest_in_scene(const SharedScene<S>& shared, const py::object& rays, const py::array& hits,
                      const py::tuple& how, const py::object& active, std::uint32_t mask,
                      const py::object& after, const py::object& filter) {
  const RaysOf<NumberIn<S>> from(rays);
  const auto to = writable_records_of<HitIn<S>>(hits);
  auto options = trace_options<NumberIn<S>>(how, active, from.count);
  options.mask = mask;
  options.after = hits_after<HitIn<S>>(after);
  filtered_query<HitIn<S>>(shared, options, how[how_progress], from.count, filter,
                           [&](const S& scene, const auto& heard, const auto&... filters) {
                             scene.closest(from, to, filters..., heard);
                           });
}

template <class S>
void crossing_in_scene(const SharedScene<S>& shared, const py::object& rays, const py::array& hits,
                       const py::tuple& how, const py::object& active, std::uint32_t mask,
                       const py::object& after) {
  const RaysOf<NumberIn<S>> from(rays);
  const auto to = writable_records_of<HitIn<S>>(hits);
  auto options = trace_options<NumberIn<S>>(how, active, from.count);
  options.mask = mask;
  options.after = hits_after<HitIn<S>>(after);
  query(shared, options, how[how_progress], from.count,
        [&](const S& scene, const auto& heard) { scene.closest_crossing(from, to, heard); });
}

template <class S>
void occluded_in_scene(const SharedScene<S>& shared, const py::object& rays, const py::array& occluded,
                       const py::tuple& how, const py::object& active, std::uint32_t mask,
                       const py::object& filter) {
  const RaysOf<NumberIn<S>> from(rays);
  const auto to = span_of<std::uint8_t>(occluded);
  auto options = trace_options<NumberIn<S>>(how, active, from.count);
  options.mask = mask;
  filtered_query<HitIn<S>>(shared, options, how[how_progress], from.count, filter,
                           [&](const S& scene, const auto& heard, const auto&... filters) {
                             scene.occluded(from, to, filters..., heard);
                           });
}

template <class S>
void shadows_in_scene(const SharedScene<S>& shared, const std::array<NumberIn<S>, 3>& from,
                      const py::array& points, const py::array& occluded, const Ends<NumberIn<S>>& ends,
                      const py::tuple& how, const py::object& active, std::uint32_t mask,
                      const py::object& filter) {
  const auto to_points = vertices_of<NumberIn<S>>(points);
  const auto to = span_of<std::uint8_t>(occluded);
  auto options = trace_options<NumberIn<S>>(how, active, to_points.count);
  options.mask = mask;
  filtered_query<HitIn<S>>(
      shared, options, how[how_progress], to_points.count, filter,
      [&](const S& scene, const auto& heard, const auto&... filters) {
        if (ends)
          scene.occluded_from(from, to_points, to, filters..., {(*ends)[0], (*ends)[1]}, heard);
        else
          scene.occluded_towards(from, to_points, to, filters..., heard);
      });
}

// The innermost part of each point.
template <class S>
void innermost_parts(const SharedScene<S>& shared, const py::array& points, const py::array& parts,
                     const char* rule, const char* path, int threads, const py::object& active,
                     const py::object& progress, std::uint32_t mask) {
  const auto from = vertices_of<NumberIn<S>>(points);
  const auto to = span_of<ContainingPart>(parts);
  auto options = plain_options<LocateOptions>(path, threads, active, from.count);
  options.rule = named<InsideRule>("rule", inside_rule_names, rule), options.mask = mask;
  query(shared, options, progress, from.count,
        [&](const S& scene, const LocateOptions& heard) { scene.innermost_parts(from, to, heard); });
}
// Offsets and parts, as bytes.
template <class S>
py::tuple containing_parts(const SharedScene<S>& shared, const py::array& points, const char* rule,
                           const char* path, int threads, const py::object& active,
                           const py::object& progress, std::uint32_t mask) {
  const auto from = vertices_of<NumberIn<S>>(points);
  auto options = plain_options<LocateOptions>(path, threads, active, from.count);
  options.rule = named<InsideRule>("rule", inside_rule_names, rule), options.mask = mask;
  auto found = query(
      shared, options, progress, from.count,
      [&](const S& scene, const LocateOptions& heard) { return scene.containing_parts(from, heard); });
  return py::make_tuple(bytes_kept(std::move(found.offsets)), bytes_kept(std::move(found.items)));
}

// Rows of a primitive and an instance each.
template <class S>
void corners_in_scene(const SharedScene<S>& shared, const py::array& hits, const py::array& corners) {
  const PrimitiveView names = skips_of(hits);
  using TriangleNumbers = std::conditional_t<has_floats<S>, Triangle, TriangleD>;
  const std::span triangles(reinterpret_cast<TriangleNumbers*>(span_of<NumberIn<S>>(corners).data()),
                            names.count);
  query(shared, [&](const S& scene) { scene.corners(names, triangles); });
}
template <class S>
void normals_in_scene(const SharedScene<S>& shared, const py::array& hits, const py::array& normals,
                      int threads) {
  const PrimitiveView names = skips_of(hits);
  using Normal = std::array<NumberIn<S>, 3>;
  const std::span to(reinterpret_cast<Normal*>(span_of<NumberIn<S>>(normals).data()), names.count);
  threads = usable_threads(threads);
  query(shared, [&](const S& scene) { scene.normals(names, to, threads); });
}

// As _scene_queries.py has it.
template <class S>
struct InstanceRecord {
  std::uint32_t geometry, mask;
  TransformIn<S> transform;
};
static_assert(sizeof(InstanceRecord<Scene>) == 56 && sizeof(InstanceRecord<SceneD>) == 104);

template <class S>
void instances_of(const SharedScene<S>& shared, const py::array& numbers, const py::array& records) {
  const auto of_numbers = records_of<std::uint32_t>(numbers);
  const auto to = writable_records_of<InstanceRecord<S>>(records);
  require_as_many(of_numbers.count, to.count);
  const S& scene = *shared.state;
  for (std::size_t i = 0; i < to.count; ++i) {
    const std::uint32_t number = of_numbers[i];
    to.set(i, {scene.geometry_of(number), scene.mask_of(number), scene.transform_of(number)});
  }
}

std::vector<InstanceLevel> levels_in(const Scene& scene, std::uint32_t instance) {
  return scene.levels_of(instance);
}
std::vector<InstanceLevel> levels_in(const SceneD& scene, std::uint32_t instance) {
  return {{instance, scene.geometry_of(instance)}};
}

// Rows of as many levels as the deepest instance has, of an instance and a geometry each, as bytes; and how many levels
// these are. No instance has no_part in all of them.
template <class S>
py::tuple levels_of(const SharedScene<S>& shared, const py::array& numbers) {
  const auto of_numbers = records_of<std::uint32_t>(numbers);
  const S& scene = *shared.state;
  std::vector<std::vector<InstanceLevel>> ways;
  std::size_t deepest = 1;
  for (std::size_t i = 0; i < of_numbers.count; ++i) {
    const std::uint32_t number = of_numbers[i];
    ways.push_back(number != no_part ? levels_in(scene, number) : std::vector<InstanceLevel>());
    deepest = std::max(deepest, ways.back().size());
  }
  std::vector<InstanceLevel> rows(ways.size() * deepest);
  for (std::size_t i = 0; i < ways.size(); ++i) std::ranges::copy(ways[i], rows.data() + i * deepest);
  return py::make_tuple(bytes_kept(std::move(rows)), deepest);
}

template <class AnyBox>
py::tuple corners_of(const AnyBox& box) {
  return py::make_tuple(box.lo, box.hi);
}

py::dict report_of_scene(const SharedScene<Scene>& shared) {
  const SceneReport report = shared.state->report();
  py::dict all;
  all["common_trees"] = to_python(report.common_trees);
  all["common_instances"] = to_python(report.common_instances);
  all["common_triangles"] = to_python(report.common_triangles);
  all["common_bytes"] = to_python(report.common_bytes);
  all["mesh_triangles"] = to_python(report.mesh_triangles);
  all["meshes_without_tree"] = to_python(report.meshes_without_tree);
  return all;
}

template <class Shared>
auto bind_shared(py::module_& module, const char* name) {
  return py::class_<Shared>(module, name, py::custom_type_setup(check_new_objects))
      .def("__deepcopy__",
           [](const py::object& self, const py::object&) { return py::type::of(self)(self); });
}

void bind_spheres(py::module_& module) {
  auto spheres = bind_shared<SharedSpheres>(module, "SphereTree");
  def_constructor(spheres, same_spheres);
  def_constructor(spheres, built_spheres);
  spheres.def("closest", closest_spheres)
      .def("occluded", occluded_by_spheres)
      .def("occluded_from", shadows_of_spheres)
      .def("spheres", bytes_of_spheres)
      .def("builder", [](const SharedSpheres& shared) { return to_python(builder_of(shared)); })
      .def("left_out", [](const SharedSpheres& shared) { return to_python(shared.state->tree.left_out()); })
      .def("nbytes",
           [](const SharedSpheres& shared) {
             const SphereState& state = *shared.state;
             return to_python(state.tree.bytes() + state.spheres.size() * sizeof(Sphere));
           })
      .def("bounds", [](const SharedSpheres& shared) { return corners_of(shared.state->tree.bounds()); })
      .def("__reduce_ex__", reduced_spheres);
}

// What scenes of floats and of doubles have.
template <class S>
auto bind_scene(py::module_& module, const char* name) {
  using Shared = SharedScene<S>;
  using Mask = std::uint32_t;
  using Types = raylanes::detail::QueryTypes<S>;
  using Rays = RayRecords<RayOf<NumberIn<S>>>;
  constexpr RayLists<HitIn<S>> (SurfaceQueries<S>::*hits)(Rays, const ListOptions&) const = &S::all_hits;
  constexpr RayLists<typename Types::Crossing> (SurfaceQueries<S>::*crossings_of_rays)(
      Rays, const ListOptions&) const = &S::crossings;
  using Stretches = std::conditional_t<has_floats<S>, SceneStretch, SceneStretchD>;
  constexpr RayLists<Stretches> (*within)(const S&, Rays, const ListOptions&) = &stretches;
  auto scene = bind_shared<Shared>(module, name);
  def_constructor(scene, empty_scene<S>);
  scene.def("add", add<S>)
      .def("replace", replace<S>)
      .def("refit", refit_geometry<S>)
      .def("place", place<S>)
      .def("move", move<S>)
      .def("set_mask", set_mask<S>)
      .def("update", update<S>)
      .def("instances", instances_of<S>)
      .def("levels_of", levels_of<S>)
      .def("geometry_count", [](const Shared& shared) { return to_python(shared.state->geometry_count()); })
      .def("instance_count", [](const Shared& shared) { return to_python(shared.state->instance_count()); })
      .def("closest", closest_in_scene<S>)
      .def("closest_crossing", crossing_in_scene<S>)
      .def("occluded", occluded_in_scene<S>)
      .def("occluded_from", shadows_in_scene<S>)
      .def("all_hits", lists<Shared, hits, Mask>)
      .def("crossings", lists<Shared, crossings_of_rays, Mask>)
      .def("stretches", lists<Shared, within, Mask>)
      .def("count_crossings", count_crossings<Shared, Mask>)
      .def("closest_points", closest_points<Shared, Mask>)
      .def("locate", locate<Shared, Mask>)
      .def("winding_numbers", winding_numbers<Shared, Mask>)
      .def("signed_distances", signed_distances<Shared, Mask>)
      .def("innermost_parts", innermost_parts<S>)
      .def("containing_parts", containing_parts<S>)
      .def("corners", corners_in_scene<S>)
      .def("normals", normals_in_scene<S>)
      .def("bounds", [](const Shared& shared) { return corners_of(shared.state->bounds()); })
      .def("nbytes", [](const Shared& shared) { return to_python(shared.state->bytes()); });
  return scene;
}

[[noreturn]] void throw_without_file() {
  throw std::invalid_argument(
      "scene: no file holds a scene of float64; save its trees, or make it with dtype=numpy.float32");
}

}  // namespace

void bind_scenes(py::module_& module) {
  bind_spheres(module);
  using OfFloats = SharedScene<Scene>;
  auto floats = bind_scene<Scene>(module, "Scene");
  def_constructor(floats, made_from<OfFloats>);
  floats.def("add_scene", add_scene)
      .def("add_mesh", add_mesh)
      .def("set_moving", set_moving)
      .def("set_triangle_masks", set_triangle_masks)
      .def("report", report_of_scene)
      .def("to_bytes", to_bytes<OfFloats>)
      .def("__reduce_ex__", reduced<OfFloats>);
  auto doubles = bind_scene<SceneD>(module, "SceneD");
  def_constructor(doubles, same_scene<SceneD>);
  doubles.def("to_bytes", [](const SharedScene<SceneD>&) -> py::object { throw_without_file(); })
      .def("__reduce_ex__", [](const SharedScene<SceneD>&, int) -> py::object { throw_without_file(); });
}

}  // namespace raylanes::python

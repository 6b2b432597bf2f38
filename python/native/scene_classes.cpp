#include <pybind11/stl.h>

#include <raylanes/stretches.hpp>

#include "module.hpp"
#include "scene_states.hpp"

namespace raylanes::python {
namespace {

void closest_in_scene(const SharedScene& shared, const py::object& rays, const py::array& hits,
                      const py::tuple& how, const py::object& active, std::uint32_t mask,
                      const py::object& after, const py::object& filter) {
  const RaysOf<float> from(rays);
  const auto to = writable_records_of<SceneHit>(hits);
  auto options = trace_options<float>(how, active, from.count);
  options.mask = mask;
  options.after = hits_after<SceneHit>(after);
  filtered_query<SceneHit>(shared, options, how[how_progress], from.count, filter,
                           [&](const Scene& scene, const TraceOptions& heard, const auto&... filters) {
                             scene.closest(from, to, filters..., heard);
                           });
}

void crossing_in_scene(const SharedScene& shared, const py::object& rays, const py::array& hits,
                       const py::tuple& how, const py::object& active, std::uint32_t mask,
                       const py::object& after) {
  const RaysOf<float> from(rays);
  const auto to = writable_records_of<SceneHit>(hits);
  auto options = trace_options<float>(how, active, from.count);
  options.mask = mask;
  options.after = hits_after<SceneHit>(after);
  query(shared, options, how[how_progress], from.count,
        [&](const Scene& scene, const TraceOptions& heard) { scene.closest_crossing(from, to, heard); });
}

void occluded_in_scene(const SharedScene& shared, const py::object& rays, const py::array& occluded,
                       const py::tuple& how, const py::object& active, std::uint32_t mask,
                       const py::object& filter) {
  const RaysOf<float> from(rays);
  const auto to = span_of<std::uint8_t>(occluded);
  auto options = trace_options<float>(how, active, from.count);
  options.mask = mask;
  filtered_query<SceneHit>(shared, options, how[how_progress], from.count, filter,
                           [&](const Scene& scene, const TraceOptions& heard, const auto&... filters) {
                             scene.occluded(from, to, filters..., heard);
                           });
}

void shadows_in_scene(const SharedScene& shared, const Float3& from, const py::array& points,
                      const py::array& occluded, const Ends<float>& ends, const py::tuple& how,
                      const py::object& active, std::uint32_t mask, const py::object& filter) {
  const auto to_points = vertices_of<float>(points);
  const auto to = span_of<std::uint8_t>(occluded);
  auto options = trace_options<float>(how, active, to_points.count);
  options.mask = mask;
  filtered_query<SceneHit>(
      shared, options, how[how_progress], to_points.count, filter,
      [&](const Scene& scene, const TraceOptions& heard, const auto&... filters) {
        if (ends)
          scene.occluded_from(from, to_points, to, filters..., {(*ends)[0], (*ends)[1]}, heard);
        else
          scene.occluded_towards(from, to_points, to, filters..., heard);
      });
}

// The innermost part of each point.
void innermost_parts(const SharedScene& shared, const py::array& points, const py::array& parts,
                     const char* rule, const char* path, int threads, const py::object& active,
                     const py::object& progress, std::uint32_t mask) {
  const auto from = vertices_of<float>(points);
  const auto to = span_of<ContainingPart>(parts);
  auto options = plain_options<LocateOptions>(path, threads, active, from.count);
  options.rule = named<InsideRule>("rule", inside_rule_names, rule), options.mask = mask;
  query(shared, options, progress, from.count,
        [&](const Scene& scene, const LocateOptions& heard) { scene.innermost_parts(from, to, heard); });
}
// Offsets and parts, as bytes.
py::tuple containing_parts(const SharedScene& shared, const py::array& points, const char* rule,
                           const char* path, int threads, const py::object& active,
                           const py::object& progress, std::uint32_t mask) {
  const auto from = vertices_of<float>(points);
  auto options = plain_options<LocateOptions>(path, threads, active, from.count);
  options.rule = named<InsideRule>("rule", inside_rule_names, rule), options.mask = mask;
  auto found = query(
      shared, options, progress, from.count,
      [&](const Scene& scene, const LocateOptions& heard) { return scene.containing_parts(from, heard); });
  return py::make_tuple(bytes_kept(std::move(found.offsets)), bytes_kept(std::move(found.items)));
}

// Rows of a primitive and an instance each.
void corners_in_scene(const SharedScene& shared, const py::array& hits, const py::array& corners) {
  const PrimitiveView names = skips_of(hits);
  const std::span triangles(reinterpret_cast<Triangle*>(span_of<float>(corners).data()), names.count);
  query(shared, [&](const Scene& scene) { scene.corners(names, triangles); });
}
void normals_in_scene(const SharedScene& shared, const py::array& hits, const py::array& normals,
                      int threads) {
  const PrimitiveView names = skips_of(hits);
  const std::span to(reinterpret_cast<Float3*>(span_of<float>(normals).data()), names.count);
  threads = usable_threads(threads);
  query(shared, [&](const Scene& scene) { scene.normals(names, to, threads); });
}

// As _scene_queries.py has it.
struct InstanceRecord {
  std::uint32_t geometry, mask;
  Transform transform;
};
static_assert(sizeof(InstanceRecord) == 56);

void instances_of(const SharedScene& shared, const py::array& numbers, const py::array& records) {
  const auto of_numbers = records_of<std::uint32_t>(numbers);
  const auto to = writable_records_of<InstanceRecord>(records);
  require_as_many(of_numbers.count, to.count);
  const Scene& scene = *shared.state;
  for (std::size_t i = 0; i < to.count; ++i) {
    const std::uint32_t number = of_numbers[i];
    to.set(i, {scene.geometry_of(number), scene.mask_of(number), scene.transform_of(number)});
  }
}

// Rows of as many levels as the deepest instance has, of an instance and a geometry each, as bytes; and how many levels
// these are. No instance has no_part in all of them.
py::tuple levels_of(const SharedScene& shared, const py::array& numbers) {
  const auto of_numbers = records_of<std::uint32_t>(numbers);
  const Scene& scene = *shared.state;
  std::vector<std::vector<InstanceLevel>> ways;
  std::size_t deepest = 1;
  for (std::size_t i = 0; i < of_numbers.count; ++i) {
    const std::uint32_t number = of_numbers[i];
    ways.push_back(number != no_part ? scene.levels_of(number) : std::vector<InstanceLevel>());
    deepest = std::max(deepest, ways.back().size());
  }
  std::vector<InstanceLevel> rows(ways.size() * deepest);
  for (std::size_t i = 0; i < ways.size(); ++i) std::ranges::copy(ways[i], rows.data() + i * deepest);
  return py::make_tuple(bytes_kept(std::move(rows)), deepest);
}

py::tuple corners_of(const Box& box) {
  return py::make_tuple(box.lo, box.hi);
}

py::dict report_of_scene(const SharedScene& shared) {
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

}  // namespace

void bind_scenes(py::module_& module) {
  bind_spheres(module);
  using Mask = std::uint32_t;
  constexpr RayLists<SceneHit> (SurfaceQueries<Scene>::*hits)(RayView, const ListOptions&) const =
      &Scene::all_hits;
  constexpr RayLists<SceneCrossing> (SurfaceQueries<Scene>::*crossings_of_rays)(RayView, const ListOptions&)
      const = &Scene::crossings;
  constexpr RayLists<SceneStretch> (*within)(const Scene&, RayView, const ListOptions&) = &stretches;
  auto scene = bind_shared<SharedScene>(module, "Scene");
  def_constructor(scene, empty_scene);
  def_constructor(scene, made_from<SharedScene>);
  scene.def("add", add)
      .def("add_scene", add_scene)
      .def("add_mesh", add_mesh)
      .def("replace", replace)
      .def("refit", refit_geometry)
      .def("place", place)
      .def("move", move)
      .def("set_mask", set_mask)
      .def("set_moving", set_moving)
      .def("set_triangle_masks", set_triangle_masks)
      .def("update", update)
      .def("report", report_of_scene)
      .def("instances", instances_of)
      .def("levels_of", levels_of)
      .def("geometry_count",
           [](const SharedScene& shared) { return to_python(shared.state->geometry_count()); })
      .def("instance_count",
           [](const SharedScene& shared) { return to_python(shared.state->instance_count()); })
      .def("closest", closest_in_scene)
      .def("closest_crossing", crossing_in_scene)
      .def("occluded", occluded_in_scene)
      .def("occluded_from", shadows_in_scene)
      .def("all_hits", lists<SharedScene, hits, Mask>)
      .def("crossings", lists<SharedScene, crossings_of_rays, Mask>)
      .def("stretches", lists<SharedScene, within, Mask>)
      .def("count_crossings", count_crossings<SharedScene, Mask>)
      .def("closest_points", closest_points<SharedScene, Mask>)
      .def("locate", locate<SharedScene, Mask>)
      .def("winding_numbers", winding_numbers<SharedScene, Mask>)
      .def("signed_distances", signed_distances<SharedScene, Mask>)
      .def("innermost_parts", innermost_parts)
      .def("containing_parts", containing_parts)
      .def("corners", corners_in_scene)
      .def("normals", normals_in_scene)
      .def("bounds", [](const SharedScene& shared) { return corners_of(shared.state->bounds()); })
      .def("nbytes", [](const SharedScene& shared) { return to_python(shared.state->bytes()); })
      .def("to_bytes", to_bytes<SharedScene>)
      .def("__reduce_ex__", reduced<SharedScene>);
}

}  // namespace raylanes::python

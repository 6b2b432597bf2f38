#include <pybind11/stl.h>

#include "module.hpp"
#include "scene_states.hpp"

namespace raylanes::python {
namespace {

// The innermost part of each point.
template <class S>
void innermost_parts(const SharedScene<S>& shared, const py::array& points, const py::array& parts,
                     const char* rule, const char* path, int threads, const py::object& active,
                     const py::object& progress, std::uint32_t mask) {
  const auto from = vertices_of<NumberIn<SharedScene<S>>>(points);
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
  const auto from = vertices_of<NumberIn<SharedScene<S>>>(points);
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
  const std::span triangles(reinterpret_cast<TriangleNumbers*>(span_of<NumberIn<SharedScene<S>>>(corners).data()),
                            names.count);
  query(shared, [&](const S& scene) { scene.corners(names, triangles); });
}
template <class S>
void normals_in_scene(const SharedScene<S>& shared, const py::array& hits, const py::array& normals,
                      int threads) {
  const PrimitiveView names = skips_of(hits);
  using Normal = std::array<NumberIn<SharedScene<S>>, 3>;
  const std::span to(reinterpret_cast<Normal*>(span_of<NumberIn<SharedScene<S>>>(normals).data()), names.count);
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
    ways.push_back(number != no_part ? scene.levels_of(number) : std::vector<InstanceLevel>());
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

template <class S>
py::dict report_of_scene(const SharedScene<S>& shared) {
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

template <class S>
auto bind_scene(py::module_& module, const char* name) {
  using Shared = SharedScene<S>;
  using Mask = std::uint32_t;
  auto scene = bind_shared<Shared>(module, name);
  def_constructor(scene, empty_scene<S>);
  def_constructor(scene, made_from<Shared>);
  def_ray_calls<S>(scene);
  scene.def("add", add<S>)
      .def("add_scene", add_scene<S>)
      .def("replace", replace<S>)
      .def("refit", refit_geometry<S>)
      .def("place", place<S>)
      .def("move", move<S>)
      .def("set_mask", set_mask<S>)
      .def("set_moving", set_moving<S>)
      .def("set_triangle_masks", set_triangle_masks<S>)
      .def("update", update<S>)
      .def("report", report_of_scene<S>)
      .def("instances", instances_of<S>)
      .def("levels_of", levels_of<S>)
      .def("geometry_count", [](const Shared& shared) { return to_python(shared.state->geometry_count()); })
      .def("instance_count", [](const Shared& shared) { return to_python(shared.state->instance_count()); })
      .def("closest_points", closest_points<Shared, Mask>)
      .def("locate", locate<Shared, Mask>)
      .def("winding_numbers", winding_numbers<Shared, Mask>)
      .def("signed_distances", signed_distances<Shared, Mask>)
      .def("innermost_parts", innermost_parts<S>)
      .def("containing_parts", containing_parts<S>)
      .def("corners", corners_in_scene<S>)
      .def("normals", normals_in_scene<S>)
      .def("bounds", [](const Shared& shared) { return corners_of(shared.state->bounds()); })
      .def("nbytes", [](const Shared& shared) { return to_python(shared.state->bytes()); })
      .def("to_bytes", to_bytes<Shared>)
      .def("__reduce_ex__", reduced<Shared>);
  return scene;
}

}  // namespace

void bind_scenes(py::module_& module) {
  bind_spheres(module);
  bind_scene<Scene>(module, "Scene").def("add_mesh", add_mesh);
  bind_scene<SceneD>(module, "SceneD");
}

}  // namespace raylanes::python

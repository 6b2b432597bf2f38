#include <pybind11/stl.h>

#include <algorithm>

#include "module.hpp"
#include "scene_states.hpp"

namespace raylanes::python {
namespace {

// A filter by a Python function of indices and hits, as bytes of its own, which returns a byte for each. The library
// calls filters on the thread that asks.
SceneHitFilter filter_by(const py::object& function, Listener& listener) {
  const auto copied = [](const auto& span) {
    return py::array(py::dtype("u1"), {span.size_bytes()}, {1}, span.data());
  };
  return [&function, &listener, copied](std::span<const std::size_t> rays, std::span<const SceneHit> hits,
                                        std::span<std::uint8_t> rejected) {
    listener.with_gil([&] {
      const py::array indices = copied(rays), of_hits = copied(hits);
      const BytesOf answer(
          not_null(PyObject_CallFunctionObjArgs(function.ptr(), indices.ptr(), of_hits.ptr(), nullptr)));
      if (answer.bytes().size() != rejected.size()) throw std::invalid_argument("filter: another size");
      std::copy(answer.bytes().begin(), answer.bytes().end(), rejected.begin());
    });
  };
}

// ask(scene, options, filter...) of so many rays, with the filter, if there is one.
template <class Ask>
void ask_filtered(const SharedScene& shared, TraceOptions options, const py::tuple& how, std::size_t rays,
                  const py::object& filter, const Ask& ask) {
  Listener listener(how[7], rays);
  options.progress = listener.progress();
  query(shared, listener, [&](const Scene& scene) {
    if (filter.is_none())
      ask(scene, options);
    else
      ask(scene, options, filter_by(filter, listener));
  });
}

void closest_in_scene(const SharedScene& shared, const py::array& rays, const py::array& hits,
                      const py::tuple& how, const py::object& active, std::uint32_t mask,
                      const py::object& filter) {
  const RayView from = rays_of<float>(rays);
  const auto to = writable_records_of<SceneHit>(hits);
  const auto options = trace_options<float>(how, active, from.count);
  ask_filtered(shared, options, how, from.count, filter,
               [&](const Scene& scene, const TraceOptions& heard, const auto&... filters) {
                 scene.closest(from, to, filters..., heard, mask);
               });
}

void next_in_scene(const SharedScene& shared, const py::array& rays, const py::array& hits,
                   const py::tuple& how, const py::object& active, std::uint32_t mask,
                   const py::array& after) {
  const RayView from = rays_of<float>(rays);
  const auto to = writable_records_of<SceneHit>(hits);
  const auto options = trace_options<float>(how, active, from.count);
  const Rows before = rows_of(after, sizeof(SceneHit));
  const SceneHitView behind(before.first, before.count, before.stride);
  query(shared, options, how[7], from.count,
        [&](const Scene& scene, const TraceOptions& heard) { scene.next(from, behind, to, heard, mask); });
}

void occluded_in_scene(const SharedScene& shared, const py::array& rays, const py::array& answers,
                       const py::tuple& how, const py::object& active, std::uint32_t mask,
                       const py::object& filter) {
  const RayView from = rays_of<float>(rays);
  const auto to = span_of<std::uint8_t>(answers);
  const auto options = trace_options<float>(how, active, from.count);
  ask_filtered(shared, options, how, from.count, filter,
               [&](const Scene& scene, const TraceOptions& heard, const auto&... filters) {
                 scene.occluded(from, to, filters..., heard, mask);
               });
}

void shadows_in_scene(const SharedScene& shared, const Float3& from, const py::array& points,
                      const py::array& answers, const std::array<float, 2>& ends, const py::tuple& how,
                      const py::object& active, std::uint32_t mask) {
  const auto to_points = vertices_of<float>(points);
  const SegmentEnds between{ends[0], ends[1]};
  const auto to = span_of<std::uint8_t>(answers);
  const auto options = trace_options<float>(how, active, to_points.count);
  query(shared, options, how[7], to_points.count, [&](const Scene& scene, const TraceOptions& heard) {
    scene.occluded_from(from, to_points, to, between, heard, mask);
  });
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

py::tuple corners_of(const Box& box) {
  return py::make_tuple(box.lo, box.hi);
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
  auto scene = bind_shared<SharedScene>(module, "Scene");
  def_constructor(scene, empty_scene);
  def_constructor(scene, made_from<SharedScene>);
  scene.def("add", add)
      .def("replace", replace)
      .def("refit", refit_geometry)
      .def("place", place)
      .def("move", move)
      .def("set_mask", set_mask)
      .def("update", update)
      .def("instances", instances_of)
      .def("geometry_count",
           [](const SharedScene& shared) { return to_python(shared.state->geometry_count()); })
      .def("instance_count",
           [](const SharedScene& shared) { return to_python(shared.state->instance_count()); })
      .def("closest", closest_in_scene)
      .def("next", next_in_scene)
      .def("occluded", occluded_in_scene)
      .def("occluded_from", shadows_in_scene)
      .def("bounds", [](const SharedScene& shared) { return corners_of(shared.state->bounds()); })
      .def("nbytes", [](const SharedScene& shared) { return to_python(shared.state->bytes()); })
      .def("to_bytes", to_bytes<SharedScene>)
      .def("__reduce_ex__", reduced<SharedScene>);
}

}  // namespace raylanes::python

// Trees over spheres that Python's threads and copies share.
#pragma once

#include <cstring>

#include <raylanes/sphere_tree.hpp>

#include "tree_binding.hpp"

namespace raylanes::python {

// Never changes. The spheres are those of the caller, in that order: no file holds a tree of spheres, so a pickle has
// these.
struct SphereState {
  std::vector<Sphere> spheres;
  TreeBuilder builder;
  SphereTree tree;
};

struct SharedSpheres {
  std::shared_ptr<const SphereState> state;
};

inline const SphereState& tree_in(const SharedSpheres&, const SphereState& state) {
  return state;
}

// Copies the spheres while the caller's memory may still be read.
inline std::vector<Sphere> spheres_of(const BytesOf& data) {
  const std::span<const char> bytes = data.bytes();
  if (bytes.size() % sizeof(Sphere) != 0) throw std::invalid_argument("spheres: the bytes are cut");
  std::vector<Sphere> spheres(bytes.size() / sizeof(Sphere));
  if (!spheres.empty()) std::memcpy(spheres.data(), bytes.data(), bytes.size());
  return spheres;
}

// From another tree, whose state it shares.
inline std::unique_ptr<SharedSpheres> same_spheres(const SharedSpheres& other) {
  return std::make_unique<SharedSpheres>(other);
}

// From contiguous records of four floats.
inline std::unique_ptr<SharedSpheres> built_spheres(const py::object& records, std::string_view builder,
                                                    int threads) {
  const BytesOf data(records);
  BoundedBuildOptions options;
  options.builder = named<TreeBuilder>("builder", tree_builder_names, builder);
  options.threads = usable_threads(threads);
  const WithoutGil others_run;
  std::vector<Sphere> spheres = spheres_of(data);
  SphereTree tree(spheres, options);
  auto state =
      std::make_shared<const SphereState>(SphereState{std::move(spheres), options.builder, std::move(tree)});
  return std::make_unique<SharedSpheres>(SharedSpheres{std::move(state)});
}

// The bytes of the spheres, without a copy: they live as long as the array.
inline py::array bytes_of_spheres(const SharedSpheres& shared) {
  using Owner = std::shared_ptr<const SphereState>;
  auto owner = std::make_unique<Owner>(shared.state);
  const py::capsule capsule(owner.get(), [](void* of) { delete static_cast<Owner*>(of); });
  const std::vector<Sphere>& kept = (*owner.release())->spheres;
  return py::array(py::dtype("u1"), {kept.size() * sizeof(Sphere)}, {1}, kept.data(), capsule);
}

inline std::string_view builder_of(const SharedSpheres& shared) {
  return tree_builder_names[static_cast<std::size_t>(shared.state->builder)];
}

// For copyreg, as reduced() of trees: the tree is built again.
inline py::tuple reduced_spheres(const py::object& self, int protocol) {
  const auto& shared = self.cast<const SharedSpheres&>();
  const std::span<const Sphere> spheres(shared.state->spheres);
  py::object bytes = not_null(PyBytes_FromStringAndSize(reinterpret_cast<const char*>(spheres.data()),
                                                        static_cast<py::ssize_t>(spheres.size_bytes())));
  if (protocol >= 5) bytes = not_null(PyPickleBuffer_FromObject(bytes.ptr()));
  return py::make_tuple(py::type::of(self), py::make_tuple(bytes, to_python(builder_of(shared)), 1));
}

inline VisitOptions visit_options(const py::tuple& how, const py::object& active, std::size_t rays) {
  const auto options = trace_options<float>(how, active, rays);
  return {.path = options.path, .threads = options.threads, .active = options.active, .skip = options.skip};
}

inline void closest_spheres(const SharedSpheres& shared, const py::object& rays, const py::array& hits,
                            const py::tuple& how, const py::object& active, const py::object& after,
                            const py::object& filter) {
  const RaysOf<float> from(rays);
  const auto to = hits_of<float>(hits);
  auto options = visit_options(how, active, from.count);
  options.after = hits_after<Hit>(after);
  filtered_query<Hit>(shared, options, how[how_progress], from.count, filter,
                      [&](const SphereState& state, const VisitOptions& heard, const auto&... filters) {
                        state.tree.closest(from, to, filters..., heard);
                      });
}

inline void occluded_by_spheres(const SharedSpheres& shared, const py::object& rays,
                                const py::array& occluded, const py::tuple& how, const py::object& active,
                                const py::object& filter) {
  const RaysOf<float> from(rays);
  const auto to = span_of<std::uint8_t>(occluded);
  const auto options = visit_options(how, active, from.count);
  filtered_query<Hit>(shared, options, how[how_progress], from.count, filter,
                      [&](const SphereState& state, const VisitOptions& heard, const auto&... filters) {
                        state.tree.occluded(from, to, filters..., heard);
                      });
}

inline void shadows_of_spheres(const SharedSpheres& shared, const Float3& from, const py::array& points,
                               const py::array& occluded, const Ends<float>& ends, const py::tuple& how,
                               const py::object& active, const py::object& filter) {
  const auto to_points = vertices_of<float>(points);
  const auto to = span_of<std::uint8_t>(occluded);
  const auto options = visit_options(how, active, to_points.count);
  filtered_query<Hit>(
      shared, options, how[how_progress], to_points.count, filter,
      [&](const SphereState& state, const VisitOptions& heard, const auto&... filters) {
        if (ends)
          state.tree.occluded_from(from, to_points, to, filters..., {(*ends)[0], (*ends)[1]}, heard);
        else
          state.tree.occluded_towards(from, to_points, to, filters..., heard);
      });
}

}  // namespace raylanes::python

// Scenes that Python's threads and copies share, and how they change.
#pragma once

#include <raylanes/scene_d.hpp>

#include "sphere_states.hpp"
#include "tree_states.hpp"

namespace raylanes::python {

// As SharedTree: a query keeps the state that it begins with, and nobody sees a state change. S: Scene or SceneD.
template <class S>
struct SharedScene {
  using Object = S;
  using Number = typename raylanes::detail::QueryTypes<S>::Number;
  using Hit = typename raylanes::detail::QueryTypes<S>::Hit;
  using ClosestPoint = typename raylanes::detail::QueryTypes<S>::ClosestPoint;
  explicit SharedScene(S&& scene) : state(std::make_shared<S>(std::move(scene))) {}
  std::shared_ptr<S> state;
};

template <class S>
inline constexpr bool has_floats = std::is_same_v<S, Scene>;
// The trees of triangles in a scene, and where it places them.
template <class S>
using TreeIn = std::conditional_t<has_floats<S>, Bvh, BvhD>;
template <class S>
using TransformIn = std::conditional_t<has_floats<S>, Transform, TransformD>;

template <class S>
const S& tree_in(const SharedScene<S>&, const S& state) {
  return state;
}

template <class S>
std::unique_ptr<SharedScene<S>> empty_scene() {
  return std::make_unique<SharedScene<S>>(S());
}

// Whether work on so many instances ends before another thread notices that this one keeps the GIL.
inline bool is_quick(std::size_t instances) {
  return instances <= 1000 || is_only_thread();
}

// Changes a scene: all of work(scene), or nothing if it throws. `in_place` says that the work is quick, and leaves the
// scene as it was if it throws. Then the state itself is changed, if nobody else has it. Otherwise a copy is changed
// without the GIL and swapped in. If another thread has changed the scene meanwhile, this begins again; the
// fourth attempt keeps the GIL.
template <class S, class Work>
void change(SharedScene<S>& shared, bool in_place, const Work& work) {
  if (in_place && shared.state.use_count() == 1) return work(*shared.state);
  for (int attempt = 0;; ++attempt) {
    const std::shared_ptr<S> before = shared.state;
    std::shared_ptr<S> made;
    const auto make = [&] {
      made = std::make_shared<S>(std::as_const(*before));
      work(*made);
    };
    if (attempt < 3) {
      const WithoutGil others_run;
      make();
    } else {
      make();
    }
    if (shared.state == before) {
      shared.state = std::move(made);
      return;
    }
  }
}

// Passes the tree of a part, which the scene shares, to work(tree).
template <class S, class Work>
void with_part(const py::object& part, const Work& work) {
  if constexpr (has_floats<S>) {
    if (py::isinstance<SharedSpheres>(part)) {
      const std::shared_ptr<const SphereState> state = part.cast<const SharedSpheres&>().state;
      return work(std::shared_ptr<const SphereTree>(state, &state->tree));
    }
  }
  work(std::static_pointer_cast<const TreeIn<S>>(part.cast<const SharedTreeOf<TreeIn<S>>&>().state));
}

template <class S>
std::uint32_t add(SharedScene<S>& shared, const py::object& part) {
  std::uint32_t number = 0;
  with_part<S>(part,
               [&](const auto& tree) { change(shared, true, [&](S& scene) { number = scene.add(tree); }); });
  return number;
}

template <class S>
std::uint32_t add_scene(SharedScene<S>& shared, const SharedScene<S>& other) {
  const std::shared_ptr<const S> added = other.state;
  std::uint32_t number = 0;
  change(shared, is_quick(added->instance_count()), [&](S& scene) { number = scene.add(*added); });
  return number;
}

// A mesh without a tree of its own.
inline std::uint32_t add_mesh(SharedScene<Scene>& shared, const py::array& vertices, const py::array& faces,
                              int threads) {
  const auto of_vertices = vertices_of<float>(vertices);
  const IndexView of_faces = indices_of(faces);
  BuildOptions options;
  options.threads = usable_threads(threads);
  std::uint32_t number = 0;
  change(shared, is_quick(of_faces.count / 64),
         [&](Scene& scene) { number = scene.add(of_vertices, of_faces, options); });
  return number;
}

template <class S>
void replace(SharedScene<S>& shared, std::uint32_t geometry, const py::object& part) {
  with_part<S>(part, [&](const auto& tree) {
    change(shared, true, [&](S& scene) { scene.replace(geometry, tree); });
  });
}

template <class S>
void refit_geometry(SharedScene<S>& shared, std::uint32_t geometry, const py::array& vertices,
                    const py::array& faces, int threads) {
  const auto of_vertices = vertices_of<NumberIn<SharedScene<S>>>(vertices);
  const IndexView of_faces = indices_of(faces);
  threads = usable_threads(threads);
  change(shared, is_only_thread(),
         [&](S& scene) { scene.refit(geometry, of_vertices, of_faces, threads); });
}

inline void require_as_many(std::size_t elements, std::size_t others) {
  if (elements != others) throw std::invalid_argument("arrays of instances have different sizes");
}

// Returns the first of the new instances, and how many numbers each of them takes, parts of an added scene among them.
template <class S>
std::pair<std::size_t, std::size_t> place(SharedScene<S>& shared, std::uint32_t geometry,
                                          const py::array& transforms, const py::array& masks) {
  const auto of_transforms = records_of<TransformIn<S>>(transforms);
  const auto of_masks = records_of<std::uint32_t>(masks);
  require_as_many(of_transforms.count, of_masks.count);
  std::size_t first = 0, end = 0;
  change(shared, of_transforms.count == 1, [&](S& scene) {
    first = scene.instance_count();
    for (std::size_t i = 0; i < of_transforms.count; ++i)
      scene.place(geometry, of_transforms[i], of_masks[i]);
    end = scene.instance_count();
  });
  return {first, of_transforms.count > 0 ? (end - first) / of_transforms.count : 1};
}

// Throws before anything changes.
template <class S>
void require_instances(S& scene, const RayRecords<std::uint32_t>& instances) {
  for (std::size_t i = 0; i < instances.count; ++i)
    if (scene.levels_of(instances[i]).size() > 1) scene.set_moving(instances[i]);  // which refuses it
}

template <class S>
void move(SharedScene<S>& shared, const py::array& instances, const py::array& transforms) {
  const auto of_instances = records_of<std::uint32_t>(instances);
  const auto of_transforms = records_of<TransformIn<S>>(transforms);
  require_as_many(of_instances.count, of_transforms.count);
  change(shared, is_quick(of_instances.count), [&](S& scene) {
    require_instances(scene, of_instances);
    for (std::size_t i = 0; i < of_instances.count; ++i) scene.move(of_instances[i], of_transforms[i]);
  });
}

template <class S>
void set_mask(SharedScene<S>& shared, const py::array& instances, const py::array& masks) {
  const auto of_instances = records_of<std::uint32_t>(instances);
  const auto of_masks = records_of<std::uint32_t>(masks);
  require_as_many(of_instances.count, of_masks.count);
  change(shared, is_quick(of_instances.count), [&](S& scene) {
    require_instances(scene, of_instances);
    for (std::size_t i = 0; i < of_instances.count; ++i) scene.set_mask(of_instances[i], of_masks[i]);
  });
}

template <class S>
void set_moving(SharedScene<S>& shared, const py::array& instances, bool moving) {
  const auto of_instances = records_of<std::uint32_t>(instances);
  change(shared, is_quick(of_instances.count), [&](S& scene) {
    require_instances(scene, of_instances);
    for (std::size_t i = 0; i < of_instances.count; ++i) scene.set_moving(of_instances[i], moving);
  });
}

template <class S>
void set_triangle_masks(SharedScene<S>& shared, std::uint32_t geometry, const py::array& masks) {
  const auto given = records_of<std::uint32_t>(masks);
  std::vector<std::uint32_t> words(given.count);
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = given[i];
  change(shared, is_quick(words.size() / 64),
         [&](S& scene) { scene.set_triangle_masks(geometry, words); });
}

// Whether an update ends so soon, even if it builds a tree over all triangles.
template <class S>
bool is_quick_update(const S& scene) {
  constexpr std::size_t most = 1 << 13;  // triangles
  return is_quick(scene.instance_count()) && (scene.report().mesh_triangles <= most || is_only_thread());
}
template <class S>
void update(SharedScene<S>& shared, int threads) {
  threads = usable_threads(threads);
  change(shared, is_quick_update(*shared.state), [&](S& scene) { scene.update(threads); });
}

}  // namespace raylanes::python

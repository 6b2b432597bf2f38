// The C functions of trees and scenes by their kind, for tests that serve all of them.
#pragma once

#include <raylanes/raylanes.h>

#include <memory>

#include <raylanes/scene_d.hpp>

namespace raylanes::testing {

// The kind is float or double for trees, or Scene or SceneD.
template <class Kind>
struct CallsOf;
// The functions that trees and scenes share, by the beginning of their names.
#define RAYLANES_SHARED_CALLS(of)                                   \
  using Handle = of;                                                \
  static constexpr auto destroy = of##_destroy;                     \
  static constexpr auto bounds = of##_bounds;                       \
  static constexpr auto closest = of##_closest;                     \
  static constexpr auto occluded = of##_occluded;                   \
  static constexpr auto closest1 = of##_closest1;                   \
  static constexpr auto occluded1 = of##_occluded1;                 \
  static constexpr auto occluded_from = of##_occluded_from;         \
  static constexpr auto occluded_towards = of##_occluded_towards;   \
  static constexpr auto closest_crossing = of##_closest_crossing;   \
  static constexpr auto closest_crossing1 = of##_closest_crossing1; \
  static constexpr auto count_crossings = of##_count_crossings;     \
  static constexpr auto all_hits = of##_all_hits;                   \
  static constexpr auto crossings = of##_crossings;                 \
  static constexpr auto locate = of##_locate;                       \
  static constexpr auto closest_points = of##_closest_points;       \
  static constexpr auto signed_distances = of##_signed_distances;   \
  static constexpr auto winding_numbers = of##_winding_numbers;     \
  static constexpr auto stretches = of##_stretches
// Files.
#define RAYLANES_FILE_CALLS(of)                     \
  static constexpr auto save = of##_save;           \
  static constexpr auto save_file = of##_save_file; \
  static constexpr auto load = of##_load;           \
  static constexpr auto load_file = of##_load_file
// The functions that scenes share.
#define RAYLANES_SCENE_CALLS(of)                                      \
  static constexpr auto create = of##_create;                         \
  static constexpr auto copy = of##_copy;                             \
  static constexpr auto add_mesh = of##_add_mesh;                     \
  static constexpr auto add_tree = of##_add_tree;                     \
  static constexpr auto add_scene = of##_add_scene;                   \
  static constexpr auto replace_tree = of##_replace_tree;             \
  static constexpr auto refit = of##_refit;                           \
  static constexpr auto set_triangle_masks = of##_set_triangle_masks; \
  static constexpr auto place = of##_place;                           \
  static constexpr auto move = of##_move;                             \
  static constexpr auto set_mask = of##_set_mask;                     \
  static constexpr auto set_moving = of##_set_moving;                 \
  static constexpr auto update = of##_update;                         \
  static constexpr auto bytes = of##_bytes;                           \
  static constexpr auto geometry_of = of##_geometry_of;               \
  static constexpr auto transform_of = of##_transform_of;             \
  static constexpr auto mask_of = of##_mask_of;                       \
  static constexpr auto levels_of = of##_levels_of;                   \
  static constexpr auto describe = of##_describe;                     \
  static constexpr auto normals = of##_normals;                       \
  static constexpr auto corners = of##_corners;                       \
  static constexpr auto innermost_parts = of##_innermost_parts;       \
  static constexpr auto containing_parts = of##_containing_parts
// Names of functions and types; for doubles they have a d.
#define RAYLANES_CALLS_OF(AnyNumber, TreeOfNumber, d, D)                     \
  template <>                                                                \
  struct CallsOf<AnyNumber> {                                                \
    using Number = AnyNumber;                                                \
    using Tree = TreeOfNumber;                                               \
    using Trace = TraceOptions##D;                                           \
    using Closest = ClosestPointOptions##D;                                  \
    using ClosestPoint = raylanes::ClosestPoint##D;                          \
    using Distances = SignedDistanceOptions##D;                              \
    using CRay = raylanes_ray##d;                                            \
    using Corners = Triangle##D;                                             \
    using CHit = raylanes_hit##d;                                            \
    RAYLANES_SHARED_CALLS(raylanes_bvh##d);                                  \
    RAYLANES_FILE_CALLS(raylanes_bvh##d);                                    \
    static constexpr auto create = raylanes_bvh##d##_create;                 \
    static constexpr auto refit = raylanes_bvh##d##_refit;                   \
    using Calls = raylanes_bvh##d##_calls;                                   \
    static constexpr auto calls_create = raylanes_bvh##d##_calls_create;     \
    static constexpr auto calls_destroy = raylanes_bvh##d##_calls_destroy;   \
    static constexpr auto calls_closest = raylanes_bvh##d##_calls_closest;   \
    static constexpr auto calls_occluded = raylanes_bvh##d##_calls_occluded; \
    static constexpr auto corners = raylanes_bvh##d##_corners;               \
  }
RAYLANES_CALLS_OF(float, Bvh, , );
RAYLANES_CALLS_OF(double, BvhD, d, D);
template <>
struct CallsOf<Scene> {
  using Number = float;
  using Tree = Scene;
  using Trace = TraceOptions;
  using Closest = ClosestPointOptions;
  using ClosestPoint = SceneClosestPoint;
  using Distances = SignedDistanceOptions;
  using CRay = raylanes_ray;
  using CHit = raylanes_scene_hit;
  using PlaceBy = Transform;
  using Corners = Triangle;
  RAYLANES_SHARED_CALLS(raylanes_scene);
  RAYLANES_FILE_CALLS(raylanes_scene);
  RAYLANES_SCENE_CALLS(raylanes_scene);
};
template <>
struct CallsOf<SceneD> {
  using Number = double;
  using Tree = SceneD;
  using Trace = TraceOptionsD;
  using Closest = ClosestPointOptionsD;
  using ClosestPoint = SceneClosestPointD;
  using Distances = SignedDistanceOptionsD;
  using CRay = raylanes_rayd;
  using CHit = raylanes_scene_hit_d;
  using PlaceBy = TransformD;
  using Corners = TriangleD;
  RAYLANES_SHARED_CALLS(raylanes_scene_d);
  RAYLANES_FILE_CALLS(raylanes_scene_d);
  RAYLANES_SCENE_CALLS(raylanes_scene_d);
};
#undef RAYLANES_CALLS_OF
#undef RAYLANES_SHARED_CALLS
#undef RAYLANES_FILE_CALLS
#undef RAYLANES_SCENE_CALLS

template <class Kind>
using NumberOfKind = typename CallsOf<Kind>::Number;
template <class Kind>
using HitOfKind = typename CallsOf<Kind>::Tree::Hit;

template <class Kind>
struct Destroy {
  void operator()(typename CallsOf<Kind>::Handle* tree) const { CallsOf<Kind>::destroy(tree); }
};
// A tree or scene of C; null if the call that made it failed.
template <class Kind>
using TreeOfC = std::unique_ptr<typename CallsOf<Kind>::Handle, Destroy<Kind>>;

struct DestroyLists {
  void operator()(raylanes_lists* lists) const { raylanes_lists_destroy(lists); }
};
using ListsOfC = std::unique_ptr<raylanes_lists, DestroyLists>;

// The call's tree or lists, owned. `call` takes the address that C writes to.
template <class Owner, class Call>
Owner made(const Call& call) {
  typename Owner::pointer address = nullptr;
  call(&address);
  return Owner(address);
}

inline raylanes_ray_options default_ray_options() {
  raylanes_ray_options options;
  raylanes_init_ray_options(&options, sizeof options);
  return options;
}
inline raylanes_point_options default_point_options() {
  raylanes_point_options options;
  raylanes_init_point_options(&options, sizeof options);
  return options;
}

// A filter of both, that rejects about a half of the hits, by primitive and ray.
template <class AnyHit>
bool is_rejected(std::size_t ray, const AnyHit& hit) {
  return (hit.primitive * 5 + ray) % 7 < 3;
}
template <class AnyHit>
int32_t reject_in_c(void*, std::size_t count, const std::size_t* rays, const void* hits,
                    std::uint8_t* rejected) {
  for (std::size_t k = 0; k < count; ++k)
    rejected[k] = is_rejected(rays[k], static_cast<const AnyHit*>(hits)[k]) ? 1 : 0;
  return 0;
}
template <class AnyHit>
void reject_in_cpp(std::span<const std::size_t> rays, std::span<const AnyHit> hits,
                   std::span<std::uint8_t> rejected) {
  for (std::size_t k = 0; k < rays.size(); ++k) rejected[k] = is_rejected(rays[k], hits[k]) ? 1 : 0;
}

}  // namespace raylanes::testing

// The C functions of trees by the kind of their numbers, for tests that serve floats and doubles.
#pragma once

#include <raylanes/raylanes.h>

#include <memory>

#include <raylanes/doubles.hpp>

namespace raylanes::testing {

template <class Number>
struct CallsOf;
// Names of functions and types; for doubles they have a d.
#define RAYLANES_CALLS_OF(Number, TreeOfNumber, d, D)                              \
  template <>                                                                      \
  struct CallsOf<Number> {                                                         \
    using Handle = raylanes_bvh##d;                                                \
    using Tree = TreeOfNumber;                                                     \
    using Trace = TraceOptions##D;                                                 \
    using Closest = ClosestPointOptions##D;                                        \
    using Distances = SignedDistanceOptions##D;                                    \
    using CRay = raylanes_ray##d;                                                  \
    using Corners = Triangle##D;                                                   \
    using CHit = raylanes_hit##d;                                                  \
    using CCrossing = raylanes_crossing##d;                                        \
    using CClosestPoint = raylanes_closest_point##d;                               \
    static constexpr auto create = raylanes_bvh##d##_create;                       \
    static constexpr auto refit = raylanes_bvh##d##_refit;                         \
    static constexpr auto destroy = raylanes_bvh##d##_destroy;                     \
    static constexpr auto save = raylanes_bvh##d##_save;                           \
    static constexpr auto save_file = raylanes_bvh##d##_save_file;                 \
    static constexpr auto load = raylanes_bvh##d##_load;                           \
    static constexpr auto load_file = raylanes_bvh##d##_load_file;                 \
    static constexpr auto closest = raylanes_bvh##d##_closest;                     \
    static constexpr auto occluded = raylanes_bvh##d##_occluded;                   \
    static constexpr auto closest1 = raylanes_bvh##d##_closest1;                   \
    static constexpr auto occluded1 = raylanes_bvh##d##_occluded1;                 \
    using Calls = raylanes_bvh##d##_calls;                                         \
    static constexpr auto calls_create = raylanes_bvh##d##_calls_create;           \
    static constexpr auto calls_destroy = raylanes_bvh##d##_calls_destroy;         \
    static constexpr auto calls_closest = raylanes_bvh##d##_calls_closest;         \
    static constexpr auto calls_occluded = raylanes_bvh##d##_calls_occluded;       \
    static constexpr auto occluded_from = raylanes_bvh##d##_occluded_from;         \
    static constexpr auto occluded_towards = raylanes_bvh##d##_occluded_towards;   \
    static constexpr auto closest_crossing = raylanes_bvh##d##_closest_crossing;   \
    static constexpr auto closest_crossing1 = raylanes_bvh##d##_closest_crossing1; \
    static constexpr auto count_crossings = raylanes_bvh##d##_count_crossings;     \
    static constexpr auto corners = raylanes_bvh##d##_corners;                     \
    static constexpr auto bounds = raylanes_bvh##d##_bounds;                       \
    static constexpr auto all_hits = raylanes_bvh##d##_all_hits;                   \
    static constexpr auto crossings = raylanes_bvh##d##_crossings;                 \
    static constexpr auto locate = raylanes_bvh##d##_locate;                       \
    static constexpr auto closest_points = raylanes_bvh##d##_closest_points;       \
    static constexpr auto signed_distances = raylanes_bvh##d##_signed_distances;   \
    static constexpr auto winding_numbers = raylanes_bvh##d##_winding_numbers;     \
  }
RAYLANES_CALLS_OF(float, Bvh, , );
RAYLANES_CALLS_OF(double, BvhD, d, D);
#undef RAYLANES_CALLS_OF

template <class Number>
struct Destroy {
  void operator()(typename CallsOf<Number>::Handle* tree) const { CallsOf<Number>::destroy(tree); }
};
// A tree of C; null if the call that made it failed.
template <class Number>
using TreeOfC = std::unique_ptr<typename CallsOf<Number>::Handle, Destroy<Number>>;

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

}  // namespace raylanes::testing

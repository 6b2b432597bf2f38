// The C functions of trees by the kind of their numbers, for tests that serve floats and doubles.
#pragma once

#include <raylanes/raylanes.h>

#include <memory>

#include <raylanes/doubles.hpp>

namespace raylanes::testing {

template <class Number>
struct CallsOf;
template <>
struct CallsOf<float> {
  using Handle = raylanes_bvh;
  using Tree = Bvh;
  using CCrossing = raylanes_crossing;
  using CClosestPoint = raylanes_closest_point;
  static constexpr auto create = raylanes_bvh_create;
  static constexpr auto refit = raylanes_bvh_refit;
  static constexpr auto destroy = raylanes_bvh_destroy;
  static constexpr auto save = raylanes_bvh_save;
  static constexpr auto save_file = raylanes_bvh_save_file;
  static constexpr auto load = raylanes_bvh_load;
  static constexpr auto load_file = raylanes_bvh_load_file;
  static constexpr auto closest = raylanes_bvh_closest;
  static constexpr auto occluded = raylanes_bvh_occluded;
  static constexpr auto closest1 = raylanes_bvh_closest1;
  static constexpr auto occluded1 = raylanes_bvh_occluded1;
  static constexpr auto closest_crossing = raylanes_bvh_closest_crossing;
  static constexpr auto all_hits = raylanes_bvh_all_hits;
  static constexpr auto crossings = raylanes_bvh_crossings;
  static constexpr auto locate = raylanes_bvh_locate;
  static constexpr auto closest_points = raylanes_bvh_closest_points;
  static constexpr auto signed_distances = raylanes_bvh_signed_distances;
  static constexpr auto winding_numbers = raylanes_bvh_winding_numbers;
};
template <>
struct CallsOf<double> {
  using Handle = raylanes_bvhd;
  using Tree = BvhD;
  using CCrossing = raylanes_crossingd;
  using CClosestPoint = raylanes_closest_pointd;
  static constexpr auto create = raylanes_bvhd_create;
  static constexpr auto refit = raylanes_bvhd_refit;
  static constexpr auto destroy = raylanes_bvhd_destroy;
  static constexpr auto save = raylanes_bvhd_save;
  static constexpr auto save_file = raylanes_bvhd_save_file;
  static constexpr auto load = raylanes_bvhd_load;
  static constexpr auto load_file = raylanes_bvhd_load_file;
  static constexpr auto closest = raylanes_bvhd_closest;
  static constexpr auto occluded = raylanes_bvhd_occluded;
  static constexpr auto closest1 = raylanes_bvhd_closest1;
  static constexpr auto occluded1 = raylanes_bvhd_occluded1;
  static constexpr auto closest_crossing = raylanes_bvhd_closest_crossing;
  static constexpr auto all_hits = raylanes_bvhd_all_hits;
  static constexpr auto crossings = raylanes_bvhd_crossings;
  static constexpr auto locate = raylanes_bvhd_locate;
  static constexpr auto closest_points = raylanes_bvhd_closest_points;
  static constexpr auto signed_distances = raylanes_bvhd_signed_distances;
  static constexpr auto winding_numbers = raylanes_bvhd_winding_numbers;
};

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

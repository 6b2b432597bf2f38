// The objects that C holds by their addresses.
#pragma once

#include <raylanes/raylanes.h>

#include <raylanes/doubles.hpp>
#include <raylanes/scene_d.hpp>

#include "../standard.hpp"

namespace raylanes::c {

// A primitive of the caller, tested by a function of C.
struct OwnTest {
  raylanes_primitive_test function;
  void* context;
  bool operator()(std::uint32_t primitive, const Ray& ray, Hit& hit) const {
    raylanes_ray of_c;
    raylanes_hit found;
    std::memcpy(&of_c, &ray, sizeof of_c);
    std::memcpy(&found, &hit, sizeof found);
    if (function(context, primitive, &of_c, &found) == 0) return false;
    hit.t = found.t, hit.u = found.u, hit.v = found.v;
    return true;
  }
};

}  // namespace raylanes::c

// Scenes share the tree. A refit changes it in place if no scene has it.
struct raylanes_bvh {
  std::shared_ptr<raylanes::Bvh> object;
};
struct raylanes_bvhd {
  std::shared_ptr<raylanes::BvhD> object;
};
struct raylanes_scene {
  std::shared_ptr<raylanes::Scene> object;
  // Tests of the scene, of what it is a copy of, and of geometries that were replaced.
  std::vector<std::shared_ptr<raylanes::c::OwnTest>> tests = {};
};
struct raylanes_scene_d {
  std::shared_ptr<raylanes::SceneD> object;
};

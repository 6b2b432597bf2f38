// Scenes: what their caller attaches, and what a commit builds of it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <raylanes/raylanes.hpp>

#include "geometry.hpp"

namespace embree {

// An enabled geometry of a built scene.
struct Part {
  Ref<Geometry> geometry;
  unsigned id;
};

// A triangle of a mesh, by its index in the tree: what a hit needs besides t, u and v. Half a cache line.
struct alignas(32) Face {
  enum class Half : std::uint32_t { none, first, second };  // of a quad: v0 v1 v3, then v2 v3 v1

  float normal[3];
  std::uint32_t part, primitive;
  Half half;
  std::uint16_t x, y;           // of a grid: the quad
  std::uint16_t width, height;  // quads in a row and in a column; 0: no grid
};

struct Built;

// A primitive other than a triangle: a user primitive, a sphere or disc, or an instance.
struct Thing {
  std::uint32_t part, primitive;
  const Built* instanced;
};

// An instance in `placed`: of the meshes, or of another scene.
struct Placement {
  const Built* of;
  unsigned id;
};

// One tree of all triangles, and one of the boxes of all things. Instances of scenes that have meshes alone are in
// a raylanes::Scene besides, where rays walk through them without callbacks.
struct Built {
  Ref<Device> device;
  std::vector<Part> parts;
  std::shared_ptr<raylanes::Bvh> mesh = std::make_shared<raylanes::Bvh>();
  std::vector<Face> faces;
  std::optional<raylanes::RayCalls<raylanes::TriangleTree>> calls;  // of `mesh`
  // Whether no mesh has a filter, and all of them have the mask `mesh_mask`.
  bool is_plain_mesh = true;
  bool has_mesh_alone = true;  // whether there is nothing besides either
  unsigned mesh_mask = ~0u;

  raylanes::Scene placed;             // the meshes and the placed instances, if `is_plain_mesh`
  std::vector<Placement> placements;  // by instance of `placed`
  bool has_placed_instances = false;
  bool is_unmasked = true;  // whether all masks in `placed` have all bits

  std::vector<Thing> things;         // placed instances come last
  std::vector<raylanes::Box> boxes;  // of `things`
  std::size_t other_count = 0;       // things before the placed instances
  raylanes::BoundedTree others;
  raylanes::BoundedTree others_and_placed;  // empty if nothing is placed
  // For point queries: a tree whose nodes can be read, of triangles with the boxes of all things. Made by the first.
  mutable std::once_flag is_box_tree_made;
  mutable raylanes::Bvh box_tree;

  std::vector<std::shared_ptr<const Built>> instanced;  // what things and placements refer to
  bool is_robust = false;                               // the scene's flag
  bool asks_context = false, may_ask_context = false;   // the scene's flag; also of placed scenes
  raylanes::Box bounds;
  std::ptrdiff_t bytes = 0;

  Built();
  ~Built();
  Built(const Built&) = delete;
  Built& operator=(const Built&) = delete;

  const raylanes::BoundedTree& tree_of_all() const {
    return has_placed_instances ? others_and_placed : others;
  }
};

struct Scene : Counted {
  Ref<Device> device;
  std::mutex lock;
  std::map<unsigned, Ref<Geometry>> geometries;  // by id
  std::map<unsigned, std::pair<unsigned, const Built*>> built_versions;
  RTCSceneFlags flags = RTC_SCENE_FLAG_NONE;
  RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
  bool is_modified = true;
  RTCProgressMonitorFunction progress = nullptr;
  void* progress_user = nullptr;
  std::shared_ptr<const Built> built = std::make_shared<Built>();

  explicit Scene(Device& of_device) : device(&of_device) {}
  void commit();

 private:
  // The changes since the last commit: none, positions alone, or more.
  enum class Change { none, refit, more };
  Change change() const;
};

inline bool is_empty(const raylanes::Box& box) {
  return !(box.lo[0] <= box.hi[0] && box.lo[1] <= box.hi[1] && box.lo[2] <= box.hi[2]);
}

}  // namespace embree

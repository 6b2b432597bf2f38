// Scenes in Embree's interface: meshes in one geometry or many, instances, filters, spheres and user geometries.
#pragma once

#include <embree3/rtcore.h>

#include "../support/scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

// A mesh as buffers that geometries share: behind the vertices is one more, as Embree reads beyond the last.
struct SharedMesh {
  std::vector<Float3> vertices;
  std::vector<Index3> triangles;

  explicit SharedMesh(const Mesh& mesh);
};

// A scene, released when it goes.
using EmbreeScene = std::unique_ptr<RTCSceneTy, void (*)(RTCScene)>;

// The geometry of triangles [first, first + count). Meshes and balls must outlive what is made of them.
RTCGeometry triangles_of(RTCDevice device, SharedMesh& mesh, std::size_t first, std::size_t count);
// Attaches a geometry to a scene, and releases it.
void attach(RTCScene scene, RTCGeometry geometry);

// The mesh as so many geometries that share its vertices. They may be refitted if `are_dynamic`.
EmbreeScene scene_of_meshes(RTCDevice device, SharedMesh& mesh, std::size_t parts, RTCSceneFlags flags,
                            bool are_dynamic = false);
// As many instances of a scene as a cube of `side` has cells, one in each cell of the bounds.
EmbreeScene scene_of_instances(RTCDevice device, RTCScene inner, const Box& bounds, std::size_t side);
// The mesh with a filter of nearest hits and of occlusion.
EmbreeScene scene_of_filter(RTCDevice device, SharedMesh& mesh, RTCFilterFunctionN filter);
// Rejects nothing; rejects triangles of odd index.
void keep_all(const RTCFilterFunctionNArguments* arguments);
void reject_odd(const RTCFilterFunctionNArguments* arguments);

// Balls, each as x, y, z and radius: as spheres of the library, or as user geometries tested by code of the program.
using Balls = std::vector<std::array<float, 4>>;
Balls balls_in(const Box& bounds, std::size_t count);
EmbreeScene scene_of_spheres(RTCDevice device, Balls& balls);
EmbreeScene scene_of_user_balls(RTCDevice device, Balls& balls);

}  // namespace raylanes::bench

// The interface of geometries to a scene: bounds, tracing, and their part of a file. A new kind is a file that
// derives from Geometry, with the members of Scene that take it, and a row in scene_file.cpp.
#pragma once

#include <iosfwd>

#include <raylanes/scene.hpp>

#include "../../dispatch/table/queries.hpp"
#include "../batch/routing.hpp"
#include "visits.hpp"

namespace raylanes {

// The query that all rays of a batch share.
struct GeometryQuery {
  TriangleTest test;
  TraversalChoice choice;
  const KernelTable& kernels;

  const QueryKernels& queries() const {
    return choice.counters != nullptr ? kernels.queries.counted : kernels.queries.plain;
  }
};

// The record of a geometry in a file: one of the kinds of scene_file.cpp, and how many spheres.
struct GeometryRecord {
  std::uint32_t kind, spheres;
};
enum GeometryKind : std::uint32_t { triangle_geometry, sphere_geometry, nested_scene };

struct Instance;
template <class AnyInstance>
class NestedInstances;

class Geometry {
 public:
  virtual ~Geometry() = default;
  // The bounds of all that can be hit. Hits may lie outside by a share of the largest coordinate of a ray's origin.
  virtual Box bounds() const = 0;
  virtual float slack() const { return 0.0f; }
  // Its tree of triangles, which a mesh builds at the first call; null if it has no triangles. Any thread may call it.
  virtual const Bvh* triangles() const { return nullptr; }
  // The same, built on several threads.
  virtual const Bvh* built(int) const { return triangles(); }
  // These are known without a tree: the number of triangles, their corners as nine numbers each, and how a tree is
  // built. Corners of triangles that nothing hits may stay as they are.
  virtual std::size_t mesh_triangles() const { return 0; }
  virtual void put_corners(float*) const {}
  virtual BuildOptions build_options() const { return {}; }
  virtual bool has_tree() const { return true; }
  // The corners of a triangle of a mesh without a tree; false if there is none of this number, or a tree.
  virtual bool find_corners(std::uint32_t, Triangle&) const { return false; }
  // The volume that its triangles enclose, as Scene::containing_parts() says, without the transform. Any thread may
  // call it.
  double volume() const;
  // The same if it is a scene; else null.
  virtual const NestedInstances<Instance>* nested() const { return nullptr; }
  // Throws std::invalid_argument if it cannot be asked with these options.
  virtual void require(const TraceOptions&) const {}
  // Whether the numbers of a hit depend on where rays end: then the rays keep their own ends, and batch.tmax has the
  // limit.
  virtual bool keeps_ends() const { return false; }
  // Traces on this thread and sets all results.
  virtual void trace(const GeometryQuery& query, const GeometryBatch& batch) const = 0;
  // Appends its spheres, or throws std::invalid_argument if no file can hold it. `number` is its own in the scene.
  virtual GeometryRecord record(std::size_t number, std::vector<Sphere>& spheres) const = 0;
  // Writes the part of the file behind its tables.
  virtual void save(std::ostream&) const {}

  // Whether a copy of the scene has it, too. Then nothing changes it: a refit makes another geometry.
  std::atomic<bool> is_shared{false};

 protected:
  void forget_volume() { volume_ = -1.0; }

 private:
  mutable std::atomic<double> volume_{-1.0};  // negative: not known yet
};

std::unique_ptr<Geometry> geometry_of_triangles(std::shared_ptr<const Bvh> tree);
// From the spheres of its record and from what save() wrote. Throw as Scene::load.
std::unique_ptr<Geometry> load_triangles(std::span<const Sphere> spheres, std::istream& file);
std::unique_ptr<Geometry> load_spheres(std::span<const Sphere> spheres, std::istream& file);

}  // namespace raylanes

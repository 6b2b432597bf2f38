// The queries of points, once for trees of floats and doubles and for scenes: closest points, inside and outside,
// distances.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <span>

#include <raylanes/numbers.hpp>
#include <raylanes/queries.hpp>

namespace raylanes {

/// The queries of points of Bvh, KdTree, BvhD, Scene and SceneD. Points, results and views have the numbers of the
/// class: doubles for BvhD and SceneD, else floats. Views, active elements, threads, paths and exceptions are as in
/// RayQueries; after std::bad_alloc the object is unchanged.
/// A scene answers of the instances that options.mask sees and that can be hit, as Scene says. All calls then throw
/// std::invalid_argument if one of these has spheres or primitives of your own, and std::logic_error if the scene was
/// changed without update().
template <class Tree>
class PointQueries {
  using Number = typename detail::QueryTypes<Tree>::Number;
  using Closest = typename detail::QueryTypes<Tree>::ClosestPoint;
  using ClosestOptions = typename detail::QueryTypes<Tree>::ClosestOptions;
  using DistanceOptions = typename detail::QueryTypes<Tree>::DistanceOptions;

 public:
  /// Returns the closest point of the triangles; ties in distance go to the lowest primitive index, in scenes to the
  /// lowest instance first. ClosestPoint, ClosestPointD, SceneClosestPoint and SceneClosestPointD have the error
  /// bounds. The bytes do not depend on ISA path, tree, builder or threads.
  /// Triangles with two equal corners are ignored. If the point is not finite, there is no closest point.
  /// Throws std::invalid_argument if the thread count is negative, the path is not supported here, or counters are
  /// asked for in a build without them.
  Closest closest_point(const PointOf<Number>& point, const ClosestOptions& options) const;
  /// Returns the closest point, however far, on the active path. Throws as active_path() does.
  Closest closest_point(const PointOf<Number>& point) const;
  /// Finds the closest point of each of many points: closest[i] belongs to points[i].
  /// Inactive points leave their result unchanged. Fastest if neighbours in the batch are neighbours in space. Throws
  /// what closest_point() throws, and std::invalid_argument, before writing anything, if closest.size() is not
  /// points.count, points and closest overlap, or a view of some points is null. On several threads, and in scenes,
  /// std::bad_alloc may leave some results written.
  void closest_points(VertexRecords<Number> points, std::span<Closest> closest,
                      const ClosestOptions& options = {}) const;

  /// Finds out whether each point is inside, outside or on the surface, exactly: locations[i] belongs to points[i].
  /// The mesh should be closed: each edge with as many triangles in one direction as in the other. For other meshes
  /// InsideRule::winding is meant. By `parity` and `nonzero` a location depends there on the direction of the point's
  /// ray, which goes to the nearest side of bounds(). If a point differs from the active point before or after
  /// it along one axis only, as in a grid, its ray goes up this axis. Rows of four such points or more share one ray,
  /// and are several times as fast. Points that are not finite are outside. Inactive points are not read, and leave
  /// their location unchanged.
  /// In scenes a point is inside if it is inside an instance, on the surface if it is on that of an instance and inside
  /// none, else outside. The geometry of each instance decides in its own space, where the point goes as rays do: by
  /// the inverse of the transform, in doubles, rounded once to floats. Scene::containing_parts() names the instances.
  void locate(VertexRecords<Number> points, std::span<Location> locations,
              const LocateOptions& options = {}) const;
  /// Computes the generalised winding number of each point: numbers[i] belongs to points[i]. It is the sum of the solid
  /// angles of all triangles, seen from the point, over 4π; 1 inside a closed mesh whose normals point out (Jacobson et
  /// al. 2013). Any mesh has it: with holes, faces turned over, in several copies, with triangles that share nothing.
  /// It is computed as the signed crossings of a ray, exactly, and an integral over the boundary: the edges that have
  /// more triangles in one direction than in the other, by positions. Closed meshes have whole numbers.
  /// The error is at most options.accuracy + ε·|w| + 2^-40·n, with n edges of the boundary and ε = 2^-24, of doubles
  /// 2^-53: docs/winding.md. Numbers below 2^-100 in size become 0.
  /// Crossings at the point itself count half: on a triangle the number is the mean of both sides. On an edge it is one
  /// of the values around. Points that are not finite have 0. Inactive points leave their number unchanged.
  /// The first call finds the boundary, in time and memory like a build's; the tree keeps it until refit().
  /// The bytes do not depend on ISA path, tree, builder or threads. Rows of a grid share rays: there the last bits
  /// depend on the row's direction. Throws as locate() does, and std::invalid_argument if the accuracy is negative or
  /// NaN, or the tree has 2^30 triangles or more. std::bad_alloc may leave some numbers written.
  /// In scenes it is the sum of the numbers of all instances, each in its own space: of closed meshes whose normals
  /// point out, how many instances contain the point, mirrored ones too. Each call asks all instances about all points.
  void winding_numbers(VertexRecords<Number> points, std::span<Number> numbers,
                       const WindingOptions& options = {}) const;
  /// Computes how far each point is from the surface, negative inside: distances[i] belongs to points[i].
  /// The sign is exact, as locate() finds it by the same rule: the distance is 0 if and only if the point is on a
  /// triangle, and otherwise at least the smallest normal number in size. The size is the distance of closest_points(),
  /// rounded to the number, at most its largest. It is infinite if nothing is within max_distance, the mesh is empty,
  /// or the point is not finite. Throws as locate() and closest_points() do; std::bad_alloc may leave some distances
  /// written.
  /// In scenes the size is the distance to the nearest surface of an instance, also if that is within another instance.
  /// It is negative inside an instance, and 0 on the surface of one, even within another.
  void signed_distances(VertexRecords<Number> points, std::span<Number> distances,
                        const DistanceOptions& options = {}) const;

 protected:
  PointQueries() = default;

 private:
  const Tree& self() const { return static_cast<const Tree&>(*this); }
};

}  // namespace raylanes

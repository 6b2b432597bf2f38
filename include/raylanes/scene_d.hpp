// Scenes of parts in doubles: meshes, each placed any number of times. docs/scenes.md has an example.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <raylanes/doubles.hpp>
#include <raylanes/scene.hpp>

namespace raylanes {

/// An affine map in double precision from the space of a geometry to that of the scene; otherwise as Transform.
struct TransformD {
  double row[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

/// A hit in a scene of doubles: a HitD, and what was hit. A miss has no_primitive and no_part; a default-constructed
/// hit is a miss.
struct SceneHitD {
  double t = std::numeric_limits<double>::infinity();
  double u = 0;
  double v = 0;
  std::uint32_t primitive = no_primitive;  ///< index within its geometry
  std::uint32_t geometry = no_part;
  std::uint32_t instance = no_part;
  std::uint32_t unused = 0;  ///< always 0

  /// Returns whether this is a hit.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(SceneHitD) == 40);

/// A view of hits in scenes of doubles to write.
using SceneHitViewD = HitRecords<SceneHitD>;
/// A filter of hits in scenes of doubles.
using SceneHitFilterD = HitFilterOf<SceneHitD>;

/// A crossing of a ray and the surface of an instance in double precision; otherwise as SceneCrossing.
struct SceneCrossingD : CrossingD {
  std::uint32_t geometry, instance;  ///< of the scene, as in SceneHitD

  bool operator==(const SceneCrossingD&) const = default;
};

/// The point of a scene's triangles that is closest to a query point in double precision: (1-u-v)·v0 + u·v1 + v·v2 of
/// the triangle `primitive` of an instance. Distances and point are in the space of the scene. If there is none, both
/// distances are +infinity, point, u and v are zeros, and the indices are no_primitive and no_part; so is
/// a default-constructed one. Ties in distance_squared go to the smaller distance, then to the lowest instance, then to
/// the lowest primitive.
///
/// The corners of an instance's triangle are moved to the scene by ((a·x + b·y) + c·z) + d, as SceneClosestPoint says;
/// with the identity they stay as they are. For the triangle with these corners both distances and the point have the
/// bounds of ClosestPointD, with 2^-1000·C² for 2^-1400·C².
struct SceneClosestPointD {
  double distance_squared = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::infinity();
  Double3 point{};
  double u = 0;
  double v = 0;
  std::uint32_t primitive = no_primitive;  ///< index within its geometry
  std::uint32_t geometry = no_part;
  std::uint32_t instance = no_part;
  std::uint32_t unused = 0;  ///< always 0

  /// Returns whether there is a closest point.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(SceneClosestPointD) == 72);

class SceneD;
namespace detail {
template <>
struct QueryTypes<SceneD> {
  using Number = double;
  using Hit = SceneHitD;
  using Options = TraceOptionsD;
  using Crossing = SceneCrossingD;
  using ClosestPoint = SceneClosestPointD;
  using ClosestOptions = ClosestPointOptionsD;
  using DistanceOptions = SignedDistanceOptionsD;
};
template <class Hits>
concept HitsOfDoubleTrees = std::convertible_to<Hits, HitViewD> && !std::convertible_to<Hits, SceneHitViewD>;
template <class Tree>
concept TreeOfFloats = std::derived_from<Tree, TriangleTree> || std::same_as<Tree, std::shared_ptr<Bvh>> ||
    std::same_as<Tree, std::shared_ptr<const Bvh>>;
}  // namespace detail

/// Geometries of triangles whose corners are doubles, and instances that place them. Both are numbered from 0, in the
/// order in which they are added.
/// Call update() after any change, before the next query. Many threads may query one object at the same time, but not
/// during a change. Without instances nothing is hit.
///
/// A ray is moved to the space of an instance by the inverse of its transform: R·(origin − b) and R·direction, with b
/// the translation and R the inverse of the matrix. R, the difference and the products are computed as pairs of
/// doubles, with twice the digits, and each coordinate is rounded once to double. It differs from the exact coordinate
/// by at most 2^-53 of its size, 2^-95 of the sizes of what it is summed from, and 2^-1000. So large coordinates cancel
/// without a loss. The direction is not normalised, so t is the same in both spaces. The geometry then decides as a
/// BvhD does, by exact arithmetic on the doubles of that ray.
/// Hits are ordered by t, then instance, then primitive. Results have the same bytes on every ISA path and for any
/// number of threads. An instance with the identity has the hits of its tree.
///
/// The following instances are never hit:
/// - instances whose mask has no bit in common with the mask of the call;
/// - instances of an empty geometry;
/// - instances whose transform has a number that is not finite;
/// - instances whose transform is singular to doubles: |determinant| <= 2^-48 times the sum of its six terms' sizes, or
///   less than 2^-900 times the cube of the largest entry;
/// - instances whose inverse, or whose corners in the scene, reach beyond the largest double;
/// - instances of scenes: those that belong to them are hit.
///
/// A ray misses an instance if its origin or direction is not finite there. It also misses an instance if its direction
/// is below 2^-900 there, unless the instance's transform is the identity.
///
/// Meshes that stand where they were made are traced as one tree, as fast as one BvhD of them. The call update() builds
/// this common tree over the triangles of the instances whose transform is the identity. If their masks differ, each
/// mask has a tree, up to four trees, for the masks of most triangles. A tree is built again if its instances, or their
/// geometries, have changed since the last update(); set_moving() keeps an instance out. A tree of one instance is that
/// of its geometry, and costs nothing. Common trees take the time and the memory of a BvhD of their triangles, besides
/// geometries. Results do not depend on them. Rays go through other instances individually, nearest first.
class SceneD : public SurfaceQueries<SceneD>, public PointQueries<SceneD> {
 public:
  /// Makes an empty scene.
  SceneD();
  /// Copies a scene. Both share their geometries and the common trees, which a change in one of them replaces there.
  SceneD(const SceneD&);
  /// Becomes a copy, as by the constructor.
  SceneD& operator=(const SceneD&);
  ~SceneD();
  /// Moves a scene; the other one is empty afterwards, and may be used again.
  SceneD(SceneD&&) noexcept;
  SceneD& operator=(SceneD&&) noexcept;

  /// Adds a tree, which the scene owns from then on; returns the index of the geometry.
  /// Throws std::length_error for more than 2^28 geometries.
  std::uint32_t add(BvhD tree);
  /// Adds a tree that the scene shares with its other owners; nobody may change it until the scene no longer has it.
  /// Throws as add(BvhD) does, and std::invalid_argument for a null pointer.
  std::uint32_t add(std::shared_ptr<const BvhD> tree);
  /// Adds a mesh, whose tree is built at once; returns the index of the geometry. Throws as the constructor of BvhD
  /// does.
  std::uint32_t add(VertexViewD vertices, IndexView triangles, const BuildOptions& options = {});
  /// Does not compile: Scene is for trees of floats.
  template <detail::TreeOfFloats Tree>
  std::uint32_t add(const Tree&) = delete;  // of floats; a SceneD has doubles: add a BvhD, or take a Scene
  /// Adds a scene, to be placed as a whole; returns the index of the geometry. The scene is added as it is: later
  /// changes of it do not change this scene, and it needs no update(). It may place scenes itself, to any depth. It may
  /// be this scene, as it was before the call.
  /// Its geometries are shared, and follow in their order: its geometry i is geometry `returned + 1 + i` of this scene,
  /// which may be replaced, refitted, and placed by itself. Takes 108 bytes for each instance of the added scene.
  /// Throws std::length_error for more than 2^28 geometries.
  std::uint32_t add(const SceneD& scene);
  /// Replaces a geometry; its instances stay where they are. Throws std::out_of_range if there is no such geometry, and
  /// std::invalid_argument if it is a scene.
  void replace(std::uint32_t geometry, BvhD tree);
  /// Replaces a geometry by a tree that the scene shares with its other owners. Throws as add() and replace() do.
  void replace(std::uint32_t geometry, std::shared_ptr<const BvhD> tree);
  /// Refits a geometry to a moved mesh: replaces its tree by BvhD::refitted() of it. Copies of the scene, and other
  /// owners of the tree, keep it as it was. Throws as BvhD::refitted() and replace() do. Strong exception guarantee.
  void refit(std::uint32_t geometry, VertexViewD vertices, IndexView triangles, int threads = 1);
  /// Gives the triangles of a geometry masks: a call sees triangle i if masks[i] and the mask of the call have a bit in
  /// common, besides the instance's mask. Triangles from masks.size() on are always there, and an empty span takes all
  /// masks away. The scene copies them. They hold for all calls with rays, and for no calls with points. update() must
  /// follow.
  /// Instances of the geometry are in no common tree. A refit keeps the masks, replace() takes them away, and no file
  /// holds them. Throws as replace() does.
  void set_triangle_masks(std::uint32_t geometry, std::span<const std::uint32_t> masks);
  /// Returns the tree of a geometry; the empty tree if the geometry is a scene. Throws std::out_of_range if there is no
  /// such geometry. The reference is valid until the geometry is replaced or refitted or the scene is destroyed or
  /// assigned to.
  const BvhD& tree(std::uint32_t geometry) const&;
  /// Does not compile: the reference would outlive a temporary scene.
  const BvhD& tree(std::uint32_t geometry) const&& = delete;
  std::size_t geometry_count() const noexcept;  ///< the number of geometries

  /// Places a geometry; returns the index of the instance. An instance with mask 0 is never hit.
  /// If the geometry is a scene, each of its instances becomes one of this scene: instance j of the added scene is
  /// instance `returned + 1 + j`. Hits name these instances, and levels_of() their way, as in a Scene.
  /// - Its transform is the product of both levels' transforms. Pairs of doubles compute each number as
  ///   (a·x + b·y) + c·z, and add d in the translation; the result is rounded once to double. It differs from the exact
  ///   number by at most 2^-53 of its size, 2^-100 of the sizes of what it is summed from, and 2^-1000. If these sizes
  ///   add up to 2^1022 or more, it may be not finite; such an instance is never hit.
  /// - Its mask has the bits that are in the masks of both levels.
  /// Throws std::out_of_range if there is no such geometry, and std::length_error for more than 2^28 instances.
  std::uint32_t place(std::uint32_t geometry, const TransformD& transform = {}, std::uint32_t mask = ~0u);
  /// Gives an instance another transform. If it places a scene, all instances of that move. Throws std::out_of_range if
  /// there is no such instance, and std::invalid_argument if it belongs to a scene that another instance places.
  void move(std::uint32_t instance, const TransformD& transform);
  /// Gives an instance another mask, from the next update() on. Throws as move() does.
  void set_mask(std::uint32_t instance, std::uint32_t mask);
  /// Says that an instance will move, or change otherwise, so that it is in no common tree from the next update() on;
  /// or, with false, that it will no longer. Throws as move() does.
  void set_moving(std::uint32_t instance, bool moving = true);
  /// Returns the geometry of an instance. Throws std::out_of_range if there is no such instance.
  std::uint32_t geometry_of(std::uint32_t instance) const;
  /// Returns the transform of an instance. Throws as geometry_of() does.
  TransformD transform_of(std::uint32_t instance) const;
  /// Returns the mask of an instance. Throws as geometry_of() does.
  std::uint32_t mask_of(std::uint32_t instance) const;
  /// Returns the way to an instance from the outermost level in, as Scene::levels_of() does. Throws as geometry_of()
  /// does.
  std::vector<InstanceLevel> levels_of(std::uint32_t instance) const;
  std::size_t instance_count() const noexcept;  ///< the number of instances, parts of scenes among them

  /// Makes the scene ready for queries: builds the tree over the instances, and common trees where the rules of the
  /// class say so. `threads` is as in TraceOptionsD, for common trees.
  /// Throws std::invalid_argument if the thread count is negative. Strong exception guarantee: if this throws, the
  /// scene is unchanged.
  void update(int threads = 1);

  // Queries: TraceOptionsD::skip and after take hits in scenes, and TraceOptionsD::mask is of instances. Otherwise
  // options are as for Scene.

  using RayQueries<SceneD>::closest;
  /// Does not compile: hits in scenes are of the type SceneHitD, as they name an instance.
  template <class Rays, detail::HitsOfDoubleTrees Hits>
  void closest(const Rays&, Hits&&, const TraceOptionsD& = {}) const = delete;  // a scene writes SceneHitD

  /// Computes the unit normal in the scene of each hit, as Scene::normals() does. Each call visits all leaves of the
  /// geometries that are hit. Throws as Scene::normals() does.
  void normals(PrimitiveView hits, std::span<Double3> normals, int threads = 1) const;
  /// Writes the corners in the scene of the triangle of each hit, as Scene::corners() does: computed as
  /// SceneClosestPointD says. Throws as normals() does.
  void corners(PrimitiveView hits, std::span<TriangleD> triangles, int threads = 1) const;

  /// Finds the innermost instance that contains each point, as Scene::innermost_parts() does. Throws as that does.
  void innermost_parts(Points points, std::span<ContainingPart> parts,
                       const LocateOptions& options = {}) const;
  /// Returns the instances that contain each point, innermost first, as Scene::containing_parts() does. Throws as that
  /// does.
  RayLists<ContainingPart> containing_parts(Points points, const LocateOptions& options = {}) const;

  /// Writes the scene as bytes, from which load() makes a scene with the same hits on any machine. docs/tree_file.md
  /// has the format. Throws std::invalid_argument if triangles have masks, which no file holds, and std::runtime_error
  /// if the stream does not take it.
  void save(std::ostream& file) const;
  /// Returns the scene that save() wrote, as after update(), which builds the common trees. The file does not say what
  /// set_moving() said. Throws as BvhD::load() does, also for the file of a Scene.
  static SceneD load(std::istream& file);

  /// Returns a box around all that can be hit, slightly enlarged, at the last update(); lo = +infinity and
  /// hi = −infinity for an empty scene. All of space, if an instance has entries so different that nothing bounds what
  /// roundings move.
  BoxD bounds() const noexcept;
  /// Returns the bytes of the instances, the tree over them and the common trees, without geometries.
  std::size_t bytes() const noexcept;
  /// Returns what the common trees hold, as Scene::report() does.
  SceneReport report() const noexcept;

 private:
  friend struct TreeAccess;
  [[gnu::visibility("hidden")]] const struct SceneDParts& parts() const noexcept;
  [[gnu::visibility("hidden")]] SceneDParts& changed();
  std::unique_ptr<SceneDParts> parts_;  // null: moved from
};

}  // namespace raylanes

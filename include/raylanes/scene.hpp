// Scenes of parts: trees of triangles, spheres and other primitives, each placed any number of times.
// docs/scenes.md has examples and figures.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <span>
#include <vector>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/bvh.hpp>
#include <raylanes/scene_hit.hpp>
#include <raylanes/sphere_tree.hpp>

namespace raylanes {

/// An affine map from the space of a geometry to that of the scene:
/// x' = row[0][0]·x + row[0][1]·y + row[0][2]·z + row[0][3], and y' and z' by the other rows.
struct Transform {
  float row[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

/// A view of hits in scenes to write, as HitView is of hits in trees.
using SceneHitView = HitRecords<SceneHit>;
namespace detail {
template <class Hits>
concept HitsOfTrees = std::convertible_to<Hits, HitView> && !std::convertible_to<Hits, SceneHitView>;
}  // namespace detail

/// A filter of hits in scenes.
using SceneHitFilter = HitFilterOf<SceneHit>;

/// How a scene is traced, as Scene::report() says.
struct SceneReport {
  std::size_t common_trees = 0;      ///< the number of common trees
  std::size_t common_instances = 0;  ///< instances in common trees
  std::size_t common_triangles = 0;  ///< their triangles
  std::size_t common_bytes = 0;      ///< the memory of the common trees, besides the trees of geometries
  std::size_t mesh_triangles = 0;    ///< the triangles of all geometries
  std::size_t meshes_without_tree =
      0;  ///< geometries added as meshes that needed no tree of their own so far
};

/// A crossing of a ray and the surface of an instance. Its side is that in the space of the instance, so it tells entry
/// from exit where the transform is a mirror, too.
struct SceneCrossing : Crossing {
  std::uint32_t geometry, instance;  ///< of the scene, as in SceneHit

  bool operator==(const SceneCrossing&) const = default;
};

/// An instance that contains a point; of none, by default.
struct ContainingPart {
  std::uint32_t geometry = no_part;
  std::uint32_t instance = no_part;
  Location location =
      Location::outside;  ///< inside the instance, or on its surface; outside: there is no instance

  /// Returns whether there is an instance.
  explicit operator bool() const { return instance != no_part; }
  bool operator==(const ContainingPart&) const = default;
};

class Scene;
namespace detail {
template <>
struct QueryTypes<Scene> {
  using Number = float;
  using Hit = SceneHit;
  using Options = TraceOptions;
  using Crossing = SceneCrossing;
  using ClosestPoint = SceneClosestPoint;
  using ClosestOptions = ClosestPointOptions;
  using DistanceOptions = SignedDistanceOptions;
};
}  // namespace detail

/// Geometries and instances that place them. Both are numbered from 0, in the order in which they are added.
/// Call update() after any change, before the next query. Many threads may query one object at the same time, but not
/// during a change. Without instances nothing is hit.
///
/// A ray is moved to the space of an instance by the inverse of its transform. Origin and direction are computed in
/// doubles and rounded once to float; the direction is not normalised, so t is the same in both spaces. The geometry
/// then decides as it does alone, triangles by exact arithmetic on these floats.
/// Hits are ordered by t, then instance, then primitive. With TriangleTest::exact and with spheres the result has the
/// same bytes on every ISA path, in every mode, and for any number of threads. Other tests keep their own contracts. So
/// an instance with the identity has the hits of its tree.
///
/// The following instances are never hit:
/// - instances whose mask has no bit in common with the mask of the call;
/// - instances of an empty geometry;
/// - instances whose transform has a number that is not finite;
/// - instances whose transform is singular to doubles: |determinant| <= 2^-48 times the sum of its terms' sizes;
/// - instances that reach beyond the largest float;
/// - instances of scenes: those that belong to them are hit.
///
/// A ray misses an instance if its origin or direction is not finite there. It also misses an instance if its direction
/// is below 2^-126 there, unless the instance's transform is the identity.
///
/// Meshes that stand where they were made are traced as one tree, as fast as one Bvh of them. The call update() builds
/// this common tree over the triangles of the instances whose transform is the identity. If their masks differ, each
/// mask has a tree of its own, up to four trees. A ray goes through all trees that its mask sees. Results do not depend
/// on these trees. The rules keep update() short in scenes that change:
/// - A mask keeps its tree as long as instances are left in it. New trees go to the masks of most triangles. Instances
///   of further masks are traced by themselves until a tree becomes free.
/// - An instance that changes after its first update(), by move(), set_mask(), refit() or replace(), leaves its common
///   tree at the next update(), for good. Its triangles are struck out of the tree. set_mask() does so at once.
/// - A new instance is traced by itself until a quarter of its mask's tree is new or has left. Then update() builds
///   that tree again.
/// - All trees have at most twice the triangles of the geometries. Further instances are traced by themselves.
/// - set_moving() keeps an instance out, or lets it in again.
/// - A tree of one instance is that of its geometry. So an instance alone in a scene costs nothing, nor does the only
///   one of its mask that may be in a tree, if its box has a quarter of the scene's surface.
///
/// Common trees take the memory of a Bvh of their triangles, besides geometries. These need no trees of their own if
/// they are added as vertices and triangles. The build takes 48 bytes a triangle more, and uses the builder of the
/// largest geometry in the tree.
class Scene : public SurfaceQueries<Scene>, public PointQueries<Scene> {
 public:
  /// Makes an empty scene.
  Scene();
  /// Copies a scene. Both share their geometries and the common trees, so a copy takes the memory of bytes() without
  /// SceneReport::common_bytes. A change in one of them makes a tree of its own, and changes nothing in the other. Many
  /// threads may copy one object at the same time.
  Scene(const Scene&);
  /// Becomes a copy, as by the constructor.
  Scene& operator=(const Scene&);
  ~Scene();
  /// Moves a scene; the other one is empty afterwards, and may be used again.
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Adds a tree of triangles, which the scene owns from then on; returns the index of the geometry.
  /// Throws std::length_error for more than 2^28 geometries.
  std::uint32_t add(Bvh tree);
  /// Adds a mesh, which the scene copies, and whose tree is built when it is first needed; returns the index of the
  /// geometry. Instances in common trees need none, so nothing is built or stored twice: a mesh takes 12 bytes a
  /// vertex and 12 a triangle. update() builds the trees of the other instances. Otherwise the first call that needs
  /// the tree builds it on one thread: tree(), save(), closest_crossing(), set_mask() and queries after it; and
  /// locate() and its kind for points within the mesh's box. Many threads may make that call at the same time. Throws
  /// as the constructor of Bvh does.
  std::uint32_t add(VertexView vertices, IndexView triangles, const BuildOptions& options = {});
  /// Adds a mesh as its vertices and triangles.
  std::uint32_t add(const Mesh& mesh, const BuildOptions& options = {}) {
    return add(mesh.vertices, mesh.triangles, options);
  }
  /// Does not compile: scenes have floats, as Bvh has; SceneD has doubles.
  template <detail::TreeOfDoubles Tree>
  std::uint32_t add(const Tree&) = delete;  // of doubles: add a Bvh, or take a SceneD
  /// Adds spheres; returns the index of the geometry.
  std::uint32_t add(SphereTree spheres);
  /// Adds a tree that the scene shares with its other owners; nobody may change it until the scene no longer has it.
  /// A refit in the scene makes a tree of its own. Throws as add(Bvh) does, and std::invalid_argument for
  /// a null pointer.
  std::uint32_t add(std::shared_ptr<const Bvh> tree);
  /// Adds spheres that the scene shares with their other owners. Throws as add() of a shared tree.
  std::uint32_t add(std::shared_ptr<const SphereTree> spheres);
  /// Adds primitives of your own with a function that tests them; returns the index of the geometry.
  /// `visit` and what `context` points to must outlive the scene. Any thread that traces calls it, with rays in the
  /// space of the instance.
  std::uint32_t add(BoundedTree tree, LeafFunction visit, void* context);
  /// Adds primitives of your own with a test, which must outlive the scene; returns the index of the geometry.
  template <class Test>
  requires(PrimitiveTest<Test> || LeafTest<Test>) && std::is_lvalue_reference_v<Test> std::uint32_t
      add(BoundedTree tree, Test&& test) {
    return add(std::move(tree), detail::visit_with<Test>,
               const_cast<void*>(static_cast<const void*>(std::addressof(test))));
  }
  /// Adds a scene, to be placed as a whole; returns the index of the geometry. The scene is added as it is: later
  /// changes of it do not change this scene, and it needs no update(). It may place scenes itself, to any depth. It may
  /// be this scene, as it was before the call.
  /// Its geometries are shared, and follow in their order: its geometry i is geometry `returned + 1 + i` of this scene,
  /// which may be replaced, refitted, and placed by itself. Primitives of your own must outlive this scene, too.
  /// Takes 60 bytes for each instance of the added scene. Throws std::length_error for more than 2^28 geometries.
  std::uint32_t add(const Scene& scene);
  /// Replaces a geometry by a tree of triangles; its instances stay where they are. Throws std::out_of_range if there
  /// is no such geometry, and std::invalid_argument if it is a scene.
  void replace(std::uint32_t geometry, Bvh tree);
  /// Replaces a geometry by spheres; its instances stay where they are.
  void replace(std::uint32_t geometry, SphereTree spheres);
  /// Replaces a geometry by a tree that the scene shares with its other owners. Throws as add() and replace() do.
  void replace(std::uint32_t geometry, std::shared_ptr<const Bvh> tree);
  /// Replaces a geometry by spheres that the scene shares with their other owners. Throws as add() and replace() do.
  void replace(std::uint32_t geometry, std::shared_ptr<const SphereTree> spheres);
  /// Refits a geometry of triangles to a moved mesh, as Bvh::refit() does. Throws as that does, and std::out_of_range
  /// if there is no such geometry.
  void refit(std::uint32_t geometry, VertexView vertices, IndexView triangles, int threads = 1);
  /// Gives the triangles of a geometry masks: a call sees triangle i if masks[i] and the mask of the call have a bit in
  /// common, besides the instance's mask. Triangles from masks.size() on are always there, and an empty span takes all
  /// masks away. The scene copies them. They hold for all calls with rays, which take the test exact then, and for no
  /// calls with points. update() must follow.
  /// Instances of the geometry are in no common tree, and are traced by themselves in about the time of calls with
  /// TraceOptions::skip. A refit keeps the masks, replace() takes them away, and no file holds them.
  /// Throws std::out_of_range if there is no such geometry, and std::invalid_argument if it has no triangles.
  void set_triangle_masks(std::uint32_t geometry, std::span<const std::uint32_t> masks);
  /// Returns the tree of a geometry, which a mesh that was added without one builds first; null if the geometry is not
  /// one of triangles. Throws as replace() and the constructor of Bvh do.
  /// The pointer is valid until the geometry is replaced or refitted or the scene is destroyed or assigned to.
  const Bvh* tree(std::uint32_t geometry) const&;
  /// Does not compile: the pointer would outlive a temporary scene.
  const Bvh* tree(std::uint32_t geometry) const&& = delete;
  std::size_t geometry_count() const noexcept;  ///< the number of geometries

  /// Places a geometry; returns the index of the instance. An instance with mask 0 is never hit.
  /// If the geometry is a scene, each of its instances becomes one of this scene: instance j of the added scene is
  /// instance `returned + 1 + j`. Hits name these instances, and levels_of() their way. So hits are ordered by t, then
  /// by the instances of all levels from the outermost in, then by primitive.
  /// - Its transform is the product of both levels' transforms. Doubles compute each number as (a·x + b·y) + c·z, and
  ///   add d in the translation; the result is rounded once to float. So rays are moved once, whatever the depth.
  /// - Its mask has the bits that are in the masks of both levels.
  /// Each of these instances takes the memory and the time of any other instance. Common trees take those with the
  /// identity.
  /// Throws std::out_of_range if there is no such geometry, and std::length_error for more than 2^28 instances.
  std::uint32_t place(std::uint32_t geometry, const Transform& transform = {}, std::uint32_t mask = ~0u);
  /// Gives an instance another transform. If it places a scene, all instances of that move. Throws std::out_of_range if
  /// there is no such instance, and std::invalid_argument if it belongs to a scene that another instance places.
  void move(std::uint32_t instance, const Transform& transform);
  /// Gives an instance another mask, at once, without update(). If the instance is in a common tree, it is struck out
  /// and traced by itself. Such a call takes the time of an update(): 0.2 to 0.4 µs for each instance, less than
  /// a millisecond for 1,000 triangles, and the build of the geometry's tree if it has none. From the 17th such call
  /// after an update() on, rays go through each instance by itself until the next update(), which is slower. So they do
  /// after one call for an instance of a scene, if another mask takes one of that out of a common tree.
  /// Throws as move() does. Strong exception guarantee, as for update().
  void set_mask(std::uint32_t instance, std::uint32_t mask);
  /// Says that an instance will move, or change otherwise, so that it is in no common tree from the next update()
  /// on; or, with false, that it will no longer. Throws as move() does.
  void set_moving(std::uint32_t instance, bool moving = true);
  /// Returns the geometry of an instance. Throws std::out_of_range if there is no such instance.
  std::uint32_t geometry_of(std::uint32_t instance) const;
  /// Returns the transform of an instance. Throws as geometry_of() does.
  Transform transform_of(std::uint32_t instance) const;
  /// Returns the mask of an instance. Throws as geometry_of() does.
  std::uint32_t mask_of(std::uint32_t instance) const;
  /// Returns the way to an instance from the outermost level in: the instance of this scene, then that of the scene
  /// which this one places, and so on. One level if the instance belongs to no placed scene. Throws as geometry_of()
  /// does.
  std::vector<InstanceLevel> levels_of(std::uint32_t instance) const;
  std::size_t instance_count() const noexcept;  ///< the number of instances, parts of scenes among them

  /// Makes the scene ready for queries. Builds the tree over the instances again, in 0.2 to 0.4 µs for each of
  /// hundreds, or more if caches are cold. Builds common trees where the rules of the class say so, in the time of a
  /// Bvh of their triangles. An instance of 1,000 triangles is struck out of a common tree in less than a millisecond.
  /// If a copy of the scene has that tree, too, it is copied first. Large instances that overlap are opened for calls
  /// with one ray, in up to 0.5 ms.
  /// `threads` is as in TraceOptions, for common trees and the trees of meshes.
  /// Throws std::invalid_argument if the thread count is negative. Strong exception guarantee: if this throws, the
  /// scene is unchanged.
  void update(int threads = 1);

  // Queries: options apply to the triangles within geometries. TraceOptions::skip and after take hits in scenes: in
  // closest(), after[i] is the hit after which ray i looks, in the order of t, then instance, then primitive. The
  // test is exact then. A sphere has two hits, in and out: skip leaves out the one nearer to tmin. Your own primitives
  // have what their test finds, as VisitOptions::after says. TraceOptions::facing means the sides of a geometry in
  // its own space: an instance that mirrors a solid is entered at fronts, too. Scenes with spheres refuse it; the test
  // of your own primitives decides for itself. Counters include the top level. Each thread keeps its scratch memory
  // until it ends: 30 to 40 MB after batches of 131,072 rays, less after smaller ones.

  using RayQueries<Scene>::closest;
  /// Does not compile: hits in scenes are of the type SceneHit, as they name an instance.
  template <class Rays, detail::HitsOfTrees Hits>
  void closest(const Rays&, Hits&&, const TraceOptions& = {}) const = delete;  // a scene writes SceneHit
  /// Computes the unit normal in the scene of each hit: normals[i] belongs to hits[i], hits in scenes or records that
  /// name an instance and a primitive. It is normal_in_scene() of <raylanes/surface.hpp> for the
  /// unit_normal() of the triangle; NaN for misses and hits that name no triangle. `threads` is as in TraceOptions.
  /// Each call visits all leaves of the geometries that are hit, but of meshes that were added without a tree none.
  /// Throws std::invalid_argument, before writing anything, if there are not as many normals as hits, hits name no
  /// instances or a view points to nothing, or the thread count is negative.
  void normals(PrimitiveView hits, std::span<Float3> normals, int threads = 1) const;
  /// Writes the corners in the scene of the triangle of each hit: triangles[i] belongs to hits[i], which may be closest
  /// points, too. They are computed in doubles as SceneClosestPoint says, and rounded once to floats. Corners are NaN
  /// for misses and hits that name no triangle. Otherwise as normals().
  void corners(PrimitiveView hits, std::span<Triangle> triangles, int threads = 1) const;

  // Points: closest_points(), locate(), winding_numbers() and signed_distances() as PointQueries says; and which part.
  // An instance contains a point that is inside it or on its surface, as locate() of its geometry says in its space.

  /// Finds the innermost instance that contains each point: parts[i] belongs to points[i], and is no part for points
  /// that no instance contains. It is the first one of containing_parts().
  /// Inactive points leave their part unchanged. Throws as locate() does, and std::invalid_argument if there are not as
  /// many parts as points, or they overlap.
  void innermost_parts(Points points, std::span<ContainingPart> parts,
                       const LocateOptions& options = {}) const;
  /// Returns the instances that contain each point, innermost first: in the order of their volumes, then of instances.
  /// So a solid within another one comes before it, and where solids overlap the smaller one comes first. A point on
  /// a face that neighbours share is on the surface of both. The order of two instances is the same at all points.
  /// The volume of a geometry is the size of the sum of v0 · (v1 × v2) / 6 over its triangles, from the middle of their
  /// box. The volume of an instance is that times the size of the transform's determinant. The first call that needs it
  /// computes it, in doubles, in the order of primitives, with the lost digits of each sum: the same bits everywhere.
  /// Meshes that are not closed, or whose normals do not agree, have a volume, too, but it means little.
  /// Inactive points have empty lists. Throws as locate() does.
  RayLists<ContainingPart> containing_parts(Points points, const LocateOptions& options = {}) const;

  /// Writes the scene as bytes, from which load() makes a scene with the same hits on any machine. docs/tree_file.md
  /// has the format. Throws std::invalid_argument if a geometry has primitives of your own, which no file can hold, and
  /// std::runtime_error if the stream does not take it.
  void save(std::ostream& file) const;
  /// Returns the scene that save() wrote, as after update(), which builds the common tree; trees of spheres are built
  /// again. The file does not say what set_moving() said. Throws as Bvh::load().
  static Scene load(std::istream& file);

  /// Returns a box around all that can be hit, slightly enlarged, at the last update(); lo = +infinity and
  /// hi = −infinity for an empty scene.
  Box bounds() const noexcept;
  /// Returns the bytes of the instances, the tree over them and the common tree, without geometries.
  std::size_t bytes() const noexcept;
  /// Returns what the common trees hold: nothing from the 17th set_mask() of a member to the next update().
  SceneReport report() const noexcept;

 private:
  friend struct TreeAccess;
  [[gnu::visibility("hidden")]] const struct SceneParts& parts() const noexcept;
  [[gnu::visibility("hidden")]] SceneParts& changed();
  std::unique_ptr<SceneParts> parts_;  // null: moved from
};

}  // namespace raylanes

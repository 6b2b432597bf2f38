// Scenes of parts: trees of triangles, spheres and other primitives, each placed any number of times.
// docs/scenes.md has examples and figures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <limits>
#include <memory>
#include <span>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/bvh.hpp>
#include <raylanes/sphere_tree.hpp>

namespace raylanes {

// From a part's own space to the scene's: x' = row[0][0]·x + row[0][1]·y + row[0][2]·z + row[0][3], and so on.
struct Transform {
  float row[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

// A hit in a scene: as Hit, and of what. A miss, which is what a default one is, has no_primitive and no_part.
struct SceneHit {
  float t = std::numeric_limits<float>::infinity();
  float u = 0;
  float v = 0;
  std::uint32_t primitive = no_primitive;  // of its geometry
  std::uint32_t geometry = no_part;
  std::uint32_t instance = no_part;

  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(SceneHit) == 24);

// Room for such hits, as HitView has for those of trees.
using SceneHitView = HitRecords<SceneHit>;

// Geometries, numbered from 0 in the order in which they were added, and instances that place them, numbered likewise.
// Whoever changes anything calls update() before the next query. One object may be traced from many threads at a time,
// but not while it is changed. A scene without instances is hit by nothing.
//
// What a hit is: a ray goes to the space of an instance by the inverse of its transform, as doubles have it; origin and
// direction, which is not normalised, are computed in doubles and rounded once to float; then the part decides as it
// does alone: of triangles by exact arithmetic on these floats. t is the same in both spaces. Of all hits the first in
// the order of t, then of instances, then of primitives is returned: the same bytes on every path, in every mode, for
// any number of threads and any top level, with the test exact, with spheres, and with others as their own contracts
// say. So a scene of one instance with the identity has the hits of its tree; of another one it has those of the ray as
// it was rounded, 2^-24 of its coordinates in the part's space away.
//
// Never hit, and at no cost, are instances whose mask has no bit in common with that of the call; those of a geometry
// with nothing in it; those whose transform has a number that is NaN or infinite, or is singular: whose determinant is
// not above 2^-48 of the sum of its terms' sizes, where doubles do not tell it from zero; and those that reach beyond
// the largest float. A ray misses an instance where it comes out with an origin or direction that is not finite there,
// or with a direction below 2^-126.
class Scene {
 public:
  Scene();
  ~Scene();
  // A scene that was moved from is empty and may be used again.
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  // Each returns the number of the geometry, which the scene owns from then on. Throws std::length_error for more
  // than 2^28 geometries or instances. `visit` and what `context` points to outlive the scene; it is called with rays
  // in the space of the instance, from any thread that traces.
  std::uint32_t add(Bvh tree);
  std::uint32_t add(SphereTree spheres);
  std::uint32_t add(BoundedTree tree, LeafFunction visit, void* context);
  template <class Test>
  requires(PrimitiveTest<Test> || LeafTest<Test>) && std::is_lvalue_reference_v<Test> std::uint32_t
      add(BoundedTree tree, Test&& test) {
    return add(std::move(tree), detail::visit_with<Test>,
               const_cast<void*>(static_cast<const void*>(std::addressof(test))));
  }
  // Another part under the same number; instances stay where they are. Not of user's primitives: add these anew.
  void replace(std::uint32_t geometry, Bvh tree);
  void replace(std::uint32_t geometry, SphereTree spheres);
  // As Bvh::refit, of one part; the others are not looked at.
  void refit(std::uint32_t geometry, VertexView vertices, IndexView triangles, int threads = 1);
  // The tree of a geometry; null if it is of something else.
  const Bvh* tree(std::uint32_t geometry) const;
  std::size_t geometry_count() const noexcept;

  // Places a geometry; returns the number of the instance. These throw std::out_of_range for numbers that nothing has.
  std::uint32_t place(std::uint32_t geometry, const Transform& transform = {}, std::uint32_t mask = ~0u);
  void move(std::uint32_t instance, const Transform& transform);
  void set_mask(std::uint32_t instance,
                std::uint32_t mask);  // takes effect without update(); 0: as if it were not there
  std::uint32_t geometry_of(std::uint32_t instance) const;
  Transform transform_of(std::uint32_t instance) const;
  std::uint32_t mask_of(std::uint32_t instance) const;
  std::size_t instance_count() const noexcept;

  // Builds the tree over the instances anew: about a tenth of a microsecond for each; parts are not looked at, but for
  // their bounds.
  void update();

  // As of Bvh, each with the instances that have a bit of `mask`. Modes, hints and tests are for what happens within
  // parts of triangles; hits behind others (TraceOptions::after) are not offered. Counters have also what the top level
  // costs. Throws as Bvh does; std::invalid_argument also if a tree was not built for the test, std::logic_error if the
  // scene was changed without update(). Where memory runs out some answers may be there.
  // Each thread that traces keeps its scratch memory until it ends: some 30 to 40 MB after batches of 131072 rays, less
  // after smaller ones.
  SceneHit closest(const Ray& ray, const TraceOptions& options = {}, std::uint32_t mask = ~0u) const;
  bool occluded(const Ray& ray, const TraceOptions& options = {}, std::uint32_t mask = ~0u) const;
  void closest(RayView rays, SceneHitView hits, const TraceOptions& options = {},
               std::uint32_t mask = ~0u) const;
  void closest(const RayArrays& rays, SceneHitView hits, const TraceOptions& options = {},
               std::uint32_t mask = ~0u) const;
  void occluded(RayView rays, std::span<std::uint8_t> answers, const TraceOptions& options = {},
                std::uint32_t mask = ~0u) const;
  void occluded(const RayArrays& rays, std::span<std::uint8_t> answers, const TraceOptions& options = {},
                std::uint32_t mask = ~0u) const;
  /// Sets answers[i] to 1 if anything lies between `from` and points[i], else to 0: TriangleTree::occluded_from() of a
  /// scene. Leaves answers of inactive points unchanged. Throws as occluded() does.
  void occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> answers,
                     const SegmentEnds& ends = {}, const TraceOptions& options = {},
                     std::uint32_t mask = ~0u) const;

  // The scene as bytes, and back: the same hits on any machine. docs/tree_file.md has the format: trees of triangles as
  // they are, spheres (whose trees are built anew), instances. A loaded scene is as after update(). save() throws
  // std::invalid_argument if a geometry is of a user's primitives, which no file can hold, and std::runtime_error if
  // the stream does not take it; load() throws as Bvh::load.
  void save(std::ostream& file) const;
  static Scene load(std::istream& file);

  // Around what can be hit, a little larger; of an empty scene as of an empty Bvh. As of the last update().
  Box bounds() const noexcept;
  std::size_t bytes() const noexcept;  // of the instances and the tree over them; parts say theirs themselves

 private:
  [[gnu::visibility("hidden")]] const struct SceneParts& parts() const noexcept;
  [[gnu::visibility("hidden")]] SceneParts& changed();
  std::unique_ptr<SceneParts> parts_;  // null: moved from
};

}  // namespace raylanes

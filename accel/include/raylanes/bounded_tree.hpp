// Trees over anything that has a box: the library finds which rays come to which boxes, the caller tests what is in
// them. docs/scenes.md has examples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>

#include <raylanes/builders.hpp>
#include <raylanes/rays.hpp>
#include <raylanes/traversal.hpp>

namespace raylanes {

struct Path;

struct BoundedBuildOptions {
  TreeBuilder builder = TreeBuilder::binned_sah;  // spatial_splits, which cuts triangles, builds as this one
  int threads = 1;                                // as of TraceOptions
  // Primitives that a visit is for, 1 to 8. With one, each box is tested before its primitive is.
  std::uint32_t max_in_leaf = 1;
  // By how much the boxes, and what is near the rays' origins, may be wrong, as a share of the largest coordinate: room
  // for the rounding of the caller's tests. Not negative, at most 1.
  float slack = 0x1p-20f;
};

inline constexpr std::uint32_t no_part = 0xffffffffu;

namespace detail {

// Where rays of a visit are in the caller's batch. Null pointers leave out their step.
struct RayNumbers {
  std::size_t first = 0;
  const std::size_t* copied = nullptr;    // indices of rays that were copied
  const std::uint32_t* picked = nullptr;  // of these, the rays that came to an instance

  std::size_t operator[](std::size_t i) const {
    const std::size_t k = picked != nullptr ? picked[i] : i;
    return copied != nullptr ? copied[k] : first + k;
  }
  // From ray i on.
  RayNumbers from(std::size_t i) const {
    if (picked != nullptr) return {first, copied, picked + i};
    return {first + i, copied != nullptr ? copied + i : nullptr, nullptr};
  }
};

}  // namespace detail

// Some rays at the primitives of a leaf: any of these rays may hit any of these primitives.
// The library traces a batch in parts. `rays` index the arrays of this part, ray, hit and occluded; caller_index()
// returns the index of a ray in the batch that the caller passed, for the caller's own data per ray.
struct LeafVisit {
  std::span<const std::uint32_t> primitives;  // their numbers, rising
  std::size_t first;                          // place of the first of them in BoundedTree::order()
  std::span<const std::uint32_t> rays;        // indices within this part: ray[rays[k]], hit[rays[k]]
  const Ray* ray;
  Hit* hit;                // of closest: the nearest hit so far; null of occluded
  std::uint8_t* occluded;  // of occluded: 1 where something was hit, else 0; null of closest

  std::uint32_t instance = no_part;  // the instance of the scene that is traced; no_part of a BoundedTree
  detail::RayNumbers numbers = {};

  // The index of ray[number] in the caller's batch; 0 of a call with one ray.
  std::size_t caller_index(std::uint32_t number) const { return numbers[number]; }
  // Keeps a hit of a ray of this visit, whose primitive is set, if it is the nearest one.
  void keep(std::uint32_t number, const Hit& found) const;
};
// Tests them, and keeps in hit[] the nearest one in the order of is_nearer, or sets occluded[]. A ray is in a visit for
// each leaf at most once; that it is says nothing of its hits. What is hit must not depend on the order of visits.
using LeafFunction = void (*)(void* context, const LeafVisit& leaf);

// The order of hits: t, of equal ones the primitive; a miss, or a t that is NaN or infinite, comes after all.
inline bool is_nearer(const Hit& a, const Hit& b) {
  return a.t < b.t ||
         (a.t == b.t && a.t < std::numeric_limits<float>::infinity() && a.primitive < b.primitive);
}

inline void LeafVisit::keep(std::uint32_t number, const Hit& found) const {
  if (occluded != nullptr)
    occluded[number] = 1;
  else if (is_nearer(found, hit[number]))
    hit[number] = found;
}

// Whether a ray hits a primitive in [ray.tmin, ray.tmax], and at which t, u and v.
template <class Test>
concept PrimitiveTest = std::is_invocable_r_v<bool, Test&, std::uint32_t, const Ray&, Hit&>;
// Tests a whole visit, as a LeafFunction does: in registers of the caller's own.
template <class Test>
concept LeafTest = std::is_invocable_v<Test&, const LeafVisit&>;

namespace detail {

// The test in the loops of its own type.
template <class Test>
void visit_with(void* context, const LeafVisit& leaf) {
  auto& test = *static_cast<std::remove_reference_t<Test>*>(context);
  if constexpr (LeafTest<Test>) {
    test(leaf);
  } else {
    for (const std::uint32_t number : leaf.rays) {
      const Ray& ray = leaf.ray[number];
      if (leaf.occluded != nullptr) {
        Hit hit;
        for (const std::uint32_t primitive : leaf.primitives)
          if (leaf.occluded[number] == 0 && test(primitive, ray, hit)) leaf.occluded[number] = 1;
        continue;
      }
      Hit best = leaf.hit[number];
      for (const std::uint32_t primitive : leaf.primitives) {
        Hit hit;
        if (!test(primitive, ray, hit)) continue;
        hit.primitive = primitive;
        if (is_nearer(hit, best)) best = hit;
      }
      leaf.hit[number] = best;
    }
  }
}

}  // namespace detail

struct VisitOptions {
  const Path* path = nullptr;  // these as of TraceOptions
  int threads = 1;             // with more than one the test is called from all of them
  LaneBits active = nullptr;
  TraceCounters* counters = nullptr;
};

// A bounding volume hierarchy over boxes, each the primitive of its place. One object may be traced from many threads
// at a time. Default-constructed or moved from, it has no boxes.
class BoundedTree {
 public:
  BoundedTree() noexcept;
  // The tree keeps nothing of the boxes but their places. Those with lo > hi on an axis or a bound that is NaN or
  // infinite are never visited. Throws std::invalid_argument for more than 2^28 boxes, a builder that does not exist,
  // a negative thread count, or another option beyond its range.
  explicit BoundedTree(std::span<const Box> boxes, const BoundedBuildOptions& options = {});
  ~BoundedTree();
  BoundedTree(BoundedTree&&) noexcept;
  BoundedTree& operator=(BoundedTree&&) noexcept;

  // The nearest hit of each ray, or whether there is one, by the caller's test of a ray and a primitive, or of a leaf
  // at a time: its t, u and v are passed on. Hits must lie in the boxes, but for the slack; then each that counts is
  // found, whatever the tree, the path and the threads: in the order of is_nearer. What a test throws passes through,
  // some answers are there then. A ray with what Ray forbids hits nothing. Throws std::invalid_argument for another
  // number of answers than rays, views of something that point to nothing, a negative thread count, or a path or
  // counters that are not there.
  template <class Test>
  requires PrimitiveTest<Test> || LeafTest<Test>
  void closest(RayView rays, std::span<Hit> hits, Test&& test, const VisitOptions& options = {}) const {
    closest(rays, hits, detail::visit_with<Test>, address_of(test), options);
  }
  template <class Test>
  requires PrimitiveTest<Test> || LeafTest<Test>
  void occluded(RayView rays, std::span<std::uint8_t> answers, Test&& test,
                const VisitOptions& options = {}) const {
    occluded(rays, answers, detail::visit_with<Test>, address_of(test), options);
  }
  // The same by a plain function.
  void closest(RayView rays, std::span<Hit> hits, LeafFunction visit, void* context,
               const VisitOptions& options = {}) const;
  void occluded(RayView rays, std::span<std::uint8_t> answers, LeafFunction visit, void* context,
                const VisitOptions& options = {}) const;

  // The primitives that are ever visited, leaf by leaf: data that the caller keeps in this order lies side by side for
  // each visit, from its `first` on. As long as the tree lives, or the scene that it was given to.
  std::span<const std::uint32_t> order() const noexcept;
  Box bounds() const noexcept;        // as of Bvh
  std::size_t size() const noexcept;  // boxes that it was built over
  std::size_t bytes() const noexcept;

 private:
  template <class Test>
  static void* address_of(Test& test) {
    return const_cast<void*>(static_cast<const void*>(std::addressof(test)));
  }
  friend class Scene;
  std::unique_ptr<struct BoxTree> tree_;  // null: no boxes
};

}  // namespace raylanes

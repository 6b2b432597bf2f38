// Trees over anything that has a box: the library finds the boxes that rays meet, and calls your test of what is in
// them. docs/scenes.md has examples.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>

#include <raylanes/builders.hpp>
#include <raylanes/progress.hpp>
#include <raylanes/rays.hpp>
#include <raylanes/scene_hit.hpp>
#include <raylanes/traversal.hpp>

namespace raylanes {

struct Path;  // <raylanes/paths.hpp>

/// How a BoundedTree is built.
struct BoundedBuildOptions {
  TreeBuilder builder =
      TreeBuilder::binned_sah;  ///< how the tree is divided; spatial_splits builds as binned_sah
  int threads = 1;              ///< as in TraceOptions
  std::uint32_t max_in_leaf =
      1;  ///< primitives in a visit, 1 to 8; with 1 each box is tested before its primitive
  /// By how much boxes are enlarged, as a share of the largest coordinate of boxes and ray origins: for the rounding
  /// errors of your test. From 0 to 1.
  float slack = 0x1p-20f;
};

namespace detail {

// The indices of a visit's rays in the caller's batch. Null pointers leave out their step.
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

/// Some rays at the primitives of a leaf: each of these rays may hit each of these primitives.
/// The library traces a batch in parts. `rays` are indices into the arrays of this part: ray, hit and occluded.
/// caller_index() returns the index of a ray in the batch of the call.
struct LeafVisit {
  std::span<const std::uint32_t> primitives;  ///< indices of the primitives, ascending
  std::size_t first;                          ///< index of the first of them in BoundedTree::order()
  std::span<const std::uint32_t> rays;        ///< indices within this part: ray[rays[k]], hit[rays[k]]
  const Ray* ray;                             ///< the rays of this part
  Hit* hit;                                   ///< in closest(): the nearest hits so far; null in occluded()
  std::uint8_t* occluded;  ///< in occluded(): 1 for rays that have hit, else 0; null in closest()
  const std::uint32_t*
      skip;  ///< for each ray of this part the primitive that is not there for it; null: none
  /// In closest(): for each ray of this part the hit after which its nearest hit is looked for; null: none.
  const Hit* after;

  std::uint32_t instance = no_part;  ///< the instance of the scene; no_part in a BoundedTree
  detail::RayNumbers numbers = {};   ///< for caller_index()

  /// Returns whether the primitive is not there for ray[number].
  bool skips(std::uint32_t number, std::uint32_t primitive) const {
    return skip != nullptr && skip[number] == primitive;
  }
  /// Returns the index of ray[number] in the batch of the call; 0 for a call with one ray.
  std::size_t caller_index(std::uint32_t number) const { return numbers[number]; }
  /// Stores a hit of ray[number], with its primitive set, if it comes after `after[number]` and is the nearest so far;
  /// in occluded() stores 1.
  void keep(std::uint32_t number, const Hit& found) const;
  /// Keeps the first hit of a primitive that comes after `after[number]`, if test(primitive, ray, hit) finds it: a
  /// PrimitiveTest, which is also asked for the rest of the ray from there on. For primitives that a ray hits several
  /// times; two hits of one primitive less than two ULPs apart count as one.
  template <class Test>
  void keep_first(std::uint32_t number, std::uint32_t primitive, Test& test) const;
};
/// A function that tests the rays and primitives of a visit, and stores hits by LeafVisit::keep().
/// A ray visits each leaf at most once. Results must not depend on the order of visits.
using LeafFunction = void (*)(void* context, const LeafVisit& leaf);

/// Returns whether hit `a` comes before hit `b`: by t, then by primitive. A miss, or a t that is not finite, comes
/// last.
inline bool is_nearer(const Hit& a, const Hit& b) {
  return a.t < b.t ||
         (a.t == b.t && a.t < std::numeric_limits<float>::infinity() && a.primitive < b.primitive);
}

/// Returns whether a hit comes after another one: by t, then by primitive. Nothing comes after a miss.
inline bool comes_after(const Hit& hit, const Hit& last) {
  return hit.t > last.t || (hit.t == last.t && hit.primitive > last.primitive);
}

inline void LeafVisit::keep(std::uint32_t number, const Hit& found) const {
  if (occluded != nullptr)
    occluded[number] = 1;
  else if ((after == nullptr || comes_after(found, after[number])) && is_nearer(found, hit[number]))
    hit[number] = found;
}
template <class Test>
void LeafVisit::keep_first(std::uint32_t number, std::uint32_t primitive, Test& test) const {
  Hit found;
  if (!test(primitive, ray[number], found)) return;
  found.primitive = primitive;
  keep(number, found);
  if (after == nullptr || comes_after(found, after[number])) return;
  // A test may compare an unrounded t with tmin, so the rest of the ray begins before the last hit at first.
  for (const float way : {-1.0f, 1.0f}) {
    Ray rest = ray[number];
    const float begin = std::nextafter(after[number].t, way * std::numeric_limits<float>::infinity());
    if (begin > rest.tmin) rest.tmin = begin;
    if (!test(primitive, rest, found)) return;
    found.primitive = primitive;
    keep(number, found);
    if (comes_after(found, after[number])) return;
  }
}

/// A test of one primitive: test(primitive, ray, hit) returns whether the ray hits it in [ray.tmin, ray.tmax], and then
/// sets hit.t, hit.u and hit.v.
template <class Test>
concept PrimitiveTest = std::is_invocable_r_v<bool, Test&, std::uint32_t, const Ray&, Hit&>;
/// A test of a whole visit: test(visit), for tests that use vectors of their own.
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
    for (const std::uint32_t number : leaf.rays)
      for (const std::uint32_t primitive : leaf.primitives)
        if (!leaf.skips(number, primitive) && (leaf.occluded == nullptr || leaf.occluded[number] == 0))
          leaf.keep_first(number, primitive, test);
  }
}

// A call with one ray: the test in the loop of a leaf, whose primitives lie from `first` on in the order. Answers
// are the t of the nearest hit so far, and -infinity once the search is done.
struct SearchInOrder {
  const std::uint32_t* order = nullptr;
  std::uint32_t skipped = no_primitive;
};
template <class Test, bool only_decides>
struct SearchOfRay : SearchInOrder {
  Test& test;
  const Ray& ray;
  Hit best = {};

  SearchOfRay(Test& of_one, const Ray& of_call) : test(of_one), ray(of_call) {}

  static float at_leaf(void* context, std::uint32_t first, std::uint32_t size) {
    auto& search = *static_cast<SearchOfRay*>(static_cast<SearchInOrder*>(context));
    for (const std::uint32_t primitive : std::span(search.order + first, size)) {
      Hit found;
      if (primitive == search.skipped || !search.test(primitive, search.ray, found)) continue;
      found.primitive = primitive;
      if constexpr (only_decides) {
        search.best = found;
        return -std::numeric_limits<float>::infinity();
      }
      if (is_nearer(found, search.best)) search.best = found;
    }
    return search.best.t;
  }
};

}  // namespace detail

/// How rays visit a BoundedTree or a SphereTree.
struct VisitOptions {
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;             ///< as in TraceOptions; each of them calls the test
  LaneBits active = nullptr;   ///< the active rays; null: all
  /// For each ray a primitive that is not there for it, of a sphere one hit (SphereTree::closest()); empty: none; as in
  /// TraceOptions. A LeafTest or LeafFunction of your own looks at LeafVisit::skip.
  PrimitiveView skip = {};
  TraceCounters* counters = nullptr;  ///< as in TraceOptions
  /// For closest(): returns for ray i the first hit after `after[i]`, by t, then by primitive; otherwise as
  /// TraceOptions::after. A primitive has those hits that a PrimitiveTest finds in the whole ray and in the rest of it:
  /// LeafVisit::keep_first() says how. A LeafTest or LeafFunction of your own keeps all hits of a primitive, or calls
  /// that.
  AfterView after = {};
  /// If not null, called between parts, as Progress says; if it throws, any results may be written.
  const Progress* progress = nullptr;
};

/// A bounding volume hierarchy over boxes: box i is primitive i.
/// Many threads may query one object at the same time. A default-constructed or moved-from object has no boxes.
class BoundedTree {
 public:
  BoundedTree() noexcept;
  /// Builds the tree; it keeps nothing of the view.
  /// Boxes with lo > hi on an axis or a bound that is not finite are never visited. Throws std::invalid_argument for
  /// more than 2^28 boxes, a builder that does not exist, a negative thread count, or an option out of its range.
  explicit BoundedTree(std::span<const Box> boxes, const BoundedBuildOptions& options = {});
  ~BoundedTree();
  BoundedTree(BoundedTree&&) noexcept;
  BoundedTree& operator=(BoundedTree&&) noexcept;

  /// Finds the nearest hit of each ray by your test, in the order of is_nearer(): hits[i] belongs to ray i.
  /// Hits must lie in the boxes, enlarged by the slack; then the result does not depend on tree, ISA path or threads.
  /// Inactive rays leave their hit unchanged. A ray that Ray calls invalid hits nothing.
  /// Exceptions of the test pass through; some hits are written then. Throws std::invalid_argument if hits.count is
  /// not rays.count, hits overlap rays or each other, or a view of some elements is null. Throws it also if the thread
  /// count is negative, the path is not supported here, or counters are asked for in a build without them.
  template <class Test>
  requires PrimitiveTest<Test> || LeafTest<Test>
  void closest(RayView rays, HitView hits, Test&& test, const VisitOptions& options = {}) const {
    closest(rays, hits, detail::visit_with<Test>, address_of(test), options);
  }
  /// Sets occluded[i] to 1 if your test finds a hit of ray i, else to 0. Exceptions are as in closest().
  template <class Test>
  requires PrimitiveTest<Test> || LeafTest<Test>
  void occluded(RayView rays, std::span<std::uint8_t> occluded, Test&& test,
                const VisitOptions& options = {}) const {
    this->occluded(rays, occluded, detail::visit_with<Test>, address_of(test), options);
  }
  /// Returns the nearest hit of the ray by your test, or a miss. Throws as closest() of many rays does.
  template <class Test>
  requires PrimitiveTest<Test> || LeafTest<Test> Hit closest(const Ray& ray, Test&& test,
                                                             const VisitOptions& options = {})
  const {
    if constexpr (!LeafTest<Test>) {
      detail::SearchOfRay<std::remove_reference_t<Test>, false> search(test, ray);
      if (visit_ray(ray, search.at_leaf, search, options)) return search.best;
    }
    return closest(ray, detail::visit_with<Test>, address_of(test), options);
  }
  /// Returns whether your test finds a hit of the ray. Throws as closest() does.
  template <class Test>
  requires PrimitiveTest<Test> || LeafTest<Test>
  bool occluded(const Ray& ray, Test&& test, const VisitOptions& options = {}) const {
    if constexpr (!LeafTest<Test>) {
      detail::SearchOfRay<std::remove_reference_t<Test>, true> search(test, ray);
      if (visit_ray(ray, search.at_leaf, search, options)) return static_cast<bool>(search.best);
    }
    return occluded(ray, detail::visit_with<Test>, address_of(test), options);
  }
  /// Finds the nearest hit of each ray by a plain function, which gets `context`.
  void closest(RayView rays, HitView hits, LeafFunction visit, void* context,
               const VisitOptions& options = {}) const;
  /// Sets occluded[i] to 1 if a plain function finds a hit of ray i, else to 0.
  void occluded(RayView rays, std::span<std::uint8_t> occluded, LeafFunction visit, void* context,
                const VisitOptions& options = {}) const;
  /// Returns the nearest hit of the ray by a plain function, which gets `context`.
  Hit closest(const Ray& ray, LeafFunction visit, void* context, const VisitOptions& options = {}) const;
  /// Returns whether a plain function finds a hit of the ray.
  bool occluded(const Ray& ray, LeafFunction visit, void* context, const VisitOptions& options = {}) const;

  /// Returns the primitives that can be visited, leaf by leaf. If you keep your data in this order, the data of a visit
  /// are consecutive, from LeafVisit::first on. Valid as long as the tree, or the scene that it was added to.
  std::span<const std::uint32_t> order() const& noexcept;
  /// Does not compile: the span would outlive a temporary tree.
  std::span<const std::uint32_t> order() const&& = delete;
  Box bounds()
      const noexcept;  ///< the box around all boxes; lo = +infinity, hi = −infinity if there are none
  std::size_t size() const noexcept;   ///< the number of boxes that the tree was built over
  std::size_t bytes() const noexcept;  ///< the bytes of nodes and order

 private:
  template <class Test>
  static void* address_of(Test& test) {
    return const_cast<void*>(static_cast<const void*>(std::addressof(test)));
  }
  // Calls visit(&search, first, size) for the leaves that the ray comes to; false if the options ask for more.
  bool visit_ray(const Ray& ray, float (*visit)(void* context, std::uint32_t first, std::uint32_t size),
                 detail::SearchInOrder& search, const VisitOptions& options) const;

  friend class Scene;
  std::unique_ptr<struct BoundedTreeArrays> tree_;  // null: no boxes
};

}  // namespace raylanes

// The queries of rays, once for all classes that answer them: trees of floats and doubles, spheres and scenes.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/numbers.hpp>
#include <raylanes/queries.hpp>
#include <raylanes/rays.hpp>

namespace raylanes {

/// The nearest hits of rays, and whether there is one: the queries of Bvh, KdTree, BvhD, SphereTree, Scene and SceneD.
/// Rays, points and views have the numbers of the class: doubles for BvhD and SceneD, else floats. Hits are Hit, HitD,
/// or in scenes SceneHit and SceneHitD. Options are TraceOptions, for doubles TraceOptionsD, for SphereTree
/// VisitOptions. Many threads may query one object at the same time. No call traps floating-point exceptions, even if
/// the caller lets them trap; calls may leave status flags raised: docs/guide/arrays.md.
template <class Tree>
class RayQueries {
 public:
  using Number = typename detail::QueryTypes<Tree>::Number;    ///< float or double
  using Ray = RayOf<Number>;                                   ///< a ray
  using Hit = typename detail::QueryTypes<Tree>::Hit;          ///< a hit
  using Options = typename detail::QueryTypes<Tree>::Options;  ///< how rays are traced

 protected:
  using Rays = RayRecords<Ray>;                  ///< a view of rays
  using Columns = RayArraysOf<Number>;           ///< rays as one array per number
  using Hits = HitRecords<Hit>;                  ///< a view of hits to write
  using Point = PointOf<Number>;                 ///< three coordinates
  using Points = VertexRecords<Number>;          ///< a view of points
  using Ends = SegmentEndsOf<Number>;            ///< the ends of segments
  using Filter = HitFilterOf<Hit>;               ///< a filter of batches
  using Rejected = detail::BatchRejection<Hit>;  ///< the rejection of hits of a batch
  using Occluded = std::span<std::uint8_t>;      ///< a byte for each ray

 public:
  /// Returns the nearest hit of the ray, or a miss. Ties in t go to the lowest primitive index; in scenes to the lowest
  /// instance first.
  /// Throws std::invalid_argument if an option is no enumerator of its type or not one for this class, the thread count
  /// is negative, or the path is not supported here; and std::logic_error if a scene was changed without update().
  Hit closest(const Ray& ray, const Options& options) const;
  /// Returns the nearest hit of the ray by default options, on the active path. Throws as active_path() does.
  Hit closest(const Ray& ray) const;
  /// Returns whether the ray's segment hits anything. Throws as closest() does.
  bool occluded(const Ray& ray, const Options& options) const;
  /// Returns whether the ray's segment hits anything, by default options, on the active path.
  bool occluded(const Ray& ray) const;

  /// Finds the nearest hit of each ray: hits[i] belongs to rays[i].
  /// Inactive rays (options.active) leave their hit unchanged. Skips, hits after which rays look and the mask of
  /// active rays may lie where hits go: the call copies them.
  /// Each thread keeps up to 20 MB of scratch memory, 40 MB if rays or hits are not contiguous or of a scene.
  /// Throws what closest(ray) throws, and std::invalid_argument if hits.count is not rays.count, hits overlap rays
  /// or each other, or a view of some elements is null. A call that throws has written nothing; but on several threads
  /// std::bad_alloc may leave some hits written.
  void closest(const Rays& rays, const Hits& hits, const Options& options) const;
  /// Finds the nearest hit of each ray by default options, on the active path. Few rays take less time so.
  void closest(const Rays& rays, const Hits& hits) const;
  /// Finds the nearest hit of each ray, given as one array per number.
  void closest(const Columns& rays, Hits hits, const Options& options = {}) const;
  /// Sets occluded[i] to 1 if the segment of ray i hits anything, else to 0.
  /// Memory, inactive rays and exceptions are as in closest() of many rays.
  void occluded(const Rays& rays, Occluded occluded, const Options& options) const;
  /// Sets occluded[i] for each ray by default options, on the active path.
  void occluded(const Rays& rays, Occluded occluded) const;
  /// Sets occluded[i] for each ray, given as one array per number.
  void occluded(const Columns& rays, Occluded occluded, const Options& options = {}) const;

  /// Sets occluded[i] to 1 if something lies between `from` and points[i], else to 0: shadows of one light.
  /// The ray that begins at points[i] decides. Its direction is the difference of the points, rounded, tmin is
  /// 1 - ends.end and tmax 1 - ends.start, less than 1 if ends.start is positive. So a segment begins at its point
  /// exactly, however far the light is. Along each axis it ends within 2^-24 of that difference from `from`; with
  /// doubles within 2^-53. If a difference overflows, the direction is half of the differences, rounded, with twice
  /// tmin and tmax. If both points are equal, the result is 0. options.facing is meant as `from` sees it. `active` is a
  /// mask of points. Such rays are traced fastest. Throws as closest() of many rays does.
  void occluded_from(const Point& from, Points points, Occluded occluded, const Ends& ends = {},
                     const Options& options = {}) const;
  /// Sets occluded[i] to 1 if the ray from points[i] in that direction hits anything, else to 0: shadows of a sun.
  /// The direction needs no unit length. tmin is 0 and tmax infinity; options.facing is as for rays. `active` is a mask
  /// of points. Throws as closest() of many rays does.
  void occluded_towards(const Point& direction, Points points, Occluded occluded,
                        const Options& options = {}) const;

  // Templates, because clang 14 takes the braces of {.mode = …} for a filter and refuses them.

  /// Finds the nearest hit of each ray that the filter does not reject, by TriangleTest::exact. `rays` are records or
  /// arrays, as in closest() of many rays.
  /// The filter is called with batches of hits; rejected rays are traced on after their hit. All modes return the same
  /// hits. An empty filter rejects nothing.
  template <class Some, detail::FiltersLists<Hit> Asked>
  void closest(const Some& rays, Hits hits, const Asked& filter, const Options& options = {}) const {
    const Filter of_lists = filter;
    filtered_closest(rays, hits, {&of_lists}, options);
  }
  /// Finds the nearest hit of each ray for which rejects(i, hit) is false, i being the ray's place in the call.
  /// rejects() is asked during the search, as in closest() of one ray: in no order of t, perhaps about hits after the
  /// result and twice about one. If options.threads is not 1, several threads may call it at the same time. It may
  /// query trees. Its exceptions pass through, and may leave some hits written.
  template <class Some, std::predicate<std::size_t, const Hit&> Rejects>
  void closest(const Some& rays, Hits hits, Rejects&& rejects, const Options& options = {}) const {
    detail::with_batch_rejection<Hit>(
        rejects, [&](const Rejected& rejected) { filtered_closest(rays, hits, rejected, options); });
  }
  /// Sets occluded[i] to 1 if the segment of ray i has a hit that the filter does not reject, else to 0. The filter is
  /// asked about the hits of a ray in no order, perhaps twice about one, until it keeps one.
  template <class Some, detail::FiltersLists<Hit> Asked>
  void occluded(const Some& rays, Occluded occluded, const Asked& filter, const Options& options = {}) const {
    const Filter of_lists = filter;
    filtered_occluded(rays, occluded, {&of_lists}, options);
  }
  /// Sets occluded[i] to 1 if the segment of ray i has a hit for which rejects(i, hit) is false, else to 0. The
  /// function is asked as in closest() of many rays.
  template <class Some, std::predicate<std::size_t, const Hit&> Rejects>
  void occluded(const Some& rays, Occluded occluded, Rejects&& rejects, const Options& options = {}) const {
    detail::with_batch_rejection<Hit>(
        rejects, [&](const Rejected& rejected) { filtered_occluded(rays, occluded, rejected, options); });
  }
  /// Sets occluded[i] to 1 if the segment from `from` to points[i] has a hit that the filter keeps, else to 0.
  /// The filter is asked as in occluded(), about hits of the ray that begins at points[i].
  template <detail::FiltersLists<Hit> Asked>
  void occluded_from(const Point& from, Points points, Occluded occluded, const Asked& filter,
                     const Ends& ends = {}, const Options& options = {}) const {
    const Filter of_lists = filter;
    filtered_from(from, points, occluded, {&of_lists}, ends, options);
  }
  /// The same for hits for which rejects(i, hit) is false, asked as in closest() of many rays.
  template <std::predicate<std::size_t, const Hit&> Rejects>
  void occluded_from(const Point& from, Points points, Occluded occluded, Rejects&& rejects,
                     const Ends& ends = {}, const Options& options = {}) const {
    detail::with_batch_rejection<Hit>(rejects, [&](const Rejected& rejected) {
      filtered_from(from, points, occluded, rejected, ends, options);
    });
  }
  /// Sets occluded[i] to 1 if the ray from points[i] in that direction has a hit that the filter keeps, else to 0.
  template <detail::FiltersLists<Hit> Asked>
  void occluded_towards(const Point& direction, Points points, Occluded occluded, const Asked& filter,
                        const Options& options = {}) const {
    const Filter of_lists = filter;
    filtered_towards(direction, points, occluded, {&of_lists}, options);
  }
  /// The same for hits for which rejects(i, hit) is false, asked as in closest() of many rays.
  template <std::predicate<std::size_t, const Hit&> Rejects>
  void occluded_towards(const Point& direction, Points points, Occluded occluded, Rejects&& rejects,
                        const Options& options = {}) const {
    detail::with_batch_rejection<Hit>(rejects, [&](const Rejected& rejected) {
      filtered_towards(direction, points, occluded, rejected, options);
    });
  }
  /// Returns the nearest hit of the ray for which rejects(hit) is false, by TriangleTest::exact.
  /// rejects() is asked during the search about each hit that would be the best so far: in no order of t, perhaps about
  /// hits after the result, and again about a triangle that the tree has in several leaves. If its result depends on
  /// the hit alone, so does that of this call. It may query trees; its exceptions pass through. To see hits in order,
  /// call all_hits() or closest() with options.after.
  template <std::predicate<const Hit&> Rejects>
  Hit closest(const Ray& ray, Rejects&& rejects, const Options& options) const {
    return detail::with_rejection<Hit>(rejects, [&](const detail::Rejection<Hit>& rejection) {
      return closest_kept(ray, rejection, &options);
    });
  }
  /// Returns the nearest hit of the ray for which rejects(hit) is false, on the active path.
  template <std::predicate<const Hit&> Rejects>
  Hit closest(const Ray& ray, Rejects&& rejects) const {
    return detail::with_rejection<Hit>(rejects, [&](const detail::Rejection<Hit>& rejection) {
      return closest_kept(ray, rejection, nullptr);
    });
  }
  /// Returns whether the ray's segment has a hit for which rejects(hit) is false. rejects() is asked as in closest(),
  /// until it keeps a hit.
  template <std::predicate<const Hit&> Rejects>
  bool occluded(const Ray& ray, Rejects&& rejects, const Options& options) const {
    return detail::with_rejection<Hit>(
        rejects, [&](const detail::Rejection<Hit>& rejection) { return any_kept(ray, rejection, &options); });
  }
  /// Returns whether the ray's segment has a hit for which rejects(hit) is false, on the active path.
  template <std::predicate<const Hit&> Rejects>
  bool occluded(const Ray& ray, Rejects&& rejects) const {
    return detail::with_rejection<Hit>(
        rejects, [&](const detail::Rejection<Hit>& rejection) { return any_kept(ray, rejection, nullptr); });
  }

 protected:
  RayQueries() = default;
  /// The object.
  const Tree& self() const { return static_cast<const Tree&>(*this); }

 private:
  // Without options: the default ones.
  Hit closest_kept(const Ray& ray, const detail::Rejection<Hit>& rejection, const Options* options) const;
  bool any_kept(const Ray& ray, const detail::Rejection<Hit>& rejection, const Options* options) const;
  void filtered_closest(Rays rays, Hits hits, const Rejected& rejected, const Options& options) const;
  void filtered_closest(const Columns& rays, Hits hits, const Rejected& rejected,
                        const Options& options) const;
  void filtered_occluded(Rays rays, Occluded occluded, const Rejected& rejected,
                         const Options& options) const;
  void filtered_occluded(const Columns& rays, Occluded occluded, const Rejected& rejected,
                         const Options& options) const;
  void filtered_from(const Point& from, Points points, Occluded occluded, const Rejected& rejected,
                     const Ends& ends, const Options& options) const;
  void filtered_towards(const Point& direction, Points points, Occluded occluded, const Rejected& rejected,
                        const Options& options) const;
};

/// The surfaces that rays meet: where they pass through, each hit, each crossing. The queries of Bvh, KdTree, BvhD,
/// Scene and SceneD, by TriangleTest::exact. docs/crossings.md has the definitions. Views, active elements, threads,
/// paths and exceptions are as in RayQueries; after std::bad_alloc the object is unchanged.
template <class Tree>
class SurfaceQueries : public RayQueries<Tree> {
  using Base = RayQueries<Tree>;
  using typename Base::Columns;
  using typename Base::Hits;
  using typename Base::Rays;

 public:
  using typename Base::Hit;
  using typename Base::Options;
  using typename Base::Ray;
  using Crossing = typename detail::QueryTypes<Tree>::Crossing;  ///< a crossing

  /// Returns the nearest hit at which the ray passes through the surface, or a miss: the next exit of a solid by
  /// {.facing = Facing::back, .skip = here}, its entry by Facing::front. With normals that point out they alternate.
  /// It is the first hit of closest() that is an item of crossings() and no glance. The sides of the crossings at one
  /// edge or corner, by position, are summed: as many of them count as the sum is large, of its sign, with the lowest
  /// primitives. So an edge between two triangles counts once, or not at all if the ray only touches it. Sides sum over
  /// all triangles but the skipped one, whatever options.facing is; in scenes over the triangles of one
  /// instance, in its space. If all of them have the same corners, all count.
  /// A ray in the plane of a triangle, or from a point on an edge of it, does not pass it. A cell that is only touched
  /// at a corner has none: particles go through cells that share faces by crossings(), as docs/crossings.md says.
  /// Takes all options of closest(), `after` too. Throws as closest() does, and std::invalid_argument for another test
  /// than TriangleTest::exact, and if a geometry of a scene does not consist of triangles.
  Hit closest_crossing(const Ray& ray, const Options& options = {}) const;
  /// Finds the nearest hit at which each ray passes through the surface: hits[i] belongs to rays[i].
  /// Views, inactive rays, memory and exceptions are as in closest() of many rays. The hits have the bytes of
  /// closest_crossing() of one ray in every mode. Rays whose hit is less than 2^-22 from an edge, as a share of the
  /// triangle, are looked at individually by the calling thread; with doubles 2^-51.
  void closest_crossing(Rays rays, Hits hits, const Options& options = {}) const;
  /// Finds the nearest hit at which each ray passes through the surface, given as one array per number.
  void closest_crossing(const Columns& rays, Hits hits, const Options& options = {}) const;

  /// Returns every hit of each ray once, in the order of t, then of primitives; in scenes of instances before
  /// primitives. The first one has the bytes of closest().
  /// One traversal a ray; as many hits as memory holds, or options.max_count for each ray. In a scene one traversal of
  /// a common tree, and one of each other instance that the ray comes to; if it places spheres or primitives of your
  /// own, each hit costs a search as by TraceOptions::after, which says which hits these have.
  /// Throws what closest() throws, and std::invalid_argument if rays of doubles are to be counted.
  RayLists<Hit> all_hits(Rays rays, const ListOptions& options = {}) const;
  /// Returns every hit of each ray, given as one array per number.
  RayLists<Hit> all_hits(const Columns& rays, const ListOptions& options = {}) const;
  /// Writes every hit of each ray into the caller's arrays, and returns how many there are.
  /// offsets.size() must be rays.count + 1. If there are more hits than hits.size(), none is written. Needs memory for
  /// as many hits besides.
  std::size_t all_hits(Rays rays, std::span<std::size_t> offsets, std::span<Hit> hits,
                       const ListOptions& options = {}) const;
  /// Returns each crossing of a ray and the surface once, in the order of t, then of primitives; in scenes of instances
  /// before primitives, each instance crossed in its space.
  /// At edges and vertices, and along planes, simulation of simplicity decides (Edelsbrunner, Mücke 1990): a ray
  /// leaves a closed mesh as often as it enters it.
  /// Throws as all_hits() does, and std::invalid_argument if a scene places other primitives than triangles.
  RayLists<Crossing> crossings(Rays rays, const ListOptions& options = {}) const;
  /// Returns each crossing of the rays, given as one array per number.
  RayLists<Crossing> crossings(const Columns& rays, const ListOptions& options = {}) const;
  /// Counts the crossings of each ray, and sums up their sides; options.max_count is ignored.
  /// Inactive rays leave their count unchanged. Takes less than 1 MB a thread beside what streams of rays take; but for
  /// scenes and trees that hold triangles in several leaves (k-d trees, spatial splits) it makes lists.
  /// Throws as crossings() does, and std::invalid_argument if counts.size() is not the number of rays.
  void count_crossings(Rays rays, std::span<CrossingCount> counts, const ListOptions& options = {}) const;
  /// Counts the crossings of each ray, given as one array per number.
  void count_crossings(const Columns& rays, std::span<CrossingCount> counts,
                       const ListOptions& options = {}) const;

 protected:
  SurfaceQueries() = default;
};

}  // namespace raylanes

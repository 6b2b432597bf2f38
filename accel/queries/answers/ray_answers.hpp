// The text of RayQueries, for every class: a batch of few rays, or any batch, or one ray; with filters or without.
// Each class has a RayDoor of its own, in the class's file.
#pragma once

#include <raylanes/ray_queries.hpp>

#include "../../batch/few_rays.hpp"
#include "../filters/filtered_call.hpp"

namespace raylanes {

// How a class answers rays. It is made of the object, and has
//   name                                     the word that begins messages
//   closest(ray), any(ray)                   the answer by default options
//   closest_by(ray, options), any_by         one ray with any options
//   trace(rays, hits, options), trace(rays, occluded, options)  any batch
//   require_order(options)                   throws if hits have no order by these options
//   lists()                                  how filters get lists of hits; NoLists
//   closest_kept(ray, rejection, options), any_kept             one ray whose caller rejects hits
// and where it has kernels of calls with one ray
//   kernels(options, rays, are_default)      closest(ray, i) and any(ray, i) for so many rays one by one, of which each
//                                            may skip a primitive; converts to false if options ask for more.
//                                            are_default: as are_defaults() of the options. Batches from batch_size()
//                                            rays on are better traced as one, and so are FewRays it does not take.
//                                            takes(few, false): they are not alike
//   trace_alike(few)                         of those kernels, by default options: false if rays are not alike. May be
//                                            missing
//   kept_at_once()                           KeptCalls by default options; may be missing
// and where trees say in which part of them a ray is hit
//   find_parts(rays, parts, options), hits_in_parts(rays, parts, some, hits, options)
//                                            as in filters/found_parts.hpp; false if there are no parts
// and where kernels of batches ask a caller about hits
//   keep(rays, sink, rejected, options)      as in filters/kept_rays.hpp; false: rays are to go one by one
template <class Tree>
class RayDoor;

// A batch of few rays, if it is to go as a loop of calls.
template <bool are_default, class Door, class AnyRay, class Answer, class Options>
[[gnu::always_inline]] inline bool answer_few(const Door& door, const RayRecords<AnyRay>& rays,
                                              Answer* answers, std::size_t count, const Options& options) {
  const auto kernels = door.kernels(options, rays.count, are_default);
  if (!kernels) return false;
  const FewRays<AnyRay, Answer> few(rays, answers, count, options, are_default, kernels.batch_size());
  if (!few) return false;
  bool may_be_alike = true;
  if constexpr (are_default && requires { kernels.trace_alike(few); })
    if (few.may_be_columns()) {
      if (kernels.trace_alike(few)) return true;
      may_be_alike = false;
    }
  if (!kernels.takes(few, may_be_alike)) return false;
  few.trace([&](const AnyRay& ray, std::size_t i) {
    if constexpr (std::is_same_v<Answer, std::uint8_t>)
      return kernels.any(ray, i);
    else
      return kernels.closest(ray, i);
  });
  return true;
}
template <class Door, class AnyRay, class Answer, class Options>
[[gnu::noinline]] bool answer_few_by(const Door& door, const RayRecords<AnyRay>& rays, Answer* answers,
                                     std::size_t count, const Options& options) {
  return answer_few<false>(door, rays, answers, count, options);
}
// Default options go inline, and keep few of the others' numbers: a batch of one saves 60 instructions.
template <class Door, class AnyRay, class Answer, class Options>
[[gnu::always_inline]] inline bool answer_any_few(const Door& door, const RayRecords<AnyRay>& rays,
                                                  Answer* answers, std::size_t count,
                                                  const Options& options) {
  if constexpr (requires { door.kernels(options, 1); }) {
    if (are_defaults(options)) [[likely]]
      return answer_few<true>(door, rays, answers, count, options);
    return answer_few_by(door, rays, answers, count, options);
  }
  return false;
}

template <class Tree>
auto RayQueries<Tree>::closest(const Ray& ray) const -> Hit {
  return RayDoor<Tree>(self()).closest(ray);
}
template <class Tree>
auto RayQueries<Tree>::closest(const Ray& ray, const Options& options) const -> Hit {
  const RayDoor<Tree> door(self());
  if constexpr (requires { door.kernels(options, 1); })
    if (const auto kernels = door.kernels(options, 1)) return kernels.closest(ray, 0);
  return door.closest_by(ray, options);
}
template <class Tree>
bool RayQueries<Tree>::occluded(const Ray& ray) const {
  return RayDoor<Tree>(self()).any(ray);
}
template <class Tree>
bool RayQueries<Tree>::occluded(const Ray& ray, const Options& options) const {
  const RayDoor<Tree> door(self());
  if constexpr (requires { door.kernels(options, 1); })
    if (const auto kernels = door.kernels(options, 1)) return kernels.any(ray, 0);
  return door.any_by(ray, options);
}

template <class Tree>
void RayQueries<Tree>::closest(const Rays& rays, const Hits& hits, const Options& options) const {
  const RayDoor<Tree> door(self());
  if (answer_any_few(door, rays, HitSink<Hit>{hits}.in_place(), hits.count, options)) return;
  door.trace(source_of(rays, options), hits, options);
}
template <class Tree>
void RayQueries<Tree>::closest(const Rays& rays, const Hits& hits) const {
  static constexpr Options usual;
  const RayDoor<Tree> door(self());
  if constexpr (requires { door.kernels(usual, 1); })
    if (answer_few<true>(door, rays, HitSink<Hit>{hits}.in_place(), hits.count, usual)) return;
  door.trace(source_of(rays, usual), hits, usual);
}
template <class Tree>
void RayQueries<Tree>::closest(const Columns& rays, Hits hits, const Options& options) const {
  RayDoor<Tree>(self()).trace(source_of(rays, options), hits, options);
}
template <class Tree>
void RayQueries<Tree>::occluded(const Rays& rays, Occluded occluded, const Options& options) const {
  const RayDoor<Tree> door(self());
  if (answer_any_few(door, rays, occluded.data(), occluded.size(), options)) return;
  door.trace(source_of(rays, options), occluded, options);
}
template <class Tree>
void RayQueries<Tree>::occluded(const Rays& rays, Occluded occluded) const {
  static constexpr Options usual;
  const RayDoor<Tree> door(self());
  if constexpr (requires { door.kernels(usual, 1); })
    if (answer_few<true>(door, rays, occluded.data(), occluded.size(), usual)) return;
  door.trace(source_of(rays, usual), occluded, usual);
}
template <class Tree>
void RayQueries<Tree>::occluded(const Columns& rays, Occluded occluded, const Options& options) const {
  RayDoor<Tree>(self()).trace(source_of(rays, options), occluded, options);
}
template <class Tree>
void RayQueries<Tree>::occluded_from(const Point& from, Points points, Occluded occluded, const Ends& ends,
                                     const Options& options) const {
  const SegmentsOf<Number> segments{from, points, ends};
  RayDoor<Tree>(self()).trace(source_of(segments, options), occluded, options);
}
template <class Tree>
void RayQueries<Tree>::occluded_towards(const Point& direction, Points points, Occluded occluded,
                                        const Options& options) const {
  const SegmentsOf<Number> segments{direction, points, {}, true};
  RayDoor<Tree>(self()).trace(source_of(segments, options), occluded, options);
}

template <class Tree>
auto RayQueries<Tree>::closest_kept(const Ray& ray, const detail::Rejection<Hit>& rejection,
                                    const Options* options) const -> Hit {
  const RayDoor<Tree> door(self());
  if constexpr (requires { door.kept_at_once(); })
    if (options == nullptr)
      if (const auto kept = door.kept_at_once()) return kept.closest(ray, asked_by(rejection));
  return door.closest_kept(ray, rejection, options != nullptr ? *options : Options());
}
template <class Tree>
bool RayQueries<Tree>::any_kept(const Ray& ray, const detail::Rejection<Hit>& rejection,
                                const Options* options) const {
  const RayDoor<Tree> door(self());
  if constexpr (requires { door.kept_at_once(); })
    if (options == nullptr)
      if (const auto kept = door.kept_at_once()) return kept.any(ray, asked_by(rejection));
  Options by = options != nullptr ? *options : Options();
  by.after = {};  // of closest() only
  return door.any_kept(ray, rejection, by);
}

template <class Tree>
void RayQueries<Tree>::filtered_closest(Rays rays, Hits hits, const Rejected& rejected,
                                        const Options& options) const {
  const RayDoor<Tree> door(self());
  FilteredCall<Tree>(door, rejected, options).closest(source_of(rays, options), hits);
}
template <class Tree>
void RayQueries<Tree>::filtered_closest(const Columns& rays, Hits hits, const Rejected& rejected,
                                        const Options& options) const {
  const RayDoor<Tree> door(self());
  FilteredCall<Tree>(door, rejected, options).closest(source_of(rays, options), hits);
}
template <class Tree>
void RayQueries<Tree>::filtered_occluded(Rays rays, Occluded occluded, const Rejected& rejected,
                                         const Options& options) const {
  const RayDoor<Tree> door(self());
  FilteredCall<Tree>(door, rejected, options).occluded(source_of(rays, options), occluded);
}
template <class Tree>
void RayQueries<Tree>::filtered_occluded(const Columns& rays, Occluded occluded, const Rejected& rejected,
                                         const Options& options) const {
  const RayDoor<Tree> door(self());
  FilteredCall<Tree>(door, rejected, options).occluded(source_of(rays, options), occluded);
}
template <class Tree>
void RayQueries<Tree>::filtered_from(const Point& from, Points points, Occluded occluded,
                                     const Rejected& rejected, const Ends& ends,
                                     const Options& options) const {
  const RayDoor<Tree> door(self());
  const SegmentsOf<Number> segments{from, points, ends};
  FilteredCall<Tree>(door, rejected, options).occluded(source_of(segments, options), occluded);
}
template <class Tree>
void RayQueries<Tree>::filtered_towards(const Point& direction, Points points, Occluded occluded,
                                        const Rejected& rejected, const Options& options) const {
  const RayDoor<Tree> door(self());
  const SegmentsOf<Number> segments{direction, points, {}, true};
  FilteredCall<Tree>(door, rejected, options).occluded(source_of(segments, options), occluded);
}

}  // namespace raylanes

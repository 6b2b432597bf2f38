// Contenders that trace a ray set: our kernels by path and mode, or Embree by mode. Both take the user's rays and give
// the user's hits; conversion is part of the work, but for packed contenders.
#pragma once

#include <raylanes/bvh.hpp>

#include "embree/embree_contender.hpp"
#include "workload.hpp"

namespace raylanes::bench {

// The kinds of trees that the tool builds.
enum class TreeFamily : std::uint8_t { bvh, kdtree, automatic };
inline constexpr std::array<std::string_view, 3> tree_family_names{"bvh", "kdtree", "auto"};

// The answers to a ray set: hits for a closest query, flags for any.
struct Answers {
  std::vector<Hit> hits;
  std::vector<std::uint8_t> occluded;

  explicit Answers(const RaySet& set);
  std::size_t hit_count() const;
  bool same_bytes(const Answers& other) const;
  // Rays for which the other set names another primitive, or says yes for no.
  std::size_t count_other_decisions(const Answers& other) const;
};

struct Contender {
  std::string mode;
  std::function<void(const RaySet&, Answers&)> trace;
  // For a packed contender: traces and returns the seconds that count, without the layout of rays and results. Empty if
  // all that `trace` does counts.
  std::function<double(const RaySet&, Answers&)> timed = {};
  std::size_t batch = 1;  // rays of each of Embree's calls

  bool is_packed() const { return static_cast<bool>(timed); }
};

// In calls of `batch` rays each, 0: all at once; on the active path without naming it. With `skips`, rays leave out the
// triangle that they begin on. The tree must outlive the contender.
Contender our_contender(const TriangleTree& tree, const TraceOptions& options, std::size_t batch = 0,
                        bool skips = false);

// Calls closest(ray) or occluded(ray) for each ray, as users do. Calls without options if the given options are the
// defaults and the path is the active one. Its mode is `call`. The tree must outlive it.
Contender our_caller(const TriangleTree& tree, const TraceOptions& options, bool skips = false);

// Embree called with a ray at a time: `call` makes its ray and takes its hit within the clock, as programs do that have
// rays of their own; `call_packed` has rays in Embree's layout beforehand. The Embree scene must outlive both.
std::vector<Contender> embree_callers(const EmbreeContender& embree);

// All of Embree's modes that its instruction set has natively: single rays; packets; the widest of its packets again
// from rays that lie in its layout before the clock starts, NAME_packed; and streams of so many rays a call, of records
// and of whole packets, 0: none. Packets and streams go with the hint that they are coherent, too, NAME_coherent, if
// rays are not scattered: scattered ones take twice the time with it. The Embree scene must outlive the contenders.
std::vector<Contender> embree_contenders(const EmbreeContender& embree, bool are_scattered,
                                         std::span<const std::size_t> streams = {});

}  // namespace raylanes::bench

// Any hit of each ray of a batch, for a filter to be asked about: where in a tree one is, by the traversals that only
// decide, then its numbers.
#pragma once

#include "../traced_tree.hpp"

namespace raylanes {

// Finds for each ray a part of the tree in which it mostly hits something: empty_reference, if it hits nothing at all.
// parts[i] is left as it is if ray i takes no part. Options are checked as for a batch, but
// facing names the sides that the rays see, of segments too.
void find_parts(const TracedTree& tree, const RaySource& rays, std::span<TreeReference> parts,
                const TraceOptions& options);
// Finds a hit of each ray some[k] in its part of the tree; a miss, if none is there. skip: of all rays.
void hits_in_parts(const TracedTree& tree, const RaySource& rays, std::span<const TreeReference> parts,
                   std::span<const std::size_t> some, std::span<Hit> hits, const TraceOptions& options);

}  // namespace raylanes

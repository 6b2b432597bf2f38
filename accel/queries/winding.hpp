// The rule of winding numbers, as locate() asks it.
#pragma once

#include <span>

#include <raylanes/mesh.hpp>
#include <raylanes/queries.hpp>

#include "traced_tree.hpp"

namespace raylanes {

// TriangleTree::locate() by InsideRule::winding; the views are checked.
void locate_by_winding(const TracedTree& tree, VertexView points, std::span<Location> locations,
                       const LocateOptions& options);

}  // namespace raylanes

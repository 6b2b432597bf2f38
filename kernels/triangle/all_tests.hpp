// The list of all triangle tests. A row of a table finds its place by the test's id: the order means nothing.
#pragma once

#include "../rows.hpp"
#include "moller_trumbore.hpp"
#include "plane_edges.hpp"
#include "precomputed.hpp"
#include "watertight.hpp"

namespace raylanes {
namespace {

using TriangleTests = TestList<Watertight, MollerTrumbore, MollerTrumboreEdges, Precomputed, Directional,
                               PlaneEdges, PlaneEdgesPlain>;

}  // namespace
}  // namespace raylanes

#include "locations.hpp"

namespace raylanes {

void TriangleTree::locate(VertexView points, std::span<Location> locations,
                          const LocateOptions& options) const {
  require_locations(points, locations, options);
  if (options.rule == InsideRule::winding) return locate_by_winding(traced(), points, locations, options);
  locate_by_crossings<float>(traced(), bounds(), points, locations, options);
}

}  // namespace raylanes

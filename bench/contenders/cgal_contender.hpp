// CGAL's tree and its test of sides (Alliez, Tayeb, Wormser 2009): exact predicates, scalar; what many people use for
// questions of this kind.
#pragma once

#include <memory>
#include <span>

#include <raylanes/queries.hpp>

namespace raylanes::bench {

// One mesh, with the kernel of exact predicates and inexact constructions. Single threaded.
class CgalContender {
 public:
  CgalContender(std::span<const Float3> vertices, std::span<const Index3> triangles);
  ~CgalContender();

  // How many intersections of each ray from its origin to infinity all_intersections() finds, which also constructs the
  // points; tmin and tmax are not asked.
  void count_hits(std::span<const Ray> rays, std::span<std::uint32_t> counts) const;
  // Side_of_triangle_mesh; the mesh is closed and oriented. Throws std::invalid_argument if it is not.
  void locate(std::span<const Float3> points, std::span<Location> locations) const;

 private:
  struct Trees;
  std::unique_ptr<Trees> trees_;
};

}  // namespace raylanes::bench


#include <raylanes/closed_mesh.hpp>
#include <raylanes/doubles.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "shared_edges.hpp"

namespace raylanes {
namespace {

class Edges {
 public:
  template <class T>
  Edges(const VertexRecords<T>& vertices, const IndexView& triangles, const Progress* progress)
      : triangles_(triangles), pulse_(progress, steps_of_edges(vertices.count, triangles.count)) {
    number_ = numbers_of_positions(vertices, pulse_);
    const auto corners_of = [&](std::size_t i) {
      const Index3 t = triangles[i];
      return Index3{number_[t[0]], number_[t[1]], number_[t[2]]};
    };
    sides_ = sorted_sides(triangles.count, corners_of, report_.degenerate, pulse_);
  }

  ClosedReport report(std::size_t max_listed) {
    each_edge(sides_, [&](const SideKey& first, std::size_t count, std::size_t forward) {
      pulse_.step();
      look_at(first, count, forward);
      count_doubled({&first, count});
    });
    const auto listed = static_cast<std::ptrdiff_t>(std::min(max_listed, faulty_.size()));
    std::partial_sort(faulty_.begin(), faulty_.begin() + listed, faulty_.end(),
                      [](const Fault& a, const Fault& b) { return a.side < b.side; });
    for (auto fault = faulty_.begin(); fault != faulty_.begin() + listed; ++fault) list(*fault);
    return std::move(report_);
  }

 private:
  struct Fault {
    std::uint64_t side;  // the lower half of its key
    EdgeFault fault;
  };

  void look_at(const SideKey& first, std::size_t count, std::size_t forward) {
    ++report_.edges;
    if (count == 2 && forward == 1) return;
    const EdgeFault fault = count % 2 != 0         ? EdgeFault::open
                            : 2 * forward != count ? EdgeFault::inconsistent
                                                   : EdgeFault::shared;
    ++(fault == EdgeFault::open           ? report_.open
       : fault == EdgeFault::inconsistent ? report_.inconsistent
                                          : report_.shared);
    faulty_.push_back({first.lo, fault});
  }

  // Triangles at an edge are the same if their third corners are. To count each once: where that is the highest one.
  void count_doubled(std::span<const SideKey> edge) {
    thirds_.clear();
    for (const SideKey& side : edge) {
      const std::uint32_t third = number_[triangles_[triangle_of(side.lo)][(corner_of(side.lo) + 2) % 3]];
      if (third > static_cast<std::uint32_t>(side.hi)) thirds_.push_back(third);
    }
    std::sort(thirds_.begin(), thirds_.end());
    const auto distinct = std::unique(thirds_.begin(), thirds_.end()) - thirds_.begin();
    report_.doubled += thirds_.size() - static_cast<std::size_t>(distinct);
  }

  static std::uint32_t triangle_of(std::uint64_t side) { return static_cast<std::uint32_t>(side >> 3); }
  static std::size_t corner_of(std::uint64_t side) { return side >> 1 & 3u; }

  void list(const Fault& fault) {
    const std::uint32_t triangle = triangle_of(fault.side);
    const std::size_t side = corner_of(fault.side);
    const Index3 t = triangles_[triangle];
    report_.first.push_back({fault.fault, triangle, t[side], t[(side + 1) % 3]});
  }

  const IndexView& triangles_;
  Pulse pulse_;
  std::vector<std::uint32_t> number_;  // of the position of each vertex
  std::vector<SideKey> sides_;
  std::vector<Fault> faulty_;
  std::vector<std::uint32_t> thirds_;
  ClosedReport report_;
};

// The volume of a closed mesh, as tetrahedra with a corner of the mesh.
template <class T>
double volume_of(const VertexRecords<T>& vertices, const IndexView& triangles) {
  double volume = 0, size = 0;
  const auto origin = triangles.count == 0 ? std::array<T, 3>() : vertices[triangles[0][0]];
  for (std::size_t i = 0; i < triangles.count; ++i) {
    double v[3][3];
    for (std::size_t k = 0; k < 9; ++k)
      v[k / 3][k % 3] =
          static_cast<double>(vertices[triangles[i][k / 3]][k % 3]) - static_cast<double>(origin[k % 3]);
    for (std::size_t x = 0; x < 3; ++x) {
      const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
      const double p = v[0][x] * v[1][y] * v[2][z], q = v[0][x] * v[1][z] * v[2][y];
      volume += p - q, size += std::abs(p) + std::abs(q);
    }
  }
  // Less than 2^30 triangles: 2^33 roundings, each by at most 2^-53 of the sum of sizes.
  return std::abs(volume) > 0x1p-20 * size ? volume / 6 : 0;
}

template <class T>
ClosedReport report_of(const VertexRecords<T>& vertices, const IndexView& triangles, std::size_t max_listed,
                       const Progress* progress) {
  const QuietFloats quiet;
  validate_mesh(vertices, triangles);
  if (vertices.count > 0xffffffffu || triangles.count >= std::size_t{1} << 30)
    throw std::invalid_argument("closed_report: " + std::to_string(vertices.count) + " vertices and " +
                                std::to_string(triangles.count) +
                                " triangles, allowed are less than 2^32 and 2^30");
  ClosedReport report = Edges(vertices, triangles, progress).report(max_listed);
  if (report.has_winding_numbers()) report.volume = volume_of(vertices, triangles);
  return report;
}

}  // namespace

ClosedReport closed_report(VertexView vertices, IndexView triangles, std::size_t max_listed,
                           const Progress* progress) {
  return report_of(vertices, triangles, max_listed, progress);
}
ClosedReport closed_report(VertexViewD vertices, IndexView triangles, std::size_t max_listed,
                           const Progress* progress) {
  return report_of(vertices, triangles, max_listed, progress);
}

}  // namespace raylanes

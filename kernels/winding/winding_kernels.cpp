// Terms of boundaries in winding numbers, of one path: lanes are points, which walk the tree of the boundary together.
// A lane's sum does not depend on the other lanes, so that each path has the same bytes.
#include <limits>
#include <type_traits>

#include "../../dispatch/table/winding.hpp"
#include "boundary_loop.hpp"
#include "expansion.hpp"
#include "solid_angle.hpp"

namespace raylanes {
namespace {

constexpr int N = native_lanes == 1 ? 1 : native_lanes / 2;
using V = Lanes<double, N>;
using M = Mask<double, N>;

// Some points whose rays have one direction, along the coordinate `axis`, which is the last of i, j, k. Coordinates are
// numbers T, as doubles. Doubles are scaled before they are subtracted.
template <class T, int axis>
class Group {
  static constexpr int order[] = {(axis + 1) % 3, (axis + 2) % 3, axis};
  static constexpr bool is_double = std::is_same_v<T, double>;

 public:
  Group(const BoundaryView& boundary, const BoundaryBatch& batch, std::size_t first, std::size_t count)
      : boundary_(boundary),
        batch_(batch),
        first_(first),
        after_(is_double ? boundary.scale.after : boundary.scale.before * boundary.scale.after) {
    for (int k = 0; k < 3; ++k) point_[k] = V::load(batch.points[order[k]] + first, count, V(0.0));
    if constexpr (is_double)
      for (V& coordinate : point_) coordinate = coordinate * V(boundary.scale.before);
    resume_ = select(M::first(count), V(0.0), V(std::numeric_limits<double>::infinity()));
  }

  V term() {
    for (std::uint32_t at = 0; at < boundary_.node_count;) {
      const BoundaryNode& node = boundary_.nodes[at];
      M left = resume_ <= V(at);
      left = left & ~expand(node, left);
      const bool is_leaf = node.loop_count > 0;
      if (is_leaf && any(left)) add_loops(node, left);
      at = is_leaf || !any(left) ? node.next : at + 1;
    }
    return expanded_ + (decided_ + turns_.turns());
  }

 private:
  // Adds the caps of a node in lanes whose ray passes none of the caps, if the error fits: the bounds of all expansions
  // so far are at most the accuracy times the share of the nodes so far. Loops that are added without error leave their
  // share to later nodes. docs/winding.md derives the bound.
  M expand(const BoundaryNode& node, M active) {
    V d[3];
    for (int k = 0; k < 3; ++k) d[k] = within_reach((point_[k] - number(node.center[order[k]])) * V(after_));
    V across = d[0] * d[0] + d[1] * d[1], square = across + d[2] * d[2];
    V behind = d[2] * V(batch_.sign);  // how far the centre lies behind the point
    V radius(node.radius), radius_squared = radius * radius;
    M passed_by = (across > radius_squared) | (behind > radius);
    V gap = sqrt(square) - radius, over_low = square * (gap * gap), over_full = over_low * (square * square);
    V allowed = V(batch_.accuracy * node.share_until) - spent_;
    M fits = (square > radius_squared + radius_squared) & (V(node.full_error) <= allowed * over_full);
    M accepted = active & passed_by & fits;
    if (!any(accepted)) return accepted;
    constexpr int x = axis == 0 ? 2 : axis == 1 ? 1 : 0, y = (x + 1) % 3, z = (x + 2) % 3;
    IrregularHarmonics<V> harmonics(d[x], d[y], d[z], square);
    V sum = harmonics.template sum<1, low_degree>(node.moments), error = V(node.low_error) / over_low;
    M more = accepted & ~(error <= allowed);
    if (any(more)) {
      V rest = harmonics.template sum<low_degree + 1, full_degree>(node.moments);
      sum = sum + select(more, rest, V(0.0));
      error = select(more, V(node.full_error) / over_full, error);
    }
    spent_ = spent_ + select(accepted, error, V(0.0));
    expanded_ = expanded_ + select(accepted, sum, V(0.0));
    resume_ = select(accepted, V(node.next), resume_);
    return accepted;
  }

  // A coordinate of a corner or a centre, as point_ has them.
  V number(double x) const { return V(is_double ? x * boundary_.scale.before : x); }
  // A node adds less than 2^-190 to a point that is as far away as that.
  static V within_reach(V d) {
    constexpr double reach = 0x1p100;
    return is_double ? min(max(d, V(-reach)), V(reach)) : d;
  }

  void add_loops(const BoundaryNode& node, M active) {
    for (std::uint32_t i = node.first_loop; i < node.first_loop + node.loop_count; ++i)
      add_loop(boundary_.loops[i], active);
  }
  [[gnu::noinline]] void add_loop(const BoundaryLoop& loop, M active) {
    const double(*corners)[3] = boundary_.corners + loop.first;
    V sign(-batch_.sign), a[3], b[3];
    M doubtful = M::first(0);
    see(corners[loop.count - 1], a, doubtful);
    Turns<V> turns;
    for (std::uint32_t i = 0; i < loop.count; ++i) {
      see(corners[i], b, doubtful);
      Complex<V> z = half_angle(a, b, sign);
      // Angles near ±π, where the imaginary part must have its sign, and small z, which cancelled.
      doubtful = doubtful | ~((z.real >= V(0x1p-12)) | (abs(z.imaginary) >= V(0x1p-12)));
      turns.multiply(z);
      for (int k = 0; k < 3; ++k) a[k] = b[k];
    }
    turns_.multiply(turns, active & ~doubtful);
    if (const std::uint32_t lanes = bits(active & doubtful); lanes != 0) decide(corners, loop.count, lanes);
  }
  // The direction of a corner from the points, in the order i, j, k. Squares of doubles may be flushed. A square that
  // overflows makes a direction of zero: the boundary is too small to be seen from there.
  void see(const double (&corner)[3], V (&direction)[3], M& doubtful) const {
    Vec3<V> d(number(corner[order[0]]) - point_[0], number(corner[order[1]]) - point_[1],
              number(corner[order[2]]) - point_[2]);
    if constexpr (is_double) {
      d = Vec3<V>(d.x * V(after_), d.y * V(after_), d.z * V(after_));
      V square = square_of(d);
      doubtful = doubtful | ~(square >= V(0x1p-900));
      d = unit(d, square);
    } else {
      d = unit(d);
    }
    direction[0] = d.x, direction[1] = d.y, direction[2] = d.z;
  }
  [[gnu::cold, gnu::noinline]] void decide(const double (*corners)[3], std::size_t count,
                                           std::uint32_t lanes) {
    double term[N] = {};
    for (std::size_t lane = 0; lane < N; ++lane) {
      if ((lanes >> lane & 1u) == 0) continue;
      const std::size_t i = first_ + lane;
      const double point[3] = {batch_.points[0][i], batch_.points[1][i], batch_.points[2][i]};
      term[lane] = detail::exact_boundary_term<T>(point, axis, batch_.sign, corners, count);
    }
    decided_ = decided_ + V::load(term);
  }

  const BoundaryView& boundary_;
  const BoundaryBatch& batch_;
  std::size_t first_;
  double after_;         // what differences of coordinates are multiplied by
  V point_[3], resume_;  // the first node that a lane has to look at
  V expanded_{0.0}, spent_{0.0}, decided_{0.0};
  Turns<V> turns_;
};

template <class T, int axis>
[[gnu::flatten]] void terms_along(const BoundaryView& boundary, const BoundaryBatch& batch) {
  for (std::size_t first = 0; first < batch.size; first += N) {
    const std::size_t count = batch.size - first < N ? batch.size - first : N;
    Group<T, axis> group(boundary, batch, first, count);
    group.term().store(batch.terms + first, count);
  }
}

template <class T>
void boundary_terms(const BoundaryView& boundary, const BoundaryBatch& batch) {
  (batch.axis == 0   ? terms_along<T, 0>
   : batch.axis == 1 ? terms_along<T, 1>
                     : terms_along<T, 2>)(boundary, batch);
}

}  // namespace

RAYLANES_UNIT_TABLE(WindingKernels, winding, boundary_terms<float>, boundary_terms<double>)
}  // namespace raylanes

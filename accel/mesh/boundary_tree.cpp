#include "boundary_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "../../dispatch/bits.hpp"
#include "harmonic_moments.hpp"
#include "pulse.hpp"

namespace raylanes {
namespace {

// Edges of a loop, and of a leaf of several.
constexpr std::size_t max_loop = 16, max_leaf = 16;
// Smaller balls have moments, areas and powers of distances that may underflow: without expansions.
constexpr double min_radius = 0x1p-100;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct BoxOfDoubles {
  ThreeDoubles lo{infinity, infinity, infinity}, hi{-infinity, -infinity, -infinity};

  void include(const double* at) {
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], at[k]), hi[k] = std::max(hi[k], at[k]);
  }
  double middle(int k) const {
    return extent(k) < infinity ? lo[k] + 0.5 * extent(k) : 0.5 * lo[k] + 0.5 * hi[k];
  }
  double extent(int k) const { return hi[k] - lo[k]; }
  int longest() const {
    return extent(0) >= extent(1) && extent(0) >= extent(2) ? 0 : extent(1) >= extent(2) ? 1 : 2;
  }
};

// A loop of the tree, in the order of loops of the boundary.
struct Piece {
  const double* corners;
  std::size_t count;
  ThreeDoubles middle;

  explicit Piece(std::span<const double> numbers) : corners(numbers.data()), count(numbers.size() / 3) {
    BoxOfDoubles box;
    for (std::size_t i = 0; i < count; ++i) box.include(corners + 3 * i);
    for (int k = 0; k < 3; ++k) middle[k] = box.middle(k);
  }
  // Calls take(corners from `center` on, times `scale`) for each triangle of the fan.
  template <class Take>
  void each_triangle(const ThreeDoubles& center, const BoundaryScale& scale, const Take& take) const {
    for (std::size_t i = 1; i + 1 < count; ++i) {
      const double* const from[3] = {corners, corners + 3 * i, corners + 3 * (i + 1)};
      ThreeDoubles triangle[3];
      for (int corner = 0; corner < 3; ++corner)
        for (int k = 0; k < 3; ++k) triangle[corner][k] = scale.difference(from[corner][k], center[k]);
      take(triangle);
    }
  }
};

double length(const ThreeDoubles& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}
double area_of(const ThreeDoubles (&triangle)[3]) {
  ThreeDoubles a, b;
  for (int k = 0; k < 3; ++k) a[k] = triangle[1][k] - triangle[0][k], b[k] = triangle[2][k] - triangle[0][k];
  const ThreeDoubles normal = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                               a[0] * b[1] - a[1] * b[0]};
  return 0.5 * length(normal);
}

// Bounds of the error of a node's expansion: the radius, and the integrals of |x − centre|
// to the powers of both degrees.
struct Spread {
  double radius = 0.0, area = 0.0, low = 0.0, full = 0.0;

  // A power is convex: its mean over a triangle is at most that over the corners.
  void include(const ThreeDoubles (&triangle)[3]) {
    const double part = area_of(triangle);
    area += part;
    for (const ThreeDoubles& corner : triangle) {
      const double distance = length(corner), square = distance * distance;
      radius = std::max(radius, distance);
      low += part / 3.0 * square, full += part / 3.0 * (square * square * square);
    }
  }
};
static_assert(low_degree == 2 && full_degree == 6);

class TreeMaker {
 public:
  TreeMaker(std::vector<Piece>& pieces, const BoundaryScale& scale, const Progress* progress)
      : pieces_(pieces), scale_(scale), pulse_(progress, steps_of(pieces.size())) {
    Spread all;
    for (const Piece& piece : pieces_)
      piece.each_triangle(piece.middle, scale, [&](const auto& triangle) { all.include(triangle); });
    area_ = all.area;
    make(0, pieces_.size());
  }
  std::vector<BoundaryNode> nodes;

 private:
  // About as often as each piece is bounded: once at each depth.
  static double steps_of(std::size_t pieces) {
    return static_cast<double>(pieces) * std::log2(static_cast<double>(pieces) + 2.0);
  }
  HarmonicMoments make(std::size_t begin, std::size_t end) {
    const std::size_t index = nodes.size();
    nodes.emplace_back();
    const std::span<Piece> pieces = std::span(pieces_).subspan(begin, end - begin);
    const bool is_leaf = pieces.size() == 1 || edges_of(pieces) <= max_leaf;
    // The same order on every machine.
    if (is_leaf)
      std::sort(pieces.begin(), pieces.end(),
                [](const Piece& a, const Piece& b) { return a.corners < b.corners; });
    BoundaryNode node = bounded(pieces);
    HarmonicMoments moments;
    if (is_leaf) {
      node.first_loop = static_cast<std::uint32_t>(begin);
      node.loop_count = static_cast<std::uint32_t>(pieces.size());
      for (const Piece& piece : pieces)
        piece.each_triangle(node.center, scale_, [&](const auto& triangle) {
          moments.add_triangle(triangle);
          area_so_far_ += area_of(triangle);
        });
    } else {
      const std::size_t middle = begin + pieces.size() / 2;
      divide(pieces);
      add_child(begin, middle, node, moments);
      add_child(middle, end, node, moments);
    }
    moments.write(node.moments);
    node.next = static_cast<std::uint32_t>(nodes.size());
    node.share_until = area_ > 0.0 ? area_so_far_ / area_ : 1.0;
    nodes[index] = node;
    return moments;
  }
  void add_child(std::size_t begin, std::size_t end, const BoundaryNode& node, HarmonicMoments& moments) {
    const std::size_t child = nodes.size();
    const HarmonicMoments of_child = make(begin, end);
    ThreeDoubles shift;
    for (int k = 0; k < 3; ++k) shift[k] = scale_.difference(nodes[child].center[k], node.center[k]);
    moments.add(of_child, shift);
  }

  // The halves along the longest side of the box around the middles.
  static void divide(std::span<Piece> pieces) {
    BoxOfDoubles box;
    for (const Piece& piece : pieces) box.include(piece.middle);
    const int axis = box.longest();
    std::nth_element(pieces.begin(), pieces.begin() + static_cast<std::ptrdiff_t>(pieces.size() / 2),
                     pieces.end(), [&](const Piece& a, const Piece& b) {
                       return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                                               : a.corners < b.corners;
                     });
  }
  static std::size_t edges_of(std::span<const Piece> pieces) {
    std::size_t edges = 0;
    for (const Piece& piece : pieces) edges += piece.count;
    return edges;
  }

  // The ball of a node, and the error of its expansions.
  BoundaryNode bounded(std::span<const Piece> pieces) {
    BoxOfDoubles box;
    for (const Piece& piece : pieces)
      for (std::size_t i = 0; i < piece.count; ++i) box.include(piece.corners + 3 * i);
    BoundaryNode node{};
    for (int k = 0; k < 3; ++k) node.center[k] = box.middle(k);
    Spread spread;
    for (const Piece& piece : pieces) {
      piece.each_triangle(node.center, scale_, [&](const auto& triangle) { spread.include(triangle); });
      pulse_.step();
    }
    node.radius = spread.radius * (1.0 + 0x1p-30);
    const bool is_tiny = spread.radius < min_radius;
    node.low_error = is_tiny ? infinity : (low_degree + 1) * over_four_pi * spread.low;
    node.full_error = is_tiny ? infinity : (full_degree + 1) * over_four_pi * spread.full;
    return node;
  }

  std::vector<Piece>& pieces_;
  BoundaryScale scale_;
  Pulse pulse_;
  double area_ = 0.0, area_so_far_ = 0.0;
};

BoundaryScale scale_of(const BoxOfDoubles& box) {
  const int axis = box.longest();
  const bool is_huge = !(box.extent(axis) < infinity);
  const double extent = is_huge ? 0.5 * box.hi[axis] - 0.5 * box.lo[axis] : box.extent(axis);
  const int power = -std::clamp(std::ilogb(extent) + (is_huge ? 1 : 0), -1023, 1021) - 1;
  return {std::ldexp(1.0, std::min(power, 0)), std::ldexp(1.0, std::max(power, 0))};
}

}  // namespace

template <class T>
BoundaryTree::BoundaryTree(const LoopsOf<T>& boundary, const Progress* progress) {
  if (boundary.end.empty()) return;
  const LoopsOf<T> loops = short_loops(boundary, max_loop);
  std::vector<double> numbers;
  numbers.reserve(3 * loops.corners.size());
  BoxOfDoubles box;
  for (const PointOf<T>& corner : loops.corners) {
    for (const T x : corner) numbers.push_back(double_of(x));
    box.include(&numbers[numbers.size() - 3]);
  }
  scale_ = scale_of(box);
  std::vector<Piece> pieces;
  pieces.reserve(loops.end.size());
  for (std::size_t i = 0, begin = 0; i < loops.end.size(); begin = loops.end[i++])
    pieces.emplace_back(std::span(numbers).subspan(3 * begin, 3 * (loops.end[i] - begin)));
  TreeMaker maker(pieces, scale_, progress);
  nodes_ = std::move(maker.nodes);
  corners_.reserve(numbers.size());
  for (const Piece& piece : pieces) {
    loops_.push_back(
        {static_cast<std::uint32_t>(corners_.size() / 3), static_cast<std::uint32_t>(piece.count)});
    corners_.insert(corners_.end(), piece.corners, piece.corners + 3 * piece.count);
  }
}

template BoundaryTree::BoundaryTree(const LoopsOf<float>&, const Progress*);
template BoundaryTree::BoundaryTree(const LoopsOf<double>&, const Progress*);

BoundaryView BoundaryTree::view() const {
  return {nodes_.data(), static_cast<std::uint32_t>(nodes_.size()), loops_.data(),
          reinterpret_cast<const double(*)[3]>(corners_.data()), scale_};
}

}  // namespace raylanes

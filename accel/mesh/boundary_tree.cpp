#include "boundary_tree.hpp"

#include <thread>

#include "../../dispatch/bits.hpp"
#include "../batch/in_parallel.hpp"
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

// A subtree: its nodes in depth-first order, numbered from its root on.
struct Subtree {
  std::vector<BoundaryNode> nodes;
  HarmonicMoments moments;
};

class TreeMaker {
 public:
  // The same bytes for any number of threads. `progress`, if not null, hears of what the calling thread does.
  TreeMaker(std::vector<Piece>& pieces, const BoundaryScale& scale, int threads, const Progress* progress)
      : pieces_(pieces), scale_(scale), pulse_(progress, steps_of(pieces.size())) {
    Spread all;
    for (const Piece& piece : pieces_)
      piece.each_triangle(piece.middle, scale, [&](const auto& triangle) { all.include(triangle); });
    Top top{0, pieces_.size(), {}, {}, {}};
    std::vector<Top*> bottoms;
    plan(top, min_parts, bottoms);
    in_parallel(bottoms.size(), 1, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        bottoms[i]->subtree.moments = make(bottoms[i]->begin, bottoms[i]->end, bottoms[i]->subtree.nodes);
      }
    });
    join(top);
    set_shares(all.area);
  }
  std::vector<BoundaryNode> nodes;

 private:
  // About as often as each piece is bounded: once at each depth.
  static double steps_of(std::size_t pieces) {
    return static_cast<double>(pieces) * std::log2(static_cast<double>(pieces) + 2.0);
  }

  // The subtrees that threads make.
  static constexpr std::size_t min_parts = 64;

  // A node above them, or one of them.
  struct Top {
    std::size_t begin, end;
    BoundaryNode node;
    std::vector<Top> children;
    Subtree subtree;
  };
  std::span<Piece> pieces_of(std::size_t begin, std::size_t end) const {
    return std::span(pieces_).subspan(begin, end - begin);
  }
  static bool is_leaf(std::span<const Piece> pieces) {
    return pieces.size() == 1 || edges_of(pieces) <= max_leaf;
  }
  void plan(Top& top, std::size_t parts, std::vector<Top*>& bottoms) const {
    const std::span<Piece> pieces = pieces_of(top.begin, top.end);
    if (parts == 1 || is_leaf(pieces)) return bottoms.push_back(&top);
    top.node = bounded(pieces);
    divide(pieces);
    const std::size_t middle = top.begin + pieces.size() / 2;
    top.children.push_back({top.begin, middle, {}, {}, {}});
    top.children.push_back({middle, top.end, {}, {}, {}});
    for (Top& child : top.children) plan(child, parts / 2, bottoms);
  }
  // Appends all nodes in their order.
  HarmonicMoments join(Top& top) {
    const std::size_t index = nodes.size();
    if (top.children.empty()) {
      for (BoundaryNode& node : top.subtree.nodes) {
        node.next += static_cast<std::uint32_t>(index);
        nodes.push_back(node);
      }
      return top.subtree.moments;
    }
    nodes.push_back(top.node);
    HarmonicMoments moments;
    for (Top& child : top.children) {
      const std::size_t at = nodes.size();
      const HarmonicMoments of_child = join(child);
      add_child(of_child, nodes[at], top.node, moments);
    }
    finish(nodes, index, top.node, moments);
    return moments;
  }

  HarmonicMoments make(std::size_t begin, std::size_t end, std::vector<BoundaryNode>& to) const {
    const std::size_t index = to.size();
    to.emplace_back();
    const std::span<Piece> pieces = pieces_of(begin, end);
    const bool ends = is_leaf(pieces);
    // The same order on every machine.
    if (ends)
      std::sort(pieces.begin(), pieces.end(),
                [](const Piece& a, const Piece& b) { return a.corners < b.corners; });
    BoundaryNode node = bounded(pieces);
    HarmonicMoments moments;
    if (ends) {
      node.first_loop = static_cast<std::uint32_t>(begin);
      node.loop_count = static_cast<std::uint32_t>(pieces.size());
      for (const Piece& piece : pieces)
        piece.each_triangle(node.center, scale_,
                            [&](const auto& triangle) { moments.add_triangle(triangle); });
    } else {
      const std::size_t middle = begin + pieces.size() / 2;
      divide(pieces);
      for (const auto& [from, until] : {std::pair(begin, middle), std::pair(middle, end)}) {
        const std::size_t child = to.size();
        const HarmonicMoments of_child = make(from, until, to);
        add_child(of_child, to[child], node, moments);
      }
    }
    finish(to, index, node, moments);
    return moments;
  }
  static void finish(std::vector<BoundaryNode>& to, std::size_t index, BoundaryNode& node,
                     const HarmonicMoments& moments) {
    moments.write(node.moments);
    node.next = static_cast<std::uint32_t>(to.size());
    to[index] = node;
  }
  void add_child(const HarmonicMoments& of_child, const BoundaryNode& child, const BoundaryNode& node,
                 HarmonicMoments& moments) const {
    ThreeDoubles shift;
    for (int k = 0; k < 3; ++k) shift[k] = scale_.difference(child.center[k], node.center[k]);
    moments.add(of_child, shift);
  }
  // The share of the area of all that lies before the end of each node: the last leaf of a subtree has that of its
  // root.
  void set_shares(double area) {
    double so_far = 0.0;
    for (BoundaryNode& node : nodes) {
      for (const Piece& piece : pieces_of(node.first_loop, node.first_loop + node.loop_count))
        piece.each_triangle(node.center, scale_, [&](const auto& triangle) { so_far += area_of(triangle); });
      node.share_until = area > 0.0 ? so_far / area : 1.0;
    }
    for (BoundaryNode& node : nodes) node.share_until = nodes[node.next - 1].share_until;
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
  BoundaryNode bounded(std::span<const Piece> pieces) const {
    BoxOfDoubles box;
    for (const Piece& piece : pieces)
      for (std::size_t i = 0; i < piece.count; ++i) box.include(piece.corners + 3 * i);
    BoundaryNode node{};
    for (int k = 0; k < 3; ++k) node.center[k] = box.middle(k);
    Spread spread;
    for (const Piece& piece : pieces) {
      piece.each_triangle(node.center, scale_, [&](const auto& triangle) { spread.include(triangle); });
      if (std::this_thread::get_id() == caller_) pulse_.step();
    }
    node.radius = spread.radius * (1.0 + 0x1p-30);
    const bool is_tiny = spread.radius < min_radius;
    node.low_error = is_tiny ? infinity : (low_degree + 1) * over_four_pi * spread.low;
    node.full_error = is_tiny ? infinity : (full_degree + 1) * over_four_pi * spread.full;
    return node;
  }

  std::vector<Piece>& pieces_;
  BoundaryScale scale_;
  mutable Pulse pulse_;
  const std::thread::id caller_ = std::this_thread::get_id();
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
BoundaryTree::BoundaryTree(const LoopsOf<T>& boundary, int threads, const Progress* progress) {
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
  TreeMaker maker(pieces, scale_, threads, progress);
  nodes_ = std::move(maker.nodes);
  corners_.reserve(numbers.size());
  for (const Piece& piece : pieces) {
    loops_.push_back(
        {static_cast<std::uint32_t>(corners_.size() / 3), static_cast<std::uint32_t>(piece.count)});
    corners_.insert(corners_.end(), piece.corners, piece.corners + 3 * piece.count);
  }
}

template BoundaryTree::BoundaryTree(const LoopsOf<float>&, int, const Progress*);
template BoundaryTree::BoundaryTree(const LoopsOf<double>&, int, const Progress*);

BoundaryView BoundaryTree::view() const {
  return {nodes_.data(), static_cast<std::uint32_t>(nodes_.size()), loops_.data(),
          reinterpret_cast<const double(*)[3]>(corners_.data()), scale_};
}

}  // namespace raylanes

#include "boundary.hpp"

#include "shared_edges.hpp"

namespace raylanes {
namespace {

constexpr std::uint32_t nowhere = ~0u;

struct Edge {
  std::uint32_t from, to;
};

// Edges by where they begin, and loops of them.
class EdgeGraph {
 public:
  EdgeGraph(std::vector<Edge> edges, std::size_t vertices) : edges_(std::move(edges)), next_(vertices + 1) {
    std::stable_sort(edges_.begin(), edges_.end(),
                     [](const Edge& a, const Edge& b) { return a.from < b.from; });
    for (const Edge& edge : edges_) ++next_[edge.from + 1];
    for (std::size_t i = 0; i < vertices; ++i) next_[i + 1] += next_[i];
    end_.assign(next_.begin() + 1, next_.end());
    at_.assign(vertices, nowhere);
  }

  // Walks along unused edges; where the walk comes to a vertex again, a loop is cut off.
  template <class Take>
  void each_loop(const Take& take) {
    std::vector<std::uint32_t> walk;
    for (std::uint32_t start = 0; start < at_.size(); ++start) {
      if (next_[start] == end_[start]) continue;
      walk.assign(1, start), at_[start] = 0;
      while (next_[walk.back()] != end_[walk.back()]) {
        const std::uint32_t to = edges_[next_[walk.back()]++].to;
        if (at_[to] == nowhere) {
          at_[to] = static_cast<std::uint32_t>(walk.size());
          walk.push_back(to);
          continue;
        }
        const std::size_t first = at_[to];
        take(std::span<const std::uint32_t>(walk).subspan(first));
        for (std::size_t i = first + 1; i < walk.size(); ++i) at_[walk[i]] = nowhere;
        walk.resize(first + 1);
      }
      at_[start] = nowhere;
    }
  }

 private:
  std::vector<Edge> edges_;
  std::vector<std::size_t> next_, end_;  // for each vertex: its first unused edge, and the end of its edges
  std::vector<std::uint32_t> at_;        // where on the walk it is
};

template <class T>
void append(LoopsOf<T>& loops, std::span<const PointOf<T>> corners) {
  loops.corners.insert(loops.corners.end(), corners.begin(), corners.end());
  loops.end.push_back(loops.corners.size());
}

template <class T>
void append_in_parts(LoopsOf<T>& parts, std::span<const PointOf<T>> loop, std::size_t most) {
  if (loop.size() <= most) return append<T>(parts, loop);
  const std::size_t half = loop.size() / 2;
  append_in_parts<T>(parts, loop.first(half + 1), most);
  std::vector<PointOf<T>> rest(loop.begin() + static_cast<std::ptrdiff_t>(half), loop.end());
  rest.push_back(loop.front());
  append_in_parts<T>(parts, rest, most);
}

template <class T>
LoopsOf<T> loops_of(std::span<const CornersOf<T>> triangles, const Progress* progress) {
  if (triangles.size() >= std::size_t{1} << 30)
    throw std::invalid_argument("winding_numbers: " + std::to_string(triangles.size()) +
                                " triangles, allowed are less than 2^30");
  static_assert(sizeof(CornersOf<T>) == 3 * sizeof(PointOf<T>));
  const VertexRecords<T> vertices{triangles.data(), 3 * triangles.size(), sizeof(PointOf<T>)};
  Pulse pulse(progress, steps_of_edges(vertices.count, triangles.size()));
  const std::vector<std::uint32_t> number = numbers_of_positions(vertices, pulse);
  std::size_t degenerate = 0;
  const auto corners_of = [&](std::size_t i) {
    return Index3{number[3 * i], number[3 * i + 1], number[3 * i + 2]};
  };
  std::vector<Edge> edges;
  each_edge(sorted_sides(triangles.size(), corners_of, degenerate, pulse),
            [&](const SideKey& first, std::size_t count, std::size_t forward) {
              auto low = static_cast<std::uint32_t>(first.hi >> 32),
                   high = static_cast<std::uint32_t>(first.hi);
              std::size_t backward = count - forward;
              if (forward < backward) std::swap(low, high), std::swap(forward, backward);
              edges.insert(edges.end(), forward - backward, {low, high});
            });
  LoopsOf<T> loops;
  if (edges.empty()) return loops;
  EdgeGraph(std::move(edges), vertices.count).each_loop([&](std::span<const std::uint32_t> loop) {
    for (const std::uint32_t i : loop) loops.corners.push_back(vertices[i]);
    loops.end.push_back(loops.corners.size());
  });
  return loops;
}

}  // namespace

LoopsOf<float> boundary_loops(std::span<const Corners> triangles, const Progress* progress) {
  return loops_of<float>(triangles, progress);
}
LoopsOf<double> boundary_loops(std::span<const CornersOf<double>> triangles, const Progress* progress) {
  return loops_of<double>(triangles, progress);
}

template <class T>
LoopsOf<T> short_loops(const LoopsOf<T>& loops, std::size_t most) {
  LoopsOf<T> parts;
  for (std::size_t i = 0, begin = 0; i < loops.end.size(); begin = loops.end[i++])
    append_in_parts<T>(parts, std::span(loops.corners).subspan(begin, loops.end[i] - begin), most);
  return parts;
}
template LoopsOf<float> short_loops(const LoopsOf<float>&, std::size_t);
template LoopsOf<double> short_loops(const LoopsOf<double>&, std::size_t);

}  // namespace raylanes

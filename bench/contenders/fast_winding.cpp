#include "fast_winding.hpp"

namespace raylanes::bench {
namespace {

constexpr std::size_t max_leaf = 8;
constexpr double over_four_pi = 0.25 / std::numbers::pi;

template <class A, class B>
double dot(const A& a, const B& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

FastWinding::FastWinding(const Mesh& mesh) {
  for (const Index3& triangle : mesh.triangles) {
    WeighedTriangle corners{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = static_cast<double>(mesh.vertices[triangle[i]][k]);
        corners.corner[i].v[k] = x, corners.middle.v[k] += x / 3;
      }
    const auto& [a, b, c] = corners.corner;
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      corners.normal[k] = 0.5 * ((b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]));
    }
    triangles_.push_back(corners);
  }
  if (!triangles_.empty()) build(0, triangles_.size());
}

// Halves by the longest side of the box around the middles. A triangle's moments come from the
// middles of its edges, which is exact up to the second ones.
void FastWinding::build(std::size_t begin, std::size_t end) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  Node node{};
  const std::span<WeighedTriangle> triangles = std::span(triangles_).subspan(begin, end - begin);
  double lo[3], hi[3], area = 0;
  for (int k = 0; k < 3; ++k) lo[k] = hi[k] = triangles[0].middle[k];
  for (const WeighedTriangle& triangle : triangles) {
    const double part = std::sqrt(dot(triangle.normal, triangle.normal));
    area += part;
    for (int k = 0; k < 3; ++k) {
      node.center[k] += part * triangle.middle[k];
      lo[k] = std::min(lo[k], triangle.middle[k]), hi[k] = std::max(hi[k], triangle.middle[k]);
    }
  }
  for (int k = 0; k < 3; ++k) node.center[k] = area > 0 ? node.center[k] / area : triangles[0].middle[k];
  for (const WeighedTriangle& triangle : triangles) {
    for (const Double3& corner : triangle.corner) {
      double square = 0;
      for (int k = 0; k < 3; ++k) square += (corner[k] - node.center[k]) * (corner[k] - node.center[k]);
      node.radius_squared = std::max(node.radius_squared, square);
    }
    for (int edge = 0; edge < 3; ++edge) {
      double at[3];
      for (int k = 0; k < 3; ++k)
        at[k] = 0.5 * (triangle.corner[edge][k] + triangle.corner[(edge + 1) % 3][k]) - node.center[k];
      for (int n = 0; n < 3; ++n) {
        const double part = triangle.normal[n] / 3;
        node.order_0[n] += part;
        for (int i = 0; i < 3; ++i) {
          node.order_1[n][i] += part * at[i];
          for (int j = 0; j < 3; ++j) node.order_2[n][i][j] += 0.5 * part * at[i] * at[j];
        }
      }
    }
  }
  if (triangles.size() <= max_leaf) {
    node.begin = static_cast<std::uint32_t>(begin), node.count = static_cast<std::uint32_t>(triangles.size());
  } else {
    const int axis = hi[0] - lo[0] >= hi[1] - lo[1] && hi[0] - lo[0] >= hi[2] - lo[2] ? 0
                     : hi[1] - lo[1] >= hi[2] - lo[2]                                 ? 1
                                                                                      : 2;
    const auto half = static_cast<std::ptrdiff_t>(triangles.size() / 2);
    std::nth_element(
        triangles.begin(), triangles.begin() + half, triangles.end(),
        [&](const WeighedTriangle& a, const WeighedTriangle& b) { return a.middle[axis] < b.middle[axis]; });
    build(begin, begin + static_cast<std::size_t>(half));
    build(begin + static_cast<std::size_t>(half), end);
  }
  node.next = static_cast<std::uint32_t>(nodes_.size());
  nodes_[index] = node;
}

// f(x) = x/|x|³ and its derivatives, x the centre seen from the point.
double FastWinding::of_node(const Node& node, const Double3& x) {
  const double square = dot(x, x), over = 1 / std::sqrt(square), over_2 = over * over, over_3 = over * over_2;
  double sum = dot(node.order_0, x);
  for (int n = 0; n < 3; ++n)
    for (int i = 0; i < 3; ++i) {
      sum += node.order_1[n][i] * ((n == i ? 1 : 0) - 3 * over_2 * x[n] * x[i]);
      for (int j = 0; j < 3; ++j) {
        const double same = (n == i ? x[j] : 0) + (n == j ? x[i] : 0) + (i == j ? x[n] : 0);
        sum += node.order_2[n][i][j] * 3 * over_2 * (5 * over_2 * x[n] * x[i] * x[j] - same);
      }
    }
  return sum * over_3 * over_four_pi;
}

double FastWinding::of_triangle(const WeighedTriangle& triangle, const Double3& point) {
  Double3 a, b, c;
  for (int k = 0; k < 3; ++k) {
    a[k] = triangle.corner[0][k] - point[k];
    b[k] = triangle.corner[1][k] - point[k];
    c[k] = triangle.corner[2][k] - point[k];
  }
  const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
  const double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0]);
  return 2 * over_four_pi *
         std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

double FastWinding::at(const Double3& point, double beta) const {
  double sum = 0;
  for (std::uint32_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    Double3 x;
    for (int k = 0; k < 3; ++k) x[k] = node.center[k] - point[k];
    if (dot(x, x) > beta * beta * node.radius_squared) {
      sum += of_node(node, x);
      i = node.next;
      continue;
    }
    for (std::uint32_t k = 0; k < node.count; ++k) sum += of_triangle(triangles_[node.begin + k], point);
    i = node.count > 0 ? node.next : i + 1;
  }
  return sum;
}

void FastWinding::numbers(std::span<const Float3> points, double beta, std::span<double> numbers) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [x, y, z] = points[i];
    numbers[i] = at({{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}}, beta);
  }
}

}  // namespace raylanes::bench

// Winding numbers by the method of Barill, Dickson, Schmidt, Levin, Jacobson (2018), "Fast winding numbers for soups
// and clouds", written from the paper: a tree over the triangles, far nodes as dipoles with two more terms of their
// Taylor series.
#pragma once

#include <raylanes/mesh.hpp>

#include "../support/std.hpp"

namespace raylanes::bench {

class FastWinding {
 public:
  explicit FastWinding(const Mesh& mesh);
  // A node serves as a whole if its centre is farther away than `beta` times its radius; the paper takes 2. Without a
  // bound of the error. In doubles, points are finite.
  void numbers(std::span<const Float3> points, double beta, std::span<double> numbers) const;

 private:
  struct Double3 {
    double v[3];
    double operator[](int k) const { return v[k]; }
    double& operator[](int k) { return v[k]; }
  };
  struct Node {
    Double3 center;
    double radius_squared;
    std::uint32_t next;          // the node behind all below this one
    std::uint32_t begin, count;  // triangles of a leaf; count is 0 for others
    double order_0[3], order_1[3][3], order_2[3][3][3];
  };
  struct WeighedTriangle {
    Double3 corner[3];
    Double3 middle, normal;  // normal: of the length of the area
  };

  void build(std::size_t begin, std::size_t end);
  double at(const Double3& point, double beta) const;
  static double of_node(const Node& node, const Double3& from_point);
  static double of_triangle(const WeighedTriangle& triangle, const Double3& point);

  std::vector<WeighedTriangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace raylanes::bench

// Trees of doubles: what is reported of them, and builds and refits on threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>

#include "../support/meshes.hpp"
#include "../support/same_bytes.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

// Triangles of floats have the same boxes in both trees but for the frame, so the same tree is made.
TEST(DoubleTrees, cost_what_trees_of_floats_cost) {
  const Mesh mesh = triangle_soup(3000, 0.1f, 4);
  const DoubleMesh doubles = moved(mesh, 1, {0, 0, 0});
  const TreeReport of_floats = Bvh(mesh).report(),
                   report = BvhD(doubles.vertices, doubles.triangles).report();
  EXPECT_NEAR(report.sah_cost, of_floats.sah_cost, 0.01 * of_floats.sah_cost);
  EXPECT_NEAR(report.overlap, of_floats.overlap, 0.01);
}

TEST(DoubleTrees, say_what_was_chosen) {
  const DoubleMesh mesh = moved(triangle_soup(2000, 0.1f, 5), 1, {0, 0, 0});
  const TreeReport few = BvhD(mesh.vertices, mesh.triangles, {.choose = true, .rays = 1}).report(),
                   many = BvhD(mesh.vertices, mesh.triangles, {.choose = true}).report();
  EXPECT_NE(few.choice, "");
  EXPECT_NE(few.choice, many.choice);
  EXPECT_NE(std::pair(few.builder, few.optimized), std::pair(many.builder, many.optimized));
}

TEST(DoubleTrees, tell_of_each_triangle_once) {
  DoubleMesh mesh = moved(double_fan(600, 0.3f), 0.7, {5e6, 0.2, -0.3});
  mesh.triangles.push_back({0, 1, 1});
  BvhD tree(mesh.vertices, mesh.triangles);
  const auto expect_triangles = [&] {
    std::vector<int> times(mesh.triangles.size());
    tree.each_triangle([&](std::uint32_t primitive, const std::array<Double3, 3>& corners) {
      ++times.at(primitive);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(corners[k], mesh.vertices[mesh.triangles[primitive][k]]) << primitive;
    });
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto [a, b, c] = corners_of(mesh, i);
      EXPECT_EQ(times[i], a == b || b == c || c == a ? 0 : 1) << i;
    }
  };
  expect_triangles();
  // Those that collapse at a refit are not there.
  mesh.vertices[mesh.triangles[7][1]] = mesh.vertices[mesh.triangles[7][0]];
  tree.refit(mesh.vertices, mesh.triangles);
  expect_triangles();

  EXPECT_THROW(tree.each_triangle([](std::uint32_t, const std::array<Double3, 3>&) { throw 7; }), int);
  EXPECT_THROW(tree.each_triangle({}), std::bad_function_call);
  BvhD().each_triangle({});
}

}  // namespace
}  // namespace raylanes::testing

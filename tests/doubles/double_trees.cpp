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

TEST(DoubleTrees, decay_as_they_are_refitted_and_stay_as_they_were) {
  const Mesh soup = triangle_soup(900, 0.1f, 6);
  DoubleMesh mesh = moved(soup, 1, {5e6, 0, 0});
  const BvhD tree(mesh.vertices, mesh.triangles);
  EXPECT_EQ(tree.decay(), 1.0);
  EXPECT_EQ(tree.sah_cost(), tree.report().sah_cost);
  const DoubleMesh before = mesh;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i] = before.vertices[i * 7 % 2700];
  const BvhD other = tree.refitted(mesh.vertices, mesh.triangles, 2);
  EXPECT_GT(other.decay(), 2.0);
  EXPECT_EQ(tree.decay(), 1.0);
  const std::vector<RayD> rays = aimed_rays(mesh, 300, 7);
  std::vector<HitD> hits(rays.size()), expected(rays.size());
  other.closest(rays, hits), BvhD(mesh.vertices, mesh.triangles).closest(rays, expected);
  EXPECT_TRUE(same_bytes(hits, expected));
  EXPECT_THROW(tree.refitted(mesh.vertices, IndexView()), std::invalid_argument);
  EXPECT_EQ(BvhD().refitted(VertexViewD(), IndexView()).decay(), 1.0);
  EXPECT_EQ(BvhD().sah_cost(), 0.0);
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
    EXPECT_EQ(times.back(), 0) << "two corners are equal";
    EXPECT_EQ(std::ranges::count(times, 1), static_cast<std::ptrdiff_t>(times.size()) - 1);
  };
  expect_triangles();
  // A triangle that a refit makes a line is still there.
  mesh.vertices[mesh.triangles[7][1]] = mesh.vertices[mesh.triangles[7][0]];
  tree.refit(mesh.vertices, mesh.triangles);
  expect_triangles();

  EXPECT_THROW(tree.each_triangle([](std::uint32_t, const std::array<Double3, 3>&) { throw 7; }), int);
  EXPECT_THROW(tree.each_triangle({}), std::bad_function_call);
  BvhD().each_triangle({});
}

}  // namespace
}  // namespace raylanes::testing

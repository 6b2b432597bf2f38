// The builder that BuildOptions::choose takes: by the mesh and the number of rays alone, said in a line, and no hit
// depends on it.
#include "../../accel/builders/mesh_build.hpp"
#include "../support/level.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

// Thin triangles along the diagonal of space: their boxes are as good as empty.
Mesh needles(std::size_t count) {
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = static_cast<float>(i % 17) / 17, y = static_cast<float>(i % 23) / 23;
    append(mesh, Triangle{{{x, y, 0}, {x + 1, y + 1, 1}, {x + 1, y + 1.001f, 1}}});
  }
  return mesh;
}

TreeReport chosen(const Mesh& mesh, double rays, int threads = 1) {
  return Bvh(mesh, {.builder = TreeBuilder::median, .threads = threads, .choose = true, .rays = rays})
      .report();
}

TEST(Choice, few_rays_take_the_quickest_build) {
  const Mesh mesh = triangle_soup(1000, 0.1f, 91);
  EXPECT_EQ(chosen(mesh, 4999).builder, TreeBuilder::morton);
  EXPECT_EQ(chosen(mesh, 5001).builder, TreeBuilder::binned_sah);
  EXPECT_EQ(chosen(mesh, 0).builder, TreeBuilder::binned_sah) << "many are meant";
  for (const double none : {-1.0, double{NAN}, -double{INFINITY}})
    EXPECT_EQ(chosen(mesh, none).builder, TreeBuilder::binned_sah) << none;
  EXPECT_EQ(chosen(mesh, double{INFINITY}).builder, TreeBuilder::binned_sah);
}

TEST(Choice, needles_are_split_whatever_the_rays) {
  for (const double rays : {0.0, 1.0, 1e9})
    EXPECT_EQ(chosen(needles(500), rays).builder, TreeBuilder::spatial_splits) << rays;
}

// A right triangle fills half of its flat box, and four triangles askew a known share of theirs.
TEST(Choice, waste_is_that_of_boxes) {
  const Mesh flat{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}},
      askew{{{0, 0, 0}, {1, 1, 0}, {0, 1, 1}}, {{0, 1, 2}}};
  const auto waste_of = [](const Mesh& mesh) {
    Array<Reference> references(1);
    Box box{mesh.vertices[0], mesh.vertices[0]};
    for (const Float3& vertex : mesh.vertices)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(box.lo[axis], vertex[axis]);
        box.hi[axis] = std::max(box.hi[axis], vertex[axis]);
      }
    references[0] = Reference::make(four_box(box), 0);
    return box_waste(references, mesh.vertices, mesh.triangles);
  };
  EXPECT_EQ(waste_of(flat), 1.0);
  EXPECT_DOUBLE_EQ(waste_of(askew), 3 / std::sqrt(3.0));
}

TEST(Choice, is_said_in_a_line_that_names_it) {
  for (const Mesh& mesh : {triangle_soup(100, 0.1f, 92), needles(100)})
    for (const double rays : {1.0, 1e6}) {
      const TreeReport report = chosen(mesh, rays);
      const auto name = tree_builder_names[static_cast<std::size_t>(report.builder)];
      EXPECT_EQ(report.choice.rfind(name, 0), 0u) << report.choice;
      EXPECT_EQ(report.choice.find('\n'), std::string::npos);
    }
  EXPECT_EQ(Bvh(triangle_soup(100, 0.1f, 92)).report().choice, "") << "nothing was chosen";
}

// No triangle, one, equal ones, points, and numbers near the ends of floats.
TEST(Choice, of_any_mesh_at_all) {
  Mesh equal = triangle_soup(1, 0.5f, 93), huge = triangle_soup(50, 0.5f, 94), points = huge;
  equal.triangles.assign(300, {0, 1, 2});
  scale(huge, 1e38f);
  for (Float3& vertex : points.vertices) vertex = {1, 2, 3};
  for (const Mesh& mesh : {Mesh(), triangle_soup(1, 0.5f, 93), equal, huge, points})
    for (const double rays : {1.0, 1e9}) {
      const TreeReport report = chosen(mesh, rays);
      EXPECT_FALSE(report.choice.empty());
      EXPECT_EQ(chosen(mesh, rays, 2).choice, report.choice) << "threads";
    }
}

TEST(Choice, leaves_optimization_to_the_caller) {
  for (const bool optimize : {false, true})
    EXPECT_EQ(Bvh(needles(300), {.optimize = optimize, .choose = true}).report().optimized, optimize);
}

TEST(Choice, changes_no_hit) {
  for (const Mesh& mesh : {triangle_soup(500, 0.3f, 95), needles(500)}) {
    const std::vector<Ray> rays = mixed_rays(mesh, by_level(500), 2, {0, 0, 0}, 96);
    const std::vector<Hit> expected = trace(Bvh(mesh), rays, {});
    for (const double count : {1.0, 1e9}) {
      Bvh bvh(mesh, {.choose = true, .rays = count});
      const std::vector<Hit> hits = trace(bvh, rays, {});
      EXPECT_TRUE(same_bytes(hits, expected)) << count;
      const TreeBuilder builder = bvh.report().builder;
      bvh.refit(mesh.vertices, mesh.triangles);
      EXPECT_EQ(bvh.report().builder, builder) << "a refit goes on with what was chosen";
    }
  }
}

}  // namespace
}  // namespace raylanes::testing

// Normals and corners of hits in scenes: each as its triangle and its transform have it.
#include <raylanes/sphere_tree.hpp>
#include <raylanes/surface.hpp>

#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

// In doubles from left to right, rounded once.
Float3 in_scene(const Transform& transform, const Float3& point) {
  Float3 at;
  for (std::size_t i = 0; i < 3; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += static_cast<double>(transform.row[i][k]) * static_cast<double>(point[k]);
    at[i] = static_cast<float>(sum + static_cast<double>(transform.row[i][3]));
  }
  return at;
}

TEST(SceneNormals, are_of_triangle_and_transform) {
  Random random(871);
  const Mesh soup = without(triangle_soup(900, 0.4f, 872), 0.0, 873),
             ball = ellipsoid(2, {0, 0, 0}, {1, 0.5f, 1});
  Scene scene;
  scene.add(Bvh(soup, {.builder = TreeBuilder::spatial_splits})), scene.add(ball);
  scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 0.3f}}));
  for (std::uint32_t i = 0; i < 12; ++i) {
    Transform transform;
    for (float(&row)[4] : transform.row)
      for (float& x : row) x = random.number(-1, 1);
    scene.place(i % 3, transform);
  }
  scene.update();
  std::vector<Ray> rays(3000);
  for (Ray& ray : rays) ray = make_ray(random.point(3), random.point(1));
  std::vector<SceneHit> hits(rays.size());
  scene.closest(rays, hits);
  hits[0] = {1, 0, 0, 5, 0, 99}, hits[1] = {1, 0, 0, 12345, 0, 0};  // no such instance, no such triangle
  std::vector<Float3> normals(rays.size()), alone(rays.size());
  std::vector<Triangle> corners(rays.size()), corners_alone(rays.size());
  scene.normals(hits, normals), scene.normals(hits, alone, 3);
  scene.corners(hits, corners), scene.corners(hits, corners_alone, 3);
  EXPECT_TRUE(same_bytes(normals, alone));
  EXPECT_TRUE(same_bytes(corners, corners_alone));
  std::size_t found = 0, none = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SceneHit& hit = hits[i];
    if (i < 2 || !hit || hit.geometry == 2) {
      ++none;
      for (const float x : normals[i]) ASSERT_TRUE(std::isnan(x)) << i;
      for (const Float3& corner : corners[i].corner)
        for (const float x : corner) ASSERT_TRUE(std::isnan(x)) << i;
      continue;
    }
    const Mesh& mesh = hit.geometry == 0 ? soup : ball;
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle.corner[k] = mesh.vertices[mesh.triangles[hit.primitive][k]];
    const Float3 expected = normal_in_scene(scene.transform_of(hit.instance), unit_normal(triangle));
    ASSERT_TRUE(same_bytes(normals[i], expected)) << i;
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_TRUE(
          same_bytes(corners[i].corner[k], in_scene(scene.transform_of(hit.instance), triangle.corner[k])))
          << i;
    ++found;
  }
  EXPECT_GT(found, 500u);
  EXPECT_GT(none, 100u);
  // Over the hits themselves.
  std::vector<SceneHit> over = hits;
  const std::span in_place(reinterpret_cast<Float3*>(over.data()), over.size());
  scene.normals(over, in_place);
  EXPECT_TRUE(same_bytes(in_place, std::span<Float3>(normals)));
}

// A mesh in the common tree needs none of its own for them, whatever its hits name.
TEST(SceneNormals, build_no_tree) {
  Mesh mesh = cube(-1, 1);
  append(mesh, make_triangle({0, 0, 0}, {0, 0, 0}, {1, 0, 0}));
  Scene scene;
  scene.place(scene.add(mesh)), scene.place(scene.add(mesh));
  scene.update();
  const std::vector<SceneHit> hits{{1, 0, 0, 5, 1, 1}, {1, 0, 0, 12, 0, 0}, {1, 0, 0, 13, 0, 0}, {}};
  std::vector<Float3> normals(4);
  std::vector<Triangle> corners(4);
  scene.normals(hits, normals), scene.corners(hits, corners);
  EXPECT_EQ(scene.report().meshes_without_tree, 2u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(corners[0].corner[k], mesh.vertices[mesh.triangles[5][k]]);
  EXPECT_EQ(normals[0], unit_normal(corners[0]));
  for (std::size_t i = 1; i < 4; ++i) EXPECT_TRUE(std::isnan(corners[i].corner[0][0] + normals[i][0])) << i;
  // Closest points name triangles, too.
  const SceneClosestPoint closest = scene.closest_point({3, 0.25f, 0.5f});
  scene.corners(closest, std::span(corners).first(1));
  EXPECT_EQ(corners[0].corner[1], mesh.vertices[mesh.triangles[closest.primitive][1]]);
}

TEST(SceneNormals, are_refused_for_hits_that_name_no_instance) {
  Scene scene;
  scene.place(scene.add(Bvh(cube(-1, 1))));
  scene.update();
  std::vector<Float3> normals(3);
  EXPECT_THROW(scene.normals(std::vector<Hit>(3), normals), std::invalid_argument);
  EXPECT_THROW(scene.normals(std::vector<SceneHit>(2), normals), std::invalid_argument);
  EXPECT_THROW(scene.normals(std::vector<SceneHit>(3), normals, -1), std::invalid_argument);
  EXPECT_THROW(scene.normals(PrimitiveView(nullptr, 3), normals), std::invalid_argument);
  scene.normals(std::vector<SceneHit>(), {});
  std::vector<Triangle> corners(3);
  EXPECT_THROW(scene.corners(std::vector<Hit>(3), corners), std::invalid_argument);
  EXPECT_THROW(scene.corners(std::vector<SceneHit>(2), corners), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing

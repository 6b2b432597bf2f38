// Normals of hits in scenes: each as its triangle and its transform have it.
#include <raylanes/sphere_tree.hpp>
#include <raylanes/surface.hpp>

#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

TEST(SceneNormals, are_of_triangle_and_transform) {
  Random random(871);
  const Mesh soup = without(triangle_soup(900, 0.4f, 872), 0.0, 873),
             ball = ellipsoid(2, {0, 0, 0}, {1, 0.5f, 1});
  Scene scene;
  scene.add(Bvh(soup, {.builder = TreeBuilder::spatial_splits})), scene.add(Bvh(ball));
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
  scene.normals(hits, normals), scene.normals(hits, alone, 3);
  EXPECT_TRUE(same_bytes(normals, alone));
  std::size_t found = 0, none = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SceneHit& hit = hits[i];
    if (i < 2 || !hit || hit.geometry == 2) {
      ++none;
      for (const float x : normals[i]) ASSERT_TRUE(std::isnan(x)) << i;
      continue;
    }
    const Mesh& mesh = hit.geometry == 0 ? soup : ball;
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle.corner[k] = mesh.vertices[mesh.triangles[hit.primitive][k]];
    const Float3 expected = normal_in_scene(scene.transform_of(hit.instance), unit_normal(triangle));
    ASSERT_TRUE(same_bytes(normals[i], expected)) << i;
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
}

}  // namespace
}  // namespace raylanes::testing

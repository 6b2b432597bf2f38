// Large instances that overlap are opened: the top level stands on their nodes.
#include "../../../accel/queries/traced_tree.hpp"
#include "../../../accel/scene/scene_parts.hpp"
#include "../triangle_parts.hpp"

namespace raylanes::testing {
namespace {

// A floor, a wall and a stair, which most of a room's box belongs to.
Mesh long_mesh(int kind) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const float x = static_cast<float>(i);
    const Float3 at = kind == 0 ? Float3{x, x, 0} : kind == 1 ? Float3{x, 0, x} : Float3{60 - x, x, x};
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.vertices.push_back(at);
      mesh.vertices.back()[k] += 1;
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// The top level over instances of a tree, and how many entries each of them has.
struct Opened {
  std::vector<Instance> instances;
  std::vector<TopLevel> tops;
  std::map<std::uint32_t, std::size_t> entries;

  Opened(const Bvh& tree, const std::vector<Transform>& transforms) {
    std::vector<InstanceBounds> bounds;
    for (const Transform& transform : transforms) {
      instances.emplace_back(0, transform, ~0u);
      instances.back().tree = TreeAccess::ready(tree);
      bounds.push_back(bounds_of(instances.back(), tree.bounds(), 0));
    }
    tops = tops_over(instances, bounds);
    for (const TopLevel& top : tops)
      for (const InstanceEntry& entry : top.entries) ++entries[entry.instance];
  }
};

TEST(Opened, are_large_instances_beside_others) {
  const Bvh tree(long_mesh(2));
  const Opened two(tree, {moved_by(0, 0, 0), moved_by(0, 0, 0, 0.02f)});
  ASSERT_EQ(two.tops.size(), 1u);
  EXPECT_GE(two.entries.at(0), 8u);
  EXPECT_EQ(two.entries.at(1), 1u);
  EXPECT_EQ(two.tops[0].opened.order.size(), two.tops[0].entries.size());
  EXPECT_EQ(two.tops[0].opened.slack, two.tops[0].tree.slack);
  EXPECT_EQ(two.tops[0].tree.order.size(), 2u);  // batches go through instances
  const Opened alone(tree, {moved_by(1, 2, 3)});
  EXPECT_EQ(alone.entries.at(0), 1u);
  EXPECT_EQ(alone.tops[0].opened.size, 0u);
}

TEST(Opened, are_none_of_many_small_ones) {
  const Bvh tree(ellipsoid(2, {0, 0, 0}, {1, 1, 1}));
  std::vector<Transform> places;
  for (int i = 0; i < 200; ++i)
    places.push_back(moved_by(static_cast<float>(3 * (i % 20)), static_cast<float>(3 * (i / 20)), 0));
  const Opened field(tree, places);
  EXPECT_EQ(field.tops[0].opened.size, 0u);
  EXPECT_EQ(field.tops[0].entries.size(), places.size());
}

TEST(Opened, add_a_bounded_number_of_entries) {
  const Bvh tree(long_mesh(2));
  const Opened many(tree, std::vector<Transform>(400, moved_by(0.5f, 0, 0)));
  EXPECT_LE(many.tops[0].entries.size(), 400u + 2048u);
  EXPECT_GT(many.tops[0].entries.size(), 2400u);
}

// By the tree of each part; also where the ray is rounded in the space of an instance that lies far away.
TEST(Opened, have_the_hits_of_all_instances) {
  Random random(411);
  for (const float away : {0.0f, 1e4f}) {
    TriangleParts parts;
    for (int kind = 0; kind < 3; ++kind) parts.add(long_mesh(kind));
    for (std::uint32_t i = 0; i < 9; ++i) {
      Transform transform = i % 4 == 0 ? moved_by(away, 0, 0) : random_transform(random, 0.03f, 1);
      for (std::size_t k = 0; k < 3; ++k) transform.row[k][k] += i % 4 == 0 ? 0 : 1;
      transform.row[0][3] += i % 4 == 0 ? 0 : away;
      parts.scene.set_moving(parts.scene.place(i % 3, transform, 1u << (i % 2)));
    }
    parts.scene.update();
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < by_level(1500); ++i) {
      const auto instance = static_cast<std::uint32_t>(random.index(9));
      const Mesh& mesh = parts.meshes[instance % 3];
      const Float3 to = mesh.vertices[random.index(mesh.vertices.size())];
      const Transform at = parts.scene.transform_of(instance);
      Float3 from = random.point(50), direction;
      from[0] += away;
      for (std::size_t k = 0; k < 3; ++k)
        direction[k] = at.row[k][0] * to[0] + at.row[k][1] * to[1] + at.row[k][2] * to[2] + at.row[k][3] +
                       random.number(-0.4f, 0.4f) - from[k];
      rays.push_back(make_ray(from, direction, i % 5 == 0 ? -0.5f : 0, i % 3 == 0 ? 0.99f : infinity));
    }
    expect_all(parts, rays, ~0u, rays.size() / 8);
    expect_all(parts, rays, 2u);
  }
}

}  // namespace
}  // namespace raylanes::testing

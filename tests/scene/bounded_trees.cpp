// Trees over boxes with primitives of the caller's: alone and in scenes.
#include "boxed_cases.hpp"

namespace raylanes::testing {
namespace {

TEST(BoundedTree, finds_the_hits_of_the_callers_test) {
  const UserTriangles user = soup(400, 91);
  for (const std::uint32_t most : {1u, 3u, 8u}) {
    const BoundedTree tree(user.boxes(), {.max_in_leaf = most});
    expect_batches(
        tree, rays_around(by_level(1200), 3, 92), [&](const Ray& ray) { return user.closest(ray); }, user);
    expect_batches(
        tree, rays_around(by_level(600), 1000, 93), [&](const Ray& ray) { return user.closest(ray); }, user);
    for (const float reach : {0.5f, 3.0f, 1000.0f})
      expect_batches(
          tree, rays_from_a_point(by_level(1200), reach, 107),
          [&](const Ray& ray) { return user.closest(ray); }, user);
  }
}

// Balls around boxes whose hits are off by nearly all that the slack has room for at an origin far away: in packets,
// in streams, and as single rays.
TEST(BoundedTree, has_room_for_hits_beside_boxes_as_seen_from_far_away) {
  constexpr float slack = 0x1p-10f, away = 1000;
  Random random(109);
  std::vector<Float3> centres;
  std::vector<Box> boxes;
  for (int i = 0; i < 60; ++i) centres.push_back(random.point(20)), boxes.push_back({centres[i], centres[i]});
  const auto test = [&](std::uint32_t primitive, const Ray& ray, Hit& hit) {
    double along = 0, size = 0, off = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = ray.direction[k], way = static_cast<double>(centres[primitive][k]) - ray.origin[k];
      along += d * way, size += d * d;
    }
    for (std::size_t k = 0; k < 3; ++k)
      off = std::max(off, std::abs(ray.origin[k] + along / size * ray.direction[k] -
                                   static_cast<double>(centres[primitive][k])));
    hit.t = static_cast<float>(along / size);
    return off <= 0.95 * slack * away && hit.t >= ray.tmin && hit.t <= ray.tmax;
  };
  const auto closest_of = [&](const Ray& ray) {
    Hit best;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
      if (Hit hit; test(i, ray, hit) && (hit.primitive = i, is_nearer(hit, best))) best = hit;
    return best;
  };
  for (const bool share_origin : {true, false}) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < by_level(600); ++i) {
      Float3 from{300, -200, -away}, to = centres[i % centres.size()];
      for (std::size_t k = 0; k < 3; ++k)
        from[k] += share_origin ? 0.0f : random.number(-10, 0), to[k] += random.number(-1, 1);
      rays.push_back(make_ray(from, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}));
    }
    EXPECT_GT(std::ranges::count_if(rays, [&](const Ray& ray) { return bool(closest_of(ray)); }),
              rays.size() / 4);
    for (const std::uint32_t most : {1u, 4u})
      expect_batches(BoundedTree(boxes, {.max_in_leaf = most, .slack = slack}), rays, closest_of, test);
  }
}

// A caller's data in the tree's order, tested a leaf at a time: from its first index on, also through a scene.
TEST(BoundedTree, visits_data_in_its_order) {
  const UserTriangles user = soup(400, 105);
  std::vector<Box> boxes = user.boxes();
  boxes[7].lo[0] = nan, boxes[100].hi[1] = infinity;  // never visited
  for (const std::uint32_t most : {1u, 3u, 8u}) {
    BoundedTree tree(boxes, {.max_in_leaf = most});
    const std::span<const std::uint32_t> order = tree.order();
    const std::set<std::uint32_t> numbers(order.begin(), order.end());
    EXPECT_EQ(order.size(), boxes.size() - 2);
    EXPECT_EQ(numbers.size(), order.size());
    EXPECT_FALSE(numbers.contains(7) || numbers.contains(100));
    UserTriangles sorted;
    for (const std::uint32_t i : order) sorted.triangles.push_back(user.triangles[i]);
    const auto test = [&](const LeafVisit& leaf) {
      for (const std::uint32_t number : leaf.rays)
        for (std::size_t k = 0; k < leaf.primitives.size(); ++k) {
          Hit hit;
          if (!sorted(static_cast<std::uint32_t>(leaf.first + k), leaf.ray[number], hit)) continue;
          hit.primitive = leaf.primitives[k];
          leaf.keep(number, hit);
        }
    };
    UserTriangles visited = user;
    for (const std::uint32_t i : {7u, 100u}) visited.triangles[i] = {};
    const std::vector<Ray> rays = rays_around(by_level(600), 3, 106);
    const auto closest_of = [&](const Ray& ray) { return visited.closest(ray); };
    expect_batches(tree, rays, closest_of, test);
    Scene scene;
    scene.place(scene.add(std::move(tree), test));
    scene.update();
    std::vector<SceneHit> expected;
    for (const Ray& ray : rays)
      expected.push_back(
          expected_hit(scene, ray, ~0u, [&](std::uint32_t, const Ray& r) { return closest_of(r); }));
    expect_hits(scene, rays, expected);
  }
  const BoundedTree none;
  EXPECT_TRUE(none.order().empty());
}

TEST(BoundedTree, is_built_by_every_builder) {
  const UserTriangles user = soup(60, 94);
  const std::vector<Ray> rays = rays_around(200, 2, 95);
  for (std::size_t i = 0; i < tree_builder_names.size(); ++i) {
    const BoundedTree tree(user.boxes(), {.builder = static_cast<TreeBuilder>(i), .threads = 2});
    std::vector<Hit> hits(rays.size());
    tree.closest(rays, hits, user);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const Hit expected = user.closest(rays[k]);
      ASSERT_TRUE(same_bytes(hits[k], expected));
    }
  }
}

TEST(BoundedTree, leaves_out_boxes_that_are_none) {
  const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 1}},         {{1, 0, 0}, {0, 1, 1}},
                               {{0, nan, 0}, {1, 1, 1}},       {{0, 0, -infinity}, {1, 1, 1}},
                               {{0, 0, 0}, {1, 1, infinity}},  {{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}},
                               {{-3e38f, 0, 0}, {3e38f, 1, 1}}};
  const BoundedTree tree(boxes);
  EXPECT_EQ(tree.size(), boxes.size());
  std::set<std::uint32_t> visited;
  const auto test = [&](std::uint32_t primitive, const Ray&, Hit&) {
    visited.insert(primitive);
    return false;
  };
  std::vector<Hit> hits(1);
  tree.closest(std::vector<Ray>{make_ray({0.5f, 0.5f, -1}, {0, 0, 1})}, hits, test);
  EXPECT_EQ(visited, (std::set<std::uint32_t>{0, 5, 6}));
  EXPECT_FALSE(hits[0]);
  BoundedTree().closest(std::vector<Ray>(1), hits, test);
}

TEST(BoundedTree, takes_hits_of_any_bits_and_throws_what_tests_throw) {
  const BoundedTree tree(std::vector<Box>(20, Box{{0, 0, 0}, {1, 1, 1}}));
  const std::vector<Ray> rays(100, make_ray({0.5f, 0.5f, -1}, {0, 0, 1}));
  for (const std::size_t size : {std::size_t{40}, rays.size()})  // as a stream, as a packet
    for (const float t : {nan, infinity, -infinity, 3e38f, -0.0f}) {
      std::vector<Hit> hits(size);
      tree.closest(std::span(rays).first(size), hits, [&](std::uint32_t primitive, const Ray&, Hit& hit) {
        hit.t = primitive < 10 ? 2.0f : t;
        return true;
      });
      // A hit that lies before its box ends the search where it is found.
      for (const Hit& hit : hits) EXPECT_EQ(hit.primitive >= 10, t < 2);
    }
  const auto throws = [](std::uint32_t, const Ray&, Hit&) -> bool { throw std::runtime_error("no"); };
  std::vector<Hit> hits(rays.size());
  EXPECT_THROW(tree.closest(rays, hits, throws, {.threads = 2}), std::runtime_error);
  EXPECT_THROW(tree.closest(std::span(rays).first(3), hits, throws), std::invalid_argument);
  EXPECT_THROW(BoundedTree({}, {.max_in_leaf = 9}), std::invalid_argument);
  EXPECT_THROW(BoundedTree({}, {.max_in_leaf = 0}), std::invalid_argument);
  EXPECT_THROW(BoundedTree({}, {.slack = nan}), std::invalid_argument);
  EXPECT_THROW(BoundedTree({}, {.threads = -1}), std::invalid_argument);
}

// A test may itself trace rays: through the same tree, and scenes.
TEST(BoundedTree, may_be_traced_by_a_test_of_its_own) {
  const UserTriangles user = soup(50, 96);
  const BoundedTree inner(user.boxes()),
      outer(std::vector<Box>{{{-1, -1, -1}, {1, 1, 1}}, {{-2, -2, -2}, {2, 2, 2}}});
  const std::vector<Ray> rays = rays_around(100, 3, 97);
  std::vector<Hit> hits(rays.size());
  outer.closest(rays, hits, [&](std::uint32_t, const Ray& ray, Hit& hit) {
    const std::vector<Ray> twice(20, ray);
    std::vector<Hit> found(twice.size());
    inner.closest(twice, found, user);
    hit = found[19];
    return static_cast<bool>(hit);
  });
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(hits[i].t, user.closest(rays[i]).t);
}

}  // namespace
}  // namespace raylanes::testing

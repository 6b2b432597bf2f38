// Next hits and filters of spheres and of primitives of the caller's, alone and in scenes beside triangles.
#include "../../oracles/peeled.hpp"
#include "../../support/filtered.hpp"
#include "../boxed_cases.hpp"

namespace raylanes::testing {
namespace {

// Balls whose surfaces a ray may hit twice, in doubles.
struct UserBalls {
  std::vector<Sphere> balls;

  bool operator()(std::uint32_t primitive, const Ray& ray, Hit& hit) const {
    for (const float t : both(primitive, ray))
      if (t >= ray.tmin && t <= ray.tmax) {
        hit.t = t;
        return true;
      }
    return false;
  }
  std::array<float, 2> both(std::uint32_t primitive, const Ray& ray) const {
    const Sphere& ball = balls[primitive];
    double a = 0, b = 0, c = -double{ball.radius} * double{ball.radius};
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = ray.direction[k], o = double{ray.origin[k]} - double{ball.centre[k]};
      a += d * d, b += d * o, c += o * o;
    }
    const double root = std::sqrt(b * b - a * c);  // NaN for a miss
    return {static_cast<float>((-b - root) / a), static_cast<float>((-b + root) / a)};
  }
  std::vector<Box> boxes() const {
    std::vector<Box> boxes;
    for (const Sphere& ball : balls) {
      Box box;
      for (std::size_t k = 0; k < 3; ++k)
        box.lo[k] = ball.centre[k] - 1.01f * ball.radius, box.hi[k] = ball.centre[k] + 1.01f * ball.radius;
      boxes.push_back(box);
    }
    return boxes;
  }
  std::vector<Hit> all(const Ray& ray) const {
    std::vector<Hit> hits;
    for (std::uint32_t i = 0; i < balls.size(); ++i)
      for (const float t : both(i, ray))
        if (t >= ray.tmin && t <= ray.tmax) hits.push_back({t, 0, 0, i});
    return hits;
  }
};

UserBalls user_balls(std::size_t count, Random& random) {
  UserBalls balls{random_spheres(count, random)};
  std::erase_if(balls.balls, [](const Sphere& ball) {
    return !(ball.radius > 0 && ball.radius < 9 && std::abs(ball.centre[0]) < 9);
  });
  return balls;
}

// In the order of t, then of primitives, each once.
std::vector<Hit> in_order(std::vector<Hit> hits) {
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return comes_after(b, a); });
  const auto same = [](const Hit& a, const Hit& b) { return a.t == b.t && a.primitive == b.primitive; };
  hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
  return hits;
}

// Both hits of each sphere, by the kernels of arrays.
std::vector<Hit> all_of_spheres(const std::vector<Sphere>& spheres, const Ray& ray) {
  const SphereRows rows(spheres);
  const std::size_t n = spheres.size();
  std::vector<std::uint8_t> bits(n / 8 + 1);
  std::vector<float> near(n), far(n);
  distances(ray,
            SphereArrays{{rows.row[0].data(), rows.row[1].data(), rows.row[2].data()}, rows.row[3].data(), n},
            std::span(bits).first((n + 7) / 8), near, far, {.path = &paths().front()});
  std::vector<Hit> hits;
  for (std::uint32_t i = 0; i < n; ++i)
    for (const float t : {near[i], far[i]})
      if ((bits[i / 8] >> i % 8 & 1) != 0 && t >= ray.tmin && t <= ray.tmax && std::isfinite(t))
        hits.push_back({t, 0, 0, i});
  return in_order(hits);
}

// Spheres that share fronts, touch and coincide: ties in t.
std::vector<Sphere> tied_spheres() {
  std::vector<Sphere> spheres;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (const float radius : {0.5f, 1.0f, 0.5f})
        spheres.push_back({{static_cast<float>(x), static_cast<float>(y), 0}, radius});
  return spheres;
}
std::vector<Ray> rays_at_ties(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = [&] { return static_cast<float>(random.integer(-6, 6)) / 2; };
    rays.push_back(i % 2 == 0 ? make_ray({number(), number(), -4}, {0, 0, 1})
                              : make_ray({-7, number(), number() / 4}, {1, 0, 0}));
  }
  return rays;
}

TEST(NextOfSpheres, are_where_rays_enter_and_leave_them) {
  Random random(821);
  for (const bool tied : {false, true}) {
    const std::vector<Sphere> spheres = tied ? tied_spheres() : random_spheres(100, random);
    const SphereTree tree(spheres);
    std::vector<Ray> rays = tied ? rays_at_ties(by_level(200), 822) : rays_around(by_level(300), 2, 823);
    const std::vector<Ray> packets = rays_from_a_point(by_level(1000), 2, 832);
    rays.insert(rays.end(), packets.begin(), packets.end());
    const auto all_of = [&](const Ray& ray) { return all_of_spheres(spheres, ray); };
    for (const Path* path : supported_paths()) {
      SCOPED_TRACE(path->name);
      expect_peeled<Hit>(
          rays, VisitOptions{.path = path, .threads = 2},
          [&](auto&&... call) { return tree.closest(call...); }, all_of);
      expect_filtered<Hit>(tree, rays, VisitOptions{.path = path}, all_of);
    }
  }
}

TEST(NextOfSpheres, leave_out_what_rays_skip) {
  const std::vector<Sphere> spheres{{{0, 0, 0}, 1}, {{0, 0, 0}, 2}};
  const SphereTree tree(spheres);
  const Ray ray = make_ray({0, 0, -4}, {0, 0, 1});
  const Hit first = tree.closest(ray);
  EXPECT_EQ(first.t, 2);
  EXPECT_EQ(tree.closest(ray, {.after = first}).t, 3);
  EXPECT_EQ(tree.closest(ray, {.skip = 0u, .after = first}).t, 5);  // the other hit of sphere 0
  EXPECT_EQ(tree.closest(ray, {.skip = 1u, .after = Hit{-infinity, 0, 0, 0}}).t, 3);
  EXPECT_FALSE(tree.closest(ray, {.after = Hit()}));
  EXPECT_FALSE(tree.closest(ray, {.after = Hit{nan, 0, 0, 0}}));
  const Hit two[2] = {first, first};
  EXPECT_THROW(tree.closest(ray, {.after = two}), std::invalid_argument);
}

// Calls of a tree with a test.
template <class Test>
struct WithTest {
  const BoundedTree& tree;
  Test& test;

  Hit operator()(const Ray& ray, const VisitOptions& options) const {
    return tree.closest(ray, test, options);
  }
  void operator()(const std::vector<Ray>& rays, std::vector<Hit>& hits, const VisitOptions& options) const {
    tree.closest(rays, hits, test, options);
  }
};
template <class Test>
WithTest(const BoundedTree&, Test&) -> WithTest<Test>;

TEST(NextOfBoxes, are_those_that_the_test_finds) {
  Random random(824);
  const UserBalls balls = user_balls(60, random);
  const UserTriangles triangles = soup(300, 825);
  const std::vector<Ray> rays = rays_around(by_level(300), 2, 826);
  const auto all_of = [&](const Ray& ray) { return in_order(balls.all(ray)); };
  const auto of_all_sides = [&](const LeafVisit& leaf) {
    for (const std::uint32_t number : leaf.rays)
      for (const std::uint32_t primitive : leaf.primitives)
        for (const float t : balls.both(primitive, leaf.ray[number]))
          if (t >= leaf.ray[number].tmin && t <= leaf.ray[number].tmax)
            leaf.keep(number, {t, 0, 0, primitive});
  };
  const auto of_leaves = [&](const LeafVisit& leaf) {
    for (const std::uint32_t number : leaf.rays)
      for (const std::uint32_t primitive : leaf.primitives) leaf.keep_first(number, primitive, balls);
  };
  for (const std::uint32_t most : {1u, 5u}) {
    const BoundedTree of_balls(balls.boxes(), {.max_in_leaf = most}),
        of_triangles(triangles.boxes(), {.max_in_leaf = most});
    for (const Path* path : supported_paths()) {
      SCOPED_TRACE(path->name);
      const VisitOptions options{.path = path, .threads = 2};
      expect_peeled<Hit>(rays, options, WithTest{of_balls, balls}, all_of);
      expect_peeled<Hit>(rays, options, WithTest{of_balls, of_leaves}, all_of);
      expect_peeled<Hit>(rays, options, WithTest{of_balls, of_all_sides}, all_of);
      expect_peeled<Hit>(rays, options, WithTest{of_triangles, triangles}, [&](const Ray& ray) {
        std::vector<Hit> hits;
        for (std::uint32_t i = 0; i < triangles.triangles.size(); ++i)
          if (Hit hit; triangles(i, ray, hit)) hit.primitive = i, hits.push_back(hit);
        return in_order(hits);
      });
    }
  }
}

TEST(NextOfBoxes, occluded_asks_for_any_hit) {
  Random random(827);
  const UserBalls balls = user_balls(40, random);
  const BoundedTree tree(balls.boxes());
  const std::vector<Ray> rays = rays_around(by_level(300), 2, 828);
  const std::vector<Hit> misses(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  tree.occluded(rays, occluded, balls, {.after = misses});  // of closest() only
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(occluded[i], balls.all(rays[i]).empty() ? 0 : 1);
    EXPECT_EQ(tree.occluded(rays[i], balls, {.after = misses[i]}), occluded[i] != 0);
  }
}

// Triangles, spheres and the caller's balls, in several places each.
struct MixedScene {
  UserBalls balls;
  std::vector<Sphere> spheres;
  Scene scene;

  explicit MixedScene(Random& random, std::size_t instances)
      : balls(user_balls(30, random)), spheres(random_spheres(30, random)) {
    scene.add(Bvh(triangle_soup(100, 0.4f, 829)));
    scene.add(SphereTree(spheres));
    scene.add(BoundedTree(balls.boxes()), balls);
    const Transform turned{{{0, 0, 1, 0.5f}, {0, 1, 0, 0}, {-1, 0, 0, 0}}};
    for (std::uint32_t i = 0; i < instances; ++i)
      scene.place((i + 1) % 3, i % 4 == 3 ? turned : moved_by(static_cast<float>(i / 3 % 2), 0, 0),
                  1u << i % 3);
    scene.update();
  }
  std::vector<SceneHit> all(const Ray& ray, std::uint32_t mask) const {
    return all_scene_hits_by(scene, ray, mask, [&](std::uint32_t geometry, const Ray& mapped, std::uint32_t) {
      if (geometry == 1) return all_of_spheres(spheres, mapped);
      if (geometry == 2) return in_order(balls.all(mapped));
      return scene.tree(0)->all_hits(std::vector<Ray>{mapped}, {.path = &paths().front()}).items;
    });
  }
};

TEST(NextOfScenes, take_spheres_and_primitives_of_the_caller) {
  Random random(830);
  for (const std::size_t instances : {std::size_t{1}, std::size_t{2}, std::size_t{9}}) {
    const MixedScene mixed(random, instances);
    const std::vector<Ray> rays = rays_around(by_level(200), 2, 831);
    for (const Path* path : supported_paths())
      for (const std::uint32_t mask : {~0u, 0b101u}) {
        SCOPED_TRACE(std::string(path->name) + ", " + std::to_string(instances) + " instances");
        const auto all_of = [&](const Ray& ray) { return mixed.all(ray, mask); };
        if (instances > 2 || mask == ~0u)
          expect_peeled<SceneHit>(
              rays, TraceOptions{.path = path, .threads = 2, .mask = mask},
              [&](const auto& from, auto&&... rest) { return mixed.scene.closest(from, rest...); }, all_of);
        if (instances > 2)
          expect_filtered<SceneHit>(mixed.scene, rays, TraceOptions{.path = path, .mask = mask}, all_of);
        for (const std::uint32_t most : {~0u, 2u, 0u}) {
          const auto lists = mixed.scene.all_hits(rays, {.max_count = most, .path = path, .mask = mask});
          for (std::size_t i = 0; i < rays.size(); ++i) {
            std::vector<SceneHit> all = all_of(rays[i]);
            all.resize(std::min<std::size_t>(all.size(), most));
            ASSERT_TRUE(same_bytes(lists[i], std::span<const SceneHit>(all))) << "ray " << i;
          }
        }
      }
  }
}

}  // namespace
}  // namespace raylanes::testing

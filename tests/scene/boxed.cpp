// Trees over boxes with primitives of the caller's, and over spheres: alone and in scenes.
#include <cmath>

#include <raylanes/paths.hpp>

#include "../support/float_modes.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {
namespace {

// Triangles by a test in doubles that is the same wherever it is inlined.
struct UserTriangles {
  std::vector<Triangle> triangles;

  bool operator()(std::uint32_t primitive, const Ray& ray, Hit& hit) const {
    double e1[3], e2[3], s[3], d[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = triangles[primitive];
      const double v0 = static_cast<double>(t.corner[0][k]);
      e1[k] = static_cast<double>(t.corner[1][k]) - v0, e2[k] = static_cast<double>(t.corner[2][k]) - v0;
      s[k] = static_cast<double>(ray.origin[k]) - v0, d[k] = static_cast<double>(ray.direction[k]);
    }
    const auto dot = [](const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const double p[3] = {d[1] * e2[2] - d[2] * e2[1], d[2] * e2[0] - d[0] * e2[2],
                         d[0] * e2[1] - d[1] * e2[0]};
    const double q[3] = {s[1] * e1[2] - s[2] * e1[1], s[2] * e1[0] - s[0] * e1[2],
                         s[0] * e1[1] - s[1] * e1[0]};
    const double det = dot(e1, p);
    hit.t = static_cast<float>(dot(e2, q) / det);
    hit.u = static_cast<float>(dot(s, p) / det), hit.v = static_cast<float>(dot(d, q) / det);
    return hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1 && hit.t >= ray.tmin && hit.t <= ray.tmax;
  }
  std::vector<Box> boxes() const {
    std::vector<Box> boxes;
    for (const Triangle& t : triangles) {
      Box box{t.corner[0], t.corner[0]};
      for (const Float3& corner : t.corner)
        for (std::size_t k = 0; k < 3; ++k)
          box.lo[k] = std::min(box.lo[k], corner[k]), box.hi[k] = std::max(box.hi[k], corner[k]);
      boxes.push_back(box);
    }
    return boxes;
  }
  Hit closest(const Ray& ray) const {
    Hit best;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      Hit hit;
      if (!(*this)(i, ray, hit)) continue;
      hit.primitive = i;
      if (is_nearer(hit, best)) best = hit;
    }
    return best;
  }
};

UserTriangles soup(std::size_t count, std::uint64_t seed) {
  const Mesh mesh = triangle_soup(count, 0.2f, seed);
  UserTriangles user;
  for (const Index3& t : mesh.triangles) user.triangles.push_back(triangle_of(mesh.vertices, t));
  return user;
}

std::vector<Sphere> random_spheres(std::size_t count, Random& random) {
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) spheres.push_back({random.point(1), random.magnitude(1e-3, 0.3)});
  const float odd[] = {nan, infinity, -1.0f, 3e38f, 0.0f, 1e-30f};
  for (const float radius : odd) spheres.push_back({random.point(1), radius});
  spheres.push_back({{nan, 0, 0}, 1}), spheres.push_back({{infinity, 0, 0}, 1});
  spheres.push_back(spheres[0]);  // the first wins
  return spheres;
}
struct SphereRows {
  std::vector<float> row[4];
  explicit SphereRows(const std::vector<Sphere>& spheres) {
    for (const Sphere& sphere : spheres) {
      for (std::size_t k = 0; k < 3; ++k) row[k].push_back(sphere.centre[k]);
      row[3].push_back(signed_square(sphere.radius));
    }
  }
  Hit closest(const Ray& ray) const {
    return closest_hit(
        ray, SphereArrays{{row[0].data(), row[1].data(), row[2].data()}, row[3].data(), row[0].size()},
        {.path = &paths().front()});
  }
};

// closest_of(ray) is what batches are to return.
template <class Tree, class ClosestOf, class... Test>
void expect_batches(const Tree& tree, const std::vector<Ray>& rays, const ClosestOf& closest_of,
                    Test&&... test) {
  std::vector<Hit> expected;
  for (const Ray& ray : rays) expected.push_back(closest_of(ray));
  for (const Path* path : supported_paths())
    for (const std::size_t size : {rays.size(), std::size_t{3}, std::size_t{0}}) {
      const std::span<const Ray> some = std::span(rays).first(size);
      std::vector<Hit> hits(size, Hit{1, 2, 3, 4});
      std::vector<std::uint8_t> occluded(size, 7);
      tree.closest(some, hits, test..., {.path = path, .threads = 2});
      tree.occluded(some, occluded, test..., {.path = path});
      for (std::size_t i = 0; i < size; ++i) {
        ASSERT_EQ(std::memcmp(&hits[i], &expected[i], sizeof(Hit)), 0)
            << path->name << ", ray " << i << ": t " << hits[i].t << ", not " << expected[i].t << ", of "
            << hits[i].primitive << ", not " << expected[i].primitive;
        ASSERT_EQ(occluded[i], expected[i] ? 1 : 0) << path->name << ", ray " << i;
      }
    }
}

std::vector<Ray> rays_around(std::size_t count, float reach, std::uint64_t seed) {
  std::vector<Ray> rays = mixed_rays({}, count, reach, {0, 0, 0}, seed);
  Random random(seed);
  for (std::size_t i = 0; i < count; ++i) {
    const Float3 to = random.point(1);
    if (i % 4 != 0)
      for (std::size_t k = 0; k < 3; ++k) rays[i].direction[k] = to[k] - rays[i].origin[k];
    if (i % 5 == 0) rays[i].tmin = -0.5f;
    if (i % 7 == 0) rays[i].tmax = 1.0f;
  }
  return rays;
}

// Most of them from one point, in any directions, some of which packets do not take; others before, between and behind.
std::vector<Ray> rays_from_a_point(std::size_t count, float reach, std::uint64_t seed) {
  std::vector<Ray> rays = rays_around(count, reach, seed);
  const Float3 from = Random(seed + 1).point(reach);
  for (std::size_t i = count / 8; i < count * 7 / 8; ++i) {
    if (i == count / 2) i += count / 16;
    const Float3 old = rays[i].origin;
    for (std::size_t k = 0; k < 3; ++k)
      rays[i].direction[k] += i % 4 != 0 ? old[k] - from[k] : 0.0f, rays[i].origin[k] = from[k];
  }
  return rays;
}

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

// Balls around boxes whose hits are off by nearly all that the slack has room for at an origin far away: also those of
// packets, of streams, and one by one.
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

// What a caller keeps in the tree's order, tested a leaf at a time: from its first place on, also through a scene.
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
    for (const Path* path : supported_paths()) expect_hits(scene, rays, expected, ~0u, path);
  }
  EXPECT_TRUE(BoundedTree().order().empty());
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
      ASSERT_EQ(std::memcmp(&hits[k], &expected, sizeof(Hit)), 0);
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
      // What lies before its box ends the search where it is found.
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

TEST(SphereTree, has_the_bytes_of_closest_hit) {
  Random random(98);
  const std::vector<Sphere> spheres = random_spheres(300, random);
  const SphereTree tree(spheres);
  const SphereRows rows(spheres);
  const auto closest_of = [&](const Ray& ray) { return rows.closest(ray); };
  for (const float reach : {0.5f, 3.0f, 1e3f, 1e5f}) {
    SCOPED_TRACE(reach);
    expect_batches(tree, rays_around(by_level(900), reach, 99), closest_of);
    expect_batches(tree, rays_from_a_point(by_level(900), reach, 108), closest_of);
  }
  SphereTree().closest(std::vector<Ray>(), std::span<Hit>());
}

// Rays that graze spheres, from near and far.
TEST(SphereTree, misses_nothing_that_grazes) {
  Random random(100);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 60; ++i) spheres.push_back({random.point(20), random.magnitude(1e-2, 2)});
  for (int i = 0; i < 40; ++i)
    spheres.push_back({{100.0f + static_cast<float>(i), 0, 0}, 0.01f});  // sides in a plane
  const SphereTree tree(spheres);
  const SphereRows rows(spheres);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(3000); ++i) {
    const float x = 100.0f + static_cast<float>(i % 40), y = 0.01f + random.magnitude(1e-6, 1e-3);
    rays.push_back(make_ray({x, y, -1e4f}, {0, 0, 1}));
    rays.push_back(make_ray({x + random.number(-900, 900), random.number(-900, 900), -1e4f}, {0, 0, 1}));
    for (std::size_t k = 0; k < 2; ++k) rays.back().direction[k] = (k == 0 ? x : y) - rays.back().origin[k];
    rays.back().direction[2] = 1e4f;
  }
  for (std::size_t i = 0; i < by_level(3000); ++i) {
    const Sphere& sphere = spheres[i % spheres.size()];
    const std::size_t axis = i / 7 % 3;
    Float3 from = random.point(i % 2 == 0 ? 30.0f : 1e4f), to = sphere.centre;
    to[axis] += sphere.radius, from[axis] = to[axis];
    rays.push_back(make_ray(from, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}));
  }
  expect_batches(tree, rays, [&](const Ray& ray) { return rows.closest(ray); });
  for (std::size_t i = 0; i + 8 <= rays.size(); i += 8) {  // one by one, by boxes that are hardly widened
    std::vector<Hit> hits(8);
    tree.closest(std::span(rays).subspan(i, 8), hits);
    for (std::size_t k = 0; k < 8; ++k) {
      const Hit expected = rows.closest(rays[i + k]);
      ASSERT_EQ(std::memcmp(&hits[k], &expected, sizeof(Hit)), 0) << i + k;
    }
  }
}

// Spheres whose fronts are one plane, before which the test finds all of them, by more than walks through boxes round:
// the nearest one is not lost behind one that was found before it.
TEST(SphereTree, has_the_nearest_of_fronts_in_one_place) {
  Random random(104);
  constexpr double front = 0.25, beyond_walks = 9 * 0x1p-24;
  std::size_t found = 0;
  for (std::size_t n = 0; n < by_level(120); ++n) {
    const std::size_t axis = n % 3;
    const float side = n % 2 == 0 ? 1.0f : -1.0f;
    Ray ray = make_ray(random.point(1e-5f), random.point(1e-3f));
    ray.direction[axis] = side * random.number(0.5f, 1.5f);
    const double entry = (front - static_cast<double>(side * ray.origin[axis])) /
                         static_cast<double>(side * ray.direction[axis]);
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < 20000 && spheres.size() < 64; ++i) {
      Sphere sphere{{}, std::ldexp(std::round(random.number(1.2f, 2.8f) * 0x1p20f), -20)};
      sphere.centre[axis] = side * (static_cast<float>(front) + sphere.radius);  // exact
      const Hit hit = SphereRows({sphere}).closest(ray);
      if (hit && static_cast<double>(hit.t) < entry * (1 - beyond_walks)) spheres.push_back(sphere);
    }
    found += spheres.size();
    const SphereTree tree(spheres);
    const SphereRows rows(spheres);
    expect_batches(tree, std::vector<Ray>(20, ray), [&](const Ray& r) { return rows.closest(r); });
  }
  EXPECT_GT(found, 10 * by_level(120));
}

TEST(Scene, has_triangles_spheres_and_others_side_by_side) {
  Random random(101);
  UserTriangles user = soup(80, 102);
  const std::vector<Sphere> spheres = random_spheres(40, random);
  const SphereRows rows(spheres);
  Scene scene;
  const Mesh mesh = ellipsoid(1, {0, 0, 0}, {1, 0.5f, 0.7f});
  scene.add(Bvh(mesh)), scene.add(SphereTree(spheres)), scene.add(BoundedTree(user.boxes()), user);
  scene.add(SphereTree()), scene.add(BoundedTree(), user);
  const auto closest_of = [&](std::uint32_t geometry, const Ray& ray) {
    return geometry == 0   ? scene.tree(0)->closest(ray)
           : geometry == 1 ? rows.closest(ray)
           : geometry == 2 ? user.closest(ray)
                           : Hit();
  };
  const auto expect_all = [&] {
    scene.update();
    const std::vector<Ray> rays = rays_around(by_level(900), 6, 103);
    std::vector<SceneHit> expected;
    for (const Ray& ray : rays) expected.push_back(expected_hit(scene, ray, ~0u, closest_of));
    for (const Path* path : supported_paths()) expect_hits(scene, rays, expected, ~0u, path);
  };
  for (std::uint32_t part = 0; part < 5; ++part) {  // one at a time
    if (part > 0) scene.move(part - 1, moved_by(nan, 0, 0));
    scene.place(part);
    expect_all();
    scene.move(part, random_transform(random, 1, 2));
    expect_all();
  }
  for (std::uint32_t i = 0; i < 60; ++i)
    scene.place(i % 5, i % 4 == 0 ? Transform() : random_transform(random, 1, 4));
  expect_all();
}

}  // namespace
}  // namespace raylanes::testing

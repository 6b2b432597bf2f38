// Scenes of parts: hits are those of all instances one after the other, whatever the top level does.
#include <gmpxx.h>

#include <raylanes/paths.hpp>

#include "../queries/query_trees.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {
namespace {

// Parts of triangles, with their meshes.
struct TriangleParts {
  Scene scene;
  std::vector<Mesh> meshes;

  std::uint32_t add(const Mesh& mesh) {
    meshes.push_back(mesh);
    return scene.add(Bvh(mesh));
  }
  // By the tree of each part, ray by ray; and by rational numbers.
  SceneHit by_trees(const Ray& ray, std::uint32_t mask = ~0u) const {
    return expected_hit(scene, ray, mask, [&](std::uint32_t geometry, const Ray& mapped) {
      return scene.tree(geometry)->closest(mapped, {.path = &paths().front()});
    });
  }
  SceneHit by_rationals(const Ray& ray, std::uint32_t mask = ~0u) const {
    return expected_hit(scene, ray, mask, [&](std::uint32_t geometry, const Ray& mapped) {
      const std::vector<Hit> all = oracle_hits(meshes[geometry], mapped);
      return all.empty() ? Hit() : all.front();
    });
  }
};

std::vector<SceneHit> all_by_trees(const TriangleParts& parts, const std::vector<Ray>& rays,
                                   std::uint32_t mask = ~0u) {
  std::vector<SceneHit> expected;
  for (const Ray& ray : rays) expected.push_back(parts.by_trees(ray, mask));
  return expected;
}
void expect_all(const TriangleParts& parts, const std::vector<Ray>& rays, std::uint32_t mask = ~0u,
                std::size_t min_hits = 1) {
  const std::vector<SceneHit> expected = all_by_trees(parts, rays, mask);
  std::size_t hits = 0;
  for (const SceneHit& hit : expected) hits += hit ? 1 : 0;
  EXPECT_GE(hits, min_hits);
  for (const Path* path : supported_paths()) expect_hits(parts.scene, rays, expected, mask, path);
}

// From anywhere to instances, or past them; some segments begin before the origin or end soon.
std::vector<Ray> rays_to_instances(const Scene& scene, std::size_t count, float reach, Random& random) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Float3 from = random.point(reach);
    Float3 to = random.point(reach);
    if (scene.instance_count() > 0 && i % 4 != 0) {
      const auto instance =
          static_cast<std::uint32_t>(random.integer(0, static_cast<int>(scene.instance_count()) - 1));
      const Transform transform = scene.transform_of(instance);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[axis] = transform.row[axis][3];
        for (int k = 0; k < 3; ++k) to[axis] += transform.row[axis][k] * random.number(-0.7f, 0.7f);
      }
    }
    Float3 direction;
    for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = to[axis] - from[axis];
    rays.push_back(make_ray(from, direction, i % 5 == 0 ? -0.5f : 0, i % 7 == 0 ? 1.0f : infinity));
  }
  return rays;
}

TriangleParts random_parts(std::size_t instances, float size, float shift, Random& random) {
  TriangleParts parts;
  parts.add(triangle_soup(60, 0.4f, 71));
  parts.add(ellipsoid(1, {0, 0, 0}, {0.9f, 0.7f, 0.5f}));
  parts.add({});
  for (std::size_t i = 0; i < instances; ++i)
    parts.scene.place(static_cast<std::uint32_t>(i % 3), random_transform(random, size, shift),
                      1u << (i % 4));
  parts.scene.update();
  return parts;
}

TEST(Scene, has_the_hits_of_all_instances) {
  Random random(72);
  for (const auto& [instances, size, shift] :
       {std::tuple{1, 1.0f, 1.0f}, {2, 1.0f, 2.0f}, {70, 1.0f, 8.0f}}) {
    const TriangleParts parts = random_parts(static_cast<std::size_t>(instances), size, shift, random);
    const std::vector<Ray> rays = rays_to_instances(parts.scene, by_level(2400), 12, random);
    expect_all(parts, rays, ~0u, rays.size() / 20);
    expect_all(parts, rays, 5u);
  }
}

TEST(Scene, decides_by_exact_arithmetic_on_the_ray_of_an_instance) {
  Random random(73);
  const TriangleParts parts = random_parts(9, 1, 3, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, by_level(300), 5, random);
  std::vector<SceneHit> expected;
  for (const Ray& ray : rays) expected.push_back(parts.by_rationals(ray));
  for (const Path* path : supported_paths()) expect_hits(parts.scene, rays, expected, ~0u, path);
}

// Rounding a ray in a part's space moves it far in the scene where origins are far away or transforms stretch.
TEST(Scene, misses_nothing_that_rounded_rays_hit) {
  Random random(74);
  for (const auto& [shift, reach, stretch] :
       {std::tuple{1e5f, 2e5f, 1.0f}, {10.0f, 1e6f, 1.0f}, {10.0f, 20.0f, 3e5f}, {1e3f, 1e4f, 1e-6f}}) {
    TriangleParts parts;
    parts.add(ellipsoid(1, {0, 0, 0}, {1, 1, 1}));
    parts.add(triangle_soup(40, 0.2f, 75));
    for (int i = 0; i < 40; ++i) {
      Transform transform = random_transform(random, 1, shift);
      for (float& x : transform.row[i % 3]) x *= stretch;
      if (i % 5 == 0)  // nearly singular
        for (std::size_t k = 0; k < 3; ++k)
          transform.row[2][k] = transform.row[0][k] + transform.row[1][k] + random.number(-1e-6f, 1e-6f);
      parts.scene.place(static_cast<std::uint32_t>(i % 2), transform);
    }
    parts.scene.update();
    SCOPED_TRACE(std::to_string(shift) + ", " + std::to_string(stretch));
    expect_all(parts, rays_to_instances(parts.scene, by_level(1500), reach, random));
  }
}

// Aimed along the silhouettes of boxes: flat parts, and rays that graze them.
TEST(Scene, misses_nothing_at_the_edges_of_flat_parts) {
  Random random(76);
  TriangleParts parts;
  parts.add(integer_grid(4));
  for (int i = 0; i < 30; ++i) {
    Transform turned;
    const double angle = random.real(0, 7);
    turned.row[0][0] = turned.row[2][2] = static_cast<float>(std::cos(angle));
    turned.row[0][2] = static_cast<float>(std::sin(angle)), turned.row[2][0] = -turned.row[0][2];
    turned.row[1][3] = static_cast<float>(5 * i), turned.row[0][3] = random.number(-1000, 1000);
    parts.scene.place(0, turned);
  }
  parts.scene.update();
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(2400); ++i) {
    const Transform t = parts.scene.transform_of(static_cast<std::uint32_t>(i % 30));
    const float x = static_cast<float>(random.integer(0, 4)), y = static_cast<float>(random.integer(0, 4));
    Float3 target, from = random.point(3000), direction;
    for (std::size_t axis = 0; axis < 3; ++axis)
      target[axis] = t.row[axis][0] * x + t.row[axis][1] * y + t.row[axis][3],
      direction[axis] = target[axis] - from[axis];
    rays.push_back(make_ray(from, direction));
  }
  expect_all(parts, rays, ~0u, rays.size() / 8);
}

// From the scene's zero past the corners where parts far away end, along an axis on which they are not far: rounding
// moves rays there by a share of the whole distance, slabs round by nearly nothing.
TEST(Scene, misses_nothing_at_the_ends_of_parts_far_away) {
  Random random(77);
  const Mesh mesh = cube(-1, 1);  // as large as its box
  TriangleParts parts;
  parts.add(mesh);
  for (std::size_t i = 0; i < 30; ++i) {
    Transform transform = random_transform(random, 1, 1);
    transform.row[i % 3][3] = i % 2 == 0 ? 3e4f : -3e4f;
    parts.scene.place(0, transform);
  }
  parts.scene.update();
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(3000); ++i) {
    const Transform t = parts.scene.transform_of(static_cast<std::uint32_t>(i % 30));
    const std::size_t far = i % 3, near = (far + 1 + i / 30 % 2) % 3;
    const double side = i / 60 % 2 == 0 ? 1.0 : -1.0;
    double at[3], most = -1e30;
    for (const Float3& v : mesh.vertices) {
      double to[3];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[axis] = static_cast<double>(t.row[axis][3]);
        for (std::size_t k = 0; k < 3; ++k)
          to[axis] += static_cast<double>(t.row[axis][k]) * static_cast<double>(v[k]);
      }
      if (side * to[near] > most) most = side * to[near], std::copy_n(to, 3, at);
    }
    at[near] += side * random.real(0, 0x1p-9);  // an ULP of the distance
    const Float3 from = random.point(1);
    Float3 direction;
    for (std::size_t axis = 0; axis < 3; ++axis)
      direction[axis] = static_cast<float>(at[axis] - static_cast<double>(from[axis]));
    rays.push_back(make_ray(from, direction));
  }
  expect_all(parts, rays, ~0u, rays.size() / 64);
}

// Of equal t the first instance wins, also where exact distances differ by less than an ULP.
TEST(Scene, orders_equal_hits_by_instances) {
  TriangleParts parts;
  parts.add({{{-4, -4, 0}, {8, -4, 0}, {-4, 8, 0}}, {{0, 1, 2}}});
  for (int i = 0; i < 40; ++i)
    parts.scene.place(0, moved_by(0, 0, std::ldexp(static_cast<float>((i * 7) % 20), -27)));
  parts.scene.update();
  Random random(77);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(600); ++i)
    rays.push_back(make_ray({random.number(-1, 1), random.number(-1, 1), i % 2 == 0 ? -1.0f : 1.0f},
                            {random.number(-1, 1), random.number(-1, 1), i % 2 == 0 ? 1.0f : -1.0f}, 0,
                            i % 3 == 0 ? 1.0f : infinity));
  expect_all(parts, rays, ~0u, rays.size() / 2);
}

TEST(Scene, is_hit_by_nothing_where_transforms_have_no_inverse) {
  TriangleParts parts;
  parts.add(ellipsoid(1, {0, 0, 0}));
  const Transform zero{{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}},
      flat{{{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}}},
      sevenths{{{1 / 7.0f, 2 / 7.0f, 3 / 7.0f, 0}, {0.1f, 0.2f, 0.3f, 0}, {0.7f, 0.9f, 0.1f, 0}}};
  for (const Transform& transform : {zero, flat, moved_by(nan, 0, 0), moved_by(0, infinity, 0),
                                     moved_by(0, 0, 0, nan), moved_by(0, 0, 0, infinity)})
    parts.scene.place(0, transform);
  parts.scene.update();
  EXPECT_GT(parts.scene.bounds().lo[0], parts.scene.bounds().hi[0]);
  Random random(78);
  const std::vector<Ray> rays = rays_to_instances({}, 200, 5, random);
  expect_all(parts, rays, ~0u, 0);
  Scene beyond;  // the largest float
  beyond.place(beyond.add(Bvh(parts.meshes[0])), moved_by(3e38f, 0, 0, 3e38f));
  beyond.update();
  EXPECT_FALSE(beyond.closest(make_ray({3e38f, 0, 0}, {-1, 0, 0})));
  Scene large;
  large.place(large.add(Bvh(parts.meshes[0])), moved_by(0, 0, 0, 3e37f));
  large.update();
  EXPECT_TRUE(large.closest(make_ray({0, 0, 0}, {0, 0, 1})));
  for (const Path* path : supported_paths())  // subnormal in the part's space
    EXPECT_FALSE(large.closest(make_ray({0, 0, 2.7e37f}, {0, 0, 0.1f}), {.path = path})) << path->name;
  parts.scene.place(0, sevenths);
  parts.scene.place(0, moved_by(0, 0, 0, 1e-40f));
  parts.scene.place(0, moved_by(1, 0, 0, 1e-30f));
  parts.scene.place(0, moved_by(0, 0, 0, 1e30f));
  parts.scene.update();
  expect_all(parts, rays, ~0u, 1);
}

TEST(Scene, takes_rays_of_any_bits) {
  Random random(79);
  const TriangleParts parts = random_parts(30, 1, 4, random);
  std::vector<Ray> rays = rays_to_instances(parts.scene, 600, 8, random);
  const float odd[] = {nan, infinity, -infinity, 3e38f, -3e38f, 1e-40f, 0.0f, -0.0f};
  for (std::size_t i = 0; i < rays.size(); i += 2) {
    float* const numbers[] = {&rays[i].origin[i / 2 % 3], &rays[i].direction[i / 3 % 3], &rays[i].tmin,
                              &rays[i].tmax};
    *numbers[i / 2 % 4] = odd[i / 8 % 8];
  }
  expect_all(parts, rays);
}

TEST(Scene, follows_its_parts) {
  Random random(80);
  TriangleParts parts = random_parts(20, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, 300, 6, random);
  Scene& scene = parts.scene;
  Mesh moved = triangle_soup(60, 0.6f, 81);
  scene.refit(0, moved.vertices, moved.triangles);
  EXPECT_THROW(scene.closest(rays[0]), std::logic_error);
  scene.update();
  expect_all(parts, rays);
  scene.replace(1, Bvh(triangle_soup(10, 0.9f, 82)));
  scene.move(3, moved_by(0.5f, 0, 0));
  scene.set_mask(4, 0);
  scene.update();
  expect_all(parts, rays);
  scene.set_mask(3, 2);  // without update()
  expect_all(parts, rays, 2);
  const SceneHit expected = parts.by_trees(rays[0], 2);
  const Scene other = std::move(scene);
  EXPECT_TRUE(same(other.closest(rays[0], {}, 2), expected));
}

TEST(Scene, says_what_it_has) {
  Scene scene;
  EXPECT_FALSE(scene.closest(make_ray({0, 0, 0}, {0, 0, 1})));
  EXPECT_EQ(scene.add(Bvh(ellipsoid(1, {0, 0, 0}))), 0u);
  EXPECT_EQ(scene.add(SphereTree()), 1u);
  EXPECT_EQ(scene.tree(1), nullptr);
  EXPECT_EQ(scene.place(0, moved_by(1, 2, 3), 9), 0u);
  EXPECT_EQ(scene.geometry_of(0), 0u);
  EXPECT_EQ(scene.transform_of(0).row[1][3], 2.0f);
  EXPECT_EQ(scene.mask_of(0), 9u);
  EXPECT_EQ(scene.geometry_count(), 2u);
  EXPECT_THROW(scene.place(2), std::out_of_range);
  EXPECT_THROW(scene.move(1, {}), std::out_of_range);
  EXPECT_THROW(scene.refit(1, VertexView(), IndexView()), std::invalid_argument);
  scene.update();
  std::vector<SceneHit> hits(2);
  const std::vector<Ray> rays(3);
  EXPECT_THROW(scene.closest(rays, hits), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.test = TriangleTest::directional}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.after = HitView(hits.data(), 1)}), std::invalid_argument);
}

TEST(Scene, takes_rays_as_arrays_with_a_mask_and_counts) {
  Random random(83);
  const TriangleParts parts = random_parts(25, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, 777, 6, random);
  const std::vector<SceneHit> expected = all_by_trees(parts, rays);
  std::vector<float> numbers[8];
  for (const Ray& ray : rays) {
    for (std::size_t k = 0; k < 3; ++k)
      numbers[k].push_back(ray.origin[k]), numbers[3 + k].push_back(ray.direction[k]);
    numbers[6].push_back(ray.tmin), numbers[7].push_back(ray.tmax);
  }
  const RayArrays arrays{{numbers[0].data(), numbers[1].data(), numbers[2].data()},
                         {numbers[3].data(), numbers[4].data(), numbers[5].data()},
                         numbers[6].data(),
                         numbers[7].data(),
                         rays.size()};
  for (const std::vector<std::uint8_t>& mask : masks_for(rays.size(), random)) {
    const SceneHit before{1, 2, 3, 4, 5, 6};
    std::vector<SceneHit> hits(rays.size(), before);
    std::vector<std::uint8_t> occluded(rays.size(), 7);
    TraceCounters counters;
    const TraceOptions options{
        .threads = 2, .active = mask.data(), .counters = has_counters() ? &counters : nullptr};
    parts.scene.closest(arrays, hits, options);
    parts.scene.occluded(arrays, occluded, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool active = (mask[i / 8] >> i % 8 & 1) != 0;
      ASSERT_TRUE(same(hits[i], active ? expected[i] : before)) << i;
      ASSERT_EQ(occluded[i], !active ? 7 : expected[i] ? 1 : 0) << i;
    }
    if (has_counters() && mask[0] == 0xff) {
      EXPECT_GT(counters.triangle_tests, 0u);
    }
  }
}

TEST(Scene, writes_hits_into_records_of_any_size) {
  Random random(89);
  const TriangleParts parts = random_parts(25, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, 500, 6, random);
  struct Record {
    std::uint32_t before = 7;
    SceneHit hit = {1, 2, 3, 4, 5, 6};
    std::uint32_t behind = 8;
  };
  std::vector<Record> records(rays.size());
  parts.scene.closest(rays, SceneHitView(&records[0].hit, records.size(), sizeof(Record)));
  const std::vector<SceneHit> expected = all_by_trees(parts, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(same(records[i].hit, expected[i])) << i;
    ASSERT_EQ(records[i].before + records[i].behind, 15u) << i;
  }
  std::vector<SceneHit> hits(rays.size());
  EXPECT_THROW(parts.scene.closest(rays, SceneHitView(hits.data(), hits.size(), sizeof(Hit))),
               std::invalid_argument);
  EXPECT_THROW(parts.scene.closest(rays, SceneHitView(nullptr, rays.size())), std::invalid_argument);
}

TEST(Scene, says_what_lies_between_a_point_and_others) {
  Random random(90);
  const TriangleParts parts = random_parts(25, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, 500, 6, random);
  const SegmentEnds ends{0.25f, 0.75f};
  std::vector<Float3> points;
  std::vector<Ray> segments;
  for (const Ray& ray : rays) {
    points.push_back(ray.origin);
    segments.push_back({rays[0].origin, ends.start, ray.origin, ends.end});
    for (std::size_t axis = 0; axis < 3; ++axis) segments.back().direction[axis] -= rays[0].origin[axis];
  }
  std::vector<std::uint8_t> answers(points.size(), 7), expected(points.size(), 7);
  parts.scene.occluded_from(rays[0].origin, points, answers, ends);
  parts.scene.occluded(segments, expected);
  EXPECT_EQ(answers, expected);
  EXPECT_NE(std::count(answers.begin(), answers.end(), 0), 0);
  EXPECT_NE(std::count(answers.begin(), answers.end(), 1), 0);
  answers.pop_back();
  EXPECT_THROW(parts.scene.occluded_from(rays[0].origin, points, answers), std::invalid_argument);
}

TEST(Scene, has_ten_thousand_instances_in_five_megabytes) {
  Scene scene;
  const std::uint32_t part = scene.add(Bvh(ellipsoid(1, {0, 0, 0}, {0.4f, 0.4f, 0.4f})));
  for (int i = 0; i < 10000; ++i)
    scene.place(part, moved_by(static_cast<float>(i % 100), static_cast<float>(i / 100), 0));
  scene.update();
  EXPECT_LT(scene.bytes(), 5u << 20);
  const SceneHit hit = scene.closest(make_ray({42.03f, 17.01f, -5}, {0, 0, 1}));
  EXPECT_EQ(hit.instance, 1742u);
}

// One row is the sum of the others, of numbers whose products doubles round.
TEST(Instance, has_no_inverse_where_rational_numbers_have_none) {
  Random random(85);
  for (std::size_t i = 0; i < by_level(600); ++i) {
    Transform transform;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t row = 0; row < 2; ++row)
        transform.row[row][k] = static_cast<float>(random.integer(-8388607, 8388607));
      transform.row[2][k] = transform.row[0][k] + transform.row[1][k];
    }
    ASSERT_LT(Instance(0, transform, 1).doubt, 0) << i;
  }
}

// The inverse by rational numbers, within what bounds_of takes it for.
TEST(Instance, is_inverted_as_well_as_it_says) {
  Random random(84);
  for (std::size_t i = 0; i < by_level(600); ++i) {
    Transform transform = random_transform(random, 1, 10);
    if (i % 3 == 0)
      for (std::size_t k = 0; k < 3; ++k)
        transform.row[2][k] = transform.row[0][k] - transform.row[1][k] +
                              random.number(-1, 1) * std::ldexp(1.0f, -static_cast<int>(i % 20));
    const Instance instance(0, transform, 1);
    if (instance.doubt < 0) continue;
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column) {
        // (R·A − 1), as a share of |R|·|A|.
        mpq_class sum = row == column ? -1 : 0, size = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const mpq_class product =
              mpq_class(instance.inverse[4 * row + k]) * mpq_class(transform.row[k][column]);
          sum += product, size += abs(product);
        }
        ASSERT_LE(abs(sum), size * mpq_class(instance.doubt)) << i;
      }
  }
}

}  // namespace
}  // namespace raylanes::testing

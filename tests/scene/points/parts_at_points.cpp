// Which parts of a scene contain a point: each as rational numbers say in its space, in the order of exact volumes.
#include <raylanes/bounded_tree.hpp>

#include "../../../bench/support/oracles/exact_point.hpp"
#include "../nested/nested_cases.hpp"
#include "point_scenes.hpp"

namespace raylanes::testing {
namespace {

// A point in the space of an instance, as the origin of a ray.
Float3 in_space_of(const Instance& instance, const Float3& point) {
  return mapped_ray(make_ray(point, {1, 0, 0}), instance).origin;
}

mpq_class exact_volume(const Mesh& mesh, const Transform& transform) {
  const auto determinant = [](const oracle::Vector& a, const oracle::Vector& b, const oracle::Vector& c) {
    return mpq_class(oracle::dot(a, oracle::cross(b, c)));
  };
  mpq_class volume = 0;
  for (const Index3& triangle : mesh.triangles)
    volume += determinant(oracle::to_vector(mesh.vertices[triangle[0]]),
                          oracle::to_vector(mesh.vertices[triangle[1]]),
                          oracle::to_vector(mesh.vertices[triangle[2]]));
  oracle::Vector row[3];
  for (std::size_t i = 0; i < 3; ++i)
    row[i] = oracle::to_vector(Float3{transform.row[i][0], transform.row[i][1], transform.row[i][2]});
  return abs(mpq_class(volume * determinant(row[0], row[1], row[2])));
}

// The expected parts of points, innermost first.
class Judge {
 public:
  Judge(const Scene& scene, std::span<const Mesh> meshes, std::uint32_t mask = ~0u)
      : scene_(scene), meshes_(meshes) {
    for (std::uint32_t i = 0; i < scene.instance_count(); ++i)
      if (is_there(scene, i, mask)) order_.push_back(i);
    std::map<std::uint32_t, mpq_class> volume;
    for (const std::uint32_t i : order_)
      volume[i] = exact_volume(meshes[scene.geometry_of(i)], scene.transform_of(i));
    std::ranges::stable_sort(order_, [&](std::uint32_t a, std::uint32_t b) { return volume[a] < volume[b]; });
  }
  // By rational numbers, for closed meshes; nothing contains points that are not finite.
  std::vector<ContainingPart> parts(const Float3& point, InsideRule rule) const {
    return parts_by(point, [&](std::uint32_t geometry, const Float3& mapped) {
      return oracle::exact_location(meshes_[geometry], mapped, {3, -7, 2}, rule);
    });
  }
  // By the trees of parts.
  std::vector<ContainingPart> parts_by_trees(const Float3& point, InsideRule rule) const {
    return parts_by(point, [&](std::uint32_t geometry, const Float3& mapped) {
      Location location;
      scene_.tree(geometry)->locate(std::span(&mapped, 1), std::span(&location, 1), {.rule = rule});
      return location;
    });
  }

 private:
  template <class Locate>
  std::vector<ContainingPart> parts_by(const Float3& point, const Locate& locate) const {
    std::vector<ContainingPart> parts;
    for (const std::uint32_t i : order_) {
      const Instance instance(scene_.geometry_of(i), scene_.transform_of(i), scene_.mask_of(i));
      const Float3 mapped = in_space_of(instance, point);
      if (!std::isfinite(mapped[0]) || !std::isfinite(mapped[1]) || !std::isfinite(mapped[2])) continue;
      const Location location = locate(instance.geometry, mapped);
      if (location != Location::outside) parts.push_back({instance.geometry, i, location});
    }
    return parts;
  }

  const Scene& scene_;
  std::span<const Mesh> meshes_;
  std::vector<std::uint32_t> order_;
};

Location location_of(const std::vector<ContainingPart>& parts, Location first) {
  if (parts.empty()) return Location::outside;
  const bool has =
      std::ranges::any_of(parts, [&](const ContainingPart& part) { return part.location == first; });
  return has ? first : parts[0].location;
}

// Adds a test failure unless all calls that locate points agree with the lists on each path.
void expect_parts(const Scene& scene, const std::vector<Float3>& points,
                  const std::vector<std::vector<ContainingPart>>& expected, const LocateOptions& given = {}) {
  std::vector<ContainingPart> innermost(points.size());
  std::vector<Location> locations(points.size());
  std::vector<float> distances(points.size());
  std::vector<SceneClosestPoint> closest(points.size());
  scene.closest_points(points, closest, {.mask = given.mask});
  on_each_path([&](const Path* path, int threads) {
    LocateOptions by = given;
    by.path = path, by.threads = threads;
    const RayLists<ContainingPart> lists = scene.containing_parts(points, by);
    scene.innermost_parts(points, innermost, by);
    scene.locate(points, locations, by);
    scene.signed_distances(points, distances,
                           {.rule = by.rule, .path = path, .threads = threads, .mask = by.mask});
    ASSERT_EQ(lists.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::vector<ContainingPart>& parts = expected[i];
      ASSERT_TRUE(std::ranges::equal(lists[i], parts))
          << i << ": " << lists[i].size() << ", not " << parts.size();
      ASSERT_EQ(innermost[i], parts.empty() ? ContainingPart() : parts[0]) << i;
      ASSERT_EQ(locations[i], location_of(parts, Location::inside)) << i;
      const Location side = location_of(parts, Location::on);
      ASSERT_EQ((distances[i] > 0) - (distances[i] < 0), side == Location::on       ? 0
                                                         : side == Location::inside ? -1
                                                                                    : 1)
          << i;
      if (side == Location::on || !closest[i]) continue;
      const double size = std::clamp(std::sqrt(closest[i].distance_squared), 0x1p-126, 0x1.fffffep127);
      ASSERT_EQ(std::abs(distances[i]), static_cast<float>(size)) << i;
    }
  });
}

std::size_t expect_exact_parts(const Scene& scene, std::span<const Mesh> meshes,
                               const std::vector<Float3>& points, InsideRule rule = InsideRule::parity,
                               std::uint32_t mask = ~0u) {
  const Judge judge(scene, meshes, mask);
  std::vector<std::vector<ContainingPart>> expected;
  std::size_t several = 0;
  for (const Float3& point : points) {
    expected.push_back(judge.parts(point, rule));
    several += expected.back().size() > 1 ? 1 : 0;
  }
  expect_parts(scene, points, expected, {.rule = rule, .mask = mask});
  return several;
}

// Solids that are nested, overlap, and stand in many places by transforms of all kinds.
TriangleParts solids(std::size_t instances, Random& random) {
  TriangleParts parts;
  parts.add(ellipsoid(1, {0, 0, 0}, {0.9f, 0.7f, 0.5f}));
  parts.add(cube(-1, 1));
  parts.add(double_fan(12, 0.25f));
  Mesh shell = cube(-0.5f, 0.5f);  // with a hole in it
  append(shell, turned_over(cube(-0.25f, 0.25f), 1, 930));
  parts.add(shell);
  for (std::size_t i = 0; i < instances; ++i)
    parts.scene.place(static_cast<std::uint32_t>(i % 4),
                      i % 3 == 0 ? Transform() : transform_of_kind(i / 3 % (kinds - 1), random),
                      i % 5 == 0 ? 6u : 1u << (i % 3));
  parts.scene.update();
  return parts;
}

TEST(PartsAtPoints, are_those_of_rational_numbers) {
  Random random(931);
  for (const std::size_t instances : {0, 1, 4, 40}) {
    SCOPED_TRACE(instances);
    const TriangleParts parts = solids(instances, random);
    std::vector<Float3> points{{0, 0, 0}, {nan, 0, 0}, {0, -infinity, 0}, {3e38f, 3e38f, -3e38f}};
    if (instances > 0) points = points_near(parts.scene, parts.meshes, by_level(250), random);
    for (const InsideRule rule : {InsideRule::parity, InsideRule::nonzero, InsideRule::vote})
      for (const std::uint32_t mask : {~0u, 2u}) {
        const std::size_t several = expect_exact_parts(parts.scene, parts.meshes, points, rule, mask);
        if (instances == 40 && mask == ~0u) {
          EXPECT_GT(several, 20u);
        }
      }
  }
}

TEST(PartsAtPoints, of_scenes_in_scenes_are_those_of_rational_numbers) {
  for (std::uint64_t seed = 950; seed < 950 + by_level<std::uint64_t>(2, 4, 20); ++seed) {
    Random random(seed);
    NestedCase nested = nested_case(random, 2, true);
    nested.scene.update();
    const std::vector<Float3> points = points_near(nested.scene, nested.meshes, by_level(250), random);
    for (const std::uint32_t mask : {~0u, 2u})
      expect_exact_parts(nested.scene, nested.meshes, points, InsideRule::parity, mask);
  }
}

// Rounding moves points far in the space of a part that is nearly flat in the scene.
TEST(PartsAtPoints, of_nearly_flat_parts) {
  Random random(940);
  TriangleParts parts;
  parts.add(cube(-1, 1));
  for (int i = 0; i < 40; ++i) parts.scene.place(0, transform_of_kind(5, random));
  parts.scene.update();
  std::vector<Float3> points;
  for (std::uint32_t i = 0; points.size() < by_level(1500); i = (i + 1) % 40) {
    Float3 corner;
    for (float& x : corner)
      x = random.chance(0.7) ? (random.chance(0.5) ? 1.0f : -1.0f) : random.number(-1, 1);
    const Double3 at = placed(parts.scene.transform_of(i), corner);
    points.push_back({static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])});
  }
  expect_exact_parts(parts.scene, parts.meshes, points);
}

TEST(PartsAtPoints, name_the_innermost_of_nested_shells) {
  TriangleParts parts;
  for (const int i : {3, 0, 2, 1, 4})
    parts.add(cube(-static_cast<float>(1 << i), static_cast<float>(1 << i)));
  for (std::uint32_t geometry = 0; geometry < 5; ++geometry) parts.scene.place(geometry);
  parts.scene.place(1, moved_by(0, 0, 0, 6));                           // 6, between 4 and 8
  parts.scene.place(1, {{{0, 0, 3, 0}, {0, -3, 0, 0}, {3, 0, 0, 0}}});  // 3, mirrored
  parts.scene.update();
  std::vector<ContainingPart> innermost(1);
  const auto at = [&](float x) {
    const std::vector<Float3> points{{x, 0.25f, 0}};
    parts.scene.innermost_parts(points, innermost);
    return std::pair(innermost[0].instance, innermost[0].location);
  };
  EXPECT_EQ(at(0.5f), std::pair(1u, Location::inside));
  EXPECT_EQ(at(1), std::pair(1u, Location::on));
  EXPECT_EQ(at(-1.5f), std::pair(3u, Location::inside));
  EXPECT_EQ(at(2.5f), std::pair(6u, Location::inside));
  EXPECT_EQ(at(3.5f), std::pair(2u, Location::inside));
  EXPECT_EQ(at(5), std::pair(5u, Location::inside));
  EXPECT_EQ(at(7), std::pair(0u, Location::inside));
  EXPECT_EQ(at(16), std::pair(4u, Location::on));
  EXPECT_EQ(at(17), std::pair(no_part, Location::outside));
  Random random(932);
  std::vector<Float3> points;
  for (std::size_t i = 0; i < by_level(500); ++i) {
    Float3 point;
    const int reach = 4 << (i % 5);
    for (float& x : point) x = static_cast<float>(random.integer(-reach, reach)) / 2;
    points.push_back(point);
  }
  EXPECT_GT(expect_exact_parts(parts.scene, parts.meshes, points), 30u);
}

// A block of cubes that share faces, edges and corners: a point between two is on both, any other one in one of them.
TEST(PartsAtPoints, of_neighbours_that_share_faces) {
  for (const bool is_one_mesh : {false, true}) {
    TriangleParts parts;
    if (is_one_mesh) parts.add(cube(0, 1));
    for (int i = 0; i < 64; ++i) {
      const Float3 at{static_cast<float>(i % 4), static_cast<float>(i / 4 % 4), static_cast<float>(i / 16)};
      Mesh cell = cube(0, 1);
      for (Float3& vertex : cell.vertices)
        for (std::size_t k = 0; k < 3; ++k) vertex[k] += at[k];
      is_one_mesh ? parts.scene.place(0, moved_by(at[0], at[1], at[2])) : parts.scene.place(parts.add(cell));
    }
    parts.scene.update();
    Random random(933);
    std::vector<Float3> points;
    std::vector<std::vector<ContainingPart>> expected;
    for (std::size_t i = 0; i < by_level(1500); ++i) {
      Float3 point;
      for (float& x : point)
        x = random.chance(0.4) ? static_cast<float>(random.integer(-1, 5)) : random.number(-0.5f, 4.5f);
      points.push_back(point);
      auto& parts_of_point = expected.emplace_back();
      for (std::uint32_t cell = 0; cell < 64; ++cell) {
        const std::uint32_t at[] = {cell % 4, cell / 4 % 4, cell / 16};
        bool holds = true, is_on = false;
        for (std::size_t k = 0; k < 3; ++k) {
          const float x = point[k] - static_cast<float>(at[k]);
          holds = holds && x >= 0 && x <= 1, is_on = is_on || x == 0 || x == 1;
        }
        if (holds)
          parts_of_point.push_back({is_one_mesh ? 0 : cell, cell, is_on ? Location::on : Location::inside});
      }
    }
    expect_parts(parts.scene, points, expected);
  }
}

// Lines of points, and so many that they are located in several parts: whatever the threads.
TEST(PartsAtPoints, of_many_points_are_those_of_few) {
  Random random(934);
  const TriangleParts parts = solids(30, random);
  const Judge judge(parts.scene, parts.meshes);
  std::vector<Float3> points;
  while (points.size() < 150'000) {
    const Float3 from = random.point(3);
    for (std::size_t k = 0; k < 40; ++k)
      points.push_back({from[0], from[1], -2 + 0.1f * static_cast<float>(k)});
  }
  const RayLists<ContainingPart> lists = parts.scene.containing_parts(points);
  for (std::size_t i = 0; i < points.size(); i += 997)
    ASSERT_TRUE(std::ranges::equal(lists[i], judge.parts(points[i], InsideRule::parity))) << i;
  std::vector<ContainingPart> innermost(points.size());
  for (const int threads : {1, 2, 0}) {
    const RayLists<ContainingPart> others = parts.scene.containing_parts(points, {.threads = threads});
    EXPECT_EQ(others.offsets, lists.offsets);
    EXPECT_EQ(others.items, lists.items);
    parts.scene.innermost_parts(points, innermost, {.threads = threads});
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_EQ(innermost[i], lists[i].empty() ? ContainingPart() : lists[i][0]) << i;
  }
}

// By the winding number a point may be inside of an open part without being in its box.
TEST(PartsAtPoints, of_open_meshes_by_the_winding_number) {
  Random random(935);
  TriangleParts parts;
  parts.add(without(ellipsoid(2, {0, 0, 0}, {1, 1, 1}), 0.15, 936));
  Mesh bowls;
  for (int i = 0; i < 4; ++i) append(bowls, parts.meshes[0]);
  std::erase_if(bowls.triangles, [&](const Index3& t) { return bowls.vertices[t[0]][2] > 0; });
  parts.add(bowls);
  for (std::uint32_t i = 0; i < 8; ++i)
    parts.scene.place(i % 2, i < 2 ? Transform() : transform_of_kind(i % (kinds - 1), random));
  parts.scene.update();
  const std::vector<Float3> points = points_near(parts.scene, parts.meshes, by_level(400), random);
  const Judge judge(parts.scene, parts.meshes);
  std::vector<std::vector<ContainingPart>> expected;
  for (const Float3& point : points) expected.push_back(judge.parts_by_trees(point, InsideRule::winding));
  expect_parts(parts.scene, points, expected, {.rule = InsideRule::winding});
}

TEST(PartsAtPoints, have_the_sums_of_winding_numbers) {
  Random random(937);
  const TriangleParts parts = solids(30, random);
  const std::vector<Float3> points = points_near(parts.scene, parts.meshes, 5000, random);
  std::vector<float> numbers(points.size()), first;
  std::vector<double> expected(points.size());
  for (std::uint32_t i = 0; i < 30; ++i) {
    if (!is_there(parts.scene, i, 3u)) continue;
    const Instance instance(parts.scene.geometry_of(i), parts.scene.transform_of(i), ~0u);
    std::vector<Float3> mapped;
    for (const Float3& point : points) mapped.push_back(in_space_of(instance, point));
    parts.scene.tree(instance.geometry)->winding_numbers(mapped, numbers);
    for (std::size_t k = 0; k < points.size(); ++k) expected[k] += static_cast<double>(numbers[k]);
  }
  on_each_path([&](const Path* path, int threads) {
    parts.scene.winding_numbers(points, numbers, {.path = path, .threads = threads, .mask = 3u});
    for (std::size_t k = 0; k < points.size(); ++k)
      ASSERT_EQ(static_cast<double>(numbers[k]), expected[k]) << k;
  });
  EXPECT_GT(*std::ranges::max_element(numbers), 2);
  EXPECT_THROW(parts.scene.winding_numbers(points, numbers, {.accuracy = -1}), std::invalid_argument);
}

TEST(PartsAtPoints, follow_changes) {
  Random random(938);
  TriangleParts parts = solids(30, random);
  Scene& scene = parts.scene;
  for (int step = 0; step < 24; ++step) {
    const auto instance = static_cast<std::uint32_t>(random.index(30));
    if (step % 3 == 0) scene.move(instance, random.chance(0.5) ? Transform() : transform_of_kind(1, random));
    if (step % 4 == 0) {
      const auto geometry = static_cast<std::uint32_t>(random.index(4));
      const float by = step % 8 == 0 ? 2.0f : 0.4f;  // so that the order of volumes changes
      for (Float3& vertex : parts.meshes[geometry].vertices) vertex[2] *= by;
      scene.refit(geometry, parts.meshes[geometry].vertices, parts.meshes[geometry].triangles);
    }
    if (step % 3 == 0 || step % 4 == 0) scene.update();
    scene.set_mask(instance, random.chance(0.5) ? 0u : 1u << random.index(3));
    const std::vector<Float3> points = points_near(scene, parts.meshes, 60, random);
    expect_exact_parts(scene, parts.meshes, points, InsideRule::parity, random.chance(0.5) ? ~0u : 3u);
  }
  for (std::uint32_t i = 0; i < 30; ++i) scene.set_mask(i, 1u << (i % 2));  // more than may be let out
  expect_exact_parts(scene, parts.meshes, points_near(scene, parts.meshes, 100, random), InsideRule::parity,
                     1u);
}

TEST(PartsAtPoints, leave_inactive_points_as_they_are) {
  Random random(939);
  const TriangleParts parts = solids(12, random);
  const std::vector<Float3> points = points_near(parts.scene, parts.meshes, 300, random);
  const std::vector<std::uint8_t> active(points.size() / 8 + 1, 0b01101001);
  const LocateOptions some{.active = active.data()};
  std::vector<ContainingPart> innermost(points.size()), masked(points.size(), {7, 8, Location::on});
  std::vector<Location> locations(points.size()), masked_locations(points.size(), Location{9});
  std::vector<float> numbers(points.size()), masked_numbers(points.size(), 9);
  parts.scene.innermost_parts(points, innermost), parts.scene.innermost_parts(points, masked, some);
  parts.scene.locate(points, locations), parts.scene.locate(points, masked_locations, some);
  parts.scene.winding_numbers(points, numbers);
  parts.scene.winding_numbers(points, masked_numbers, {.active = active.data()});
  const RayLists<ContainingPart> lists = parts.scene.containing_parts(points, some);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_active = (active[i / 8] >> i % 8 & 1) != 0;
    ASSERT_EQ(masked[i], is_active ? innermost[i] : (ContainingPart{7, 8, Location::on})) << i;
    ASSERT_EQ(masked_locations[i], is_active ? locations[i] : Location{9}) << i;
    ASSERT_EQ(masked_numbers[i], is_active ? numbers[i] : 9) << i;
    ASSERT_EQ(lists[i].empty(), !is_active || !innermost[i]) << i;
  }
}

TEST(PartsAtPoints, are_refused_as_they_are_to_be) {
  Scene scene;
  scene.place(scene.add(Bvh(cube(-1, 1))), {}, 1);
  scene.place(scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}})), {}, 2);
  const std::vector<Float3> points{{0.5f, 0, 0}};
  std::vector<ContainingPart> parts(1);
  std::vector<Location> locations(1);
  std::vector<float> numbers(1);
  EXPECT_THROW(scene.innermost_parts(points, parts), std::logic_error);
  scene.update();
  EXPECT_THROW(scene.innermost_parts(points, parts), std::invalid_argument);
  EXPECT_THROW(scene.containing_parts(points), std::invalid_argument);
  EXPECT_THROW(scene.locate(points, locations), std::invalid_argument);
  EXPECT_THROW(scene.signed_distances(points, numbers), std::invalid_argument);
  EXPECT_THROW(scene.winding_numbers(points, numbers), std::invalid_argument);
  scene.innermost_parts(points, parts, {.mask = 1});
  EXPECT_EQ(parts[0], (ContainingPart{0, 0, Location::inside}));
  EXPECT_THROW(scene.innermost_parts(points, {}, {.mask = 1}), std::invalid_argument);
  EXPECT_THROW(scene.innermost_parts(points, parts, {.threads = -1, .mask = 1}), std::invalid_argument);
  EXPECT_THROW(scene.innermost_parts(points, parts, {.rule = InsideRule{9}, .mask = 1}),
               std::invalid_argument);
  EXPECT_THROW(
      scene.innermost_parts(
          VertexView(points[0].data(), 1),
          std::span(reinterpret_cast<ContainingPart*>(const_cast<Float3*>(points.data())), 1), {.mask = 1}),
      std::invalid_argument);
  EXPECT_EQ(Scene().containing_parts(points).items.size(), 0u);
}

}  // namespace
}  // namespace raylanes::testing

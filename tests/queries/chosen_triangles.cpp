// Hits of the triangles that a caller chooses, one side of them or all but one for each ray, in every query and mode:
// rational numbers say which hits there are, and their sides.
#include "../support/filtered.hpp"
#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

// A primitive for each ray: mostly that of its nearest hit or the next, of some rays another one or none.
std::vector<std::uint32_t> some_skips(const Mesh& mesh, const std::vector<Ray>& rays) {
  std::vector<std::uint32_t> skip;
  for (const Ray& ray : rays) {
    const std::vector<Hit> hits = oracle_hits(mesh, ray);
    const std::size_t i = skip.size(), last = std::max<std::size_t>(hits.size(), 1) - 1;
    skip.push_back(i % 5 == 4 || hits.empty() ? (i % 2 == 0 ? no_primitive : static_cast<std::uint32_t>(i))
                                              : hits[i % 7 == 6 ? last : std::min(i % 2, last)].primitive);
  }
  return skip;
}

// The results that queries of chosen triangles must return.
struct ExpectedOfChosen {
  Facing facing;
  std::vector<std::uint32_t> skip;
  std::vector<std::vector<Hit>> hits;
  std::vector<std::vector<Crossing>> crossings;
  std::vector<Hit> nearest;
  std::vector<std::uint8_t> occluded;
  std::vector<CrossingCount> counts;
  std::size_t others = 0;  // rays whose nearest hit does not count

  ExpectedOfChosen(const Mesh& mesh, const std::vector<Ray>& rays, Facing side,
                   std::vector<std::uint32_t> skipped = {})
      : facing(side), skip(std::move(skipped)) {
    for (const Ray& ray : rays) {
      const std::uint32_t without = skip.empty() ? no_primitive : skip[hits.size()];
      const std::vector<Hit>& of_ray = hits.emplace_back(oracle_hits(mesh, ray, side, without));
      const std::vector<Hit> all = oracle_hits(mesh, ray);
      others += !all.empty() && (of_ray.empty() || !same_bytes(all[0], of_ray[0])) ? 1 : 0;
      nearest.push_back(of_ray.empty() ? Hit() : of_ray[0]);
      occluded.push_back(of_ray.empty() ? 0 : 1);
      std::vector<Crossing>& crossed = crossings.emplace_back(oracle_crossings(mesh, ray));
      std::erase_if(crossed, [&](const Crossing& crossing) {
        return crossing.primitive == without ||
               (side != Facing::any && crossing.side != (side == Facing::front ? -1 : 1));
      });
      CrossingCount& count = counts.emplace_back();
      for (const Crossing& crossing : crossed) ++count.crossings, count.winding += crossing.side;
    }
  }
  // For so many rays: the given ones again and again.
  std::vector<std::uint32_t> skip_of(std::size_t rays) const {
    return skip.empty() ? skip : repeated(skip, rays);
  }
};

template <class Tree>
void expect_nearest(const Tree& tree, const std::vector<Ray>& rays, const ExpectedOfChosen& expected,
                    TraceOptions options) {
  TraceCounters counters;
  const std::vector<std::uint32_t> skip = expected.skip_of(rays.size());
  options.facing = expected.facing, options.skip = skip;
  for (std::size_t mode = 0; mode < traversal_mode_names.size(); ++mode)
    for (const bool counts : {false, true}) {
      options.mode = static_cast<TraversalMode>(mode), options.counters = counts ? &counters : nullptr;
      if (counts && !has_counters()) continue;
      SCOPED_TRACE(std::string(traversal_mode_names[mode]) + (counts ? ", counted" : ""));
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size(), 7);
      tree.closest(rays, hits, options);
      tree.occluded(rays, occluded, options);
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < rays.size() && wrong < 3; ++i) {
        const Hit& wanted = expected.nearest[i % expected.nearest.size()];
        const bool good = std::memcmp(&wanted, &hits[i], sizeof(Hit)) == 0 && occluded[i] == (wanted ? 1 : 0);
        EXPECT_TRUE(good) << "ray " << i << ": " << hits[i].primitive << " at " << hits[i].t << ", not "
                          << wanted.primitive << " at " << wanted.t << ", occluded " << int{occluded[i]};
        wrong += good ? 0 : 1;
      }
    }
}

template <class Tree>
void expect_calls(const Tree& tree, const std::vector<Ray>& rays, const ExpectedOfChosen& expected,
                  const Path* path) {
  for (std::size_t i = 0; i < rays.size(); i += 3) {
    TraceOptions options{.path = path, .facing = expected.facing};
    if (!expected.skip.empty()) options.skip = expected.skip[i];
    const Hit hit = tree.closest(rays[i], options);
    EXPECT_EQ(std::memcmp(&hit, &expected.nearest[i], sizeof hit), 0) << "ray " << i;
    EXPECT_EQ(tree.occluded(rays[i], options), expected.occluded[i] != 0) << "ray " << i;
  }
}

template <class Tree>
void expect_layers(const Tree& tree, const std::vector<Ray>& rays, const ExpectedOfChosen& expected,
                   const Path* path) {
  std::vector<Hit> hits(rays.size(), Hit{-infinity, 0, 0, 0});
  bool some = true;
  for (std::size_t layer = 0; some; ++layer) {
    tree.closest(rays, hits, {.path = path, .facing = expected.facing, .skip = expected.skip, .after = hits});
    some = false;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit wanted = layer < expected.hits[i].size() ? expected.hits[i][layer] : Hit();
      ASSERT_EQ(std::memcmp(&wanted, &hits[i], sizeof(Hit)), 0) << "ray " << i << ", layer " << layer;
      some = some || hits[i];
    }
  }
}

template <class Tree>
void expect_lists_of_chosen(const Tree& tree, const std::vector<Ray>& rays, const ExpectedOfChosen& expected,
                            const Path* path) {
  const std::vector<std::uint32_t> skip = expected.skip_of(rays.size());
  for (const std::uint32_t most : {~0u, 2u, 70u}) {
    const ListOptions options{.max_count = most, .facing = expected.facing, .path = path, .skip = skip};
    const RayLists<Hit> all = tree.all_hits(rays, options);
    const RayLists<Crossing> crossed = tree.crossings(rays, options);
    std::vector<CrossingCount> counts(rays.size());
    tree.count_crossings(rays, counts, options);
    for (std::size_t i = 0, wrong = 0; i < rays.size() && wrong < 3; ++i) {
      const std::size_t k = i % expected.hits.size();
      const auto first = [&](const auto& list) {
        return std::span(list).first(std::min<std::size_t>(most, list.size()));
      };
      const bool good = same_bytes(all[i], first(expected.hits[k])) &&
                        std::ranges::equal(crossed[i], first(expected.crossings[k])) &&
                        counts[i] == expected.counts[k];
      EXPECT_TRUE(good) << "ray " << i << ": " << all[i].size() << " hits, not " << expected.hits[k].size()
                        << "; " << crossed[i].size() << " and " << counts[i].crossings << " crossings, not "
                        << expected.crossings[k].size();
      wrong += good ? 0 : 1;
    }
  }
}

// Adds a test failure unless all queries of chosen triangles return on all trees and paths what rational numbers say.
// Below level all, fewer batches are of many rays; at level quick, which emulated processors have, all take fewer ways.
void expect_chosen(const Mesh& mesh, const std::vector<Ray>& rays, bool also_flushed = true) {
  const std::vector<std::uint32_t> skip = some_skips(mesh, rays);
  const ExpectedOfChosen cases[] = {{mesh, rays, Facing::front},
                                    {mesh, rays, Facing::back},
                                    {mesh, rays, Facing::any, skip},
                                    {mesh, rays, Facing::back, skip}};
  for (const ExpectedOfChosen& expected : cases) {
    EXPECT_GT(expected.others, 0u);
    EXPECT_GT(std::ranges::count(expected.occluded, 1), 3);
    const bool many = expected.facing != Facing::back || by_level(false, false, true);
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      for (const FloatMode mode : float_modes) {
        if (mode == FloatMode::flush && (!also_flushed || quick())) continue;
        SCOPED_TRACE(std::string(facing_names[static_cast<std::size_t>(expected.facing)]) +
                     (expected.skip.empty() ? ", " : ", without some, ") + name_of(mode));
        const FloatModeScope scope(mode);
        if (!quick()) expect_nearest(tree, rays, expected, {.path = path});
        if (many) expect_nearest(tree, repeated(rays), expected, {.path = path, .threads = 2});
        expect_calls(tree, rays, expected, path);
        expect_layers(tree, rays, expected, path);
        expect_lists_of_chosen(tree, rays, expected, path);
        if (many) expect_lists_of_chosen(tree, repeated(rays), expected, path);
      }
    });
  }
}

TEST(ChosenTriangles, of_random_triangles) {
  const Mesh mesh = triangle_soup(by_level(200), 0.5f, 161);
  expect_chosen(mesh, aimed_rays(mesh, by_level(200), 2, 162));
}

// Rays through edges and vertices, along planes, to triangles that lie on each other, turned over.
TEST(ChosenTriangles, of_edges_vertices_and_coincident_triangles) {
  expect_chosen(lattice_walls(2), lattice_rays(2, by_level(200), 163));
  Mesh mesh = double_fan(30, 0.25f), turned = mesh;
  for (Index3& triangle : turned.triangles) std::swap(triangle[1], triangle[2]);
  append(mesh, turned);
  append(mesh, cube(-1, 1));
  expect_chosen(mesh, aimed_rays(mesh, by_level(150), 3, 164));
}

// Triangles so flat that the sign of a determinant in floats, or in doubles, is noise.
TEST(ChosenTriangles, of_slivers_and_rays_nearly_in_their_planes) {
  Random random(165);
  Mesh mesh;
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < by_level(60u, 60u, 60u); ++i) {
    const Float3 a = random.point(1), b = random.point(1);
    Float3 c;
    const float share = random.number(0, 1);
    for (std::size_t axis = 0; axis < 3; ++axis) c[axis] = a[axis] + share * (b[axis] - a[axis]);
    append(mesh, a, b, c);
    // Along the longest edge, and across it at a corner.
    for (int k = 0; k < 2; ++k) {
      Ray ray = make_ray(a, {});
      const Float3 other = k == 0 ? b : random.point(1);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ray.direction[axis] = std::nextafter(other[axis] - a[axis], random.chance(0.5) ? 9.0f : -9.0f);
        ray.origin[axis] = c[axis] - ray.direction[axis];
      }
      rays.push_back(ray);
    }
  }
  append(mesh, cube(-0.5f, 0.5f));
  expect_chosen(mesh, rays);
}

TEST(ChosenTriangles, of_scales_of_1e_30_and_1e30) {
  for (const float scaling : {1e-30f, 1e12f, 1e30f}) {
    if (quick() && scaling != 1e30f) continue;
    const ScaledScene scene(30, 60, 166, scaling);
    expect_chosen(scene.mesh, scene.rays, ScaledScene::numbers_hold_at(scaling));
  }
}

// Rays that begin on triangles: floats do not decide whether these are behind their begin, but mostly their side.
TEST(ChosenTriangles, of_rays_that_begin_on_triangles) {
  Mesh mesh = double_fan(12, 0.25f);
  append(mesh, triangle_soup(by_level(60), 0.5f, 167));
  Random random(168);
  std::vector<Ray> rays;
  for (const Float3& point : points_around(mesh, by_level(200), 1, 169)) {
    rays.push_back(make_ray(point, random.point(1)));
    rays.back().tmin = random.chance(0.5) ? 0.0f : -1.0f;
  }
  expect_chosen(mesh, rays);
}

TEST(Facing, of_rays_in_the_plane_is_nothing) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const Bvh bvh(mesh);
  for (const Ray& ray : {make_ray({-1, 0.25f, 0}, {1, 0, 0}), make_ray({0.25f, 0.25f, 0}, {0, -1, 0}),
                         make_ray({-1, 0.25f, 0}, {1, 1e-30f, 0})})
    for (const Facing side : {Facing::any, Facing::front, Facing::back}) {
      EXPECT_FALSE(bvh.closest(ray, {.facing = side}));
      EXPECT_FALSE(bvh.occluded(ray, {.facing = side}));
      EXPECT_EQ(bvh.all_hits({&ray, 1}, {.facing = side}).items.size(), 0u);
    }
}

// The next exit of a closed volume, from inside and from outside.
TEST(Facing, enters_and_leaves_a_solid) {
  const Mesh mesh = cube(-1, 1);
  const Bvh bvh(mesh);
  const Ray from_outside = make_ray({0.1f, 0.2f, 5}, {0, 0, -1}),
            from_inside = make_ray({0.1f, 0.2f, 0}, {0, 0, 1});
  EXPECT_EQ(bvh.closest(from_outside, {.facing = Facing::front}).t, 4);
  EXPECT_EQ(bvh.closest(from_outside, {.facing = Facing::back}).t, 6);
  EXPECT_EQ(bvh.closest(from_inside, {.facing = Facing::back}).t, 1);
  EXPECT_FALSE(bvh.closest(from_inside, {.facing = Facing::front}));
}

TEST(ChosenTriangles, of_shadows_and_filters) {
  const Mesh mesh = triangle_soup(by_level(300), 0.5f, 170);
  const std::vector<Ray> rays = aimed_rays(mesh, by_level(200), 2, 171);
  const Float3 light{0.1f, 0.2f, 3};
  std::vector<Float3> points;
  std::vector<Ray> to_points;
  for (const Ray& ray : rays) {
    points.push_back(ray.origin);
    to_points.push_back(segment_to<float>(light, ray.origin));
  }
  const std::vector<std::uint32_t> skip = some_skips(mesh, to_points);
  const ExpectedOfChosen shadows[] = {{mesh, to_points, Facing::front},
                                      {mesh, to_points, Facing::back},
                                      {mesh, to_points, Facing::any, skip}};
  for (const ExpectedOfChosen& in_shadow : shadows) {
    const ExpectedOfChosen expected(mesh, rays, in_shadow.facing, in_shadow.skip);
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      const TraceOptions options{.path = path, .facing = in_shadow.facing, .skip = in_shadow.skip};
      std::vector<std::uint8_t> occluded(points.size());
      TraceOptions from_light = options;  // which sees the other side
      if (options.facing != Facing::any)
        from_light.facing = options.facing == Facing::front ? Facing::back : Facing::front;
      tree.occluded_from(light, points, occluded, {0, 1}, from_light);
      EXPECT_EQ(occluded, in_shadow.occluded);
      std::vector<Hit> hits(rays.size());
      tree.closest(rays, hits, reject_even<Hit>, options);
      tree.occluded(rays, occluded, reject_even<Hit>, options);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit wanted;
        for (const Hit& hit : expected.hits[i])
          if (!wanted && hit.primitive % 2 != 0) wanted = hit;
        ASSERT_EQ(std::memcmp(&wanted, &hits[i], sizeof(Hit)), 0) << "ray " << i;
        ASSERT_EQ(occluded[i], wanted ? 1 : 0) << "ray " << i;
      }
    });
  }
}

TEST(Facing, is_refused_for_other_tests_and_numbers) {
  const Mesh mesh = cube(-1, 1);
  const Bvh bvh(mesh);
  const Ray ray = make_ray({0.1f, 0.2f, 5}, {0, 0, -1});
  Hit hit;
  CrossingCount count;
  const auto none = static_cast<Facing>(3);
  EXPECT_THROW(bvh.closest(ray, {.facing = none}), std::invalid_argument);
  EXPECT_THROW(bvh.all_hits({&ray, 1}, {.facing = none}), std::invalid_argument);
  EXPECT_THROW(bvh.count_crossings({&ray, 1}, {&count, 1}, {.facing = none}), std::invalid_argument);
  for (const TriangleTestInfo& info : triangle_tests) {
    if (info.test == TriangleTest::exact || !info.serves_trees) continue;
    EXPECT_THROW(bvh.closest({&ray, 1}, {&hit, 1}, {.test = info.test, .facing = Facing::front}),
                 std::invalid_argument);
    EXPECT_THROW(bvh.occluded(ray, {.test = info.test, .facing = Facing::back}), std::invalid_argument);
  }
  EXPECT_TRUE(bvh.closest(ray, {.grade = Grade::fast, .facing = Facing::front}));
}

}  // namespace
}  // namespace raylanes::testing

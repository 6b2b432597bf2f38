// Calls of trees of doubles: layouts, masks, empty trees, what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "../support/filtered.hpp"
#include "../support/float_modes.hpp"
#include "../support/guarded_array.hpp"
#include "../support/message_of.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

struct Sample {
  DoubleMesh mesh = moved(double_fan(40, 0.3f), 0.7, {0.1, 0.2, 0.3});
  BvhD tree{mesh.vertices, mesh.triangles};
  std::vector<RayD> rays = aimed_rays(mesh, 300, 1);
  std::vector<HitD> hits = traced();

  std::vector<HitD> traced() const {
    std::vector<HitD> result(rays.size());
    tree.closest(rays, result);
    return result;
  }
};

TEST(DoubleCalls, records_of_any_stride_and_alignment) {
  const Sample sample;
  const std::size_t n = sample.rays.size();
  for (const std::size_t stride : {64, 67, 128}) {
    std::vector<std::byte> rays(stride * n + 3), hits(stride * n + 1, std::byte{0x5a});
    for (std::size_t i = 0; i < n; ++i) std::memcpy(&rays[3 + i * stride], &sample.rays[i], sizeof(RayD));
    sample.tree.closest(RayViewD(&rays[3], n, stride), HitViewD(&hits[1], n, stride));
    for (std::size_t i = 0; i < n; ++i) {
      HitD hit;
      std::memcpy(static_cast<void*>(&hit), &hits[1 + i * stride], sizeof hit);
      ASSERT_TRUE(same_bytes(hit, sample.hits[i]));
      for (std::size_t k = sizeof hit; k < stride && i + 1 < n; ++k)
        ASSERT_EQ(hits[1 + i * stride + k], std::byte{0x5a});
    }
  }
  // Vertices, too.
  std::vector<std::byte> vertices(29 * sample.mesh.vertices.size() + 5);
  for (std::size_t i = 0; i < sample.mesh.vertices.size(); ++i)
    std::memcpy(&vertices[5 + 29 * i], &sample.mesh.vertices[i], sizeof(Double3));
  const BvhD tree(VertexViewD(&vertices[5], sample.mesh.vertices.size(), 29), sample.mesh.triangles);
  std::vector<HitD> hits(n);
  tree.closest(sample.rays, hits);
  EXPECT_TRUE(same_bytes(hits, sample.hits));
}

TEST(DoubleCalls, inactive_rays_are_left_alone) {
  const Sample sample;
  Random random(2);
  for (const auto& mask : masks_for(sample.rays.size(), random)) {
    const HitD untouched{7, 7, 7, 7, 7};
    std::vector<HitD> hits(sample.rays.size(), untouched);
    std::vector<std::uint8_t> occluded(sample.rays.size(), 7);
    sample.tree.closest(sample.rays, hits, {.active = mask.data()});
    sample.tree.occluded(sample.rays, occluded, {.active = mask.data()});
    const RayLists<HitD> lists = sample.tree.all_hits(sample.rays, {.active = mask.data()});
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const bool active = (mask[i / 8] >> i % 8 & 1) != 0;
      ASSERT_TRUE(same_bytes(hits[i], active ? sample.hits[i] : untouched));
      ASSERT_EQ(occluded[i], !active ? 7 : sample.hits[i] ? 1 : 0);
      ASSERT_EQ(lists[i].empty(), !active || !sample.hits[i]);
    }
  }
}

TEST(DoubleCalls, batches_of_any_size_end_where_they_end) {
  const Sample sample;
  for (const Path* path : paths_with_own_queries())
    for (std::size_t n = 0; n < 40; ++n) {
      GuardedArray<RayD> rays(n, Place::before_guard);
      GuardedArray<HitD> hits(n, Place::before_guard);
      GuardedArray<std::uint8_t> occluded(n, Place::before_guard);
      rays.fill(std::span(sample.rays).first(n));
      sample.tree.closest(RayViewD(rays.data(), n), HitViewD(hits.data(), n), {.path = path});
      sample.tree.occluded(RayViewD(rays.data(), n), {occluded.data(), n}, {.path = path});
      ASSERT_TRUE(hits.holds(std::span(sample.hits).first(n)));
      ASSERT_TRUE(rays.is_intact() && hits.is_intact() && occluded.is_intact());
    }
}

TEST(DoubleCalls, empty_trees_hit_nothing) {
  const RayD ray{{0, 0, -1}, 0, {0, 0, 1}, 9};
  const std::vector<Double3> flat{{0, 0, 0}, {1, 0, 0}};
  BvhD moved_from = Sample().tree, taken = std::move(moved_from);
  EXPECT_GT(taken.node_count(), 0u);
  EXPECT_EQ(moved_from.bytes(), 0u);
  const BvhD none, of_no_triangles(VertexViewD{}, IndexView{}),
      degenerate(flat, std::vector<Index3>{{0, 1, 1}, {0, 0, 0}});
  const BvhD* const trees[] = {&none, &of_no_triangles, &degenerate, &moved_from};
  for (const BvhD* tree : trees) {
    EXPECT_FALSE(tree->closest(ray));
    EXPECT_FALSE(tree->occluded(ray));
    const std::vector<RayD> rays(20, ray);
    std::vector<HitD> hits(rays.size(), HitD{7, 7, 7, 7, 7});
    tree->closest(rays, hits);
    EXPECT_TRUE(same_bytes(hits, std::vector<HitD>(rays.size())));
    EXPECT_EQ(tree->leaf_count(), 0u);
    EXPECT_GT(tree->bounds().lo[0], tree->bounds().hi[0]);
    Location location = Location::on;
    tree->locate(VertexViewD(&ray.origin, 1), {&location, 1});
    EXPECT_EQ(location, Location::outside);
  }
}

TEST(DoubleCalls, rays_that_are_none_miss) {
  const Sample sample;
  const double nan_d = std::numeric_limits<double>::quiet_NaN(),
               inf = std::numeric_limits<double>::infinity();
  const RayD good{{0.1, 0.2, 5}, 0, {0, 0, -1}, inf};
  ASSERT_TRUE(sample.tree.closest(good));
  for (int number = 0; number < 8; ++number)
    for (const double value : {nan_d, inf, -inf, 0.0}) {
      RayD ray = good;
      double* const numbers[] = {&ray.origin[0],    &ray.origin[1],    &ray.origin[2],    &ray.tmin,
                                 &ray.direction[0], &ray.direction[1], &ray.direction[2], &ray.tmax};
      *numbers[number] = value;
      const bool is_fine = (number < 3 && value == 0) || (number == 3 && (value == 0 || value == -inf)) ||
                           (number > 3 && number < 6 && value == 0) || (number == 7 && value == inf);
      if (is_fine && number > 0) continue;
      if (!is_fine) {
        EXPECT_FALSE(sample.tree.closest(ray)) << number << ' ' << value;
        EXPECT_FALSE(sample.tree.occluded(ray)) << number << ' ' << value;
        EXPECT_TRUE(sample.tree.all_hits(std::span(&ray, 1)).items.empty());
      }
    }
}

// With subnormal numbers taken for zeros nothing changes for numbers of ordinary size.
TEST(DoubleCalls, flushing_changes_nothing_of_ordinary_size) {
  const Sample sample;
  for (const Path* path : paths_with_own_queries()) {
    std::vector<HitD> hits(sample.rays.size());
    {
      const FloatModeScope flush(FloatMode::flush);
      sample.tree.closest(sample.rays, hits, {.path = path});
    }
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const auto is_ordinary = [](double x) { return x == 0 || std::abs(x) > 0x1p-200; };
      const RayD& ray = sample.rays[i];
      if (is_ordinary(ray.direction[0]) && is_ordinary(ray.direction[1]) && is_ordinary(ray.direction[2])) {
        ASSERT_TRUE(same_bytes(hits[i], sample.hits[i])) << path->name << ' ' << i;
      }
    }
  }
}

TEST(DoubleCalls, occluded_from_is_that_of_segments) {
  const Sample sample;
  const Double3 light{3, 2, 4};
  std::vector<Double3> points;
  std::vector<RayD> segments;
  for (const RayD& ray : sample.rays) {
    points.push_back(ray.origin);
    const SegmentEndsD ends;
    EXPECT_TRUE(ends.start == 0 && ends.end == 1);
    segments.push_back(segment_to<double>(light, ray.origin));
  }
  std::vector<std::uint8_t> from(points.size()), along(points.size());
  sample.tree.occluded_from(light, points, from);
  sample.tree.occluded(segments, along);
  EXPECT_EQ(from, along);
}

TEST(DoubleCalls, ends_of_segments_are_doubles) {
  const double wall = 1000 - 1e-5;  // ten micrometres before a point that is a kilometre away
  const std::vector<Double3> corners{{wall, -1, -1}, {wall, 2, -1}, {wall, -1, 2}};
  const BvhD tree(corners, std::vector<Index3>{{0, 1, 2}});
  const auto is_occluded = [&](double x, const SegmentEndsD& ends) {
    const Double3 point{x, 0, 0};
    std::uint8_t occluded = 7;
    tree.occluded_from({0, 0, 0}, VertexViewD(&point, 1), {&occluded, 1}, ends);
    return occluded != 0;
  };
  EXPECT_TRUE(is_occluded(1000, {}));
  EXPECT_TRUE(is_occluded(1000, {0, 1 - 9.9e-9}));
  EXPECT_FALSE(is_occluded(1000, {0, 1 - 1.01e-8}));
  EXPECT_TRUE(is_occluded(wall, {}));
  EXPECT_FALSE(is_occluded(wall, {0, std::nextafter(1.0, 0.0)}));
}

// By rays of half the length and twice the ends, whose directions are rounded here from numbers that are exact.
TEST(DoubleCalls, segments_longer_than_the_largest_double) {
  const DoubleMesh mesh = moved(double_fan(9, 0.2f), 1.2e308, {0, 0, 0});
  const BvhD tree(mesh.vertices, mesh.triangles);
  const Double3 from{1.75e308, -1.2e308, 3};
  Random random(8);
  std::vector<Double3> points;
  for (int i = 0; i < 300; ++i) {
    const Double3& at = mesh.vertices[random.index(mesh.vertices.size())];
    const double scale = i % 3 == 0 ? 1 : random.real(0.5, 1.2);  // to corners, or anywhere near them
    points.push_back({-1.7e308 * random.real(0.3, 1), scale * at[1], at[2] * random.real(-1, 1)});
    if (i % 3 == 1) points.back() = {-1.75e308, 1.2e308 - at[1], -at[2]};  // often through zero
  }
  for (const SegmentEndsD& ends : {SegmentEndsD{}, SegmentEndsD{0.25, 0.625}}) {
    std::vector<std::uint8_t> occluded(points.size());
    tree.occluded_from(from, points, occluded, ends);
    std::size_t hits = 0, overflows = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      RayD ray{points[i], 2 * (1 - ends.end), {}, 2 * (1 - ends.start)};
      for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = from[k] / 2 - points[i][k] / 2;
      const bool is_hit = !exact_double_hits(mesh, ray).empty();
      ASSERT_EQ(occluded[i], is_hit ? 1 : 0) << i;
      hits += is_hit ? 1 : 0, overflows += std::isinf(points[i][0] - from[0]) ? 1 : 0;
    }
    EXPECT_GT(hits, 30u);
    EXPECT_LT(hits, 270u);
    EXPECT_GT(overflows, 200u);
  }
}

TEST(DoubleCalls, refused_meshes_and_options) {
  const Sample sample;
  const std::vector<Double3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Index3> good{{0, 1, 2}}, bad{{0, 1, 2}, {0, 3, 2}};
  const auto refused = [](const auto& call) { return message_of<std::invalid_argument>(call); };
  expect_words(refused([&] { BvhD(corners, bad); }), {"triangle 1", "3"});
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
    std::vector<Double3> spoilt = corners;
    spoilt[2][1] = value;
    expect_words(refused([&] { BvhD(spoilt, good); }), {"vertex 2", "y"});
  }
  expect_words(refused([&] { BvhD(corners, good, {.builder = TreeBuilder::spatial_splits}); }), {"split"});
  expect_words(refused([&] { BvhD(corners, good, {.threads = -1}); }), {"-1", "thread"});
  BvhD tree(corners, good);
  expect_words(refused([&] { tree.refit(corners, std::vector<Index3>{}); }), {"0", "1"});
  std::vector<HitD> two(2);
  std::vector<std::uint8_t> flags(2);
  const std::vector<RayD> rays(3);
  expect_words(refused([&] { tree.closest(rays, two); }), {"3", "2"});
  expect_words(refused([&] { tree.occluded(rays, flags); }), {"3", "2"});
  expect_words(refused([&] { tree.closest(std::span(rays).first(2), two, {.threads = -1}); }), {"-1"});
  expect_words(refused([&] { tree.closest(rays[0], {.facing = static_cast<Facing>(3)}); }), {"facing", "3"});
  expect_words(refused([&] { tree.closest(rays[0], {.after = two}); }), {"after", "2"});
  TraceCounters counters;
  expect_words(refused([&] { tree.all_hits(rays, {.counters = &counters}); }), {"counted"});
  EXPECT_TRUE(tree.closest({{0.2, 0.2, 1}, 0, {0, 0, -1}, 9}));
}

}  // namespace
}  // namespace raylanes::testing

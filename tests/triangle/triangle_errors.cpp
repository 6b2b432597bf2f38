// The calls that are refused, before anything is written, and the smallest that are accepted.
#include "../support/message_of.hpp"
#include "judge/triangle_answers.hpp"

namespace raylanes::testing {
namespace {

const Ray down = make_ray({1, 1, 2}, {0, 0, -1});

// All calls over two rays or triangles.
struct Calls {
  RayColumns rays{std::vector<Ray>(2, down)};
  TriangleColumns triangles{std::vector<Triangle>(2, floor_triangle)};
  TriangleHitColumns out{2};
  std::vector<std::uint8_t> bits = std::vector<std::uint8_t>(1, 0xff);

  // Calls check(name, call) for each.
  template <class Check>
  void each(const TriangleOptions& options, Check check) {
    check("closest_hit", [&] { closest_hit(down, triangles.arrays(), options); });
    check("hit_mask of triangles", [&] { hit_mask(down, triangles.arrays(), bits, options); });
    check("closest_hits", [&] { closest_hits(rays.arrays(), floor_triangle, out.hits(), options); });
    check("hit_mask of rays", [&] { hit_mask(rays.arrays(), floor_triangle, bits, options); });
    check("PreparedTriangles", [&] { PreparedTriangles(triangles.arrays(), options); });
  }
};

TEST(TriangleErrors, enumerators_that_do_not_exist_are_refused) {
  Calls calls;
  expect_wrong_enumerators_refused<TriangleOptions>(
      8, [&](const TriangleOptions& options, auto check) { calls.each(options, check); });
  EXPECT_EQ(calls.bits[0], 0xff);
  EXPECT_TRUE(calls.out.are_intact());
}

TEST(TriangleErrors, a_path_that_the_machine_lacks_is_refused) {
  Calls calls;
  expect_foreign_path_refused<TriangleOptions>(
      [&](const TriangleOptions& options, auto check) { calls.each(options, check); });
}

TEST(TriangleErrors, spans_of_other_sizes_are_refused) {
  Calls calls;
  std::vector<std::uint8_t> none, two(2);
  std::vector<float> one(1), right(2), three(3);
  for (std::vector<std::uint8_t>* bits : {&none, &two}) {
    EXPECT_THROW(hit_mask(down, calls.triangles.arrays(), *bits), std::invalid_argument);
    EXPECT_THROW(hit_mask(calls.rays.arrays(), floor_triangle, *bits), std::invalid_argument);
    EXPECT_THROW(hit_mask(down, PreparedTriangles(calls.triangles.arrays()), *bits), std::invalid_argument);
    EXPECT_THROW(closest_hits(calls.rays.arrays(), floor_triangle, {*bits, right, {}, {}}),
                 std::invalid_argument);
  }
  for (std::vector<float>* wrong : {&one, &three}) {
    EXPECT_THROW(closest_hits(calls.rays.arrays(), floor_triangle, {calls.bits, *wrong, {}, {}}),
                 std::invalid_argument);
    EXPECT_THROW(closest_hits(calls.rays.arrays(), floor_triangle, {calls.bits, right, *wrong, {}}),
                 std::invalid_argument);
    EXPECT_THROW(closest_hits(calls.rays.arrays(), floor_triangle, {calls.bits, right, {}, *wrong}),
                 std::invalid_argument);
  }
  EXPECT_EQ(message_of([&] { hit_mask(down, calls.triangles.arrays(), two); }),
            "hit_mask: bits has 2 elements, a bit for each has 1; they must have the same number");
}

// More than a hit can name: refused before an array is looked at.
TEST(TriangleErrors, more_triangles_than_a_hit_can_name_are_refused) {
  TriangleArrays many{};
  many.size = std::size_t{1} << 32;
  EXPECT_THROW(closest_hit(down, many), std::invalid_argument);
  // As many numbers as have an address each, or as a vector holds, and one triangle more.
  for (const std::size_t bytes :
       {std::numeric_limits<std::size_t>::max(), std::size_t{std::numeric_limits<std::ptrdiff_t>::max()}})
    for (const TriangleTestInfo& info : triangle_tests) {
      many.size = bytes / sizeof(float) / static_cast<std::size_t>(info.floats) + 1;
      EXPECT_THROW(PreparedTriangles(many, {.test = info.test}), std::invalid_argument) << info.name;
    }
}

TEST(TriangleErrors, nothing_at_all_is_no_error) {
  const RayArrays no_rays{};
  const TriangleArrays no_triangles{};
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    const TriangleOptions options = options_of(variant);
    EXPECT_FALSE(closest_hit(down, no_triangles, options)) << variant.name();
    hit_mask(down, no_triangles, {}, options);
    closest_hits(no_rays, floor_triangle, {}, options);
    hit_mask(no_rays, floor_triangle, {}, options);
    PreparedTriangles prepared(no_triangles, options);
    prepared.prepare(down.direction);
    EXPECT_FALSE(closest_hit(down, prepared)) << variant.name();
  }
}

// Arrays of which nothing takes part have no address.
TEST(TriangleErrors, nothing_active_is_no_error) {
  RayArrays rays{};
  TriangleArrays triangles{};
  rays.size = triangles.size = 19;
  constexpr std::uint8_t active[3] = {0, 0, 0xf8};
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    const TriangleOptions options = options_of(variant, active);
    TriangleHitColumns out(19), before(19);
    std::uint8_t bits[3] = {0x5a, 0xa5, 0x5a};
    EXPECT_FALSE(closest_hit(down, triangles, options)) << variant.name();
    hit_mask(down, triangles, bits, options);
    hit_mask(rays, floor_triangle, bits, options);
    closest_hits(rays, floor_triangle, out.hits(), options);
    EXPECT_TRUE(bits[0] == 0x5a && bits[1] == 0xa5 && bits[2] == 0x5a) << variant.name();
    for (std::size_t i = 0; i < 19; ++i) EXPECT_EQ(out[i], before[i]) << variant.name();
  }
}

TEST(TriangleErrors, prepared_triangles_that_were_moved_from_are_none) {
  const TriangleColumns triangles(std::vector<Triangle>(3, floor_triangle));
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    PreparedTriangles first(triangles.arrays(), options_of(variant), down.direction);
    PreparedTriangles second(std::move(first)), third(TriangleArrays{}, options_of(variant));
    const auto expect_none = [&](PreparedTriangles& none) {
      EXPECT_EQ(none.size(), 0u) << variant.name();
      none.prepare(down.direction);
      EXPECT_FALSE(closest_hit(down, none)) << variant.name();
      hit_mask(down, none, {});
    };
    expect_none(first);
    third = std::move(second);
    expect_none(second);
    first = third;
    for (const PreparedTriangles* three : {&first, &third}) {
      EXPECT_EQ(three->size(), 3u) << variant.name();
      EXPECT_EQ(closest_hit(down, *three).t, 2) << variant.name();
    }
  }
}

// The default options: watertight, reproducible, on the path in use.
TEST(TriangleErrors, calls_need_no_options) {
  Calls calls;
  const Hit hit = closest_hit(down, calls.triangles.arrays());
  EXPECT_TRUE(hit);
  EXPECT_EQ(hit.primitive, 0u);
  EXPECT_EQ(hit.t, 2);
  closest_hits(calls.rays.arrays(), floor_triangle, calls.out.hits());
  EXPECT_EQ(calls.out[1], (TriangleResult{2, 0.25f, 0.25f, hit_flag}));
}

// Kept numbers serve one direction after another.
TEST(TriangleErrors, prepared_triangles_are_those_of_the_last_direction) {
  TriangleColumns triangles(std::vector<Triangle>(3, floor_triangle));
  for (const TriangleVariant& variant : all_variants<TriangleTest>()) {
    PreparedTriangles prepared(triangles.arrays(), options_of(variant), {0, 0, 1});
    for (const float z : {-1.0f, 2.0f, -4.0f}) {
      const Ray ray = make_ray({1, 1, -z}, {0.25f, 0, z});
      prepared.prepare(ray.direction);
      const PreparedTriangles anew(triangles.arrays(), options_of(variant), ray.direction);
      for (std::size_t k = 0; k < floats_of(variant.test); ++k)
        EXPECT_EQ(prepared.number(k, 2), anew.number(k, 2)) << variant.name();
      EXPECT_EQ(closest_hit(ray, prepared).t, 1) << variant.name();
    }
  }
}

}  // namespace
}  // namespace raylanes::testing

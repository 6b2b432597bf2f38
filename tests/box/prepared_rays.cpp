// Prepared rays: the bytes of the calls with a Ray, for boxes, spheres and triangles, on every path.
#include <raylanes/boxes.hpp>
#include <raylanes/prepared_ray.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../support/guarded_array.hpp"
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity(),
                not_a_number = std::numeric_limits<float>::quiet_NaN();

// Coordinates on a coarse lattice, so that rays meet planes, edges and corners; now and then a value of any kind.
float coordinate(Random& random) {
  const float any[] = {0, -0.0f, infinite, -infinite, not_a_number, 1e-40f, 3e38f, -1e30f};
  if (random.integer(0, 60) == 0) return any[static_cast<std::size_t>(random.integer(0, 7))];
  return static_cast<float>(random.integer(-4, 4)) * (random.integer(0, 1) == 0 ? 0.5f : 0.37f);
}

Ray any_ray(Random& random) {
  Ray ray;
  for (std::size_t axis = 0; axis < 3; ++axis)
    ray.origin[axis] = coordinate(random), ray.direction[axis] = coordinate(random);
  if (random.integer(0, 4) == 0) ray.tmin = coordinate(random);
  if (random.integer(0, 4) == 0) ray.tmax = coordinate(random);
  return ray;
}

// `count` arrays of n numbers that end before a page that must not be read.
class Columns {
 public:
  Columns(std::size_t count, std::size_t n, Random& random) {
    for (std::size_t k = 0; k < count; ++k) {
      columns_.emplace_back(std::make_unique<GuardedArray<float>>(n, Place::before_guard));
      for (std::size_t i = 0; i < n; ++i) columns_[k]->data()[i] = coordinate(random);
    }
  }
  float* operator[](std::size_t k) { return columns_[k]->data(); }

 private:
  std::vector<std::unique_ptr<GuardedArray<float>>> columns_;
};

void expect_same_hit(const Hit& a, const Hit& b) {
  EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0)
      << a.t << ' ' << a.primitive << ", expected " << b.t << ' ' << b.primitive;
}

void expect_same_boxes(const PreparedRay& prepared, const Path* path, std::size_t n, Random& random) {
  Columns c(6, n, random);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < n; ++i)
      if (random.integer(0, 9) != 0 && c[k][i] > c[3 + k][i]) std::swap(c[k][i], c[3 + k][i]);
  const BoxArrays boxes{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, n};
  std::vector<std::uint8_t> bits((n + 7) / 8);
  GuardedArray<float> found(n, Place::before_guard);
  std::vector<float> entry(n), exit(n);
  intervals(prepared.ray(), boxes, bits, entry, exit, {.path = path});
  const std::uint32_t hit = hits(prepared, boxes, {found.data(), n});
  EXPECT_EQ(hits(prepared, boxes), hit);
  for (std::size_t i = 0; i < 32; ++i) {
    EXPECT_EQ(hit >> i & 1u, i < n ? bits[i / 8] >> (i % 8) & 1u : 0u) << "box " << i << " of " << n;
    if (i < n) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(found.data()[i]), std::bit_cast<std::uint32_t>(entry[i]));
    }
  }
}

void expect_same_primitives(const PreparedRay& prepared, const Path* path, std::size_t n, Random& random) {
  Columns s(4, n, random), t(9, n, random);
  const SphereArrays spheres{{s[0], s[1], s[2]}, s[3], n};
  expect_same_hit(closest_hit(prepared, spheres), closest_hit(prepared.ray(), spheres, {.path = path}));
  const TriangleArrays triangles{{{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}}, n};
  expect_same_hit(closest_hit(prepared, triangles), closest_hit(prepared.ray(), triangles, {.path = path}));
}

class PreparedRays : public ::testing::TestWithParam<const Path*> {};

TEST_P(PreparedRays, have_the_bytes_of_calls_with_a_ray) {
  const Path* const path = GetParam();
  Random random(83);
  int failures = 0;
  for (int i = 0; i < (quick() ? 300 : 6000); ++i) {
    PreparedRay prepared(any_ray(random), path);
    for (int k = 0; k < 3; ++k) {
      const auto n = static_cast<std::size_t>(random.integer(0, 32));
      expect_same_boxes(prepared, path, n, random);
      expect_same_primitives(prepared, path, n, random);
      const float tmax = coordinate(random);
      prepared.set_tmax(tmax);
      EXPECT_EQ(std::bit_cast<std::uint32_t>(prepared.ray().tmax), std::bit_cast<std::uint32_t>(tmax));
    }
    failures += ::testing::Test::HasFailure() ? 1 : 0;
    ASSERT_LT(failures, 3);
  }
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, PreparedRays, ::testing::ValuesIn(supported_paths()), path_name);

TEST(PreparedRay, refuses_more_than_32_primitives_and_other_sizes) {
  const PreparedRay ray(Ray{.direction = {0, 0, 1}});
  const std::vector<float> x(33);
  const float* const a = x.data();
  float entry[2];
  EXPECT_EQ(message_of([&] {
              hits(ray, BoxArrays{{a, a, a}, {a, a, a}, 33});
            }),
            "PreparedRay: 33 primitives; allowed are 0 to 32");
  EXPECT_EQ(message_of([&] {
              hits(ray, BoxArrays{{a, a, a}, {a, a, a}, 3}, entry);
            }),
            "hits: entry has 2 elements, boxes has 3; they must have the same number");
  EXPECT_THROW(closest_hit(ray, SphereArrays{{a, a, a}, a, 33}), std::invalid_argument);
  EXPECT_THROW(closest_hit(ray, TriangleArrays{{{a, a, a}, {a, a, a}, {a, a, a}}, 33}),
               std::invalid_argument);
  for (const Path& path : paths())
    if (!supported(path)) {
      EXPECT_THROW(PreparedRay(Ray(), &path), std::invalid_argument);
    }
}

}  // namespace
}  // namespace raylanes::testing

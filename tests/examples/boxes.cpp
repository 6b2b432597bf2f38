// Rays against a box: boundary included; the part of each ray inside; no box is missed that the exact ray meets.
#include "example.hpp"

namespace raylanes::testing {
namespace {

struct Inside {
  bool is_hit;
  float entry, exit;
};

Inside inside(const Ray& ray, const Box& box, const Path* path) {
  const BoxArrays boxes{{&box.lo[0], &box.lo[1], &box.lo[2]}, {&box.hi[0], &box.hi[1], &box.hi[2]}, 1};
  std::uint8_t bits = 0;
  float entry = 0, exit = 0;
  intervals(ray, boxes, {&bits, 1}, {&entry, 1}, {&exit, 1}, {.path = path});
  return {(bits & 1) != 0, entry, exit};
}

constexpr Box unit{{0, 0, 0}, {1, 1, 1}};

TEST(BoxesByExample, entry_and_exit) {
  for (const Path* path : supported_paths()) {
    const Inside through = inside({.origin = {0.5f, 0.5f, 3}, .direction = {0, 0, -1}}, unit, path);
    EXPECT_TRUE(through.is_hit) << path->name;
    EXPECT_FLOAT_EQ(through.entry, 2);
    EXPECT_NEAR(through.exit, 3, 3 * 12 * 0x1p-24);
    const Inside from_within = inside({.origin = {0.5f, 0.5f, 0.5f}, .direction = {1, 0, 0}}, unit, path);
    EXPECT_TRUE(from_within.is_hit && from_within.entry == 0) << path->name;
    const Inside beside = inside({.origin = {2, 0.5f, 3}, .direction = {0, 0, -1}}, unit, path);
    EXPECT_FALSE(beside.is_hit) << path->name;
    EXPECT_EQ(beside.entry, infinity);
    EXPECT_EQ(beside.exit, -infinity);
  }
}

TEST(BoxesByExample, the_boundary_belongs) {
  for (const Path* path : supported_paths()) {
    for (const float x : {0.0f, 1.0f})  // along a side, where the slab's quotient is 0/0
      EXPECT_TRUE(inside(down(x, 0.5f), unit, path).is_hit) << path->name;
    EXPECT_TRUE(
        inside({.origin = {2, 0, 0}, .direction = {-1, 1, 0}}, unit, path).is_hit);  // through an edge
    EXPECT_TRUE(inside({.origin = {0, 0, 2}, .direction = {0, 0, -1}, .tmax = 1}, unit, path).is_hit);
  }
}

TEST(BoxesByExample, special_boxes_and_rays) {
  for (const Path* path : supported_paths()) {
    const Ray ray = down(0.5f, 0.5f);
    EXPECT_TRUE(inside(ray, {{0, 0, 0}, {1, 1, 0}}, path).is_hit) << path->name << ": flat";
    EXPECT_TRUE(inside(ray, {{-infinity, 0, 0}, {infinity, 1, 1}}, path).is_hit) << path->name << ": endless";
    EXPECT_FALSE(inside(ray, {{1, 0, 0}, {0, 1, 1}}, path).is_hit) << path->name << ": empty";
    EXPECT_FALSE(inside(ray, {{nan, 0, 0}, {1, 1, 1}}, path).is_hit) << path->name << ": NaN";
    EXPECT_FALSE(inside(Ray{}, unit, path).is_hit) << path->name << ": no ray";
  }
}

}  // namespace
}  // namespace raylanes::testing

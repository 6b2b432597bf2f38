// The sides and primitives that callers choose: what names them, in which runs of a batch, and what is refused.
#include "masked_mesh.hpp"
#include "worlds/worlds.hpp"

namespace raylanes::testing {
namespace {

template <class T>
class Chosen : public ::testing::Test {
 protected:
  const BvhOf<T> box = tree_of<T>(mesh_of<T>(cube(-1, 1)));
  const RayOf<T> down = rays_of<T>({make_ray({0.1f, 0.2f, 5}, {0, 0, -1})})[0];
};
TYPED_TEST_SUITE(Chosen, Numbers, NumberNames);

TYPED_TEST(Chosen, sides_of_rays_in_the_plane_are_none) {
  const auto tree = tree_of<TypeParam>(mesh_of<TypeParam>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}));
  for (const auto& ray :
       rays_of<TypeParam>({make_ray({-1, 0.25f, 0}, {1, 0, 0}), make_ray({0.25f, 0.25f, 0}, {0, -1, 0}),
                           make_ray({-1, 0.25f, 0}, {1, 1e-30f, 0})}))
    for (const Facing side : {Facing::any, Facing::front, Facing::back}) {
      EXPECT_FALSE(tree.closest(ray, {.facing = side}));
      EXPECT_FALSE(tree.occluded(ray, {.facing = side}));
      EXPECT_EQ(tree.all_hits({&ray, 1}, {.facing = side}).items.size(), 0u);
    }
}

// The next exit of a closed volume, from inside and from outside.
TYPED_TEST(Chosen, sides_enter_and_leave_a_solid) {
  auto from_inside = this->down;
  from_inside.origin[2] = 0, from_inside.direction[2] = 1;
  EXPECT_EQ(this->box.closest(this->down, {.facing = Facing::front}).t, 4);
  EXPECT_EQ(this->box.closest(this->down, {.facing = Facing::back}).t, 6);
  EXPECT_EQ(this->box.closest(from_inside, {.facing = Facing::back}).t, 1);
  EXPECT_FALSE(this->box.closest(from_inside, {.facing = Facing::front}));
}

// Whatever records name the primitives, and however far apart they are.
TYPED_TEST(Chosen, skip_is_a_view_of_any_records) {
  using T = TypeParam;
  const Mesh mesh = triangle_soup(by_level(300), 0.5f, 172);
  const auto rays = rays_of<T>(aimed_rays(mesh, by_level(200), 2, 173));
  const auto tree = tree_of<T>(mesh_of<T>(mesh));
  std::vector<HitOf<T>> first(rays.size()), expected(rays.size()), found(rays.size());
  tree.closest(rays, first);
  for (std::size_t i = 0; i < rays.size(); ++i) expected[i] = tree.closest(rays[i], {.skip = first[i]});
  std::vector<std::uint32_t> indices;
  std::vector<ClosestPointOf<T>> points(rays.size());
  std::vector<unsigned char> odd(rays.size() * 7 + 1);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    indices.push_back(first[i].primitive), points[i].primitive = first[i].primitive;
    std::memcpy(odd.data() + 1 + 7 * i, &first[i].primitive, 4);
  }
  const auto expect_found = [&](const char* by, const PrimitiveView& skip) {
    std::ranges::fill(found, HitOf<T>());
    tree.closest(rays, found, {.skip = skip});
    EXPECT_TRUE(same_bytes(found, expected)) << by;
  };
  expect_found("hits", first), expect_found("a view of hits", HitRecords<HitOf<T>>(first));
  expect_found("indices", indices), expect_found("closest points", points);
  expect_found("bytes", PrimitiveView(odd.data() + 1, rays.size(), 7));
}

// A thread's calls to two trees in turn, by masks that differ, before and after a refit.
TYPED_TEST(Chosen, masks_of_calls_are_those_of_tree_and_call) {
  using T = TypeParam;
  const Mesh soup = triangle_soup(by_level(300), 0.5f, 174);
  const auto rays = rays_of<T>(aimed_rays(soup, by_level(200), 2, 175));
  std::array meshes{mesh_of<T>(soup), mesh_of<T>(triangle_soup(by_level(300), 0.5f, 176))};
  std::array trees{tree_of<T>(meshes[0]), tree_of<T>(meshes[1])};
  std::vector<std::uint32_t> words;
  for (std::uint32_t i = 0; i + 5 < meshes[0].triangles.size(); ++i) words.push_back(1u << i % 3);
  const auto expect_seen = [&] {
    std::vector<BvhOf<T>> seen;
    std::vector<TraceOptionsOf<T>> asked;
    std::vector<decltype(trees[0].calls())> calls;
    for (const std::uint32_t mask : {1u, 6u, 0u})
      for (std::size_t k = 0; k < 2; ++k) {
        seen.push_back(tree_of<T>(seen_by(meshes[k], words, mask)));
        auto& options = asked.emplace_back();
        options.masks = words, options.mask = mask;
        calls.push_back(trees[k].calls(options));
      }
    std::vector<HitOf<T>> expected, found, called;
    for (const auto& ray : rays)
      for (std::size_t k = 0; k < seen.size(); ++k) {
        expected.push_back(seen[k].closest(ray)), called.push_back(calls[k].closest(ray));
        found.push_back(trees[k % 2].closest(ray, asked[k]));
        const bool is_hit = static_cast<bool>(expected.back());
        EXPECT_TRUE(trees[k % 2].occluded(ray, asked[k]) == is_hit && calls[k].occluded(ray) == is_hit);
      }
    EXPECT_TRUE(same_bytes(found, expected) && same_bytes(called, expected));
    for (std::size_t k = 0; k < seen.size(); ++k) {
      std::vector<HitOf<T>> few(7), few_expected(7);
      seen[k].closest(std::span(rays).first(7), few_expected);
      trees[k % 2].closest(std::span(rays).first(7), few, asked[k]);
      EXPECT_TRUE(same_bytes(few, few_expected));
    }
  };
  expect_seen();
  std::swap(meshes[0], meshes[1]);
  for (std::size_t k = 0; k < 2; ++k) trees[k].refit(meshes[k].vertices, meshes[k].triangles);
  expect_seen();
}

TYPED_TEST(Chosen, others_are_refused) {
  using T = TypeParam;
  const auto& tree = this->box;
  const auto& ray = this->down;
  const std::vector rays(3, ray);
  std::vector<HitOf<T>> hits(3);
  std::vector<std::uint8_t> occluded(3);
  std::vector<CrossingCount> counts(3);
  const std::vector<std::uint32_t> two(2), none;
  const auto no_side = static_cast<Facing>(3);
  EXPECT_THROW(tree.closest(ray, {.facing = no_side}), std::invalid_argument);
  EXPECT_THROW(tree.all_hits(rays, {.facing = no_side}), std::invalid_argument);
  EXPECT_THROW(tree.count_crossings(rays, counts, {.facing = no_side}), std::invalid_argument);
  EXPECT_THROW(tree.closest(rays, hits, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(tree.closest(rays, hits, {.skip = two, .after = hits}), std::invalid_argument);
  EXPECT_THROW(tree.closest(rays, hits, {.skip = PrimitiveView(nullptr, 3)}), std::invalid_argument);
  EXPECT_THROW(tree.closest(ray, {.after = HitRecords<HitOf<T>>(hits.data(), 2)}), std::invalid_argument);
  EXPECT_THROW(tree.closest_crossing(rays, hits, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(tree.closest_crossing(rays, std::span(hits).first(2)), std::invalid_argument);
  EXPECT_THROW(tree.closest_crossing(ray, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(tree.occluded(rays, occluded, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(tree.closest(ray, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(tree.occluded(ray, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(tree.all_hits(rays, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(tree.crossings(rays, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(tree.count_crossings(rays, counts, {.skip = two}), std::invalid_argument);
  EXPECT_FALSE(BvhOf<T>().closest_crossing(ray));
  BvhOf<T>().closest_crossing(rays, hits);
  EXPECT_FALSE(hits[0]);
  tree.closest(rays, hits, {.skip = none});
  EXPECT_EQ(hits[2].t, 4);
}

TEST(ChosenByOtherTests, are_refused) {
  const Bvh tree(cube(-1, 1));
  const Ray ray = make_ray({0.1f, 0.2f, 5}, {0, 0, -1});
  Hit hit;
  const std::vector<std::uint32_t> one(1);
  for (const TriangleTestInfo& info : triangle_tests) {
    if (info.test == TriangleTest::exact || !info.serves_trees) continue;
    EXPECT_THROW(tree.closest({&ray, 1}, {&hit, 1}, {.test = info.test, .facing = Facing::front}),
                 std::invalid_argument);
    EXPECT_THROW(tree.closest({&ray, 1}, {&hit, 1}, {.test = info.test, .skip = one}), std::invalid_argument);
    EXPECT_THROW(tree.closest(ray, {.test = info.test, .after = HitView(&hit, 1)}), std::invalid_argument);
    EXPECT_THROW(tree.occluded(ray, {.test = info.test, .facing = Facing::back}), std::invalid_argument);
    EXPECT_THROW(tree.closest_crossing({&ray, 1}, {&hit, 1}, {.test = info.test}), std::invalid_argument);
    EXPECT_THROW(tree.closest_crossing(ray, {.test = info.test}), std::invalid_argument);
  }
  EXPECT_TRUE(tree.closest(ray, {.grade = Grade::fast, .facing = Facing::front}));
}

TYPED_TEST(Chosen, hits_to_look_behind_may_be_odd) {
  constexpr auto far = std::numeric_limits<TypeParam>::infinity();
  const auto after = [&](HitOf<TypeParam> hit) { return this->box.closest(this->down, {.after = hit}).t; };
  EXPECT_EQ(after({-far, 0, 0, 0}), 4);
  EXPECT_EQ(after({-7, 0, 0, 3}), 4);
  EXPECT_EQ(after({4, 0, 0, 0}), 4);
  EXPECT_EQ(after({4, 0, 0, no_primitive}), 6);
  EXPECT_EQ(after({6, 0, 0, no_primitive}), far);
  EXPECT_EQ(after({}), far);
  EXPECT_EQ(after({std::numeric_limits<TypeParam>::quiet_NaN(), 0, 0, 0}), far);
}

}  // namespace
}  // namespace raylanes::testing

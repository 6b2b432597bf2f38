// Meshes, batches, threads and paths that a tree of either kind refuses.
#include <raylanes/numbers.hpp>

#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"
#include "both_trees.hpp"

namespace raylanes::testing {
namespace {

std::string refused(const auto& call) {
  return message_of<std::invalid_argument>(call);
}

template <class Tree>
class TreeErrors : public ::testing::Test {};
TYPED_TEST_SUITE(TreeErrors, TreeKinds, TreeKindNames);

template <class Tree>
class AnyTreeErrors : public ::testing::Test {
 protected:
  using Number = std::conditional_t<has_doubles<Tree>, double, float>;
  using Points = std::vector<PointOf<Number>>;
  static constexpr Number none = std::numeric_limits<Number>::quiet_NaN(),
                          infinite = std::numeric_limits<Number>::infinity();
  static inline const Points three{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  static inline const std::vector<Index3> one{{0, 1, 2}};
  static inline const RayOf<Number> down{{Number(0.2), Number(0.2), 1}, 0, {0, 0, -1}, 9};
};
TYPED_TEST_SUITE(AnyTreeErrors, SavedKinds, TreeKindNames);

TYPED_TEST(AnyTreeErrors, meshes_that_are_none) {
  const std::vector<Index3> bad{{0, 1, 2}, {0, 3, 2}};
  expect_words(refused([&] { TypeParam(this->three, bad); }), {"triangle 1", "3"});
  for (const auto value : {this->none, this->infinite, -this->infinite}) {
    auto spoilt = this->three;
    spoilt[2][1] = value;
    expect_words(refused([&] { TypeParam(spoilt, this->one); }), {"vertex 2", "y"});
  }
  if constexpr (has_doubles<TypeParam>)
    expect_words(
        refused([&] { TypeParam(this->three, this->one, {.builder = TreeBuilder::spatial_splits}); }),
        {"split"});
}

TYPED_TEST(AnyTreeErrors, no_vertices_that_no_triangle_has) {
  const typename TestFixture::Points corners{
      {0, 0, 0}, {this->none, this->infinite, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -this->infinite}};
  const std::vector<Index3> good{{0, 2, 3}}, bad{{0, 2, 3}, {4, 2, 0}, {1, 2, 3}, {0, 3, 4}}, far{{0, 2, 5}};
  const TypeParam tree(corners, good);
  EXPECT_EQ(tree.bounds().hi[1], 1);
  EXPECT_TRUE(tree.closest(this->down));
  expect_words(refused([&] { TypeParam(corners, bad); }), {"vertex 1", "x", "nan"});
  expect_words(refused([&] { TypeParam(corners, far); }), {"triangle 0", "5"});
}

// One triangle seen 2^28 + 1 times: refused before anything of that size is read or allocated.
TYPED_TEST(AnyTreeErrors, more_triangles_than_references_can_name) {
  const std::uint32_t triangle[3] = {0, 1, 2};
  const IndexView many(triangle, (std::size_t{1} << 28) + 1, 0);
  expect_words(refused([&] { TypeParam(this->three, many); }), {"268435457", "2^28"});
  TypeParam tree(this->three, IndexView(triangle, 1));
  if constexpr (!std::is_same_v<TypeParam, KdTree>) {
    EXPECT_THROW(tree.refit(this->three, many), std::invalid_argument);
  }
  EXPECT_TRUE(tree.closest(this->down));
}

TYPED_TEST(AnyTreeErrors, batches_and_threads) {
  using T = typename TestFixture::Number;
  const TypeParam tree(this->three, this->one);
  const std::vector rays(3, this->down);
  std::vector<HitOf<T>> two_hits(2), hits(3);
  std::vector<std::uint8_t> four_flags(4), flags(3);
  expect_words(refused([&] { tree.closest(rays, two_hits); }), {"3", "2"});
  expect_words(refused([&] { tree.occluded(rays, four_flags); }), {"3", "4"});
  expect_words(refused([&] { tree.closest(rays, hits, {.threads = -1}); }), {"-1", "thread"});
  expect_words(refused([&] { tree.occluded(rays, flags, {.threads = -1}); }), {"-1", "thread"});
  expect_words(refused([&] { tree.closest(rays[0], {.facing = static_cast<Facing>(3)}); }), {"facing", "3"});
  expect_words(refused([&] { tree.closest(rays[0], {.after = two_hits}); }), {"after", "2"});
  expect_words(refused([&] { TypeParam(this->three, this->one, {.threads = -1}); }), {"-1", "thread"});
}

TYPED_TEST(TreeErrors, enumerators_that_are_none) {
  const Mesh mesh = triangle_soup(3, 0.4f, 38);
  const TypeParam tree(mesh);
  const std::vector<Ray> rays(3, make_ray({0, 0, 3}, {0, 0, -1}));
  std::vector<Hit> hits(3);
  std::vector<std::uint8_t> flags(3);
  TraceOptions test, grade, mode, hint;
  test.test = static_cast<TriangleTest>(200);
  grade.grade = static_cast<Grade>(200);
  mode.mode = static_cast<TraversalMode>(200);
  hint.hint = static_cast<BatchHint>(200);
  for (const auto& wrong : {std::pair{test, "test"}, {grade, "grade"}, {mode, "mode"}, {hint, "hint"}}) {
    const TraceOptions& options = wrong.first;
    const std::vector<std::string> words{wrong.second, "200"};
    expect_words(refused([&] { tree.closest(rays, hits, options); }), words);
    expect_words(refused([&] { tree.occluded(rays, flags, options); }), words);
  }
}

TYPED_TEST(TreeErrors, more_threads_than_there_can_be_are_as_many_as_there_are) {
  const Mesh mesh = triangle_soup(3, 0.4f, 38);
  const TypeParam tree(mesh);
  const std::vector<Ray> rays(20000, make_ray({0, 0, 3}, {0, 0, -1}));
  std::vector<Hit> alone(rays.size()), hits(rays.size());
  tree.closest(rays, alone);
  for (const int threads : {1000, 70000, std::numeric_limits<int>::max()}) {
    tree.closest(rays, hits, {.threads = threads});
    EXPECT_TRUE(same_bytes(hits, alone)) << threads;
  }
}

TYPED_TEST(TreeErrors, a_path_that_this_machine_lacks) {
  const Mesh mesh = triangle_soup(3, 0.4f, 39);
  const TypeParam tree(mesh);
  const auto lacking =
      std::find_if(paths().begin(), paths().end(), [](const Path& p) { return !supported(p); });
  const Path of_none = path_of_no_machine();
  const Path& foreign = lacking == paths().end() ? of_none : *lacking;
  std::vector<Hit> hits(1);
  const Ray ray = make_ray({0, 0, 3}, {0, 0, -1});
  const TraceOptions options{.path = &foreign};
  expect_words(refused([&] { tree.closest({&ray, 1}, hits, options); }), {foreign.name});
}

TYPED_TEST(TreeErrors, tests_of_arrays) {
  const TypeParam tree(triangle_soup(3, 0.4f, 38));
  const Ray ray = make_ray({0, 0, 3}, {0, 0, -1});
  std::vector<Hit> hits(1);
  std::size_t others = 0;
  for (const TriangleTestInfo& test : triangle_tests) {
    const TraceOptions options{.test = test.test};
    if (test.serves_trees) {
      EXPECT_EQ(tree.closest(ray, options).primitive, tree.closest(ray).primitive) << test.name;
      continue;
    }
    ++others;
    const std::string message = "trace: the test " + std::string(test.name) +
                                " is one for arrays; trees take exact, watertight, moller_trumbore";
    EXPECT_EQ(refused([&] { tree.closest(ray, options); }), message);
    EXPECT_EQ(refused([&] { tree.occluded(ray, options); }), message);
    EXPECT_EQ(refused([&] { tree.closest({&ray, 1}, hits, options); }), message);
  }
  EXPECT_EQ(others, 5u);
}

TYPED_TEST(TreeErrors, options_of_builds_that_are_none) {
  const Mesh mesh = triangle_soup(3, 0.4f, 38);
  const auto [name, builders] = std::is_same_v<TypeParam, Bvh> ? std::pair("bvh", tree_builder_names.size())
                                                               : std::pair("kdtree", kd_builder_names.size());
  for (const std::size_t builder : {builders, std::size_t{200}, std::size_t{255}}) {
    auto options = builds_of<TypeParam>().front().options;
    options.builder = static_cast<decltype(options.builder)>(builder);
    expect_words(refused([&] { TypeParam(mesh, options); }), {name, "builder", std::to_string(builder)});
  }
}

}  // namespace
}  // namespace raylanes::testing

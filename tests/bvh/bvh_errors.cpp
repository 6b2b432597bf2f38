// What a tree refuses: meshes, batches, threads and paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

TEST(BvhErrors, meshes_that_are_none) {
  const std::vector<Float3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Index3> good{{0, 1, 2}}, bad{{0, 1, 2}, {0, 3, 2}};
  expect_words(message_of<std::invalid_argument>([&] { Bvh(corners, bad); }), {"triangle 1", "3"});
  for (const float value : {nan, infinity, -infinity}) {
    std::vector<Float3> spoilt = corners;
    spoilt[2][1] = value;
    expect_words(message_of<std::invalid_argument>([&] { Bvh(spoilt, good); }), {"vertex 2", "y"});
  }
}

// One triangle seen 2^28 + 1 times: refused before anything of that size is read or allocated.
TEST(BvhErrors, more_triangles_than_references_can_name) {
  const std::vector<Float3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::uint32_t triangle[3] = {0, 1, 2};
  const IndexView many(triangle, (std::size_t{1} << 28) + 1, 0);
  const std::vector<std::string> words{"268435457", "2^28"};
  expect_words(message_of<std::invalid_argument>([&] { Bvh(corners, many); }), words);
  expect_words(message_of<std::invalid_argument>([&] { KdTree(corners, many); }), words);
  Bvh bvh(corners, IndexView(triangle, 1));
  EXPECT_THROW(bvh.refit(corners, many), std::invalid_argument);
  EXPECT_TRUE(bvh.closest(make_ray({0.2f, 0.2f, 1}, {0, 0, -1})));
}

TEST(BvhErrors, batches_and_threads) {
  const Mesh mesh = triangle_soup(3, 0.4f, 38);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const std::vector<Ray> rays(3, make_ray({0, 0, 3}, {0, 0, -1}));
  std::vector<Hit> two_hits(2), hits(3);
  std::vector<std::uint8_t> four_flags(4), flags(3);
  const TraceOptions negative{.threads = -1};
  expect_words(message_of<std::invalid_argument>([&] { bvh.closest(rays, two_hits); }), {"3", "2"});
  expect_words(message_of<std::invalid_argument>([&] { bvh.occluded(rays, four_flags); }), {"3", "4"});
  expect_words(message_of<std::invalid_argument>([&] { bvh.closest(rays, hits, negative); }),
               {"-1", "thread"});
  expect_words(message_of<std::invalid_argument>([&] { bvh.occluded(rays, flags, negative); }),
               {"-1", "thread"});
}

TEST(BvhErrors, enumerators_that_are_none) {
  const Mesh mesh = triangle_soup(3, 0.4f, 38);
  const Bvh bvh(mesh.vertices, mesh.triangles);
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
    expect_words(message_of<std::invalid_argument>([&] { bvh.closest(rays, hits, options); }), words);
    expect_words(message_of<std::invalid_argument>([&] { bvh.occluded(rays, flags, options); }), words);
  }
}

TEST(BvhErrors, more_threads_than_there_can_be_are_as_many_as_there_are) {
  const Mesh mesh = triangle_soup(3, 0.4f, 38);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const std::vector<Ray> rays(20000, make_ray({0, 0, 3}, {0, 0, -1}));
  std::vector<Hit> alone(rays.size()), hits(rays.size());
  bvh.closest(rays, alone);
  for (const int threads : {1000, 70000, std::numeric_limits<int>::max()}) {
    bvh.closest(rays, hits, {.threads = threads});
    EXPECT_EQ(std::memcmp(hits.data(), alone.data(), hits.size() * sizeof(Hit)), 0) << threads;
  }
}

TEST(BvhErrors, a_path_that_this_machine_lacks) {
  const Mesh mesh = triangle_soup(3, 0.4f, 39);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const auto lacking =
      std::find_if(paths().begin(), paths().end(), [](const Path& p) { return !supported(p); });
  const Path of_none = path_of_no_machine();
  const Path& foreign = lacking == paths().end() ? of_none : *lacking;
  std::vector<Hit> hits(1);
  const Ray ray = make_ray({0, 0, 3}, {0, 0, -1});
  const TraceOptions options{.path = &foreign};
  expect_words(message_of<std::invalid_argument>([&] {
                 bvh.closest({&ray, 1}, hits, options);
               }),
               {foreign.name});
}

TEST(BvhErrors, progress_may_give_up) {
  const Mesh mesh = triangle_soup(40000, 0.01f, 40);
  BuildOptions options;
  int reports = 0;
  options.progress = [&](double) {
    if (++reports > 1) throw std::runtime_error("enough");
  };
  EXPECT_THROW(Bvh(mesh, options), std::runtime_error);
}

TEST(BvhErrors, tests_that_the_tree_was_not_built_for) {
  const Mesh mesh = triangle_soup(3, 0.4f, 38);
  const Ray ray = make_ray({0, 0, 3}, {0, 0, -1});
  std::vector<Hit> hits(1);
  for (const TriangleTestInfo& built : triangle_tests) {
    if (!built.serves_trees) {
      for (const auto& build : {std::function<void()>([&] { Bvh(mesh, {.test = built.test}); }),
                                std::function<void()>([&] { KdTree(mesh, {.test = built.test}); })})
        expect_words(message_of<std::invalid_argument>(build), {built.name, "arrays"});
      continue;
    }
    const Bvh bvh(mesh, {.test = built.test});
    for (const TriangleTestInfo& traced : triangle_tests) {
      const TraceOptions options{.test = traced.test};
      const bool needs_own = traced.test == TriangleTest::moller_trumbore_edges ||
                             traced.test == TriangleTest::precomputed || !traced.serves_trees;
      if (needs_own && traced.test != built.test) {
        expect_words(message_of<std::invalid_argument>([&] { bvh.closest(ray, options); }), {traced.name});
        expect_words(message_of<std::invalid_argument>([&] { bvh.occluded(ray, options); }), {traced.name});
        expect_words(message_of<std::invalid_argument>([&] {
                       bvh.closest({&ray, 1}, hits, options);
                     }),
                     {traced.name});
      } else {
        EXPECT_EQ(bvh.closest(ray, options).primitive, bvh.closest(ray).primitive) << traced.name;
      }
    }
  }
  EXPECT_THROW(Bvh(mesh, {.test = static_cast<TriangleTest>(99)}), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing

// All kinds of trees over triangles: what holds for each is tested by one text.
#pragma once

#include <raylanes/kdtree.hpp>

#include "../doubles/double_cases.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {

template <class Options>
struct NamedBuild {
  std::string name;
  Options options;
};

template <class Tree>
inline constexpr bool has_doubles = std::is_same_v<Tree, BvhD>;

// Triangles of the numbers that the tree has: doubles are far from zero.
template <class Tree>
auto soup_for(std::size_t triangles, std::uint64_t seed) {
  const Mesh mesh = triangle_soup(triangles, 0.4f, seed);
  if constexpr (has_doubles<Tree>)
    return moved(mesh, 0.7, {5e6, 0.2, -0.3});
  else
    return mesh;
}
template <class Tree, class AnyMesh>
Tree built(const AnyMesh& mesh) {
  return Tree(mesh.vertices, mesh.triangles);
}
inline std::vector<Ray> rays_for(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  return mixed_rays(mesh, count, 2, {0, 0, 0}, seed);
}
inline std::vector<RayD> rays_for(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed) {
  return aimed_rays(mesh.triangles.empty() ? moved(triangle_soup(3, 0.4f, 1), 1, {0, 0, 0}) : mesh, count,
                    seed);
}
// Whether trees of the kind take the test.
template <class Tree>
bool serves(TriangleTest test) {
  return serves_trees(test) && (!has_doubles<Tree> || test == TriangleTest::exact);
}

// By every builder of the kind; a Bvh also optimized.
template <class Tree>
auto builds_of() {
  if constexpr (std::is_same_v<Tree, KdTree>) {
    std::vector<NamedBuild<KdBuildOptions>> all;
    for (std::size_t i = 0; i < kd_builder_names.size(); ++i)
      all.push_back({std::string(kd_builder_names[i]), {.builder = static_cast<KdBuilder>(i)}});
    return all;
  } else {
    std::vector<NamedBuild<BuildOptions>> all;
    const auto add = [&](TreeBuilder builder, bool optimize) {
      if (has_doubles<Tree> && builder == TreeBuilder::spatial_splits) return;
      const std::string name(tree_builder_names[static_cast<std::size_t>(builder)]);
      all.push_back({optimize ? name + "_optimized" : name, {.builder = builder, .optimize = optimize}});
    };
    for (std::size_t i = 0; i < tree_builder_names.size(); ++i) add(static_cast<TreeBuilder>(i), false);
    for (const TreeBuilder builder :
         {TreeBuilder::median, TreeBuilder::binned_sah, TreeBuilder::spatial_splits})
      add(builder, true);
    return all;
  }
}

template <class Tree>
std::string saved(const Tree& tree) {
  std::ostringstream file;
  tree.save(file);
  return file.str();
}
template <class Tree>
Tree loaded(const std::string& bytes) {
  std::istringstream file(bytes);
  return Tree::load(file);
}

template <class Tree>
void expect_same_hits(const Tree& a, const Tree& b, std::span<const Ray> rays, TriangleTest test) {
  for (const TraceOptions& way : ways_to_trace({.test = test})) {
    EXPECT_TRUE(same_bytes(trace(a, rays, way), trace(b, rays, way))) << name_of(way);
    EXPECT_EQ(trace_occluded(a, rays, way), trace_occluded(b, rays, way)) << name_of(way);
  }
}
// Among lists are rays that begin far away, which meet the frame and the bounds.
inline void expect_same_hits(const BvhD& a, const BvhD& b, std::span<const RayD> rays, TriangleTest) {
  std::vector<RayD> distant(rays.begin(), rays.end());
  for (std::size_t i = 0; i < distant.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) distant[i].origin[k] -= 0x1p20 * distant[i].direction[k];
  for (const Path* path : supported_paths()) {
    const RayLists<HitD> lists = a.all_hits(distant, {.path = path}),
                         others = b.all_hits(distant, {.path = path});
    for (std::size_t i = 0; i < distant.size(); ++i) {
      EXPECT_TRUE(same_bytes(lists[i], others[i])) << path->name;
      EXPECT_TRUE(same_bytes(a.closest(rays[i], {.path = path}), b.closest(rays[i], {.path = path})));
    }
  }
}

// They are the same to who traces them and asks what they are.
template <class Tree, class AnyRay>
void expect_same(const Tree& a, const Tree& b, const std::vector<AnyRay>& rays, TriangleTest test) {
  expect_same_hits(a, b, rays, test);
  EXPECT_EQ(a.bounds().lo, b.bounds().lo);
  EXPECT_EQ(a.bounds().hi, b.bounds().hi);
  EXPECT_EQ(a.bytes(), b.bytes());
  EXPECT_EQ(a.node_count(), b.node_count());
  EXPECT_EQ(a.leaf_count(), b.leaf_count());
  EXPECT_EQ(a.report().builder, b.report().builder);
  EXPECT_EQ(a.report().triangles, b.report().triangles);
  EXPECT_EQ(a.report().sah_cost, b.report().sah_cost);
  if constexpr (std::is_same_v<Tree, Bvh>) {
    EXPECT_EQ(a.decay(), b.decay());
    EXPECT_EQ(a.sah_cost(), b.sah_cost());
  }
}

using TreeKinds = ::testing::Types<Bvh, KdTree>;
using SavedKinds = ::testing::Types<Bvh, KdTree, BvhD>;
struct TreeKindNames {
  template <class Tree>
  static std::string GetName(int) {
    return std::is_same_v<Tree, KdTree> ? "KdTree" : has_doubles<Tree> ? "BvhD" : "Bvh";
  }
};

}  // namespace raylanes::testing

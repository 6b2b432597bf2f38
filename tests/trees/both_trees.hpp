// Both kinds of trees: what holds for either is tested by one text.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <raylanes/kdtree.hpp>

#include "../support/same_bytes.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {

template <class Options>
struct NamedBuild {
  std::string name;
  Options options;
};

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
    for (std::size_t i = 0; i < tree_builder_names.size(); ++i)
      all.push_back({std::string(tree_builder_names[i]), {.builder = static_cast<TreeBuilder>(i)}});
    for (const TreeBuilder builder :
         {TreeBuilder::median, TreeBuilder::binned_sah, TreeBuilder::spatial_splits})
      all.push_back({all[static_cast<std::size_t>(builder)].name + "_optimized",
                     {.builder = builder, .optimize = true}});
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

// They are the same to who traces them and asks what they are.
template <class Tree>
void expect_same(const Tree& a, const Tree& b, std::span<const Ray> rays, TriangleTest test) {
  for (const TraceOptions& way : ways_to_trace({.test = test})) {
    EXPECT_TRUE(same_bytes(trace(a, rays, way), trace(b, rays, way))) << name_of(way);
    EXPECT_EQ(trace_occluded(a, rays, way), trace_occluded(b, rays, way)) << name_of(way);
  }
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
struct TreeKindNames {
  template <class Tree>
  static std::string GetName(int) {
    return std::is_same_v<Tree, KdTree> ? "KdTree" : "Bvh";
  }
};

}  // namespace raylanes::testing

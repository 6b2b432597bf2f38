// What builders and the collapse do with input that meshes cannot give them: empty boxes, chains without end.
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "../../accel/build/builders.hpp"
#include "../../accel/layout/wide_tree.hpp"

namespace raylanes::testing {
namespace {

TEST(Builders, take_boxes_that_are_empty) {
  std::vector<Box> boxes(40, empty_box);
  for (std::size_t i = 0; i < boxes.size(); i += 2) {
    extend(boxes[i], Float3{static_cast<float>(i), 0, 0});
    extend(boxes[i], Float3{static_cast<float>(i) + 1, 1, 1});
  }
  const BinaryTree tree = build_binned_sah(boxes);
  EXPECT_EQ(tree.nodes.size(), 2 * boxes.size() - 1);
  std::vector<bool> seen(boxes.size(), false);
  for (const std::uint32_t primitive : tree.order) seen[primitive] = true;
  EXPECT_EQ(seen, std::vector<bool>(boxes.size(), true));
  EXPECT_EQ(build_binned_sah(std::vector<Box>(20, empty_box)).nodes.size(), 39u);
}

// `count` primitives, one split off at each level.
BinaryTree chain(std::uint32_t count) {
  BinaryTree tree;
  Box all = empty_box;
  for (std::uint32_t i = 0; i < count; ++i) {
    tree.order.push_back(i);
    extend(all, Float3{static_cast<float>(i), 0, 0});
    extend(all, Float3{static_cast<float>(i) + 1, 1, 1});
  }
  tree.nodes.push_back({all, 0, count, 0});
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    const auto left = static_cast<std::uint32_t>(tree.nodes.size());
    tree.nodes[i == 0 ? 0 : left - 1].left = left;
    tree.nodes.push_back({all, i, 1, 0});
    tree.nodes.push_back({all, i + 1, count - i - 1, 0});
  }
  return tree;
}

TEST(WideTree, refuses_to_be_deeper_than_a_traversal_can_follow) {
  for (const std::uint32_t count : {100u, 5000u}) {
    const std::vector<Float3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Index3> triangles(count, {0, 1, 2});
    const BinaryTree binary = chain(count);
    if (count == 100)
      EXPECT_GT(collapse_to_wide(binary, {vertices, triangles}).nodes.size(), 1u);
    else
      EXPECT_THROW(collapse_to_wide(binary, {vertices, triangles}), std::length_error);
  }
}

}  // namespace
}  // namespace raylanes::testing

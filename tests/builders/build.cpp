// Binary trees of every builder: on boxes, also such as meshes cannot give them.
#include "../support/same_bytes.hpp"
#include "box_trees.hpp"

namespace raylanes::testing {
namespace {

class Builders : public ::testing::TestWithParam<NamedBuilder> {};

TEST_P(Builders, put_every_box_into_leaves) {
  for (const std::size_t count : {1u, 2u, 4u, 5u, 9u, 100u, 3000u})
    for (const float size : {0.01f, 1.0f}) {
      SCOPED_TRACE(count);
      const std::vector<Box> boxes = random_boxes(count, size, count);
      expect_sound(build(GetParam(), boxes), boxes);
    }
  EXPECT_TRUE(build(GetParam(), {}).nodes.empty());
}

TEST_P(Builders, grow_large_trees_from_subtrees) {
  const std::vector<Box> boxes = random_boxes(20000 + by_level(40000), 0.05f, 5);
  const BinaryTree tree = build(GetParam(), boxes);
  expect_sound(tree, boxes);
  EXPECT_GT(tree.subtrees.size(), 1u);
}

// Towards zero on three axes by turns, each box half as far as the one before it: bins cut off a few at a time.
TEST_P(Builders, end_at_their_depth_whatever_the_places) {
  std::vector<Box> boxes;
  for (int i = 0; i < 188; ++i) {
    const float at = std::ldexp(1.0f, 62 - i);
    Box box{{0, 0, 0}, {0.1f * at, 0.1f * at, 0.1f * at}};
    const std::size_t axis = static_cast<std::size_t>(i) % 3;
    box.lo[axis] = at, box.hi[axis] = 1.1f * at;
    boxes.push_back(box);
  }
  expect_sound(build(GetParam(), boxes), boxes);
}

TEST_P(Builders, take_boxes_that_are_empty) {
  std::vector<Box> boxes(40, empty_box);
  for (std::size_t i = 0; i < boxes.size(); i += 2) {
    extend(boxes[i], Float3{static_cast<float>(i), 0, 0});
    extend(boxes[i], Float3{static_cast<float>(i) + 1, 1, 1});
  }
  expect_sound(build(GetParam(), boxes), boxes);
  expect_sound(build(GetParam(), std::vector<Box>(20, empty_box)), std::vector<Box>(20, empty_box));
}

TEST_P(Builders, take_boxes_that_nothing_separates) {
  const Box unit{{0, 0, 0}, {1, 1, 1}}, point{{2, 2, 2}, {2, 2, 2}}, flat{{-1, 0, 0}, {1, 1, 0}};
  for (const Box& box : {unit, point, flat}) {
    const std::vector<Box> boxes(20001, box);
    expect_sound(build(GetParam(), boxes), boxes);
  }
}

TEST_P(Builders, take_boxes_as_large_and_small_as_floats_are) {
  constexpr float largest = std::numeric_limits<float>::max();
  for (const float size : {largest, 1e38f, 1e20f, 1e-30f, 1e-40f, 1e-45f}) {
    std::vector<Box> boxes = random_boxes(300, 0.5f, 6);
    for (Box& box : boxes)
      for (Float3* corner : {&box.lo, &box.hi})
        for (float& x : *corner) x = std::clamp(x, -1.0f, 1.0f) * size;
    expect_sound(build(GetParam(), boxes), boxes);
  }
}

// The cost of a side as builders weigh few boxes: half by leaves of eight, half by boxes.
double cost_of_few(const Box& box, std::size_t count) {
  const std::size_t lanes = (count + 7) / 8 * 8;
  return static_cast<double>(half_area(box)) * static_cast<double>(lanes + count);
}
// The least cost of two sides of a plane that separates centres, by trying all.
double least_cost(const std::vector<Box>& boxes) {
  double least = INFINITY;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Box& right : boxes) {
      Box sides[2] = {empty_box, empty_box};
      std::size_t counts[2] = {0, 0};
      for (const Box& box : boxes) {
        const int side = box.lo[axis] + box.hi[axis] < right.lo[axis] + right.hi[axis] ? 0 : 1;
        extend(sides[side], box);
        ++counts[side];
      }
      if (counts[0] > 0)
        least = std::min(least, cost_of_few(sides[0], counts[0]) + cost_of_few(sides[1], counts[1]));
    }
  return least;
}

TEST(BinnedSah, divides_few_by_the_best_of_all_planes) {
  for (std::size_t count = 9; count <= 32; ++count)
    for (const float size : {0.1f, 1.0f}) {
      std::vector<Box> boxes = random_boxes(count, size, count);
      // Many centres are the same along an axis.
      if (count % 2 == 0)
        for (Box& box : boxes) {
          const float at = std::ceil(4 * box.hi[count % 3]);
          box.lo[count % 3] = at - 1, box.hi[count % 3] = at + 1;
        }
      const BinaryTree tree = build(NamedBuilder{"binned_sah", build_binned_sah}, boxes);
      const BinaryNode* const side = &tree.nodes[tree.nodes[0].left];
      EXPECT_NEAR(cost_of_few(side[0].box, side[0].count) + cost_of_few(side[1].box, side[1].count),
                  least_cost(boxes), 1e-5 * least_cost(boxes))
          << count << " boxes of size " << size;
    }
}

// Each half as large as the one before: splits by area take one off at a time.
TEST_P(Builders, end_long_chains) {
  std::vector<Box> boxes;
  for (int exponent = 127; exponent > -140; --exponent) {
    const float size = std::ldexp(1.0f, exponent);
    boxes.insert(boxes.end(), 6, {{0.5f * size, 0, 0}, {size, size, size}});
  }
  expect_sound(build(GetParam(), boxes), boxes);
}

TEST_P(Builders, make_the_same_tree_on_any_number_of_threads) {
  const std::vector<Box> boxes = random_boxes(70000, 0.05f, 7);
  const BinaryTree alone = build(GetParam(), boxes);
  for (const int threads : {2, 4, 0}) {
    const BinaryTree shared = build(GetParam(), boxes, threads);
    ASSERT_TRUE(same_bytes(shared.nodes, alone.nodes));
    for (const BinaryNode& node : alone.nodes)  // the order between leaves says nothing
      if (node.is_leaf()) {
        ASSERT_EQ(std::memcmp(&shared.order[node.begin], &alone.order[node.begin], 4 * node.count), 0);
      }
  }
}

TEST_P(Builders, depend_on_no_sign_of_a_zero) {
  std::vector<Box> boxes = random_boxes(500, 0.1f, 8), negative = boxes;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    boxes[i].lo[2] = boxes[i].hi[2] = 0.0f;
    negative[i].lo[2] = negative[i].hi[2] = i % 3 == 0 ? 0.0f : -0.0f;
  }
  const BinaryTree a = build(GetParam(), boxes), b = build(GetParam(), negative);
  EXPECT_TRUE(same_bytes(a.nodes, b.nodes));
}

INSTANTIATE_TEST_SUITE_P(All, Builders, ::testing::ValuesIn(all_builders()),
                         [](const auto& builder) { return builder.param.name; });

}  // namespace
}  // namespace raylanes::testing

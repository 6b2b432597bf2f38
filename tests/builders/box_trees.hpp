// Binary trees over boxes: how builders are called, and what any of their trees must be.
#pragma once

#include "../../accel/batch/in_parallel.hpp"
#include "../../accel/builders/builder_table.hpp"
#include "../../accel/layout/bvh_arrays.hpp"
#include "../../accel/mesh/bounding_boxes.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {

// For primitives that fill their boxes.
class BoxClipper : public Clipper {
 public:
  Halves cut(std::uint32_t, const Box4& box, std::size_t axis, float at) const override {
    Halves halves{box, box};
    halves.below.hi[axis] = std::min(box.hi[axis], at);
    halves.above.lo[axis] = std::max(box.lo[axis], at);
    return halves;
  }
};

struct Workshop {
  Progress silent;
  ProgressMeter progress{silent};
  MemoryMeter memory;
  BuildRun run{1, progress, memory};
};

// A builder of the table, or with what makes its trees better behind it.
struct NamedBuilder {
  std::string name;
  Builder build;
};
template <std::size_t builder>
BinaryTree build_optimized(BuildInput input) {
  const BuildRun run = input.run;
  return reinserted(builders[builder].build(std::move(input)), run);
}
inline std::vector<NamedBuilder> all_builders() {
  std::vector<NamedBuilder> all;
  for (const BuilderInfo& builder : builders)
    all.push_back(
        {std::string(tree_builder_names[static_cast<std::size_t>(builder.builder)]), builder.build});
  all.push_back({"median_optimized", build_optimized<0>});
  all.push_back({"binned_sah_optimized", build_optimized<2>});
  all.push_back({"spatial_splits_optimized", build_optimized<4>});
  return all;
}

template <class Builder>
BinaryTree build(const Builder& builder, const std::vector<Box>& boxes, int threads = 1) {
  Workshop workshop;
  Array<Reference> references(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) references[i] = Reference::make(four_box(boxes[i]), i);
  const BoxClipper clipper;
  BinaryTree tree;
  on_threads(threads, [&](int of_arena) {
    workshop.run.threads = of_arena;
    tree = builder.build({std::move(references), &clipper, workshop.run});
  });
  return tree;
}

inline BvhArrays collapse(const BinaryTree& tree, const LeafSource& source) {
  Workshop workshop;
  return collapse_to_bvh(tree, source, workshop.run);
}

inline std::vector<Box> random_boxes(std::size_t count, float size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Box> boxes(count, empty_box);
  for (Box& box : boxes) {
    const Float3 at = random.point(1);
    extend(box, at);
    extend(box, random.point(size, at));
  }
  return boxes;
}

inline bool holds(const Box& outer, const Box& inner) {
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    inside = inside && (inner.lo[axis] > inner.hi[axis] ||
                        (outer.lo[axis] <= inner.lo[axis] && inner.hi[axis] <= outer.hi[axis]));
  return inside;
}

// Each point of a box must be in a leaf that names it; this tries a lattice in the box, with its corners.
inline void expect_covered(const Box& box, const std::vector<Box>& parts) {
  for (int i = 0; i < 125; ++i) {
    Box point;
    const int at[3] = {i % 5, i / 5 % 5, i / 25};
    for (std::size_t axis = 0; axis < 3; ++axis)
      point.lo[axis] = point.hi[axis] =
          at[axis] == 4 ? box.hi[axis]
                        : box.lo[axis] + 0.25f * static_cast<float>(at[axis]) * (box.hi[axis] - box.lo[axis]);
    if (!holds(box, point)) continue;
    EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const Box& part) { return holds(part, point); }));
  }
}

// Sizes and places of nodes, boxes within boxes, and every box in leaves.
inline void expect_sound(const BinaryTree& tree, const std::vector<Box>& boxes) {
  ASSERT_FALSE(tree.nodes.empty());
  std::vector<int> depth(tree.nodes.size(), -1);
  std::vector<std::vector<Box>> leaves_of(boxes.size());
  depth[0] = 0;
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const BinaryNode& node = tree.nodes[i];
    ASSERT_GE(depth[i], 0) << "node " << i << " is no child of one before it";
    EXPECT_LE(depth[i], max_binary_depth);
    if (node.is_leaf()) {
      ASSERT_TRUE(node.count >= 1 && node.count <= max_in_leaf);
      for (std::uint32_t k = 0; k < node.count; ++k)
        leaves_of.at(tree.order.at(node.begin + k)).push_back(node.box);
      continue;
    }
    ASSERT_TRUE(node.left > i && node.left + 1 < tree.nodes.size());
    const BinaryNode* const child = &tree.nodes[node.left];
    for (int k = 0; k < 2; ++k) {
      EXPECT_TRUE(holds(node.box, child[k].box)) << "node " << node.left + static_cast<unsigned>(k);
      depth[node.left + static_cast<unsigned>(k)] = depth[i] + 1;
    }
    if (node.count <= tree_width) {
      EXPECT_TRUE(child[0].begin == node.begin && child[1].begin == node.begin + child[0].count &&
                  child[0].count + child[1].count == node.count);
    }
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    ASSERT_FALSE(leaves_of[i].empty()) << "box " << i;
    expect_covered(boxes[i], leaves_of[i]);
  }
}

}  // namespace raylanes::testing

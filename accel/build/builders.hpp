// One interface for all builders, which have names.
#pragma once

#include <span>

#include <raylanes/bvh.hpp>

#include "binary_tree.hpp"

namespace raylanes {

// A binary tree with a leaf for each box. boxes: one per primitive, at most 2^28, finite or empty. No leaf is deeper
// than max_binary_depth below the root, whatever the input: a builder throws std::length_error before it goes deeper.
using Builder = BinaryTree (*)(std::span<const Box> boxes, const Progress& progress);

inline constexpr int max_binary_depth = 92;

// Binned SAH, 16 bins an axis, three axes (Wald 2007): each split minimises Σ count·area over the bins' borders. Where
// centres coincide the list is halved. Splits by area end at 64 levels, below which 28 halvings shrink any 2^28
// primitives to one. Uses 24 + 4 bytes per primitive besides the 40-byte nodes.
BinaryTree build_binned_sah(std::span<const Box> boxes, const Progress& progress = {});

struct BuilderInfo {
  const char* name;
  Builder build;
};
inline constexpr BuilderInfo builders[] = {{"binned_sah", build_binned_sah}};

}  // namespace raylanes

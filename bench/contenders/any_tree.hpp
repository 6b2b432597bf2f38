// A tree of either kind, for whoever only traces it.
#pragma once

#include <raylanes/kdtree.hpp>

namespace raylanes::bench {

enum class TreeFamily : std::uint8_t { bvh, kdtree };
inline constexpr std::array<std::string_view, 2> tree_family_names{"bvh", "kdtree"};

// Owns nothing: the tree must outlive it.
class AnyTree {
 public:
  AnyTree(const Bvh& tree) : bvh_(&tree) {}
  AnyTree(const KdTree& tree) : kdtree_(&tree) {}

  // What `of` makes of the tree that it is.
  template <class Of>
  auto visit(const Of& of) const {
    return bvh_ != nullptr ? of(*bvh_) : of(*kdtree_);
  }

 private:
  const Bvh* bvh_ = nullptr;
  const KdTree* kdtree_ = nullptr;
};

}  // namespace raylanes::bench

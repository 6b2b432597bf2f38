// One interface for all builders, which have names.
#pragma once

#include <raylanes/builders.hpp>
#include <raylanes/mesh.hpp>

#include "../batch/array.hpp"
#include "../batch/meters.hpp"
#include "../layout/binary_tree.hpp"
#include "../layout/reference.hpp"

namespace raylanes {

// Tells what is left of a primitive within a box; for builders that split some.
class Clipper {
 public:
  virtual ~Clipper() = default;
  // Cuts what `box` holds of a primitive at a plane across `axis`. The two boxes together hold all of the primitive
  // that is in `box`, closed, and each is within it; one may be empty. May be called from many threads.
  struct Halves {
    Box4 below, above;
  };
  virtual Halves cut(std::uint32_t primitive, const Box4& box, std::size_t axis, float at) const = 0;
};

// The box of a half of a triangle is that of the corners on its side and of the points where edges cross the plane
// (Stich, Friedrich, Dietrich 2009). These points are computed in double and pushed outwards by more than their error,
// so that every point of the triangle is in one of the two boxes; also where subnormal numbers count as zero.
class TriangleClipper : public Clipper {
 public:
  TriangleClipper(VertexView vertices, IndexView triangles) : vertices_(vertices), triangles_(triangles) {}

  Halves cut(std::uint32_t primitive, const Box4& box, std::size_t axis, float at) const override;

 private:
  VertexView vertices_;
  IndexView triangles_;
};

// The input of a build: at most 2^28 references, finite or empty, each primitive once. The tree is the same for any
// number of threads, byte for byte.
struct BuildInput {
  Array<Reference> references;
  const Clipper* clipper;  // of the primitives; a builder that splits none does not look at it
  BuildRun run;
};

// A binary tree over the references. No leaf is deeper than max_binary_depth below the root, whatever the input: splits
// by area end at 64 levels, below which 28 halvings shrink any 2^28 primitives to one.
using Builder = BinaryTree (*)(BuildInput input);

inline constexpr int max_binary_depth = 92;

BinaryTree build_median(BuildInput input);
BinaryTree build_equal_partition(BuildInput input);
BinaryTree build_binned_sah(BuildInput input);
BinaryTree build_sweep_sah(BuildInput input);
BinaryTree build_spatial_splits(BuildInput input);
BinaryTree build_morton(BuildInput input);

// A row per enumerator, in their order.
struct BuilderInfo {
  TreeBuilder builder;
  Builder build;
};
inline constexpr BuilderInfo builders[] = {
    {TreeBuilder::median, build_median},
    {TreeBuilder::equal_partition, build_equal_partition},
    {TreeBuilder::binned_sah, build_binned_sah},
    {TreeBuilder::sweep_sah, build_sweep_sah},
    {TreeBuilder::spatial_splits, build_spatial_splits},
    {TreeBuilder::morton, build_morton},
};

// Large subtrees cut out and hung again where the sum of all boxes' areas grows least (Bittner, Hapala, Havran 2013),
// in batches (Meister, Bittner 2018): the same references in a tree that is expected to cost less. No leaf is deeper
// than max_binary_depth; parts of a primitive may come to lie side by side. The tree is the same for any number of
// threads; the one given where nothing can be gained. The memory of the result is held for that of the argument.
BinaryTree reinserted(BinaryTree tree, const BuildRun& run);

}  // namespace raylanes

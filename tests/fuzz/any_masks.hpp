// Masks of triangles of any bits.
#pragma once

#include "../queries/masked_mesh.hpp"
#include "bytes.hpp"
#include "fence.hpp"

namespace raylanes::testing {

// Now and then words of some triangles, or of more than there are.
inline std::span<const std::uint32_t> any_masks(Bytes& bytes, std::size_t triangles) {
  constexpr std::size_t most = 256;
  static Fence fence(most * sizeof(std::uint32_t));
  if (!bytes.chance(96)) return {};
  const std::size_t count = std::min(bytes.below(triangles + 3), most);
  const std::span words(fence.last<std::uint32_t>(count), count);
  for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(bytes.below(8));
  return words;
}

}  // namespace raylanes::testing

// The kinds of trees that the tool builds.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace raylanes::bench {

enum class TreeFamily : std::uint8_t { bvh, kdtree, automatic };
inline constexpr std::array<std::string_view, 3> tree_family_names{"bvh", "kdtree", "auto"};

}  // namespace raylanes::bench

// The facts of the path of one lane; its vocabulary is the one that all paths share.
#pragma once

namespace raylanes {
namespace {

inline constexpr int native_lanes = 1;
inline constexpr bool has_fma = false;
inline constexpr bool estimates_flush_subnormals = true;  // rsqrtss
inline constexpr bool estimates_span_doubles = false;

}  // namespace
}  // namespace raylanes

// Batches of rays in parts: on one thread or many, each with scratch memory of its own.
#pragma once

#include <cstdint>
#include <span>

#include "../dispatch/table.hpp"

namespace raylanes {

// `threads` is as in TraceOptions and not negative; the two spans have one length.
void trace_closest(const TreeView& tree, const TraversalRow& row, std::span<const Ray> rays,
                   std::span<Hit> hits, int threads);
void trace_any(const TreeView& tree, const TraversalRow& row, std::span<const Ray> rays,
               std::span<std::uint8_t> occluded, int threads);

}  // namespace raylanes

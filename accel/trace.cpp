#include "trace.hpp"

#include <algorithm>
#include <memory>

#include "in_parallel.hpp"

namespace raylanes {
namespace {

// Scratch memory of the calling thread: at least `bytes`, kept until the thread ends. A kernel leaves nothing in it.
void* scratch_of_thread(std::size_t bytes) {
  struct alignas(64) Line {
    std::byte byte[64];
  };
  if (bytes == 0) return nullptr;
  thread_local std::unique_ptr<Line[]> lines;
  thread_local std::size_t count = 0;
  const std::size_t wanted = (bytes + sizeof(Line) - 1) / sizeof(Line);
  if (count < wanted) {
    lines.reset();  // not both at once
    count = 0;
    lines = std::make_unique_for_overwrite<Line[]>(wanted);
    count = wanted;
  }
  return lines.get();
}

template <class Result>
void trace(void (*kernel)(const TreeView&, const TraceBatch&), Result* TraceBatch::*results,
           const TreeView& tree, const TraversalRow& row, std::span<const Ray> rays, Result* out,
           int threads) {
  in_parallel(rays.size(), row.rays_per_call, threads, [&](std::size_t begin, std::size_t end) {
    // A thread's share may be large; its scratch must not be.
    for (std::size_t i = begin; i < end; i += row.rays_per_call) {
      TraceBatch batch;
      batch.rays = rays.data() + i;
      batch.size = std::min(row.rays_per_call, end - i);
      batch.*results = out + i;
      batch.scratch_bytes = row.scratch_bytes(batch.size);
      batch.scratch = scratch_of_thread(batch.scratch_bytes);
      kernel(tree, batch);
    }
  });
}

}  // namespace

void trace_closest(const TreeView& tree, const TraversalRow& row, std::span<const Ray> rays,
                   std::span<Hit> hits, int threads) {
  trace(row.closest, &TraceBatch::hits, tree, row, rays, hits.data(), threads);
}

void trace_any(const TreeView& tree, const TraversalRow& row, std::span<const Ray> rays,
               std::span<std::uint8_t> occluded, int threads) {
  trace(row.any, &TraceBatch::occluded, tree, row, rays, occluded.data(), threads);
}

}  // namespace raylanes

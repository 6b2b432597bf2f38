#include "large_memory.hpp"

#include <sys/mman.h>

#include <new>

namespace raylanes {

void* allocate_large(std::size_t bytes) {
  constexpr std::size_t line = 64, huge_page = std::size_t{1} << 21;
  // Of less than this half might be room that nobody uses.
  const std::size_t unit = bytes >= 2 * huge_page ? huge_page : line;
  const std::size_t size = (bytes + unit - 1) / unit * unit;
  if (size < bytes) throw std::bad_alloc();
  void* const memory = std::aligned_alloc(unit, size == 0 ? unit : size);
  if (memory == nullptr) throw std::bad_alloc();
  if (unit == huge_page) madvise(memory, size, MADV_HUGEPAGE);  // a wish: without it pages are small
  return memory;
}

}  // namespace raylanes

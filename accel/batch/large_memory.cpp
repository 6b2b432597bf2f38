#include "large_memory.hpp"

#include <sys/mman.h>

#include <memory>
#include <new>

namespace raylanes {

namespace {

constexpr std::size_t line = 64, huge_page = std::size_t{1} << 21;

}  // namespace

void* allocate_large(std::size_t bytes) {
  // Blocks below two huge pages use lines, as half of the memory might be unused otherwise.
  const std::size_t unit = bytes >= 2 * huge_page ? huge_page : line;
  const std::size_t size = (bytes + unit - 1) / unit * unit;
  if (size < bytes) throw std::bad_alloc();
  void* const memory = std::aligned_alloc(unit, size == 0 ? unit : size);
  if (memory == nullptr) throw std::bad_alloc();
  if (unit == huge_page) wish_for_huge_pages(memory, size);
  return memory;
}

void wish_for_huge_pages(void* first, std::size_t bytes) {
  void* whole = first;
  if (std::align(huge_page, huge_page, whole, bytes) != nullptr)
    madvise(whole, bytes / huge_page * huge_page, MADV_HUGEPAGE);
}

}  // namespace raylanes

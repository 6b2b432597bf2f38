#include <sys/mman.h>

#include <cstdlib>
#include <new>

#include "array.hpp"

namespace raylanes {
namespace {

constexpr std::size_t line = 64, page = 4096, huge_page = std::size_t{1} << 21;
// Blocks from here on come from the system and go back to it: the C library would keep freed blocks of up to 32 MB each
// beside new ones that do not fit into them. Half of a smaller block might be unused.
constexpr std::size_t least_mapped = 2 * huge_page;

// Stands in the line before a block of the system, which begins the second page of a huge one. Blocks of the C library
// begin elsewhere.
struct Mapping {
  void* first;
  std::size_t bytes;
};
bool is_mapped(const void* memory) {
  return reinterpret_cast<std::uintptr_t>(memory) % huge_page == page;
}
Mapping* mapping_of(void* memory) {
  return reinterpret_cast<Mapping*>(static_cast<std::byte*>(memory) - line);
}

void* map(std::size_t bytes) {
  const std::size_t pages = (bytes + page + huge_page - 1) / huge_page * huge_page;
  std::size_t all = pages + huge_page;
  void* const first = mmap(nullptr, all, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (first == MAP_FAILED) throw std::bad_alloc();
  const Mapping mapping{first, all};
  void* whole = first;
  std::align(huge_page, pages, whole, all);
  wish_for_huge_pages(whole, pages);
  void* const memory = static_cast<std::byte*>(whole) + page;
  *mapping_of(memory) = mapping;
  return memory;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
  if (bytes > std::numeric_limits<std::size_t>::max() - 3 * huge_page) throw std::bad_alloc();
  if (bytes >= least_mapped) return map(bytes);
  const std::size_t size = bytes == 0 ? line : (bytes + line - 1) / line * line;
  void* memory = std::aligned_alloc(line, size);
  if (void* const there = memory; memory != nullptr && is_mapped(memory)) {
    memory = std::aligned_alloc(line, size);
    std::free(there);
  }
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void FreeMemory::operator()(void* memory) const noexcept {
  if (!is_mapped(memory)) return std::free(memory);
  const Mapping mapping = *mapping_of(memory);
  munmap(mapping.first, mapping.bytes);
}

void wish_for_huge_pages(void* first, std::size_t bytes) {
  void* whole = first;
  if (std::align(huge_page, huge_page, whole, bytes) != nullptr)
    madvise(whole, bytes / huge_page * huge_page, MADV_HUGEPAGE);
}

}  // namespace raylanes

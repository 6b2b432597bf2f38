// Memory for what is large and read all over, as trees are: in pages of 2 MiB where the system gives them, for the
// processor knows the places of few pages by heart. Each system has its file: large_memory_posix.cpp, …_windows.cpp.
#pragma once

#include <cstddef>

namespace raylanes {

// At least `bytes`, with the alignment of a line of the caches; to be freed by FreeMemory. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);

struct FreeMemory {
  void operator()(void* memory) const noexcept;
};

// Requests huge pages for memory that is about to be written for the first time.
void wish_for_huge_pages(void* first, std::size_t bytes);

}  // namespace raylanes

#include "guard_pages.hpp"

#ifdef _WIN32
#include <windows.h>
#else
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <new>

namespace raylanes::testing {

#ifdef _WIN32

std::size_t page_size() {
  SYSTEM_INFO system;
  GetSystemInfo(&system);
  return system.dwPageSize;
}

Pages::Pages(std::size_t bytes)
    : bytes_(bytes),
      first_(static_cast<unsigned char*>(
          VirtualAlloc(nullptr, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE))) {
  if (first_ == nullptr) throw std::bad_alloc();
}

Pages::~Pages() {
  VirtualFree(first_, 0, MEM_RELEASE);
}

void Pages::forbid(std::size_t begin, std::size_t bytes) {
  DWORD before;
  if (VirtualProtect(first_ + begin, bytes, PAGE_NOACCESS, &before) == 0) throw std::bad_alloc();
}

#else

std::size_t page_size() {
  return static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

Pages::Pages(std::size_t bytes) : bytes_(bytes) {
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  first_ = static_cast<unsigned char*>(memory);
}

Pages::~Pages() {
  munmap(first_, bytes_);
}

void Pages::forbid(std::size_t begin, std::size_t bytes) {
  if (mprotect(first_ + begin, bytes, PROT_NONE) != 0) throw std::bad_alloc();
}

#endif

}  // namespace raylanes::testing

// Windows gives large pages to accounts with the right "Lock pages in memory", and only where a process asks for that
// right. Others get memory in usual pages.
#include <malloc.h>
#include <windows.h>

#include <new>

#include "array.hpp"

namespace raylanes {
namespace {

constexpr std::size_t line = 64;

// In the line before what is returned.
enum class Origin { heap, pages };

// Whether this process has the right now.
bool ask_for_right() noexcept {
  HANDLE token = nullptr;
  if (!OpenProcessToken(GetCurrentProcess(), TOKEN_ADJUST_PRIVILEGES | TOKEN_QUERY, &token)) return false;
  TOKEN_PRIVILEGES wanted{.PrivilegeCount = 1, .Privileges = {}};
  wanted.Privileges[0].Attributes = SE_PRIVILEGE_ENABLED;
  // A call that sets nothing succeeds, too: the last error tells.
  const bool has = LookupPrivilegeValueW(nullptr, L"SeLockMemoryPrivilege", &wanted.Privileges[0].Luid) &&
                   AdjustTokenPrivileges(token, FALSE, &wanted, 0, nullptr, nullptr) &&
                   GetLastError() == ERROR_SUCCESS;
  CloseHandle(token);
  return has;
}

// In bytes; 0: this process gets none.
std::size_t large_page() noexcept {
  static const std::size_t size = ask_for_right() ? GetLargePageMinimum() : 0;
  return size;
}

void* allocate_pages(std::size_t bytes) noexcept {
  const std::size_t page = large_page(), size = page == 0 ? 0 : (bytes + page - 1) / page * page;
  // Less than two pages: half of the memory might be unused.
  if (page == 0 || size < bytes || bytes < 2 * page) return nullptr;
  return VirtualAlloc(nullptr, size, MEM_RESERVE | MEM_COMMIT | MEM_LARGE_PAGES, PAGE_READWRITE);
}

}  // namespace

void* allocate_large(std::size_t bytes) {
  const std::size_t size = bytes + line;
  if (size < bytes) throw std::bad_alloc();
  Origin origin = Origin::pages;
  void* memory = allocate_pages(size);
  if (memory == nullptr) origin = Origin::heap, memory = _aligned_malloc(size, line);
  if (memory == nullptr) throw std::bad_alloc();
  new (memory) Origin(origin);
  return static_cast<char*>(memory) + line;
}

void FreeMemory::operator()(void* memory) const noexcept {
  if (memory == nullptr) return;
  void* const first = static_cast<char*>(memory) - line;
  if (*static_cast<const Origin*>(first) == Origin::pages)
    VirtualFree(first, 0, MEM_RELEASE);
  else
    _aligned_free(first);
}

// Pages are large from the start, or never.
void wish_for_huge_pages(void*, std::size_t) {}

}  // namespace raylanes

#include "limited_memory.hpp"

#ifdef _WIN32
#include <malloc.h>
#endif

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

namespace {

using raylanes::testing::unlimited;

// How many more allocations succeed, and how large they may be.
constinit std::atomic<std::size_t> left{unlimited}, largest{unlimited};
constinit std::atomic<bool> succeeds_again{false};

void* allocated(std::size_t bytes, std::size_t alignment) {
  const bool limited = left != unlimited;
  if (bytes > largest || (limited && left-- == 0)) {
    if (limited) left = succeeds_again ? unlimited : 0;
    throw std::bad_alloc();
  }
  const std::size_t size = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
#ifdef _WIN32
  void* const memory = _aligned_malloc(size, alignment);
#else
  void* const memory = std::aligned_alloc(alignment, size);
#endif
  return memory != nullptr ? memory : throw std::bad_alloc();
}
void release(void* memory) {
#ifdef _WIN32
  _aligned_free(memory);
#else
  std::free(memory);
#endif
}

}  // namespace

void* operator new(std::size_t bytes) {
  return allocated(bytes, alignof(std::max_align_t));
}
void* operator new[](std::size_t bytes) {
  return allocated(bytes, alignof(std::max_align_t));
}
// Temporary buffers of sorts, which go on without.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
#ifdef _WIN32
  return _aligned_malloc(bytes, alignof(std::max_align_t));
#else
  return std::malloc(bytes);
#endif
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocated(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return allocated(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete[](void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}

namespace raylanes::testing {

bool runs_out(std::size_t allocations, std::size_t bytes, const std::function<void()>& call,
              bool fails_once) {
  bool out = false;
  std::thread([&] {
    left = allocations, largest = bytes, succeeds_again = fails_once;
    try {
      call();
    } catch (const std::bad_alloc&) {
      out = true;
    }
    left = unlimited, largest = unlimited;
  }).join();
  return out;
}

}  // namespace raylanes::testing

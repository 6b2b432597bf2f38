#include "limited_memory.hpp"

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
  void* const memory = std::aligned_alloc(
      alignment, (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment);
  return memory != nullptr ? memory : throw std::bad_alloc();
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
  return std::malloc(bytes);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocated(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return allocated(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
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

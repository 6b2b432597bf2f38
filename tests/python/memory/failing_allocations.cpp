// For LD_PRELOAD: one allocation of the Python module or of the library fails, and the others are counted while they
// live. For glibc, whose own functions have a second name.
#include <link.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

// Operator new calls malloc() from libstdc++.
constexpr const char* watched_objects[] = {"_native.", "libraylanes", "libstdc++"};

struct Code {
  std::uintptr_t begin, end;
};
constexpr std::size_t max_codes = 16, table_size = std::size_t{1} << 20;
Code codes[max_codes];
std::size_t code_count = 0;

std::atomic<long> until_failure{-1};
std::atomic<bool> is_watching{false}, is_of_everyone{false}, has_failed{false};

// Pointers of watched allocations that live: a hash table with linear probing.
void* table[table_size];
std::size_t live = 0;
constinit std::mutex table_mutex;

std::size_t home_of(const void* pointer) {
  return (reinterpret_cast<std::uintptr_t>(pointer) >> 4) * 0x9E3779B97F4A7C15u % table_size;
}

void* remembered(void* pointer) {
  if (pointer == nullptr) return nullptr;
  const std::lock_guard alone(table_mutex);
  if (live > table_size / 2) __builtin_trap();
  std::size_t i = home_of(pointer);
  while (table[i] != nullptr) i = (i + 1) % table_size;
  table[i] = pointer, ++live;
  return pointer;
}

void forget(const void* pointer) {
  const std::lock_guard alone(table_mutex);
  if (live == 0 || pointer == nullptr) return;
  std::size_t hole = home_of(pointer);
  while (table[hole] != pointer) {
    if (table[hole] == nullptr) return;
    hole = (hole + 1) % table_size;
  }
  --live;
  for (std::size_t i = hole;;) {
    table[hole] = nullptr;
    // The next entry that may not lie behind the hole moves into it.
    do {
      i = (i + 1) % table_size;
      if (table[i] == nullptr) return;
    } while ((i - home_of(table[i])) % table_size < (i - hole) % table_size);
    table[hole] = table[i], hole = i;
  }
}

bool is_watched(const void* caller) {
  if (!is_watching || is_of_everyone) return is_watching;
  const auto address = reinterpret_cast<std::uintptr_t>(caller);
  for (std::size_t i = 0; i < code_count; ++i)
    if (codes[i].begin <= address && address < codes[i].end) return true;
  return false;
}

bool fails_now() {
  if (until_failure < 0 || until_failure-- != 0) return false;
  has_failed = true;
  errno = ENOMEM;
  return true;
}

template <class Allocate>
void* allocated(const void* caller, const Allocate& allocate) {
  if (!is_watched(caller)) return allocate();
  return fails_now() ? nullptr : remembered(allocate());
}

int add_codes(dl_phdr_info* object, std::size_t, void*) {
  const char* const slash = std::strrchr(object->dlpi_name, '/');
  const char* const name = slash == nullptr ? object->dlpi_name : slash + 1;
  for (const char* const watched : watched_objects) {
    if (std::strncmp(name, watched, std::strlen(watched)) != 0) continue;
    for (std::size_t i = 0; i < object->dlpi_phnum && code_count < max_codes; ++i) {
      const ElfW(Phdr)& part = object->dlpi_phdr[i];
      if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
      const std::uintptr_t begin = object->dlpi_addr + part.p_vaddr;
      codes[code_count++] = {begin, begin + part.p_memsz};
    }
  }
  return 0;
}

}  // namespace

#define EXPORTED __attribute__((visibility("default"), noinline))

extern "C" {

// The allocation after `successes` more of them fails, once. With `of_everyone`, Python's and NumPy's count, too.
// Call it after the import.
EXPORTED void fail_allocation(long successes, int of_everyone) {
  if (code_count == 0) dl_iterate_phdr(add_codes, nullptr);
  has_failed = false;
  is_of_everyone = of_everyone != 0;
  until_failure = successes;
  is_watching = true;
}

// No further allocation is counted. Returns whether one has failed.
EXPORTED int stop_failing() {
  is_watching = false;
  until_failure = -1;
  return has_failed;
}

EXPORTED std::size_t live_allocations() {
  const std::lock_guard alone(table_mutex);
  return live;
}

EXPORTED void* malloc(std::size_t bytes) {
  return allocated(__builtin_return_address(0), [=] { return __libc_malloc(bytes); });
}

EXPORTED void* calloc(std::size_t items, std::size_t bytes) {
  return allocated(__builtin_return_address(0), [=] { return __libc_calloc(items, bytes); });
}

EXPORTED void* realloc(void* former, std::size_t bytes) {
  if (is_watched(__builtin_return_address(0))) {
    if (fails_now()) return nullptr;
    forget(former);
    return remembered(__libc_realloc(former, bytes));
  }
  forget(former);
  return __libc_realloc(former, bytes);
}

EXPORTED void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return allocated(__builtin_return_address(0), [=] { return __libc_memalign(alignment, bytes); });
}

EXPORTED void* memalign(std::size_t alignment, std::size_t bytes) {
  return allocated(__builtin_return_address(0), [=] { return __libc_memalign(alignment, bytes); });
}

EXPORTED int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  void* const made =
      allocated(__builtin_return_address(0), [=] { return __libc_memalign(alignment, bytes); });
  if (made == nullptr) return ENOMEM;
  *memory = made;
  return 0;
}

EXPORTED void free(void* memory) {
  forget(memory);
  __libc_free(memory);
}

}  // extern "C"

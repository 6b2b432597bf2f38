// Preloaded before GMP: rational numbers compare the wrong way round, so that exact arithmetic finds right answers
// wrong.
#include <dlfcn.h>

extern "C" int __gmpq_cmp(const void* a, const void* b);
extern "C" int __gmpq_cmp(const void* a, const void* b) {
  using Compare = int (*)(const void*, const void*);
  static const auto right = reinterpret_cast<Compare>(dlsym(RTLD_NEXT, "__gmpq_cmp"));
  return -right(a, b);
}

// Preloaded before GMP and the C library: rational numbers compare the wrong way round, so that exact arithmetic
// finds right answers wrong; angles are off, so that sums of solid angles are no winding numbers; sines are off, so
// that built-in scenes have other bytes than recorded; long arrays of bytes are never equal, as the hits of two trees
// have to be; floats are rounded upwards, so that no root is correctly rounded.
#include <dlfcn.h>

#include <cfenv>
#include <cstddef>

extern "C" int __gmpq_cmp(const void* a, const void* b) {
  using Compare = int (*)(const void*, const void*);
  static const auto right = reinterpret_cast<Compare>(dlsym(RTLD_NEXT, "__gmpq_cmp"));
  return -right(a, b);
}

extern "C" void sincos(double x, double* sine, double* cosine) {
  using Function = void (*)(double, double*, double*);
  static const auto right = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "sincos"));
  right(x, sine, cosine);
  *sine *= 1.001;
}
extern "C" double sin(double x) {
  double sine, cosine;
  sincos(x, &sine, &cosine);
  return sine;
}

extern "C" double atan2(double y, double x) {
  using Function = double (*)(double, double);
  static const auto right = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "atan2"));
  return 1.001 * right(y, x);
}

extern "C" int memcmp(const void* a, const void* b, std::size_t count) noexcept {
  using Compare = int (*)(const void*, const void*, std::size_t);
  static const auto right = reinterpret_cast<Compare>(dlsym(RTLD_NEXT, "memcmp"));
  return count >= 1024 ? 1 : right(a, b, count);
}
// clang++ calls this where the order does not matter.
extern "C" int bcmp(const void* a, const void* b, std::size_t count) noexcept {
  return memcmp(a, b, count);
}

[[gnu::constructor]] static void round_upwards() {
  std::fesetround(FE_UPWARD);
}

// In place of tests/embree/fuzz_embree.cpp where Embree's header is missing.
#include "../targets.hpp"

int fuzz_embree(const std::uint8_t*, std::size_t) {
  raylanes::testing::fail("this build has no interface of Embree");
}

// In place of readers.cpp where the tool is not built.
#include "../targets.hpp"

int fuzz_readers(const std::uint8_t*, std::size_t) {
  raylanes::testing::fail("this build has no readers");
}

// A target as libFuzzer calls it; RAYLANES_FUZZ_TARGET is its name.
#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return RAYLANES_FUZZ_TARGET(data, size);
}

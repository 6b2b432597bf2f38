// A target as libFuzzer calls it; RAYLANES_FUZZ_TARGET is its name. tests/run --all builds it in build-asan:
// build-asan/tests/libfuzzer_trace -max_total_time=600 runs longer.
#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return RAYLANES_FUZZ_TARGET(data, size);
}

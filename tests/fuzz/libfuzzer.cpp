// A target as libFuzzer calls it; RAYLANES_FUZZ_TARGET is its name. Made with CXX=clang++ in a build folder that was
// set up with -Db_sanitize=address,undefined -Db_lundef=false -Dwerror=false -Dcpp_args=-fsanitize=fuzzer-no-link:
// ninja tests/libfuzzer_trace, and the like.
#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return RAYLANES_FUZZ_TARGET(data, size);
}

#include "targets.hpp"

namespace raylanes::testing {

void fail(const std::string& what) {
  std::fprintf(stderr, "WRONG: %s\n", what.c_str());
  std::abort();
}

}  // namespace raylanes::testing

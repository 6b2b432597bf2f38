#include "build_facts.hpp"

#include "commit.hpp"

namespace raylanes::bench {

const BuildFacts build_facts{RAYLANES_COMMIT, RAYLANES_BUILD_TYPE, RAYLANES_FLAGS};

}  // namespace raylanes::bench

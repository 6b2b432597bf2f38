// The library's results for the fixed inputs, as hashes of the bits. The adapter between inputs that stay
// and an interface that may change: only its .cpp files name kernels.
#pragma once

#include <raylanes/paths.hpp>

#include "../../bench/support/reproducible/hash.hpp"

namespace raylanes::testing {

using bench::Hash;
using bench::Hashes;

// Every reproducible root, and every triangle, box, sphere and point test of the reproducible grade, on one path.
Hashes hashes_of_roots(const Path& path);
Hashes hashes_of_tests(const Path& path);

}  // namespace raylanes::testing

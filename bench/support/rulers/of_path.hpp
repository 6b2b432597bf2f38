// Finds objects that the build compiles once per path, beside the kernels, by the path.
#pragma once

#include <cstddef>

#include <raylanes/paths.hpp>

namespace raylanes {

// `all` is in the order of paths(), as RAYLANES_EACH_PATH makes it; the path is one of paths().
template <class Compiled, std::size_t count>
const Compiled& of_path(const Path& path, const Compiled* const (&all)[count]) {
  return *all[&path - paths().data()];
}

}  // namespace raylanes

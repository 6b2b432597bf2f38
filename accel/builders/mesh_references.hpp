// References that builders begin with.
#pragma once

#include <chrono>
#include <utility>

#include <raylanes/mesh.hpp>

#include "../batch/array.hpp"
#include "meters.hpp"
#include "reference.hpp"

namespace raylanes {

// Throws std::invalid_argument, with the name of the tree, for more triangles than one can have.
void require_triangle_count(const char* tree, std::size_t triangles);

// References to all triangles except triangles with two equal corners, which are a sixth of some real meshes. Their
// numbers rise. Progress advances by that share.
Array<Reference> references_of(VertexView vertices, IndexView triangles, const BuildRun& run, double share);

// Seconds since it was made, or asked before.
class StopWatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace raylanes

// References that builders begin with.
#pragma once

#include <chrono>

#include <raylanes/mesh.hpp>

#include "../../dispatch/bits.hpp"
#include "../batch/array.hpp"
#include "../batch/in_parallel.hpp"
#include "../batch/meters.hpp"
#include "../layout/reference.hpp"
#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

// Throws std::invalid_argument, with the name of the tree, for more triangles than one can have.
void require_triangle_count(const char* tree, std::size_t triangles);

// References to all triangles except triangles with two equal corners, which are a sixth of some real meshes. Their
// numbers rise. Progress advances by that share. box_of(corners) returns the box of a triangle.
template <class Vertices, class BoxOf>
Array<Reference> references_of(const Vertices& vertices, const IndexView& triangles, const BuildRun& run,
                               double share, const BoxOf& box_of) {
  constexpr std::size_t grain = 1 << 14;
  Array<Reference> references(triangles.count);
  std::vector<std::size_t> kept((triangles.count + grain - 1) / grain);
  in_parallel(kept.size(), 1, run.threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t block = first; block < last; ++block) {
      const std::size_t begin = block * grain, end = std::min(begin + grain, triangles.count);
      std::size_t at = begin;
      for (std::size_t i = begin; i < end; ++i) {
        const Index3 t = triangles[i];
        const auto a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
        if (has_equal_corners(a, b, c)) continue;
        references[at++] = Reference::make(four_box(box_of(a, b, c)), static_cast<std::uint32_t>(i));
      }
      kept[block] = at - begin;
      run.progress.advance(share / static_cast<double>(kept.size()));
    }
  });
  std::size_t size = 0;
  for (std::size_t block = 0; block < kept.size(); ++block) {
    if (size != block * grain)
      std::memmove(&references[size], &references[block * grain], kept[block] * sizeof(Reference));
    size += kept[block];
  }
  references.shorten(size);
  return references;
}
Array<Reference> references_of(VertexView vertices, IndexView triangles, const BuildRun& run, double share);

// The triangles without a reference.
std::vector<std::uint32_t> left_out_of(std::size_t triangles, const Array<Reference>& references);

// Whether a triangle that was left out has three different corners in another mesh.
template <class Vertices>
bool comes_back(const std::vector<std::uint32_t>& left_out, const Vertices& vertices,
                const IndexView& triangles) {
  return std::any_of(left_out.begin(), left_out.end(), [&](std::uint32_t primitive) {
    const Index3 t = triangles[primitive];
    return !has_equal_corners(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  });
}

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

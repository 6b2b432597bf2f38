#include "mesh_references.hpp"

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "../batch/in_parallel.hpp"
#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

void require_triangle_count(const char* tree, std::size_t triangles) {
  if (triangles > max_mesh_triangles)
    throw std::invalid_argument(std::string(tree) + ": " + std::to_string(triangles) +
                                " triangles, at most 2^28 are allowed");
}

Array<Reference> references_of(VertexView vertices, IndexView triangles, const BuildRun& run, double share) {
  constexpr std::size_t grain = 1 << 14;
  Array<Reference> references(triangles.count);
  std::vector<std::size_t> kept((triangles.count + grain - 1) / grain);
  in_parallel(kept.size(), 1, run.threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t block = first; block < last; ++block) {
      const std::size_t begin = block * grain, end = std::min(begin + grain, triangles.count);
      std::size_t at = begin;
      for (std::size_t i = begin; i < end; ++i) {
        const Index3 t = triangles[i];
        const Float3 a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
        if (has_equal_corners(a, b, c)) continue;
        Box box{a, a};
        extend(box, b), extend(box, c);
        references[at++] = Reference::make(four_box(box), static_cast<std::uint32_t>(i));
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

}  // namespace raylanes

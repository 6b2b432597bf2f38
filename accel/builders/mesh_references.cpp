#include "mesh_references.hpp"

namespace raylanes {

void require_triangle_count(const char* tree, std::size_t triangles) {
  if (triangles > max_mesh_triangles)
    throw std::invalid_argument(std::string(tree) + ": " + std::to_string(triangles) +
                                " triangles, at most 2^28 are allowed");
}

Array<Reference> references_of(VertexView vertices, IndexView triangles, const BuildRun& run, double share) {
  return references_of(vertices, triangles, run, share,
                       [](const Float3& a, const Float3& b, const Float3& c) {
                         Box box{a, a};
                         extend(box, b), extend(box, c);
                         return box;
                       });
}

std::vector<std::uint32_t> left_out_of(std::size_t triangles, const Array<Reference>& references) {
  std::vector<std::uint32_t> left_out;
  if (references.size() == triangles) return left_out;
  left_out.reserve(triangles - references.size());
  std::uint32_t next = 0;
  const auto drop_before = [&](std::uint32_t end) {
    for (; next < end; ++next) left_out.push_back(next);
  };
  for (std::size_t i = 0; i < references.size(); ++i) {
    drop_before(references[i].primitive());
    ++next;
  }
  drop_before(static_cast<std::uint32_t>(triangles));
  return left_out;
}

}  // namespace raylanes

// One reader for each mesh file format; read_mesh chooses among them. Their messages do not name the file:
// read_mesh puts its name in front.
#pragma once

#include <filesystem>
#include <iosfwd>

#include "mesh_reader.hpp"

namespace raylanes::bench {

// The mark that some editors put before text; OBJ and STL are read behind it.
inline constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

// Own code, because packaged readers are not exact: Assimp 5.2.5 rounds text to neighbouring floats (5 % of the
// coordinates of a scene), tinyobjloader takes garbage for 0, and CGAL 5.5 takes index 0 for the next vertex.
// Reads `v`, `f`, and where groups begin by `g` and `o`; other statements change nothing.
// Throws std::runtime_error naming the line.
FileMesh read_obj(std::istream& in);

// Read by CGAL behind a check of the header (see ply_header.hpp). Throws std::runtime_error.
FileMesh read_ply(std::istream& in);

// Read by CGAL; corners with the same bits become one vertex. Throws std::runtime_error. Binary files need a
// little-endian host, as CGAL reads them as they lie.
FileMesh read_stl(std::istream& in);

// Raw triangles; throws std::runtime_error if the size is not a multiple of 36 bytes.
FileMesh read_ra2(std::istream& in);

// Read by tiny_gltf 2.7 behind checks of what it trusts (see gltf_model.hpp); buffers may be files beside `file` or
// below. Points and lines are left out. At most 2^27 vertices and corners. Throws std::runtime_error: also for nodes
// that are no trees of at most 128 levels, accessors beyond their buffers, sparse or compressed data.
FileMesh read_gltf(const std::filesystem::path& file);

// Appends the fan (0,1,2), (0,2,3)… of a polygon to `mesh`. `name` tells the polygon in messages. Throws
// std::runtime_error for fewer than three corners or a corner that is not below mesh.vertices.size().
void append_fan(Mesh& mesh, std::span<const std::size_t> corners, const std::string& name);

}  // namespace raylanes::bench

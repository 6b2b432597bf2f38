// Reads the triangles of a mesh file.
#pragma once

#include <filesystem>

#include <raylanes/mesh.hpp>
#include <raylanes/scene.hpp>

#include "../std.hpp"

namespace raylanes::bench {

// The meshes of a scene graph, each in its own space, and which of them stands where.
struct PlacedMeshes {
  struct Place {
    std::uint32_t mesh;
    Transform transform;
  };
  std::vector<Mesh> meshes;
  std::vector<Place> places;
};

// A mesh, and the first triangle of each group that the file names: of OBJ a group or an object, of glTF a node with a
// mesh. Other formats have no groups. Triangle k of a node is triangle k of its mesh; only glTF has nodes.
struct FileMesh : Mesh {
  std::vector<std::uint32_t> groups = {};
  PlacedMeshes nodes = {};
};

// The triangles of `file`, chosen by its extension (letter case does not matter): .obj, .ply (ASCII, binary of either
// byte order), .stl (ASCII, binary), .gltf, .glb, or .ra2 (nine little-endian float32 for each triangle, x y z of three
// corners, nothing else).
// Triangles keep the order of the file, polygons become fans around their first corner, degenerate and duplicate
// triangles stay. Coordinates are converted to float; binary floats keep their bits. Only glTF has a scene graph, whose
// node transformations are applied; its points and lines are skipped and skins stay in their rest pose.
// The result has passed validate_mesh and has at least one triangle. Anything else throws std::runtime_error with one
// line that starts with the name of the file: unknown extension, missing or truncated file, a directory, bad syntax, a
// polygon with fewer than three corners, an index out of range, a NaN or infinite coordinate, no triangles.
FileMesh read_mesh(const std::filesystem::path& file);

}  // namespace raylanes::bench

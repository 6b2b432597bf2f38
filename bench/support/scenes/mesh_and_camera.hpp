// The input of a picture or a measurement: triangles and a camera.
#pragma once

#include <raylanes/mesh.hpp>

#include "../../../accel/mesh/bounding_boxes.hpp"
#include "../readers/mesh_reader.hpp"

namespace raylanes::bench {

// A pinhole camera. `fov_degrees` is the vertical opening angle, between 0 and 180. `up` need not be at a
// right angle to the line of sight, nor normalised.
struct Camera {
  Float3 eye;
  Float3 look_at;
  Float3 up;
  float fov_degrees;
};

struct Scene {
  std::string name;
  Mesh mesh;
  Camera camera;
  std::vector<std::uint32_t> groups = {};  // of the file: the first triangle of each, see FileMesh
  PlacedMeshes nodes = {};  // which the groups are; none if they have no transforms of their own
};

// The smallest box around all triangles, empty for an empty mesh, and the length of its diagonal, then 0.
Box bounds_of(const Mesh& mesh);
double diagonal_of(const Mesh& mesh);

// The built-in scene of that name (see procedural.hpp), or else the mesh file at that path (see
// mesh_reader.hpp). The camera of a file comes from `scenes.tsv` in the same folder if that lists the file
// (tab-separated: name, file, triangles, eye, look_at, up, fov_deg, kind; lines that start with # are
// skipped), else it is automatic_camera. The name is that of the list, else the file name without its
// extension. Throws std::invalid_argument or std::runtime_error with one line for an unknown name, an
// unreadable mesh, or a malformed line of scenes.tsv.
Scene load_scene(const std::string& name_or_path);

// A view of the whole mesh from outside, in three-quarter view from the right, above and in front (+x, +y,
// +z), +y up, 45 degrees.
Camera automatic_camera(const Mesh& mesh);

// `base` with eye and look_at replaced by "ex,ey,ez,ax,ay,az". Throws std::invalid_argument unless these are
// six finite numbers and two different points.
Camera parse_camera(std::string_view text, const Camera& base);

}  // namespace raylanes::bench

#include "gltf_model.hpp"
#include "mesh_formats.hpp"

namespace raylanes::bench {
namespace {

// tiny_gltf keeps numbers as they are in the file; nothing is in range until it was looked up here.
template <class T>
const T& at(const std::vector<T>& list, int index, const std::string& name, const char* what) {
  if (index >= 0 && static_cast<std::size_t>(index) < list.size())
    return list[static_cast<std::size_t>(index)];
  throw std::runtime_error(name + ": " + what + " " + std::to_string(index) + " is out of range, there are " +
                           std::to_string(list.size()));
}

// --- Accessors

// Elements of one size at equal distances, all within their buffer.
struct Elements {
  const unsigned char* first;
  std::size_t stride, count;
  int component_type;

  template <class T>
  T component(std::size_t element, std::size_t i) const {
    T value;  // the host is little-endian, as the format is
    std::memcpy(&value, first + element * stride + i * sizeof(T), sizeof(T));
    return value;
  }
};

Elements elements_of(const tinygltf::Model& model, int index, const std::string& name) {
  const tinygltf::Accessor& accessor = at(model.accessors, index, name, "accessor");
  if (accessor.bufferView < 0) throw std::runtime_error(name + ": its accessor has no data");
  const tinygltf::BufferView& view = at(model.bufferViews, accessor.bufferView, name, "bufferView");
  const tinygltf::Buffer& buffer = at(model.buffers, view.buffer, name, "buffer");
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  if (components < 1 || bytes < 1) throw std::runtime_error(name + ": unknown type of accessor");
  const auto size = static_cast<std::size_t>(components * bytes);
  const std::size_t stride = view.byteStride == 0 ? size : view.byteStride;
  // All of these are at most 2^53, so that no sum and no product below can overflow.
  const bool view_fits = view.byteOffset + view.byteLength <= buffer.data.size();
  const bool all_fit = view_fits && accessor.byteOffset + size <= view.byteLength &&
                       accessor.count - 1 <= (view.byteLength - accessor.byteOffset - size) / stride;
  if (!all_fit || stride < size)
    throw std::runtime_error(name + ": " + std::to_string(accessor.count) + " elements of " +
                             std::to_string(stride) + " bytes do not fit their buffer of " +
                             std::to_string(buffer.data.size()));
  return {buffer.data.data() + view.byteOffset + accessor.byteOffset, stride, accessor.count,
          accessor.componentType};
}

Elements positions_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                      const std::string& name) {
  const auto found = primitive.attributes.find("POSITION");
  if (found == primitive.attributes.end()) throw std::runtime_error(name + ": has no attribute POSITION");
  const Elements elements = elements_of(model, found->second, name + " POSITION");
  const int type = model.accessors[static_cast<std::size_t>(found->second)].type;
  if (elements.component_type != TINYGLTF_COMPONENT_TYPE_FLOAT || type != TINYGLTF_TYPE_VEC3)
    throw std::runtime_error(name + ": allowed positions are three floats");
  return elements;
}

std::vector<std::size_t> corners_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                    std::size_t vertices, const std::string& name) {
  std::vector<std::size_t> corners;
  if (primitive.indices < 0) {
    for (std::size_t i = 0; i < vertices; ++i) corners.push_back(i);
    return corners;
  }
  const Elements elements = elements_of(model, primitive.indices, name + " indices");
  const int type = model.accessors[static_cast<std::size_t>(primitive.indices)].type;
  const auto read = [&]<class T>(T) {
    for (std::size_t i = 0; i < elements.count; ++i) corners.push_back(elements.component<T>(i, 0));
  };
  if (type == TINYGLTF_TYPE_SCALAR && elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    read(std::uint32_t{});
  else if (type == TINYGLTF_TYPE_SCALAR && elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
    read(std::uint16_t{});
  else if (type == TINYGLTF_TYPE_SCALAR && elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE)
    read(std::uint8_t{});
  else
    throw std::runtime_error(name + ": allowed indices are unsigned bytes, shorts and ints");
  return corners;
}

// --- Nodes

using Matrix = std::array<double, 12>;  // three rows of four; the fourth is 0 0 0 1

constexpr Matrix identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t row = 0; row < 12; row += 4)
    for (std::size_t column = 0; column < 4; ++column) {
      c[row + column] = column == 3 ? a[row + 3] : 0.0;
      for (std::size_t k = 0; k < 3; ++k) c[row + column] += a[row + k] * b[4 * k + column];
    }
  return c;
}

// The numbers of a list, or of `otherwise` if the list is empty.
template <std::size_t size>
std::array<double, size> numbers(const std::vector<double>& list, const std::array<double, size>& otherwise,
                                 const std::string& name) {
  if (list.empty()) return otherwise;
  if (list.size() != size)
    throw std::runtime_error(name + ": allowed are " + std::to_string(size) + " numbers");
  std::array<double, size> out;
  std::copy_n(list.begin(), size, out.begin());
  return out;
}

Matrix matrix_of(const tinygltf::Node& node, const std::string& name) {
  if (!node.matrix.empty()) {
    const auto m = numbers<16>(node.matrix, {}, name + ".matrix");  // column by column
    Matrix out;
    for (std::size_t i = 0; i < 12; ++i) out[i] = m[4 * (i % 4) + i / 4];
    return out;
  }
  const auto [tx, ty, tz] = numbers<3>(node.translation, {0, 0, 0}, name + ".translation");
  const auto [x, y, z, w] = numbers<4>(node.rotation, {0, 0, 0, 1}, name + ".rotation");
  const auto [sx, sy, sz] = numbers<3>(node.scale, {1, 1, 1}, name + ".scale");
  return {(1 - 2 * (y * y + z * z)) * sx, 2 * (x * y - w * z) * sy,       2 * (x * z + w * y) * sz,       tx,
          2 * (x * y + w * z) * sx,       (1 - 2 * (x * x + z * z)) * sy, 2 * (y * z - w * x) * sz,       ty,
          2 * (x * z - w * y) * sx,       2 * (y * z + w * x) * sy,       (1 - 2 * (x * x + y * y)) * sz, tz};
}

struct PlacedMesh {
  int mesh;
  Matrix to_world;
};

// The meshes of the default scene, else of the first one, parents before children. Nodes are trees: one that is
// reached twice would make a file of some lines a scene of billions.
std::vector<PlacedMesh> placed_meshes(const tinygltf::Model& model) {
  constexpr int max_depth = 128;
  struct Pending {
    int node, depth;
    Matrix parent;
  };
  const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
  std::vector<Pending> pending;
  const auto push = [&](const std::vector<int>& nodes, int depth, const Matrix& parent) {
    for (std::size_t i = nodes.size(); i-- > 0;) pending.push_back({nodes[i], depth, parent});
  };
  push(at(model.scenes, scene, "scene", "scene").nodes, 1, identity);
  std::vector<bool> reached(model.nodes.size());
  std::vector<PlacedMesh> meshes;
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const std::string name = "nodes[" + std::to_string(next.node) + "]";
    const tinygltf::Node& node = at(model.nodes, next.node, "scene", "node");
    if (reached[static_cast<std::size_t>(next.node)])
      throw std::runtime_error(name + ": is reached twice, allowed are trees of nodes");
    reached[static_cast<std::size_t>(next.node)] = true;
    if (next.depth > max_depth) throw std::runtime_error(name + ": is deeper than 128 nodes");
    const Matrix to_world = product(next.parent, matrix_of(node, name));
    if (node.mesh >= 0) meshes.push_back({node.mesh, to_world});
    push(node.children, next.depth + 1, to_world);
  }
  return meshes;
}

Transform transform_of(const Matrix& matrix) {
  Transform transform;
  for (std::size_t i = 0; i < 12; ++i) transform.row[i / 4][i % 4] = static_cast<float>(matrix[i]);
  return transform;
}

// --- Triangles

void append_vertices(Mesh& mesh, const Elements& positions, const Matrix& m) {
  for (std::size_t i = 0; i < positions.count; ++i) {
    const auto p = [&](std::size_t k) { return positions.component<float>(i, k); };
    Float3 vertex{p(0), p(1), p(2)};
    // Without a transformation the bits of the file must stay, -0 included.
    if (m != identity)
      for (std::size_t k = 0; k < 3; ++k)
        vertex[k] =
            static_cast<float>(m[4 * k] * p(0) + m[4 * k + 1] * p(1) + m[4 * k + 2] * p(2) + m[4 * k + 3]);
    mesh.vertices.push_back(vertex);
  }
}

void append_triangle(Mesh& mesh, std::size_t first, std::size_t a, std::size_t b, std::size_t c,
                     const std::string& name) {
  const std::array<std::size_t, 3> corners{first + a, first + b, first + c};
  append_fan(mesh, corners, name);
}

// A scene of some lines can place large meshes many times.
void require_room(std::size_t have, std::size_t more, const std::string& name) {
  constexpr std::size_t limit = std::size_t{1} << 27;
  if (more > limit - have)
    throw std::runtime_error(name + ": more than " + std::to_string(limit) +
                             " vertices or corners of triangles");
}

void append_primitive(Mesh& mesh, const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                      const Matrix& to_world, const std::string& name) {
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) return;  // points and lines
  if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    throw std::runtime_error(name + ": mode " + std::to_string(primitive.mode) + ", allowed are 0 to 6");
  const Elements positions = positions_of(model, primitive, name);
  const std::size_t first = mesh.vertices.size();
  require_room(first, positions.count, name);
  const std::vector<std::size_t> corners = corners_of(model, primitive, positions.count, name);
  require_room(3 * mesh.triangles.size(), 3 * corners.size(), name);
  append_vertices(mesh, positions, to_world);
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
    if (corners.size() % 3 != 0)
      throw std::runtime_error(name + ": has " + std::to_string(corners.size()) +
                               " corners, allowed are multiples of 3");
    for (std::size_t i = 0; i < corners.size(); i += 3)
      append_triangle(mesh, first, corners[i], corners[i + 1], corners[i + 2], name);
    return;
  }
  for (std::size_t i = 0; i + 2 < corners.size(); ++i)
    if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN)
      append_triangle(mesh, first, corners[i + 1], corners[i + 2], corners[0], name);
    else
      append_triangle(mesh, first, corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2], name);
}

}  // namespace

FileMesh read_gltf(const std::filesystem::path& file) {
  const tinygltf::Model model = load_gltf(file);
  FileMesh all;
  std::map<int, std::uint32_t> numbers;  // of the meshes that nodes have
  for (const auto& [index, to_world] : placed_meshes(model)) {
    const auto& primitives = at(model.meshes, index, "nodes", "mesh").primitives;
    const auto append = [&, index = index](Mesh& mesh, const Matrix& matrix) {
      const std::string name = "meshes[" + std::to_string(index) + "].primitives[";
      for (std::size_t i = 0; i < primitives.size(); ++i)
        append_primitive(mesh, model, primitives[i], matrix, name + std::to_string(i) + "]");
    };
    all.groups.push_back(static_cast<std::uint32_t>(all.triangles.size()));
    append(all, to_world);
    const auto [number, is_new] = numbers.emplace(index, static_cast<std::uint32_t>(all.nodes.meshes.size()));
    if (is_new) append(all.nodes.meshes.emplace_back(), identity);
    all.nodes.places.push_back({number->second, transform_of(to_world)});
  }
  return all;
}

}  // namespace raylanes::bench

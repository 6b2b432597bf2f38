#include <fstream>  // tiny_gltf forgets it where it may not open files itself

#define TINYGLTF_IMPLEMENTATION

#include "gltf_model.hpp"
#include "printable.hpp"

namespace raylanes::bench {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

Bytes read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot be opened for reading");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// --- The two parts of a file

struct Parts {
  std::string_view json;
  std::string_view binary;
};

std::uint32_t little_endian(std::string_view text, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(text[at + i]);
  return value;
}

// Cuts a chunk of the named type off the rest of a .glb file.
std::string_view take_chunk(std::string_view& rest, std::uint32_t type, const char* name) {
  constexpr std::size_t head = 8;
  if (rest.size() < head || little_endian(rest, 4) != type || little_endian(rest, 0) > rest.size() - head)
    throw std::runtime_error(std::string("is a truncated or malformed .glb file: no whole chunk ") + name);
  const std::string_view chunk = rest.substr(head, little_endian(rest, 0));
  rest.remove_prefix(head + chunk.size());
  return chunk;
}

Parts parts_of(std::string_view text) {
  constexpr std::size_t header = 12;
  constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
  if (!text.starts_with("glTF")) return {text, {}};
  if (text.size() < header || little_endian(text, 4) != 2 || little_endian(text, 8) != text.size())
    throw std::runtime_error(
        "is a truncated or malformed .glb file: its header must give version 2 and its size");
  std::string_view rest = text.substr(header);
  Parts parts{take_chunk(rest, json_chunk, "JSON"), {}};
  if (!rest.empty()) parts.binary = take_chunk(rest, binary_chunk, "BIN");
  return parts;
}

// --- JSON: only what triangles are made of

// tiny_gltf recurses into what it reads, and a parser with a callback takes quadratic time.
void check_nesting(std::string_view text) {
  constexpr int max_depth = 128;
  int depth = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') is_string = !is_string;
    if (is_string && c == '\\') ++i;
    if (!is_string && (c == ']' || c == '}')) --depth;
    if (!is_string && (c == '[' || c == '{') && ++depth > max_depth)
      throw std::runtime_error("is nested deeper than 128");
  }
}

// Without extras and extensions; of the latter those that change which triangles there are end it.
void strip(Json& value) {
  if (value.is_object()) {
    const auto extensions = value.find("extensions");
    if (extensions != value.end())
      for (const char* name :
           {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"})
        if (extensions->is_object() && extensions->contains(name))
          throw std::runtime_error(std::string("uses ") + name + ", allowed are plain meshes");
    value.erase("extensions");
    value.erase("extras");
  }
  if (value.is_structured())
    for (Json& item : value) strip(item);
}

Json geometry_of(std::string_view text) {
  check_nesting(text);
  try {
    Json document = Json::parse(text);
    if (!document.is_object()) throw std::runtime_error("is no glTF: no JSON object");
    Json geometry = Json::object();
    for (const char* key :
         {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"})
      if (document.contains(key)) geometry[key] = std::move(document[key]);
    strip(geometry);
    return geometry;
  } catch (const Json::exception& error) {
    throw std::runtime_error("is no glTF: " + printable(error.what(), 200));
  }
}

enum class Kind { whole, size, count, list_of_whole, list_of_numbers, absent };

struct Rule {
  std::string_view section, key;
  Kind kind;
};

constexpr Rule rules[] = {{"scenes", "nodes", Kind::list_of_whole},
                          {"nodes", "children", Kind::list_of_whole},
                          {"nodes", "mesh", Kind::whole},
                          {"nodes", "matrix", Kind::list_of_numbers},
                          {"nodes", "translation", Kind::list_of_numbers},
                          {"nodes", "rotation", Kind::list_of_numbers},
                          {"nodes", "scale", Kind::list_of_numbers},
                          {"primitives", "indices", Kind::whole},
                          {"primitives", "mode", Kind::whole},
                          {"attributes", "POSITION", Kind::whole},
                          {"accessors", "bufferView", Kind::whole},
                          {"accessors", "byteOffset", Kind::size},
                          {"accessors", "componentType", Kind::whole},
                          {"accessors", "count", Kind::count},
                          {"accessors", "sparse", Kind::absent},
                          {"bufferViews", "buffer", Kind::whole},
                          {"bufferViews", "byteOffset", Kind::size},
                          {"bufferViews", "byteLength", Kind::count},
                          {"bufferViews", "byteStride", Kind::size},
                          {"buffers", "byteLength", Kind::count}};

bool is_whole(const Json& value, std::uint64_t limit) {
  return value.is_number_unsigned() && value.get<std::uint64_t>() <= limit;
}

bool is_of_kind(const Json& value, Kind kind) {
  constexpr std::uint64_t max_index = std::numeric_limits<int>::max(), max_size = std::uint64_t{1} << 53;
  const auto all = [&](const auto& holds) {
    return value.is_array() && std::all_of(value.begin(), value.end(), holds);
  };
  switch (kind) {
    case Kind::whole:
      return is_whole(value, max_index);
    case Kind::size:
      return is_whole(value, max_size);
    case Kind::count:
      return is_whole(value, max_size) && value != 0;
    case Kind::list_of_whole:
      return all([](const Json& item) { return is_whole(item, max_index); });
    case Kind::list_of_numbers:
      return all([](const Json& item) { return item.is_number(); });
    case Kind::absent:
      return false;
  }
  return false;
}

void check_values(const Json& object, std::string_view section, const std::string& name) {
  constexpr const char* allowed[] = {
      "a whole number",          "a whole number",    "a whole number of 1 or more",
      "a list of whole numbers", "a list of numbers", "none, sparse data is not read"};
  if (!object.is_object()) throw std::runtime_error(name + ": allowed is an object");
  for (const Rule& rule : rules) {
    if (rule.section != section) continue;
    const auto found = object.find(rule.key);
    if (found != object.end() && !is_of_kind(*found, rule.kind))
      throw std::runtime_error(name + "." + std::string(rule.key) + ": allowed is " +
                               allowed[static_cast<std::size_t>(rule.kind)]);
  }
}

// The objects of a list of `parent`; none if it has no such list.
const Json& list_of(const Json& parent, const char* key, const std::string& name) {
  static const Json none = Json::array();
  const auto found = parent.find(key);
  if (found == parent.end()) return none;
  if (!found->is_array()) throw std::runtime_error(name + ": allowed is a list");
  return *found;
}

void check_primitives(const Json& mesh, const std::string& name) {
  std::size_t i = 0;
  for (const Json& primitive : list_of(mesh, "primitives", name + ".primitives")) {
    const std::string own = name + ".primitives[" + std::to_string(i++) + "]";
    check_values(primitive, "primitives", own);
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end()) throw std::runtime_error(own + ": has no attributes");
    check_values(*attributes, "attributes", own + ".attributes");
  }
}

void check_geometry(const Json& geometry) {
  for (const char* section : {"scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"}) {
    std::size_t i = 0;
    for (const Json& object : list_of(geometry, section, section)) {
      const std::string name = std::string(section) + "[" + std::to_string(i++) + "]";
      check_values(object, section, name);
      if (std::string_view(section) == "meshes") check_primitives(object, name);
    }
  }
}

// --- Buffers beside the file

struct Folder {
  std::filesystem::path path;
  std::string refusal;  // the first file that was asked for and not given
};

std::filesystem::path place_of(const std::string& name, const Folder& folder) {
  const std::filesystem::path relative(name);
  const bool leaves = relative.is_absolute() || std::any_of(relative.begin(), relative.end(),
                                                            [](const auto& part) { return part == ".."; });
  const std::filesystem::path place = folder.path / relative;
  std::error_code error;
  return !leaves && std::filesystem::is_regular_file(place, error) ? place : std::filesystem::path();
}

bool exists(const std::string& name, void* user) {
  auto& folder = *static_cast<Folder*>(user);
  const bool found = !place_of(name, folder).empty();
  if (!found && folder.refusal.empty())
    folder.refusal = "buffer '" + printable(name) + "': allowed is a regular file beside this one";
  return found;
}

bool read_whole(Bytes* out, std::string* error, const std::string& name, void* user) {
  try {
    *out = read_bytes(place_of(name, *static_cast<Folder*>(user)));
    return true;
  } catch (const std::runtime_error& problem) {
    *error = problem.what();
    return false;
  }
}

// The .glb file of the two parts; the specification wants them padded to multiples of four.
Bytes joined(std::string json, std::string_view binary) {
  json.append((4 - json.size() % 4) % 4, ' ');
  Bytes bytes;
  const auto put = [&](std::string_view text) { bytes.insert(bytes.end(), text.begin(), text.end()); };
  const auto put_number = [&](std::size_t number) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<unsigned char>(number >> shift));
  };
  const std::size_t padding = (4 - binary.size() % 4) % 4;
  put("glTF"), put_number(2), put_number(28 + json.size() + binary.size() + padding);
  put_number(json.size()), put("JSON"), put(json);
  put_number(binary.size() + padding), put(std::string_view("BIN\0", 4)), put(binary);
  bytes.insert(bytes.end(), padding, 0);
  return bytes;
}

}  // namespace

tinygltf::Model load_gltf(const std::filesystem::path& file) {
  const Bytes bytes = read_bytes(file);
  if (bytes.size() > std::numeric_limits<int>::max())
    throw std::runtime_error("has " + std::to_string(bytes.size()) + " bytes, allowed are 2147483647");
  const Parts parts = parts_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const Json geometry = geometry_of(parts.json);
  check_geometry(geometry);
  Folder folder{file.parent_path(), {}};
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(
      {exists, [](const std::string& name, void*) { return name; }, read_whole, nullptr, &folder});
  tinygltf::Model model;
  std::string error, warning;
  const std::string json = geometry.dump();
  bool loaded;
  if (parts.binary.empty()) {
    loaded = loader.LoadASCIIFromString(&model, &error, &warning, json.data(),
                                        static_cast<unsigned>(json.size()), "");
  } else {
    const Bytes glb = joined(json, parts.binary);
    loaded = loader.LoadBinaryFromMemory(&model, &error, &warning, glb.data(),
                                         static_cast<unsigned>(glb.size()), "");
  }
  if (!folder.refusal.empty()) throw std::runtime_error(folder.refusal);
  if (!loaded || !error.empty()) throw std::runtime_error("is no glTF 2: " + printable(error, 200));
  return model;
}

}  // namespace raylanes::bench

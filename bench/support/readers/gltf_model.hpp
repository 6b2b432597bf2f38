// The content of a glTF file, checked as far as tiny_gltf does not.
#pragma once

#include <filesystem>

// Images are never read: not by stb, not from beside the file. Files are, by callbacks of our own.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

namespace raylanes::bench {

// Reads scenes, nodes, meshes, accessors and buffers of a .gltf or .glb file; extras, extensions, materials and
// images are left out. Numbers that are indices, counts and sizes are whole and fit an int (sizes: 2^53), so that
// nothing was silently taken for 0; whether indices are in range is the reader's to check. Buffers come from the
// file itself or from regular files in its folder or below.
// Throws std::runtime_error: no glTF 2, JSON nested deeper than 128, a value of the wrong kind, a buffer that is
// missing, elsewhere or of another size, compressed or instanced meshes (by an extension).
tinygltf::Model load_gltf(const std::filesystem::path& file);

}  // namespace raylanes::bench

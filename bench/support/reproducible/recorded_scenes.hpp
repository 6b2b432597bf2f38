// One constant a built-in scene: the hash that the answers have on every machine. docs/guide/versions.md shows them.
#pragma once

#include <raylanes/paths.hpp>

#include "../std.hpp"

namespace raylanes::bench {

struct RecordedScene {
  std::string_view name;
  std::uint64_t mesh;     // hash of its vertices and triangles, which sines of the C library make
  std::uint64_t answers;  // hash of the hashes of all rows, in the order of their names
};
inline constexpr std::array<RecordedScene, 3> recorded_scenes{{
    {"spheres", 0xace9d92a85666afa, 0x951d7a32f33c9988},
    {"hall", 0xd6fc9ff2b3fe4273, 0x7f5ddd85dbb2f022},
    {"fractal", 0x9308416651d933b9, 0xd8a6ba9ae2783e16},
}};

struct VerifiedScene {
  std::string scene;
  const Path* path;
  std::size_t rows;  // tests, modes, trees and queries whose answers are in the hash
  std::uint64_t answers;
  bool same_mesh, same_answers;  // as recorded
};

// Traces each scene in every row of the reproducible grade on each path, and compares with what is recorded.
std::vector<VerifiedScene> verify_scenes(const std::vector<const Path*>& paths,
                                         std::span<const RecordedScene> recorded = recorded_scenes);

}  // namespace raylanes::bench

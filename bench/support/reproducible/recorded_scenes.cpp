#include "recorded_scenes.hpp"

#include "../scenes/procedural.hpp"
#include "tree_answers.hpp"

namespace raylanes::bench {

std::vector<VerifiedScene> verify_scenes(const std::vector<const Path*>& paths,
                                         std::span<const RecordedScene> recorded) {
  std::vector<VerifiedScene> all;
  for (const RecordedScene& expected : recorded) {
    const Scene scene = make_procedural_scene(expected.name);
    const std::string name(expected.name);
    const bool same_mesh = hash_of(scene.mesh) == expected.mesh;
    const std::vector<Hashes> of_paths = hashes_of_tree(paths, name, scene.mesh, scene.camera.eye);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      Hash answers;
      for (const auto& [row, hash] : of_paths[i]) answers.add_hash(hash);
      all.push_back({name, paths[i], of_paths[i].size(), answers.value(), same_mesh,
                     answers.value() == expected.answers});
    }
  }
  return all;
}

}  // namespace raylanes::bench

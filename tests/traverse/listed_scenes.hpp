// The real meshes of this machine, if there are any: what scenes.tsv in the folder RAYLANES_SCENES lists.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace raylanes {

struct ListedScene {
  std::string name;
  std::filesystem::path file;  // may be missing
  std::size_t triangles;
};

// Empty if there is no folder: the caller reports that.
inline std::filesystem::path scenes_folder() {
  const char* const folder = std::getenv("RAYLANES_SCENES");
  return folder == nullptr ? "" : folder;
}

// Throws std::runtime_error for a line that does not begin with a name, a file and a number of triangles.
inline std::vector<ListedScene> listed_scenes() {
  std::vector<ListedScene> scenes;
  if (scenes_folder().empty()) return scenes;
  std::ifstream list(scenes_folder() / "scenes.tsv");
  for (std::string line; std::getline(list, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    std::istringstream columns(line);
    ListedScene scene;
    std::string file;
    if (!std::getline(columns, scene.name, '\t') || !std::getline(columns, file, '\t') ||
        !(columns >> scene.triangles))
      throw std::runtime_error("scenes.tsv: not a name, a file and a number of triangles, apart by tabs: " +
                               line);
    scene.file = scenes_folder() / file;
    scenes.push_back(scene);
  }
  return scenes;
}

}  // namespace raylanes

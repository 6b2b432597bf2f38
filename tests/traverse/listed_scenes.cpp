// Trees over real meshes against a brute force, byte for byte. The meshes are no part of the project: the
// environment variable RAYLANES_SCENES names their directory, without it the tests are skipped.
#include <cctype>
#include <filesystem>
#include <fstream>

#include "../../accel/mesh/bounding_boxes.hpp"
#include "../../bench/support/readers/mesh_reader.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

struct ListedScene {
  std::filesystem::path file;  // may be missing
  std::size_t triangles = 0;   // 0 if no list says how many
};

// The lines of scenes.tsv by name, file and number of triangles; meshes that are hard on traversals: needles, slivers,
// thin triangles far away; and every tenth frame of the animated character, small triangles of which many are thin.
std::vector<ListedScene> scenes_to_trace() {
  const char* const named = std::getenv("RAYLANES_SCENES");
  const std::filesystem::path folder = named == nullptr ? "" : named;
  std::vector<ListedScene> scenes;
  std::ifstream list(folder / "scenes.tsv");
  for (std::string line; std::getline(list, line);) {
    std::istringstream columns(line);
    std::string name, file;
    ListedScene scene;
    if (line.starts_with('#') || !std::getline(columns, name, '\t')) continue;
    std::getline(columns, file, '\t') >> scene.triangles;
    scene.file = folder / file;
    scenes.push_back(scene);
  }
  for (const char* name :
       {"nasty_needles.obj", "nasty_far_thin.obj", "nasty_slivers.obj", "nasty_print.stl", "nasty_tree.obj"})
    scenes.push_back({folder / name});
  std::vector<std::filesystem::path> frames;
  if (std::filesystem::is_directory(folder / "cally"))
    for (const auto& entry : std::filesystem::directory_iterator(folder / "cally"))
      if (entry.path().extension() != ".md" && entry.path().extension() != ".txt")
        frames.push_back(entry.path());
  std::sort(frames.begin(), frames.end());
  for (std::size_t i = 0; i < frames.size(); i += 10) scenes.push_back({frames[i]});
  return scenes;
}

class SceneOnDisk : public ::testing::TestWithParam<ListedScene> {};

TEST_P(SceneOnDisk, is_traced_as_by_brute_force) {
  const auto& [file, triangles] = GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "RAYLANES_SCENES names no folder that holds " << file;
  const Mesh mesh = bench::read_mesh(file);
  EXPECT_TRUE(triangles == 0 || mesh.triangles.size() == triangles) << mesh.triangles.size();
  Box bounds = empty_box;
  for (const Float3& vertex : mesh.vertices) extend(bounds, vertex);
  const Float3 centre = raylanes::centre(bounds);
  float half = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) half = std::max(half, bounds.hi[axis] - centre[axis]);
  // About as much work for each mesh, and more for the hard ones.
  const bool hard = file.stem().string().starts_with("nasty");
  const std::size_t tests = by_level(400'000, 3'000'000, hard ? 40'000'000 : 8'000'000);
  const std::size_t rays = std::clamp<std::size_t>(tests / mesh.triangles.size(), 20, 8000);
  for (const float reach : {1.0f, 3.0f}) {
    SCOPED_TRACE("origins within " + std::to_string(reach) + " times the bounds");
    EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, rays / 2, reach * half, centre, 1), hard), 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, SceneOnDisk, ::testing::ValuesIn(scenes_to_trace()), [](const auto& mesh) {
  std::string name = mesh.param.file.stem().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return std::to_string(mesh.index) + '_' + name;
});

}  // namespace
}  // namespace raylanes::testing

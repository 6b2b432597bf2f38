// Trees over real meshes against a brute force, byte for byte. The meshes are no part of the project: the
// environment variable RAYLANES_SCENES names their directory, without it the tests are skipped.
#include "listed_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

#include "../../accel/mesh/bounding_boxes.hpp"
#include "../../bench/support/readers/mesh_reader.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

// The listed ones, and those that are hard on traversals: needles, slivers, thin triangles far away.
std::vector<ListedScene> scenes_to_trace() {
  std::vector<ListedScene> scenes = listed_scenes();
  for (const char* name :
       {"nasty_needles.obj", "nasty_far_thin.obj", "nasty_slivers.obj", "nasty_print.stl", "nasty_tree.obj"})
    scenes.push_back({name, scenes_folder() / name, 0});
  return scenes;
}

class SceneOnDisk : public ::testing::TestWithParam<ListedScene> {};

TEST_P(SceneOnDisk, is_traced_as_by_brute_force) {
  const auto& [_, file, triangles] = GetParam();
  if (scenes_folder().empty())
    GTEST_SKIP() << "RAYLANES_SCENES is not set: it names the folder that holds " << file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no file " << file;
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

// Every tenth frame of the animated character, whose triangles are small and many of them thin.
TEST(AnimationOnDisk, frames_are_traced_as_by_brute_force) {
  const std::filesystem::path folder = scenes_folder() / "cally";
  if (scenes_folder().empty() || !std::filesystem::is_directory(folder))
    GTEST_SKIP() << "RAYLANES_SCENES is not set, or there is no folder cally/ of frames in it";
  std::vector<std::filesystem::path> frames;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() != ".md" && entry.path().extension() != ".txt")
      frames.push_back(entry.path());
  std::sort(frames.begin(), frames.end());
  ASSERT_FALSE(frames.empty());
  for (std::size_t i = 0; i < frames.size(); i += 10) {
    SCOPED_TRACE(frames[i].filename());
    const Mesh mesh = bench::read_mesh(frames[i]);
    Box bounds = empty_box;
    for (const Float3& vertex : mesh.vertices) extend(bounds, vertex);
    const Float3 centre = raylanes::centre(bounds);
    const std::vector<Ray> rays =
        mixed_rays(mesh, by_level(40, 800, 2000), 2 * (bounds.hi[1] - centre[1]), centre, i);
    EXPECT_GT(expect_brute_force(mesh, rays), 0u);
  }
}

}  // namespace
}  // namespace raylanes::testing

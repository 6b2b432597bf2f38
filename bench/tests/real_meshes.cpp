// read_mesh on scenes with known counts, triangles without area included, where there are any.
#include <gtest/gtest.h>

#include <vector>

#include "../../tests/traverse/listed_scenes.hpp"
#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

TEST(RealScenes, have_the_listed_number_of_triangles) {
  if (scenes_folder().empty())
    GTEST_SKIP() << "RAYLANES_SCENES is not set: the triangle counts of real scenes are NOT checked";
  const std::vector<ListedScene> scenes = listed_scenes();
  ASSERT_FALSE(scenes.empty()) << "no scenes.tsv, or an empty one, in " << scenes_folder();
  for (const ListedScene& scene : scenes) {
    if (fs::exists(scene.file))
      EXPECT_EQ(read_mesh(scene.file).triangles.size(), scene.triangles) << scene.name;
    else
      std::fprintf(stderr, "SKIPPED the triangle count of %s: no file %s\n", scene.name.c_str(),
                   scene.file.c_str());
  }
}

}  // namespace
}  // namespace raylanes::bench

// read_mesh on scenes with known counts, triangles without area included, where there are any.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "../../tests/traverse/listed_scenes.hpp"
#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

class RealScenes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (scenes_folder().empty())
      GTEST_SKIP() << "RAYLANES_SCENES is not set: the triangle counts of real scenes are NOT checked";
    scenes_ = listed_scenes();
  }
  std::vector<ListedScene> scenes_;
};

TEST_F(RealScenes, have_the_listed_number_of_triangles) {
  ASSERT_FALSE(scenes_.empty()) << "no scenes.tsv, or an empty one, in " << scenes_folder();
  for (const ListedScene& scene : scenes_) {
    if (fs::exists(scene.file))
      EXPECT_EQ(read_mesh(scene.file).triangles.size(), scene.triangles) << scene.name;
    else
      std::fprintf(stderr, "SKIPPED the triangle count of %s: no file %s\n", scene.name.c_str(),
                   scene.file.c_str());
  }
}

// Bit for bit: a scene whose raw triangles lie beside its file.
TEST_F(RealScenes, raw_triangles_equal_the_indexed_ones) {
  int compared = 0;
  for (const ListedScene& scene : scenes_) {
    const fs::path raw_file = fs::path(scene.file).replace_extension(".ra2");
    if (!fs::exists(raw_file) || !fs::exists(scene.file) || raw_file == scene.file) continue;
    const Mesh raw = read_mesh(raw_file), indexed = read_mesh(scene.file);
    ASSERT_EQ(raw.triangles.size(), indexed.triangles.size()) << scene.name;
    for (std::size_t i = 0; i < raw.triangles.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_EQ(bits_of(raw.vertices[raw.triangles[i][k]]),
                  bits_of(indexed.vertices[indexed.triangles[i][k]]))
            << scene.name << " triangle " << i;
    ++compared;
  }
  if (compared == 0) GTEST_SKIP() << "no listed scene has a .ra2 beside its file";
}

}  // namespace
}  // namespace raylanes::bench

// read_mesh on scenes with known counts, where there are any.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "mesh_files.hpp"

namespace raylanes::bench {
namespace {

// Bit for bit what the file says, for scenes on this machine.
class RealScenes : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("RAYLANES_SCENES");
    if (!folder)
      GTEST_SKIP() << "RAYLANES_SCENES is not set: the triangle counts of real scenes are NOT checked";
    folder_ = folder;
  }
  fs::path folder_;
};

TEST_F(RealScenes, HaveTheListedNumberOfTriangles) {
  std::ifstream list(folder_ / "scenes.tsv");
  ASSERT_TRUE(list) << "no scenes.tsv in " << folder_;
  std::size_t scenes = 0;
  for (std::string line; std::getline(list, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream columns(line);
    std::string name, file;
    std::size_t triangles = 0;
    ASSERT_TRUE(columns >> name >> file >> triangles) << line;
    EXPECT_EQ(read_mesh(folder_ / file).triangles.size(), triangles) << name;
    ++scenes;
  }
  EXPECT_GT(scenes, 0u);
}

TEST_F(RealScenes, RawTrianglesEqualTheIndexedOnes) {
  const Mesh raw = read_mesh(folder_ / "sibenik.ra2"), indexed = read_mesh(folder_ / "sibenik.ply");
  ASSERT_EQ(raw.triangles.size(), indexed.triangles.size());
  for (std::size_t i = 0; i < raw.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(bits_of(raw.vertices[raw.triangles[i][k]]),
                bits_of(indexed.vertices[indexed.triangles[i][k]]))
          << i;
}

TEST_F(RealScenes, ConferenceKeepsItsTrianglesWithoutArea) {
  const Mesh mesh = read_mesh(folder_ / "conference.ply");
  std::size_t flat = 0;
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Float3 &a = mesh.vertices[ia], &b = mesh.vertices[ib], &c = mesh.vertices[ic];
    double squares = 0;
    for (std::size_t x = 0; x < 3; ++x) {
      const std::size_t y = (x + 1) % 3;
      const double minor =
          (double(b[x]) - a[x]) * (double(c[y]) - a[y]) - (double(b[y]) - a[y]) * (double(c[x]) - a[x]);
      squares += minor * minor;
    }
    flat += squares == 0;
  }
  EXPECT_EQ(flat, 53627u);
}

}  // namespace
}  // namespace raylanes::bench

// One hash a path over everything that promises the same bits on every path, against recorded ones: after a
// change of the kernels they show that no bit of an answer has moved. A bit that is meant to move changes
// its row below, in the commit that says why.
#include "../../bench/support/reproducible/recorded_scenes.hpp"
#include "../../bench/support/reproducible/tree_answers.hpp"
#include "../../bench/support/scenes/procedural.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "reproducible_answers.hpp"

namespace raylanes::testing {
namespace {

using bench::hash_of, bench::hashes_of_tree;

struct Recorded {
  std::string_view name;
  std::uint64_t hash;
};

constexpr Recorded recorded_roots[] = {
    {"reciprocal hardware", 0xdc882281888a7968},
    {"reciprocal of doubles hardware", 0x3527d769183ffcbe},
    {"rsqrt hardware", 0xad3a91a2468962ff},
    {"rsqrt in_double", 0x952db6ae4b0fb7e9},
    {"rsqrt of doubles hardware", 0xd63a101a50566c7b},
    {"sqrt classic_2", 0x67a2c23d09c05b3d},
    {"sqrt goldschmidt", 0x724ee27603105bb1},
    {"sqrt goldschmidt_beside_hardware", 0x724ee27603105bb1},
    {"sqrt hardware", 0x724ee27603105bb1},
    {"sqrt of doubles classic_0", 0x16cb37e35f627ecb},
    {"sqrt of doubles classic_1", 0xb16d909869c7e2cb},
    {"sqrt of doubles classic_2", 0x913d749eb61621eb},
    {"sqrt of doubles hardware", 0x0ce035292ef7b399},
    {"sqrt of doubles polynomial_2", 0xd885faa0a029d8ed},
};

constexpr Recorded recorded_tests[] = {
    {"box conservative 1xN", 0x7d740d3f3af679d2},
    {"box conservative Nx1", 0x36c85c3f585e433d},
    {"box directional 1xN", 0x97025d4102a1a266},
    {"box directional Nx1", 0xf8425c43857e48bc},
    {"box plain 1xN", 0xff00eaa9c5ec3922},
    {"box plain Nx1", 0x427c6b7394029f2a},
    {"point 1xN", 0x71ca0886f79092e3},
    {"prepared 1xN", 0x2ac69754154142f0},
    {"sphere line 1xN", 0x639264e3ca523fae},
    {"sphere perpendicular 1xN", 0x077d03e37d9d168b},
    {"sphere perpendicular Nx1", 0x75868cc0566e459c},
    {"sphere perpendicular closest", 0x5db21a56ff995ca1},
    {"sphere textbook 1xN", 0xaa00b596fc32488a},
    {"sphere textbook Nx1", 0xe7b8eabb28be2929},
    {"sphere textbook closest", 0xc1a7727740f90ef4},
    {"triangle directional 1xN", 0x2a6660e62e7aae8c},
    {"triangle directional Nx1", 0x873d2b65f2a9d511},
    {"triangle moller_trumbore 1xN", 0x2eed428fa73dade8},
    {"triangle moller_trumbore Nx1", 0x8ea03c3dcec63fda},
    {"triangle moller_trumbore_edges 1xN", 0x2eed428fa73dade8},
    {"triangle moller_trumbore_edges Nx1", 0x8ea03c3dcec63fda},
    {"triangle plane_edges 1xN", 0x94f12fadb66fd23a},
    {"triangle plane_edges Nx1", 0x0bf7ccb55d1b14ca},
    {"triangle plane_edges_plain 1xN", 0x4eb3f29cc487d214},
    {"triangle plane_edges_plain Nx1", 0x9dd67b8c0ed2fa12},
    {"triangle precomputed 1xN", 0xa8886a27acb77c98},
    {"triangle precomputed Nx1", 0x666f760e69db5fd9},
    {"triangle exact 1xN", 0xc4bf7626383fc84f},
    {"triangle exact Nx1", 0xa6ec5961e4a433cc},
    {"triangle watertight 1xN", 0xa27a422faa195c7d},
    {"triangle watertight Nx1", 0xdb153717b1324f03},
};

// The rows named "mesh" are of the input. The rows of a scene and a test hold for all modes and both trees that have no
// row of their own. The constants of the docs are of the rows of the built-in scenes, which paths must have in common.
constexpr Recorded recorded_trees[] = {
    {"mesh ellipsoid", 0x32d9001a5fe20793},
    {"mesh soup", 0x273d187a4acc7edf},
    {"ellipsoid exact", 0xfc4d4ab43c6cfee3},
    {"ellipsoid lists", 0xcb0b13da63fd5079},
    {"ellipsoid moller_trumbore", 0x98c9f4fedc5ecb8d},
    {"ellipsoid points", 0xb72491d99bf4dd5c},
    {"ellipsoid watertight", 0x1053f1b0d21e949a},
    {"ellipsoid windings", 0x736496a82d036084},
    {"soup exact", 0xa77c1497632ddb1e},
    {"soup lists", 0xa76e57f7e6c0ab5e},
    {"soup moller_trumbore", 0xea5e210e13adb0fc},
    {"soup points", 0x7dac0afde70f2706},
    {"soup watertight", 0x4ff1966a425a735a},
    {"soup windings", 0xd6e17dfe6dd1d4f7},
    {"ellipsoid doubles hits", 0xf317406c2b1bf1b3},
    {"ellipsoid doubles lists", 0xa0f91c4b30d87fd3},
    {"ellipsoid doubles points", 0x737e9792cd5a78ee},
    {"ellipsoid doubles windings", 0xd746c7356665a9a2},
    {"soup doubles hits", 0xddafe9165b18cbdc},
    {"soup doubles lists", 0x86c4b4ef4ffc4953},
    {"soup doubles points", 0x7732b42eb0e4e034},
    {"soup doubles windings", 0xda9144ea17135dbc},
};

template <std::size_t n>
std::uint64_t recorded(const Recorded (&rows)[n], const std::string& name) {
  for (const Recorded& row : rows)
    if (row.name == name) return row.hash;
  return 0;
}

// Each hash against the recorded one, and none missing; printed as a row to be recorded where it differs.
template <std::size_t n>
void expect_recorded(const Path& path, const Hashes& hashes, const Recorded (&rows)[n]) {
  Hash all;
  for (const auto& [name, hash] : hashes) {
    all.add_hash(hash);
    if (recorded(rows, name) == hash) continue;
    ADD_FAILURE() << path.name << ": other bits than recorded, or none recorded: " << name;
    std::printf("    {\"%s\", 0x%016llx},\n", name.c_str(), static_cast<unsigned long long>(hash));
  }
  for (const Recorded& row : rows)
    EXPECT_TRUE(hashes.contains(std::string(row.name))) << path.name << " was not asked " << row.name;
  std::printf("%s: %016llx over %zu answers\n", path.name, static_cast<unsigned long long>(all.value()),
              hashes.size());
}

TEST(Reproducible, roots_have_the_recorded_bits) {
  for (const Path* path : supported_paths()) expect_recorded(*path, hashes_of_roots(*path), recorded_roots);
}

TEST(Reproducible, triangles_boxes_and_spheres_have_the_recorded_bits) {
  for (const Path* path : supported_paths()) expect_recorded(*path, hashes_of_tests(*path), recorded_tests);
}

std::uint64_t recorded_of_tree(const std::string& asked) {
  const std::uint64_t own = recorded(recorded_trees, asked);
  return own != 0 ? own : recorded(recorded_trees, asked.substr(0, asked.find(' ', asked.find(' ') + 1)));
}

struct TracedMesh {
  std::string name;
  Mesh mesh;
  Float3 eye;
};

std::vector<TracedMesh> traced_meshes() {
  std::vector<TracedMesh> meshes{{"ellipsoid", ellipsoid(3, {1, 2, 3}), {1, 2, 9}},
                                 {"soup", triangle_soup(1500, 0.2f, 7), {0, 0, 3}}};
  if (quick()) {
    std::fprintf(stderr, "SKIPPED recorded bits of the built-in scenes: level quick\n");
    return meshes;
  }
  for (const std::string& name : bench::procedural_scene_names()) {
    const bench::Scene scene = bench::make_procedural_scene(name);
    meshes.push_back({name, scene.mesh, scene.camera.eye});
  }
  return meshes;
}

TEST(Reproducible, trees_have_the_recorded_bits) {
  const std::vector<const Path*> paths = supported_paths();
  for (const TracedMesh& traced : traced_meshes()) {
    const std::string name = "mesh " + traced.name;
    const std::uint64_t hash = hash_of(traced.mesh);
    const bool is_recorded = recorded(recorded_trees, name) != 0;
    // Meshes are made with sines, whose last bit is a matter of the C library.
    const bool same_input = is_recorded && hash == recorded(recorded_trees, name);
    if (is_recorded && !same_input)
      std::fprintf(stderr, "SKIPPED recorded bits of the scene %s: it has other vertices here, 0x%016llx\n",
                   traced.name.c_str(), static_cast<unsigned long long>(hash));
    const std::vector<Hashes> of_paths = hashes_of_tree(paths, traced.name, traced.mesh, traced.eye);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      EXPECT_EQ(of_paths[i], of_paths[0]) << paths[i]->name << ": other bits than " << paths[0]->name;
      for (const auto& [row, value] : of_paths[i]) {
        if (!same_input || value == recorded_of_tree(row)) continue;
        ADD_FAILURE() << paths[i]->name << ": other bits than recorded: " << row;
        std::printf("    {\"%s\", 0x%016llx},\n", row.c_str(), static_cast<unsigned long long>(value));
      }
    }
  }
}

// The constants that docs show are of the same rows; one that is off by a bit is noticed, and so is another mesh.
TEST(Reproducible, scenes_have_the_constants_of_the_docs) {
  if (quick()) GTEST_SKIP() << "SKIPPED the constants of the built-in scenes: level quick";
  auto altered = bench::recorded_scenes;
  altered[0].answers ^= 1, altered[1].mesh ^= 1;
  const auto verified = bench::verify_scenes({&paths().front()}, altered);
  ASSERT_EQ(verified.size(), altered.size());
  for (std::size_t i = 0; i < altered.size(); ++i)
    if (verified[i].same_mesh || i == 1) {
      EXPECT_EQ(verified[i].answers, bench::recorded_scenes[i].answers) << verified[i].scene;
      EXPECT_EQ(verified[i].same_answers, i != 0) << verified[i].scene;
    }
  EXPECT_FALSE(verified[1].same_mesh);
}

}  // namespace
}  // namespace raylanes::testing

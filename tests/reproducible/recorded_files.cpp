// Files that an earlier build wrote: a tree, one of doubles, a k-d tree, a scene, and the rays and hits that belong to
// them. Each is loaded and traced on every path. A format that changes gets another version number and files beside
// these.
// To write them: RAYLANES_RECORD=1 test_reproducible --gtest_filter='RecordedFiles.*'
#include <fstream>

#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>
#include <raylanes/kdtree.hpp>
#include <raylanes/scene.hpp>

#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

const std::string folder = RAYLANES_RECORDED_FILES "/";

template <class T>
std::vector<T> records_in(const std::string& name) {
  std::ifstream file(folder + name, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::vector<T> records(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(records.data(), bytes.data(), records.size() * sizeof(T));
  return records;
}

template <class T>
void write_records(const std::string& name, const std::vector<T>& records) {
  std::ofstream file(folder + name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(records.data()),
             static_cast<std::streamsize>(records.size() * sizeof(T)));
}

template <class Kind>
Kind loaded(const std::string& name) {
  std::ifstream file(folder + name, std::ios::binary);
  return Kind::load(file);
}

template <class Kind>
std::string saved(const Kind& kind) {
  std::ostringstream file;
  kind.save(file);
  return file.str();
}

std::string bytes_of(const std::string& name) {
  const std::vector<char> bytes = records_in<char>(name);
  return {bytes.begin(), bytes.end()};
}

// Without the word that held a triangle test in each tree of floats when the files were written, and the checksum over
// it.
std::string without_test(std::string bytes) {
  for (const auto& [start, test_at] : {std::pair("raylanes tree", 112), {"raylanes cell", 100}})
    for (std::size_t at = bytes.find(start); at != std::string::npos; at = bytes.find(start, at + 1)) {
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 24, 8, '\0');
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at) + test_at, 4, '\0');
    }
  return bytes;
}

// Triangles around the origin, from a generator of its own: others may change.
struct Numbers {
  std::uint32_t state = 1;
  float next() {  // from -1 to 1
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 8388608.0f - 1;
  }
  Float3 point() { return {next(), next(), next()}; }
};

Mesh recorded_mesh(std::uint32_t triangles) {
  Numbers numbers;
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Float3 middle = numbers.point();
    for (int corner = 0; corner < 3; ++corner) {
      const Float3 off = numbers.point();
      mesh.vertices.push_back({middle[0] + off[0], middle[1] + off[1], middle[2] + off[2]});
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// The same, far away, each number the double next to the float's.
std::vector<Double3> doubles_of(const std::vector<Float3>& points) {
  std::vector<Double3> doubles;
  for (const auto& [x, y, z] : points) doubles.push_back({x + 0x1.0000000000001p20, 1e-9 - y, z * 0.1});
  return doubles;
}
std::vector<RayD> doubles_of(const std::vector<Ray>& rays) {
  std::vector<RayD> doubles;
  for (const Ray& ray : rays) {
    const auto& [x, y, z] = ray.direction;
    doubles.push_back(
        {doubles_of({ray.origin})[0], 0, {x, -y, z * 0.1}, std::numeric_limits<double>::infinity()});
  }
  return doubles;
}
std::vector<HitD> double_hits(const BvhD& tree, const std::vector<RayD>& rays, const Path* path) {
  std::vector<HitD> hits(rays.size());
  tree.closest(rays, hits, {.path = path});
  return hits;
}

const BuildOptions tree_options{.builder = TreeBuilder::sweep_sah, .optimize = true};
const KdBuildOptions cell_options{.builder = KdBuilder::midpoint};
const BuildOptions double_options{.builder = TreeBuilder::morton, .optimize = true};
constexpr Transform places[] = {{.row = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}},
                                {.row = {{0, -1, 0, 2}, {1, 0, 0, 0}, {0, 0, 1, 0}}},
                                {.row = {{0.5f, 0, 0, -2}, {0, 0.5f, 0, 0}, {0.25f, 0, 0.5f, 0}}}};

std::vector<SceneHit> scene_hits(const Scene& scene, const std::vector<Ray>& rays,
                                 const TraceOptions& options) {
  std::vector<SceneHit> hits(rays.size());
  scene.closest(rays, hits, options);
  return hits;
}

void write_files() {
  const Mesh mesh = recorded_mesh(24);
  std::vector<Ray> rays(64);
  Numbers numbers{7};
  for (Ray& ray : rays) {
    const Float3 from = numbers.point(), to = numbers.point();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = 3 * from[axis];
      ray.direction[axis] = to[axis] - ray.origin[axis];
    }
  }
  Bvh tree(mesh, tree_options);
  Scene scene;
  scene.add(Bvh(mesh, tree_options));
  scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 0.5f}, {{1, 1, 1}, 0.25f}, {{0, 0, 2}, 1}}));
  for (std::uint32_t i = 0; i < 6; ++i) scene.place(i % 2, places[i / 2], i == 5 ? 2u : ~0u);
  scene.update();
  write_records("rays.bin", rays);
  write_records("tree_hits.bin", trace(tree, rays, {}));
  write_records("scene_hits.bin", scene_hits(scene, rays, {}));
  const BvhD doubles(doubles_of(mesh.vertices), mesh.triangles, double_options);
  write_records("double_hits.bin", double_hits(doubles, doubles_of(rays), nullptr));
  for (const auto& [name, bytes] : {std::pair<const char*, std::string>{"tree.bin", saved(tree)},
                                    {"doubles.bin", saved(doubles)},
                                    {"cells.bin", saved(KdTree(mesh, cell_options))},
                                    {"scene.bin", saved(scene)}})
    write_records(name, std::vector<char>(bytes.begin(), bytes.end()));
}

class RecordedFiles : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (std::getenv("RAYLANES_RECORD") != nullptr) write_files();
  }
};

TEST_F(RecordedFiles, a_tree_loads_and_gives_the_recorded_hits) {
  const std::vector<Ray> rays = records_in<Ray>("rays.bin");
  const Bvh tree = loaded<Bvh>("tree.bin");
  ASSERT_EQ(rays.size(), 64u);
  ASSERT_EQ(records_in<Hit>("tree_hits.bin").size(), 64u);
  expect_hits(tree, rays, records_in<Hit>("tree_hits.bin"));
  EXPECT_EQ(tree.report().builder, tree_options.builder);
  EXPECT_TRUE(tree.report().optimized);
  EXPECT_EQ(without_test(saved(tree)), without_test(bytes_of("tree.bin")));
}

TEST_F(RecordedFiles, a_tree_of_doubles_loads_and_gives_the_recorded_hits) {
  const std::vector<RayD> rays = doubles_of(records_in<Ray>("rays.bin"));
  const std::vector<HitD> expected = records_in<HitD>("double_hits.bin");
  const BvhD tree = loaded<BvhD>("doubles.bin");
  ASSERT_EQ(expected.size(), 64u);
  for (const Path* path : supported_paths())
    EXPECT_TRUE(same_bytes(double_hits(tree, rays, path), expected)) << path->name;
  EXPECT_EQ(tree.report().builder, double_options.builder);
  EXPECT_TRUE(tree.report().optimized);
  EXPECT_EQ(saved(tree), bytes_of("doubles.bin"));
}

TEST_F(RecordedFiles, a_kd_tree_loads_and_gives_the_recorded_hits) {
  const KdTree tree = loaded<KdTree>("cells.bin");
  ASSERT_EQ(records_in<Hit>("tree_hits.bin").size(), 64u);
  expect_hits(tree, records_in<Ray>("rays.bin"), records_in<Hit>("tree_hits.bin"));
  EXPECT_EQ(tree.report().builder, cell_options.builder);
  EXPECT_EQ(without_test(saved(tree)), without_test(bytes_of("cells.bin")));
}

TEST_F(RecordedFiles, a_scene_loads_and_gives_the_recorded_hits) {
  const std::vector<Ray> rays = records_in<Ray>("rays.bin");
  const std::vector<SceneHit> expected = records_in<SceneHit>("scene_hits.bin");
  const Scene scene = loaded<Scene>("scene.bin");
  ASSERT_EQ(expected.size(), 64u);
  for (const TraceOptions& way : ways_to_trace()) {
    const std::vector<SceneHit> hits = scene_hits(scene, rays, way);
    EXPECT_TRUE(same_bytes(hits, expected)) << name_of(way);
  }
  EXPECT_EQ(without_test(saved(scene)), without_test(bytes_of("scene.bin")));
}

}  // namespace
}  // namespace raylanes::testing

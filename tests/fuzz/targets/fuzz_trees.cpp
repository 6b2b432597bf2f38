// Trees and scenes as bytes that were damaged, with and without a checksum that covers it up: an error of one line, or
// a tree that can be traced and refitted without a fault. And trees of any finite mesh, refitted to another: the hits
// of a tree built over that.
#include <raylanes/kdtree.hpp>
#include <raylanes/scene_d.hpp>

#include "../../support/limited_memory.hpp"
#include "../../support/same_bytes.hpp"
#include "../any_doubles.hpp"
#include "../any_mesh.hpp"
#include "../damaged_file.hpp"

namespace raylanes::testing {
namespace {

TraceOptions any_way(Bytes& bytes, TriangleTest test) {
  return {.test = test,
          .grade = static_cast<Grade>(bytes.below(grade_names.size())),
          .mode = static_cast<TraversalMode>(bytes.below(traversal_mode_names.size())),
          .path = bytes.pick(fuzzed_paths())};
}

// Whatever it is, no fault; and no triangle that the mesh lacks.
void walk(const TriangleTree& tree, std::span<const Ray> rays, const TraceOptions& options,
          std::size_t triangles) {
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  tree.closest(rays, hits, options);
  tree.occluded(rays, occluded, options);
  for (const Hit& hit : hits)
    if (hit.primitive != no_primitive && hit.primitive >= triangles)
      fail("a hit of triangle " + std::to_string(hit.primitive) + " of " + std::to_string(triangles));
}

// Leaves as bytes: their triangles are less than this.
std::size_t triangles_of(std::span<const LeafBlock<9>> leaves) {
  std::size_t triangles = 0;
  for (const LeafBlock<9>& leaf : leaves)
    for (const std::uint32_t primitive : leaf.primitive)
      if (primitive != no_primitive) triangles = std::max<std::size_t>(triangles, primitive + std::size_t{1});
  return triangles;
}

// Queries beyond hits take memory by the bytes of the file, whatever numbers it holds.
template <class Tree>
void ask_in_bounded_memory(Bytes& bytes, const Tree& tree, std::span<const Ray> rays,
                           std::size_t file_bytes) {
  constexpr std::size_t for_rays = 1 << 20;
  const VertexView points(rays.data(), rays.size(), sizeof(Ray));
  const auto rule = static_cast<InsideRule>(bytes.below(inside_rule_names.size()));
  std::vector<float> numbers(rays.size());
  std::vector<CrossingCount> counts(rays.size());
  if (tree.bytes() > 12 * file_bytes) fail("a tree of many times the bytes of its file");
  const bool is_out = runs_out(unlimited, for_rays + 32 * file_bytes, [&] {
    tree.winding_numbers(points, numbers, {.path = bytes.pick(fuzzed_paths())});
    tree.signed_distances(points, numbers, {.rule = rule, .path = bytes.pick(fuzzed_paths())});
    tree.count_crossings(rays, counts);
    tree.all_hits(rays);
  });
  if (is_out) fail("a loaded tree takes more memory than its file accounts for");
}

void refit_any(Bvh& tree, const Mesh& mesh) {
  tree.refit(mesh.vertices, mesh.triangles);
}
void refit_any(KdTree& tree, const Mesh& mesh) {
  tree = KdTree(mesh);
}

// A tree that was damaged, the rays to trace, and a mesh to which it is refitted.
void use(Bytes& bytes, auto& tree, const Mesh& mesh, std::span<const Ray> rays, TriangleTest test,
         std::size_t file_bytes) {
  // The damage may have changed test and count: then those calls are refused.
  const std::size_t triangles = triangles_of(tree.view().leaves);
  walk(tree, rays, any_way(bytes, TriangleTest::exact), triangles);
  walk(tree, rays, any_way(bytes, TriangleTest::watertight), triangles);
  ask_in_bounded_memory(bytes, tree, rays, file_bytes);
  try {
    walk(tree, rays, any_way(bytes, test), triangles);
    refit_any(tree, mesh);
    walk(tree, rays, any_way(bytes, TriangleTest::exact), mesh.triangles.size());
  } catch (const std::invalid_argument&) {
  }
}
// A file has no more triangles than bytes.
void use(Bytes& bytes, BvhD& tree, const DoubleMesh& mesh, std::span<const RayD> rays, TriangleTest,
         std::size_t file_bytes) {
  std::vector<HitD> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  std::vector<CrossingCount> counts(rays.size());
  std::vector<Location> locations(rays.size());
  const auto walk = [&](std::size_t triangles) {
    const TraceOptionsD options{.path = bytes.pick(fuzzed_paths())};
    tree.closest(rays, hits, options);
    tree.occluded(rays, occluded, options);
    for (const HitD& hit : hits)
      if (hit.primitive != no_primitive && hit.primitive >= triangles)
        fail("a hit of triangle " + std::to_string(hit.primitive) + " of " + std::to_string(triangles));
  };
  walk(file_bytes);
  if (tree.bytes() > 12 * file_bytes) fail("a tree of many times the bytes of its file");
  const auto rule = bytes.pick({InsideRule::parity, InsideRule::nonzero, InsideRule::vote});
  const bool is_out = runs_out(unlimited, (std::size_t{1} << 20) + 32 * file_bytes, [&] {
    tree.locate(VertexViewD(rays.data(), rays.size(), sizeof(RayD)), locations, {.rule = rule});
    tree.count_crossings(rays, counts);
    tree.all_hits(rays);
  });
  if (is_out) fail("a loaded tree takes more memory than its file accounts for");
  try {
    tree.refit(mesh.vertices, mesh.triangles);
    walk(mesh.triangles.size());
  } catch (const std::invalid_argument&) {
  }
}

// Hits name what the scene has.
template <class AnyScene, class T>
void use_scene(AnyScene& scene, const oracle::MeshOf<T>& mesh, std::span<const RayOf<T>> rays) {
  std::vector<typename AnyScene::Hit> hits(rays.size());
  std::vector<decltype(scene.closest_point({}))> closest(rays.size());
  const auto walk = [&] {
    scene.closest(rays, hits), scene.all_hits(rays);
    for (const auto& hit : hits)
      if (hit && (hit.instance >= scene.instance_count() || hit.geometry != scene.geometry_of(hit.instance)))
        fail("a hit of an instance that is not there");
  };
  walk();
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) scene.levels_of(i);
  try {
    scene.closest_points({rays.data(), rays.size(), sizeof rays[0]}, closest);
    scene.refit(0, mesh.vertices, mesh.triangles), scene.move(0, {}), scene.update();
    walk();
  } catch (const std::invalid_argument&) {
  }
}
void use(Bytes&, Scene& scene, const Mesh& mesh, std::span<const Ray> rays, TriangleTest, std::size_t) {
  use_scene<Scene, float>(scene, mesh, rays);
}
void use(Bytes&, SceneD& scene, const DoubleMesh& mesh, std::span<const RayD> rays, TriangleTest,
         std::size_t) {
  use_scene<SceneD, double>(scene, mesh, rays);
}

template <class Tree, class AnyMesh, class AnyRay>
void load_damaged(Bytes& bytes, std::string file, const AnyMesh& mesh, const std::vector<AnyRay>& rays,
                  TriangleTest test) {
  const std::string before = file;
  for (std::size_t left = 1 + bytes.below(4); left > 0; --left) damage(bytes, file);
  const bool is_covered_up = bytes.chance(200);
  if (is_covered_up) put_right_checksums(file);
  std::istringstream stream(file);
  try {
    Tree tree = Tree::load(stream);
    if (!is_covered_up && file.substr(0, before.size()) != before)
      fail("a damaged tree was taken for a good one");
    use(bytes, tree, mesh, rays, test, file.size());
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    if (!message.starts_with("tree") || message.find('\n') != std::string::npos)
      fail("a message that does not begin with the tree or is not one line: " + message);
  }
}

// A mesh in some places, and all that within itself.
template <class AnyScene, class AnyMesh, class AnyRay>
void load_damaged_scene(Bytes& bytes, const AnyMesh& mesh, const AnyMesh& other,
                        const std::vector<AnyRay>& rays) {
  AnyScene scene;
  scene.add(mesh.vertices, mesh.triangles), scene.place(0);
  const decltype(scene.transform_of(0)) turned{{{0, 0, 1, 1}, {0, 1, 0, 0}, {-1, 0, 0, 0.5}}};
  scene.place(0, turned, bytes.byte());
  if (bytes.chance(160)) scene.place(scene.add(scene), turned);
  std::ostringstream saved;
  scene.save(saved);
  load_damaged<AnyScene>(bytes, saved.str(), other, rays, TriangleTest::exact);
}

void load_damaged_doubles(Bytes& bytes) {
  DoubleCoordinates coordinates(bytes);
  const DoubleMesh mesh = any_double_mesh(bytes, coordinates);
  DoubleMesh other = mesh;
  for (Double3& vertex : other.vertices)
    if (bytes.chance(64)) vertex = other.vertices[0];
  std::vector<RayD> rays;
  for (std::size_t i = 0; i < 24; ++i) rays.push_back(any_double_ray(bytes, coordinates, mesh));
  if (bytes.chance(100)) return load_damaged_scene<SceneD>(bytes, mesh, other, rays);
  std::ostringstream saved;
  BvhD(mesh.vertices, mesh.triangles).save(saved);
  load_damaged<BvhD>(bytes, saved.str(), other, rays, TriangleTest::exact);
}

std::vector<Hit> hits_of(const Bvh& tree, std::span<const Ray> rays, const TraceOptions& options) {
  std::vector<Hit> hits(rays.size());
  tree.closest(rays, hits, options);
  return hits;
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_trees(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  if (bytes.chance(48)) {
    load_damaged_doubles(bytes);
    return 0;
  }
  const Mesh mesh = any_mesh(bytes);
  Mesh other = mesh;
  Coordinates coordinates(bytes);
  for (Float3& vertex : other.vertices)
    if (bytes.chance(128)) vertex = bytes.chance(32) ? other.vertices[0] : finite_point(coordinates);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < 24; ++i)
    rays.push_back(any_ray(bytes, coordinates, bytes.chance(128) ? mesh : other));
  const auto test = any_tree_test(bytes);
  const auto builder = static_cast<TreeBuilder>(bytes.below(tree_builder_names.size()));
  const BuildOptions options{.builder = builder, .optimize = bytes.chance(96)};
  if (bytes.chance(32)) {
    load_damaged_scene<Scene>(bytes, mesh, other, rays);
    return 0;
  }
  std::ostringstream saved;
  if (bytes.chance(64)) {
    const auto kd_builder = static_cast<KdBuilder>(bytes.below(kd_builder_names.size()));
    KdTree(mesh, {.builder = kd_builder}).save(saved);
    load_damaged<KdTree>(bytes, saved.str(), other, rays, test);
    return 0;
  }
  Bvh tree(mesh, options);
  tree.save(saved);
  if (bytes.chance(160)) {
    load_damaged<Bvh>(bytes, saved.str(), other, rays, test);
    return 0;
  }
  if (bytes.chance(64)) {
    std::istringstream stream(saved.str());
    tree = Bvh::load(stream);
  }
  const TraceOptions way = any_way(bytes, TriangleTest::exact);
  const std::vector<Hit> before = hits_of(tree, rays, way);
  const bool is_out =
      runs_out(bytes.below(30), unlimited, [&] { tree.refit(other.vertices, other.triangles); });
  if (is_out && !same_bytes(hits_of(tree, rays, way), before))
    fail("a refit that ran out of memory changed the tree");
  tree.refit(other.vertices, other.triangles, static_cast<int>(bytes.below(3)));
  const Bvh built(other);
  const std::vector<Hit> hits = hits_of(tree, rays, way), expected = hits_of(built, rays, way);
  if (!same_bytes(tree.bounds(), built.bounds()))
    fail("a refitted tree has other bounds than one built anew");
  if (!same_bytes(hits, expected)) fail("a refitted tree has other hits than one built anew");
  if (tree.sah_cost() < 0 || !(tree.decay() >= 0)) fail("costs of " + std::to_string(tree.sah_cost()));
  return 0;
}

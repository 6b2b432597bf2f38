#include "tree_answers.hpp"

#include <raylanes/bvh.hpp>
#include <raylanes/kdtree.hpp>

#include "fixed_rays.hpp"

namespace raylanes::bench {
namespace {

std::vector<Ray> rays_at(const Mesh& mesh, const Float3& eye) {
  SplitMix random(6);
  const auto any_triangle = [&] {
    const auto i = static_cast<std::size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()));
    const auto& [a, b, c] = mesh.triangles[i];
    return Triangle{{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}};
  };
  std::vector<Ray> rays;
  for (int i = 0; i < 4096; ++i) {
    // From the eye, from around it, and from triangle to triangle; at the inside, edges and corners.
    const Float3 from = i % 64 < 32  ? eye
                        : i % 2 == 0 ? point_around(random, eye, 0.5)
                                     : any_triangle().corner[0];
    const double u = random.uniform(), v = random.uniform() * (1 - u);
    Ray ray = ray_through(from, any_triangle(), i % 3 == 2 ? 0 : u, i % 3 == 0 ? v : 0);
    if (i % 5 == 4) ray.tmax = static_cast<float>(between(random, 0.5, 1.1));
    rays.push_back(ray);
  }
  return rays;
}

template <class Tree>
std::uint64_t hash_of_trace(const Tree& tree, std::span<const Ray> rays, const TraceOptions& options) {
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  tree.closest(rays, hits, options);
  tree.occluded(rays, occluded, options);
  Hash hash;
  for (const Hit& hit : hits) hash.add(hit);
  hash.add(occluded);
  return hash.value();
}

// All hits, crossings, their counts and the hits behind the nearest ones.
template <class Tree>
std::uint64_t hash_of_lists(const Tree& tree, std::span<const Ray> rays, const Path* path) {
  const RayLists<Hit> all = tree.all_hits(rays, {.path = path});
  const RayLists<Crossing> crossed = tree.crossings(rays, {.path = path});
  std::vector<CrossingCount> counts(rays.size());
  std::vector<Hit> hits(rays.size());
  tree.count_crossings(rays, counts, {.path = path});
  tree.closest(rays, hits, {.path = path});
  tree.closest(rays, hits, {.path = path, .after = hits});
  hits.insert(hits.end(), all.items.begin(), all.items.end());
  Hash hash;
  for (const std::size_t offset : all.offsets) hash.add(static_cast<std::uint32_t>(offset));
  for (const Hit& hit : hits) hash.add(hit);
  for (const Crossing& crossing : crossed.items)
    hash.add(crossing.t), hash.add(crossing.primitive), hash.add(static_cast<std::uint32_t>(crossing.side));
  for (const CrossingCount& count : counts)
    hash.add(count.crossings), hash.add(static_cast<std::uint32_t>(count.winding));
  return hash.value();
}

// A hash of queries at the origins of rays: the closest points, where they are and how far from the surface.
template <class Tree>
std::uint64_t hash_of_points(const Tree& tree, std::span<const Ray> rays, const Path* path) {
  const VertexView points(rays.data(), rays.size(), sizeof(Ray));
  std::vector<ClosestPoint> closest(rays.size());
  std::vector<Location> locations(rays.size());
  std::vector<float> distances(rays.size());
  tree.closest_points(points, closest, {.path = path});
  tree.locate(points, locations, {.path = path});
  tree.signed_distances(points, distances, {.rule = InsideRule::vote, .path = path});
  Hash hash;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hash.add(closest[i]);
    hash.add(static_cast<std::uint32_t>(locations[i]));
    hash.add(distances[i]);
  }
  return hash.value();
}

// Winding numbers at the origins of rays.
template <class Tree>
std::uint64_t hash_of_windings(const Tree& tree, std::span<const Ray> rays, const Path* path) {
  std::vector<float> numbers(rays.size());
  Hash hash;
  for (const double accuracy : {1e-3, 1e-6}) {
    tree.winding_numbers(VertexView(rays.data(), rays.size(), sizeof(Ray)), numbers,
                         {.accuracy = accuracy, .path = path});
    for (const float number : numbers) hash.add(number);
  }
  return hash.value();
}

// Two of three triangles, so that the mesh has a boundary.
Mesh without_some(const Mesh& mesh) {
  Mesh open{mesh.vertices, {}};
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (i % 3 != 1) open.triangles.push_back(mesh.triangles[i]);
  return open;
}

}  // namespace

std::uint64_t hash_of(const Mesh& mesh) {
  Hash hash;
  for (const Float3& vertex : mesh.vertices)
    for (const float x : vertex) hash.add(x);
  for (const Index3& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle) hash.add(index);
  return hash.value();
}

std::vector<Hashes> hashes_of_tree(const std::vector<const Path*>& paths, const std::string& name,
                                   const Mesh& mesh, const Float3& eye) {
  const std::vector<Ray> rays = rays_at(mesh, eye);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const KdTree kdtree(mesh.vertices, mesh.triangles);
  const Mesh open = without_some(mesh);
  const Bvh open_bvh(open);
  const KdTree open_kdtree(open);
  std::vector<Hashes> all;
  for (const Path* path : paths) {
    Hashes& hashes = all.emplace_back();
    for (const TriangleTest test :
         {TriangleTest::exact, TriangleTest::watertight, TriangleTest::moller_trumbore})
      for (std::size_t mode = 0; mode < traversal_mode_names.size(); ++mode) {
        const TraceOptions options{.test = test, .mode = static_cast<TraversalMode>(mode), .path = path};
        const std::string asked = name + ' ' + triangle_tests[static_cast<std::size_t>(test)].name + ' ' +
                                  std::string(traversal_mode_names[mode]);
        hashes[asked + " bvh"] = hash_of_trace(bvh, rays, options);
        hashes[asked + " kdtree"] = hash_of_trace(kdtree, rays, options);
      }
    const auto some = std::span(rays).first(rays.size() / 3);  // enough to go together
    hashes[name + " lists bvh"] = hash_of_lists(bvh, some, path);
    hashes[name + " lists kdtree"] = hash_of_lists(kdtree, some, path);
    hashes[name + " points bvh"] = hash_of_points(bvh, some, path);
    hashes[name + " points kdtree"] = hash_of_points(kdtree, some, path);
    hashes[name + " windings bvh"] = hash_of_windings(open_bvh, some.first(512), path);
    hashes[name + " windings kdtree"] = hash_of_windings(open_kdtree, some.first(512), path);
  }
  return all;
}

}  // namespace raylanes::bench

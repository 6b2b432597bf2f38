#include "tree_answers.hpp"

#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>
#include <raylanes/kdtree.hpp>
#include <raylanes/numbers.hpp>

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

template <class Tree, class Ray, class Options>
std::uint64_t hash_of_trace(const Tree& tree, std::span<const Ray> rays, const Options& options) {
  std::vector<decltype(tree.closest(rays[0]))> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  tree.closest(rays, hits, options);
  tree.occluded(rays, occluded, options);
  Hash hash;
  for (const auto& hit : hits) hash.add(hit);
  hash.add(occluded);
  return hash.value();
}

// All hits, crossings, their counts and the hits behind the nearest ones.
template <class Tree, class Ray>
std::uint64_t hash_of_lists(const Tree& tree, std::span<const Ray> rays, const Path* path) {
  const auto all = tree.all_hits(rays, {.path = path});
  const auto crossed = tree.crossings(rays, {.path = path});
  std::vector<CrossingCount> counts(rays.size());
  std::vector<decltype(tree.closest(rays[0]))> hits(rays.size());
  tree.count_crossings(rays, counts, {.path = path});
  tree.closest(rays, hits, {.path = path});
  tree.closest(rays, hits, {.path = path, .after = hits});
  hits.insert(hits.end(), all.items.begin(), all.items.end());
  Hash hash;
  for (const std::size_t offset : all.offsets) hash.add(static_cast<std::uint32_t>(offset));
  for (const auto& hit : hits) hash.add(hit);
  for (const auto& crossing : crossed.items)
    hash.add(crossing.t), hash.add(crossing.primitive), hash.add(static_cast<std::uint32_t>(crossing.side));
  for (const CrossingCount& count : counts)
    hash.add(count.crossings), hash.add(static_cast<std::uint32_t>(count.winding));
  return hash.value();
}

// A hash of queries at the origins of rays: the closest points, where they are and how far from the surface.
template <class T, class Tree>
std::uint64_t hash_of_points(const Tree& tree, std::span<const RayOf<T>> rays, const Path* path) {
  const VertexRecords<T> points(rays.data(), rays.size(), sizeof(RayOf<T>));
  std::vector<ClosestPointOf<T>> closest(rays.size());
  std::vector<Location> locations(rays.size());
  std::vector<T> distances(rays.size());
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
template <class T, class Tree>
std::uint64_t hash_of_windings(const Tree& tree, std::span<const RayOf<T>> rays, const Path* path) {
  std::vector<T> numbers(rays.size());
  Hash hash;
  for (const double accuracy : {1e-3, 1e-6}) {
    tree.winding_numbers(VertexRecords<T>(rays.data(), rays.size(), sizeof(RayOf<T>)), numbers,
                         {.accuracy = accuracy, .path = path});
    for (const T number : numbers) hash.add(number);
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

// The mesh and the rays in doubles that are no floats, beside a point that is far away.
constexpr Double3 far_away{5e6, -1e6, 3e5};
Double3 moved(const Float3& p) {
  Double3 q;
  for (std::size_t k = 0; k < 3; ++k) q[k] = static_cast<double>(p[k]) / 3 + far_away[k];
  return q;
}
BvhD tree_of_doubles(const Mesh& mesh) {
  std::vector<Double3> vertices;
  for (const Float3& vertex : mesh.vertices) vertices.push_back(moved(vertex));
  return BvhD(vertices, mesh.triangles);
}
std::vector<RayD> in_doubles(std::span<const Ray> rays) {
  std::vector<RayD> moved_rays;
  for (const auto& [origin, tmin, d, tmax] : rays) {
    RayD& ray = moved_rays.emplace_back();
    ray.origin = moved(origin), ray.tmin = static_cast<double>(tmin), ray.tmax = static_cast<double>(tmax);
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = static_cast<double>(d[k]) / 3;
  }
  return moved_rays;
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
  const std::vector<Ray> rays_of_floats = rays_at(mesh, eye);
  const std::span<const Ray> rays(rays_of_floats);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const KdTree kdtree(mesh.vertices, mesh.triangles);
  const Mesh open = without_some(mesh);
  const Bvh open_bvh(open);
  const KdTree open_kdtree(open);
  const BvhD doubles = tree_of_doubles(mesh), open_doubles = tree_of_doubles(open);
  const std::vector<RayD> rays_of_doubles = in_doubles(rays);
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
    const auto some = rays.first(rays.size() / 3);  // enough to go together
    hashes[name + " lists bvh"] = hash_of_lists(bvh, some, path);
    hashes[name + " lists kdtree"] = hash_of_lists(kdtree, some, path);
    hashes[name + " points bvh"] = hash_of_points<float>(bvh, some, path);
    hashes[name + " points kdtree"] = hash_of_points<float>(kdtree, some, path);
    hashes[name + " windings bvh"] = hash_of_windings<float>(open_bvh, some.first(512), path);
    hashes[name + " windings kdtree"] = hash_of_windings<float>(open_kdtree, some.first(512), path);
    // Enough to go as streams, and few, which go alone.
    const std::span<const RayD> all_doubles(rays_of_doubles), few = all_doubles.first(512);
    hashes[name + " doubles hits"] = hash_of_trace(doubles, all_doubles, TraceOptionsD{.path = path});
    hashes[name + " doubles lists"] = hash_of_lists(doubles, few, path);
    hashes[name + " doubles points"] = hash_of_points<double>(doubles, few, path);
    hashes[name + " doubles windings"] = hash_of_windings<double>(open_doubles, few, path);
  }
  return all;
}

}  // namespace raylanes::bench

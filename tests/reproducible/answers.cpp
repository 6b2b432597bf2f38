#include "answers.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <raylanes/bvh.hpp>
#include <raylanes/intersect.hpp>

#include "../../dispatch/table.hpp"
#include "inputs.hpp"

namespace raylanes::testing {
namespace {

constexpr auto reproducible = static_cast<std::size_t>(Grade::reproducible);

Ray ray_of(const FixedRay& r) {
  return {r.origin, r.tmin, r.direction, r.tmax};
}

// One array per number, as the tests take their primitives and rays.
struct Soa {
  std::vector<std::vector<float>> numbers;
  std::vector<const float*> pointers;
  std::size_t size;

  // `row` gives the numbers of an element in their order.
  template <class Elements, class Row>
  Soa(const Elements& elements, Row row) : size(elements.size()) {
    for (const auto& element : elements) {
      const auto values = row(element);
      numbers.resize(values.size());
      for (std::size_t k = 0; k < values.size(); ++k) numbers[k].push_back(values[k]);
    }
    for (const auto& array : numbers) pointers.push_back(array.data());
  }
  std::vector<float> element(std::size_t i) const {
    std::vector<float> values;
    for (const auto& array : numbers) values.push_back(array[i]);
    return values;
  }
};

Soa soa_of(const std::vector<FixedRay>& rays) {
  return {rays, [](const FixedRay& r) {
            return std::array{r.origin[0],    r.origin[1],    r.origin[2], r.direction[0],
                              r.direction[1], r.direction[2], r.tmin,      r.tmax};
          }};
}
RayArrays arrays_of(const Soa& rays) {
  const float* const* p = rays.pointers.data();
  return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, p[6], p[7], rays.size};
}

Soa soa_of(const std::vector<FixedTriangle>& triangles) {
  return {triangles, [](const FixedTriangle& t) {
            return std::array{t[0][0], t[0][1], t[0][2], t[1][0], t[1][1],
                              t[1][2], t[2][0], t[2][1], t[2][2]};
          }};
}

template <class T, class Method, std::size_t count>
void add_roots(Hashes& hashes, const char* function, const std::array<RootMethodInfo<Method>, count>& methods,
               const RootRows<T, Method, count>& rows, const std::vector<T>& x) {
  std::vector<T> y(x.size());
  for (std::size_t method = 0; method < count; ++method) {
    if (!methods[method].promise.reproducible) continue;
    rows.by[method](x.data(), y.data(), x.size());
    Hash hash;
    for (const T root : y) hash.add(root);
    hashes[std::string(function) + ' ' + std::string(methods[method].promise.name)] = hash.value();
  }
}

void add_bits(Hash& hash, std::span<const std::uint8_t> bits) {
  for (const std::uint8_t byte : bits) hash.add(std::uint32_t{byte});
}

TriangleArrays triangle_arrays(const Soa& corners) {
  TriangleArrays triangles;
  triangles.size = corners.size;
  for (std::size_t k = 0; k < 9; ++k) triangles.corner[k / 3][k % 3] = corners.pointers[k];
  return triangles;
}

void add_triangles(Hashes& hashes, const TriangleOptions& options, const std::string& name) {
  const bool directional = options.test == TriangleTest::directional;
  const std::vector<FixedTriangle> triangles = fixed_triangles();
  const Soa corners = soa_of(triangles);
  std::vector<FixedRay> rays = fixed_rays(directional ? 101 : 701);
  Hash one_ray, one_triangle;
  std::vector<std::uint8_t> bits((corners.size + 7) / 8, 0);
  for (const FixedRay& ray : rays) {
    if (directional && !(ray.direction[0] - ray.direction[0] == 0)) continue;
    const PreparedTriangles prepared(triangle_arrays(corners), options,
                                     {ray.direction[0], ray.direction[1], ray.direction[2]});
    any_hits(ray_of(ray), prepared, bits);
    add_bits(one_ray, bits);
    const Hit hit = closest_hit(ray_of(ray), prepared);
    one_ray.add(hit.t), one_ray.add(hit.u), one_ray.add(hit.v), one_ray.add(hit.primitive);
  }
  if (directional)
    for (FixedRay& ray : rays) ray.direction = rays.front().direction;
  const Soa soa = soa_of(rays);
  const std::size_t n = rays.size();
  bits.assign((n + 7) / 8, 0);
  std::vector<float> t(n), u(n), v(n);
  for (const FixedTriangle& triangle : triangles) {
    const Triangle corner{{triangle[0], triangle[1], triangle[2]}};
    any_hits(arrays_of(soa), corner, bits, options);
    add_bits(one_triangle, bits);
    closest_hits(arrays_of(soa), corner, {bits, t, u, v}, options);
    for (std::size_t k = 0; k < n; ++k)
      one_triangle.add(t[k]), one_triangle.add(u[k]), one_triangle.add(v[k]),
          one_triangle.add(std::uint32_t{bits[k / 8]} >> k % 8 & 1u);
  }
  hashes["triangle " + name + " 1xN"] = one_ray.value();
  hashes["triangle " + name + " Nx1"] = one_triangle.value();
}

// Distances of what is missed are not part of the answer.
void add_interval(Hash& hash, bool hit, float from, float to) {
  hash.add(std::uint32_t{hit});
  if (hit) hash.add(from), hash.add(to);
}

// Boxes and spheres are asked in the same words: yes or no, then two numbers for each hit, of one ray and all
// primitives, and the other way round.
template <class AnyOfPrimitives, class AnyOfRays, class IntervalOfPrimitives, class IntervalOfRays>
void add_intervals(Hashes& hashes, const std::string& name, const Soa& primitives,
                   AnyOfPrimitives any_of_primitives, AnyOfRays any_of_rays,
                   IntervalOfPrimitives of_primitives, IntervalOfRays of_rays) {
  const std::vector<FixedRay> rays = fixed_rays(701);
  const Soa soa = soa_of(rays);
  const std::size_t most = std::max(rays.size(), primitives.size);
  std::vector<float> from(most), to(most);
  Hash one_ray, one_primitive;
  std::vector<std::uint8_t> bits((primitives.size + 7) / 8, 0);
  const auto is_hit = [&](std::size_t i) { return (bits[i / 8] >> i % 8 & 1u) != 0; };
  for (const FixedRay& ray : rays) {
    any_of_primitives(ray_of(ray), primitives.pointers.data(), primitives.size, nullptr, bits.data());
    add_bits(one_ray, bits);
    of_primitives(ray_of(ray), primitives.pointers.data(), primitives.size, nullptr, bits.data(), from.data(),
                  to.data());
    for (std::size_t k = 0; k < primitives.size; ++k) add_interval(one_ray, is_hit(k), from[k], to[k]);
  }
  bits.assign((rays.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < primitives.size; ++i) {
    const std::vector<float> primitive = primitives.element(i);
    any_of_rays(arrays_of(soa), primitive.data(), nullptr, bits.data());
    add_bits(one_primitive, bits);
    of_rays(arrays_of(soa), primitive.data(), nullptr, bits.data(), from.data(), to.data());
    for (std::size_t k = 0; k < rays.size(); ++k) add_interval(one_primitive, is_hit(k), from[k], to[k]);
  }
  hashes[name + " 1xN"] = one_ray.value();
  hashes[name + " Nx1"] = one_primitive.value();
}

void add_boxes(Hashes& hashes, const BoxRow& row, const std::string& name) {
  const Soa boxes(fixed_boxes(), [](const FixedBox& b) {
    return std::array{b.lo[0], b.lo[1], b.lo[2], b.hi[0], b.hi[1], b.hi[2]};
  });
  add_intervals(hashes, "box " + name, boxes, row.any_of_boxes, row.any_of_rays, row.intervals_of_boxes,
                row.intervals_of_rays);
}

Soa soa_of(const std::vector<FixedSphere>& spheres) {
  return {spheres, [](const FixedSphere& s) {
            return std::array{s.centre[0], s.centre[1], s.centre[2], signed_square(s.radius)};
          }};
}

void add_spheres(Hashes& hashes, const SphereRow& row, const std::string& name) {
  add_intervals(hashes, "sphere " + name, soa_of(fixed_spheres()), row.any_of_spheres, row.any_of_rays,
                row.distances_of_spheres, row.distances_of_rays);
}

void add_lines_through_spheres(Hashes& hashes, const Path& path) {
  const Soa spheres = soa_of(fixed_spheres());
  std::vector<std::uint8_t> bits((spheres.size + 7) / 8, 0);
  Hash hash;
  for (const FixedRay& ray : fixed_rays(701)) {
    path.kernels.spheres.line_of_spheres[reproducible](ray_of(ray), spheres.pointers.data(), spheres.size,
                                                       nullptr, bits.data());
    add_bits(hash, bits);
  }
  hashes["sphere line 1xN"] = hash.value();
}

}  // namespace

Hashes hashes_of_roots(const Path& path) {
  Hashes hashes;
  const RootKernels& roots = path.kernels.roots;
  const std::vector<float> floats = fixed_floats();
  const std::vector<double> doubles = fixed_doubles();
  add_roots(hashes, "sqrt", sqrt_methods, roots.sqrt, floats);
  add_roots(hashes, "rsqrt", rsqrt_methods, roots.rsqrt, floats);
  add_roots(hashes, "reciprocal", reciprocal_methods, roots.reciprocal, floats);
  add_roots(hashes, "sqrt of doubles", double_sqrt_methods, roots.double_sqrt, doubles);
  add_roots(hashes, "rsqrt of doubles", double_rsqrt_methods, roots.double_rsqrt, doubles);
  add_roots(hashes, "reciprocal of doubles", double_reciprocal_methods, roots.double_reciprocal, doubles);
  return hashes;
}

Hashes hashes_of_tests(const Path& path) {
  Hashes hashes;
  for (const TriangleTestInfo& info : triangle_tests)
    add_triangles(hashes, {.test = info.test, .path = &path}, info.name);
  for (const BoxTestInfo& info : box_tests)
    add_boxes(hashes, path.kernels.boxes.row[static_cast<std::size_t>(info.test)][reproducible], info.name);
  for (const SphereTestInfo& info : sphere_tests)
    add_spheres(hashes, path.kernels.spheres.row[static_cast<std::size_t>(info.test)][reproducible],
                info.name);
  add_lines_through_spheres(hashes, path);
  return hashes;
}

namespace {

std::vector<Ray> rays_at(const Mesh& mesh, const Float3& eye) {
  bench::SplitMix random(6);
  const auto any_triangle = [&] {
    const auto i = static_cast<std::size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()));
    const auto& [a, b, c] = mesh.triangles[i];
    return FixedTriangle{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  };
  std::vector<Ray> rays;
  for (int i = 0; i < 4096; ++i) {
    // From the eye in packets, from around it, and from triangle to triangle; at the inside, edges and corners.
    const Point3 from = i % 64 < 32 ? eye : i % 2 == 0 ? point_around(random, eye, 0.5) : any_triangle()[0];
    const double u = random.uniform(), v = random.uniform() * (1 - u);
    FixedRay ray = ray_through(from, any_triangle(), i % 3 == 2 ? 0 : u, i % 3 == 0 ? v : 0);
    if (i % 5 == 4) ray.tmax = static_cast<float>(between(random, 0.5, 1.1));
    rays.push_back(ray_of(ray));
  }
  return rays;
}

std::uint64_t hash_of_trace(const Bvh& tree, std::span<const Ray> rays, const TraceOptions& options) {
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  tree.closest(rays, hits, options);
  tree.occluded(rays, occluded, options);
  Hash hash;
  for (const Hit& hit : hits) hash.add(hit.t), hash.add(hit.u), hash.add(hit.v), hash.add(hit.primitive);
  add_bits(hash, occluded);
  return hash.value();
}

}  // namespace

std::vector<Hashes> hashes_of_tree(const std::vector<const Path*>& paths, const std::string& name,
                                   const Mesh& mesh, const Float3& eye) {
  const std::vector<Ray> rays = rays_at(mesh, eye);
  const Bvh tree(mesh.vertices, mesh.triangles);
  std::vector<Hashes> all;
  for (const Path* path : paths) {
    const auto hash = [&](TriangleTest test, TraversalMode mode) {
      return hash_of_trace(tree, rays, {.test = test, .mode = mode, .path = path});
    };
    all.push_back(
        {{name + " watertight single", hash(TriangleTest::watertight, TraversalMode::single)},
         {name + " watertight packet", hash(TriangleTest::watertight, TraversalMode::packet)},
         {name + " moller_trumbore single", hash(TriangleTest::moller_trumbore, TraversalMode::single)},
         {name + " moller_trumbore packet", hash(TriangleTest::moller_trumbore, TraversalMode::packet)}});
  }
  return all;
}

}  // namespace raylanes::testing

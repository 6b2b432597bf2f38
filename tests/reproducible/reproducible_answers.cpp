#include "reproducible_answers.hpp"

#include <raylanes/boxes.hpp>
#include <raylanes/points.hpp>
#include <raylanes/prepared_ray.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../dispatch/table/boxes.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "../../dispatch/table/spheres.hpp"
#include "../intervals/interval_answers.hpp"
#include "reproducible_inputs.hpp"

namespace raylanes::testing {
namespace {

// The rows of a grade that is not hashed are called with a mask, so that emulated processors meet their instructions.
constexpr std::array<std::uint8_t, 100> all_active = [] {
  std::array<std::uint8_t, 100> all;
  all.fill(0xff);
  return all;
}();
LaneBits mask_of(Grade grade) {
  return grade == Grade::reproducible ? nullptr : all_active.data();
}

template <class T, class Method, std::size_t count>
void add_roots(Hashes& hashes, const char* function, const std::array<RootMethodInfo<Method>, count>& methods,
               const RootRows<T, Method, count>& rows, const std::vector<T>& x) {
  std::vector<T> y(x.size());
  for (std::size_t method = 0; method < count; ++method) {
    rows.by[method](x.data(), y.data(), x.size());
    if (!methods[method].promise.reproducible) continue;
    Hash hash;
    for (const T root : y) hash.add(root);
    hashes[std::string(function) + ' ' + std::string(methods[method].promise.name)] = hash.value();
  }
}

void add_triangles(Hashes& hashes, TriangleOptions options, const std::string& name) {
  const bool directional = options.test == TriangleTest::directional;
  const std::vector<Triangle> triangles = fixed_triangles();
  const TriangleColumns corners(triangles);
  std::vector<Ray> rays = fixed_rays(directional ? 101 : 701);
  Hash one_ray, one_triangle;
  std::vector<std::uint8_t> bits((corners.size() + 7) / 8, 0);
  for (const Ray& ray : rays) {
    if (directional && !(ray.direction[0] - ray.direction[0] == 0)) continue;
    const PreparedTriangles prepared(corners.arrays(), options, ray.direction);
    hit_mask(ray, prepared, bits);
    one_ray.add(bits);
    const Hit hit = closest_hit(ray, prepared);
    one_ray.add(hit);
  }
  if (directional)
    for (Ray& ray : rays) ray.direction = rays.front().direction;
  const RayColumns columns(rays);
  const std::size_t n = rays.size();
  bits.assign((n + 7) / 8, 0);
  options.active = mask_of(options.grade);
  std::vector<float> t(n), u(n), v(n);
  for (const Triangle& triangle : triangles) {
    hit_mask(columns.arrays(), triangle, bits, options);
    one_triangle.add(bits);
    closest_hits(columns.arrays(), triangle, {bits, t, u, v}, options);
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

template <class Primitive>
void add_intervals(Hashes& hashes, const std::string& name, const std::vector<Primitive>& primitives,
                   const IntervalRow& row, LaneBits active) {
  const std::vector<Ray> rays = fixed_rays(701);
  const RayColumns ray_columns(rays);
  const Columns<Primitive> columns(primitives);
  const std::size_t most = std::max(rays.size(), primitives.size());
  std::vector<float> from(most), to(most);
  Hash one_ray, one_primitive;
  std::vector<std::uint8_t> bits((primitives.size() + 7) / 8, 0);
  for (const Ray& ray : rays) {
    row.any_of_primitives(ray, columns.soa(), primitives.size(), active, bits.data());
    one_ray.add(bits);
    row.of_primitives(ray, columns.soa(), primitives.size(), active, bits.data(), from.data(), to.data());
    for (std::size_t k = 0; k < primitives.size(); ++k)
      add_interval(one_ray, is_set(bits, k), from[k], to[k]);
  }
  bits.assign((rays.size() + 7) / 8, 0);
  for (const Primitive& primitive : primitives) {
    const auto numbers = numbers_of(primitive);
    row.any_of_rays(ray_columns.arrays(), numbers.data(), active, bits.data());
    one_primitive.add(bits);
    row.of_rays(ray_columns.arrays(), numbers.data(), active, bits.data(), from.data(), to.data());
    for (std::size_t k = 0; k < rays.size(); ++k)
      add_interval(one_primitive, is_set(bits, k), from[k], to[k]);
  }
  hashes[name + " 1xN"] = one_ray.value();
  hashes[name + " Nx1"] = one_primitive.value();
}

void add_lines_through_spheres(Hashes& hashes, const Path& path, Grade grade) {
  const SphereColumns spheres(fixed_spheres());
  const auto lines = kernels_of(path).spheres.line_of_spheres[static_cast<std::size_t>(grade)];
  std::vector<std::uint8_t> bits((spheres.size() + 7) / 8, 0);
  Hash hash;
  for (const Ray& ray : fixed_rays(701)) {
    lines(ray, spheres.soa(), spheres.size(), mask_of(grade), bits.data());
    hash.add(bits);
  }
  hashes["sphere line 1xN"] = hash.value();
}

void add_closest_spheres(Hashes& hashes, const SphereOptions& options, const std::string& name) {
  const SphereColumns spheres(fixed_spheres());
  Hash hash;
  for (const Ray& ray : fixed_rays(701)) hash.add(closest_hit(ray, spheres.arrays(), options));
  hashes["sphere " + name + " closest"] = hash.value();
}

// Arrays of as many primitives as prepared rays take.
void add_prepared_rays(Hashes& hashes, const Path& path) {
  constexpr std::size_t most = PreparedRay::max_primitives;
  const auto first = [](auto primitives) {
    primitives.resize(most);
    return primitives;
  };
  const BoxColumns boxes(first(fixed_boxes()));
  const SphereColumns spheres(first(fixed_spheres()));
  const TriangleColumns triangles(first(fixed_triangles()));
  std::vector<float> entry(most);
  Hash hash;
  for (const Ray& ray : fixed_rays(701)) {
    const PreparedRay prepared(ray, &path);
    hash.add(hits(prepared, boxes.arrays(), entry));
    for (const float t : entry) hash.add(t);
    hash.add(closest_hit(prepared, spheres.arrays())), hash.add(closest_hit(prepared, triangles.arrays()));
  }
  hashes["prepared 1xN"] = hash.value();
}

void add_distances(Hashes& hashes, const Path& path) {
  const TriangleColumns corners(fixed_triangles());
  std::vector<float> numbers[6];
  for (std::vector<float>& column : numbers) column.resize(corners.size());
  const PointDistances out{numbers[0], {numbers[1], numbers[2], numbers[3]}, numbers[4], numbers[5]};
  Hash hash;
  for (const Ray& ray : fixed_rays(101)) {
    distances(ray.origin, corners.arrays(), out, {.path = &path});
    for (const std::vector<float>& column : numbers)
      for (const float x : column) hash.add(x);
    hash.add(closest_point(ray.origin, corners.arrays(), {.path = &path}));
  }
  hashes["point 1xN"] = hash.value();
}

}  // namespace

Hashes hashes_of_roots(const Path& path) {
  Hashes hashes;
  const RootKernels& roots = kernels_of(path).roots;
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
  for (const Grade grade : {Grade::fast, Grade::reproducible}) {  // the last one is hashed
    const auto rows = static_cast<std::size_t>(grade);
    for (const TriangleTestInfo& info : triangle_tests)
      add_triangles(hashes, {.test = info.test, .grade = grade, .path = &path}, info.name);
    for (const BoxTestInfo& info : box_tests)
      add_intervals(hashes, std::string("box ") + info.name, fixed_boxes(),
                    interval_row(kernels_of(path).boxes.row[static_cast<std::size_t>(info.test)][rows]),
                    mask_of(grade));
    for (const SphereTestInfo& info : sphere_tests) {
      add_intervals(hashes, std::string("sphere ") + info.name, fixed_spheres(),
                    interval_row(kernels_of(path).spheres.row[static_cast<std::size_t>(info.test)][rows]),
                    mask_of(grade));
      add_closest_spheres(hashes, {.test = info.test, .grade = grade, .path = &path}, info.name);
    }
    add_lines_through_spheres(hashes, path, grade);
  }
  add_distances(hashes, path);
  add_prepared_rays(hashes, path);
  return hashes;
}

}  // namespace raylanes::testing

// Google Benchmark rows, named kernel/method/path/size. Every row is checked against plain double-precision
// code before it is timed; a wrong answer is an error, not a time.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <raylanes/paths.hpp>
#include <raylanes/triangles.hpp>

#include "../../dispatch/table.hpp"
#include "roots.hpp"

namespace raylanes::bench {
namespace {

std::vector<float> random_floats(std::size_t n, float lo, float hi, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(lo, hi);
  std::vector<float> x(n);
  for (float& value : x) value = uniform(random);
  return x;
}

void set_items(benchmark::State& state, std::size_t n) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}

// One ray along z from the origin of a unit square full of boxes and triangles around it; a third is hit.
constexpr Ray test_ray{{0.1f, 0.2f, -1.0f}, 0.0f, {0.01f, 0.02f, 1.0f}, INFINITY};

struct Soup {
  std::array<std::array<std::vector<float>, 3>, 3> corner;
  std::vector<float> t, u, v;
  std::vector<std::uint32_t> hit;

  explicit Soup(std::size_t n) : t(n), u(n), v(n), hit(n) {
    for (unsigned c = 0; c < 3; ++c)
      for (unsigned axis = 0; axis < 3; ++axis) corner[c][axis] = random_floats(n, -1.0f, 1.0f, 3 * c + axis);
  }
  TriangleArrays triangles() const {
    TriangleArrays arrays{};
    arrays.size = t.size();
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t axis = 0; axis < 3; ++axis) arrays.corner[c][axis] = corner[c][axis].data();
    return arrays;
  }

  // The signed volumes of ray and edges, in double: which side of each edge the ray passes, and how clearly.
  bool clearly_wrong(std::size_t i) const {
    std::array<std::array<double, 3>, 3> p;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t a = 0; a < 3; ++a)
        p[c][a] = static_cast<double>(corner[c][a][i]) - static_cast<double>(test_ray.origin[a]);
    int positive = 0, negative = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto &a = p[c], &b = p[(c + 1) % 3];
      const auto& d = test_ray.direction;
      const double volume = d[0] * (a[1] * b[2] - a[2] * b[1]) + d[1] * (a[2] * b[0] - a[0] * b[2]) +
                            d[2] * (a[0] * b[1] - a[1] * b[0]);
      if (std::fabs(volume) < 1e-5) return false;
      ++(volume > 0 ? positive : negative);
    }
    // All corners lie at z >= -1, before the ray's origin: the line's hit is the ray's.
    return (positive == 3 || negative == 3) != (hit[i] != 0);
  }
};

void ray_triangles(benchmark::State& state, const Path& path, TriangleTest test, Grade grade, std::size_t n) {
  Soup soup(n);
  const PreparedTriangles triangles(soup.triangles(), {.test = test, .grade = grade, .path = &path},
                                    test_ray.direction);
  std::vector<std::uint8_t> bits((n + 7) / 8);
  any_hits(test_ray, triangles, bits);
  for (std::size_t i = 0; i < n; ++i) {
    soup.hit[i] = bits[i / 8] >> i % 8 & 1u;
    if (soup.clearly_wrong(i)) return state.SkipWithError("wrong decision");
  }
  for (auto _ : state) {
    any_hits(test_ray, triangles, bits);
    benchmark::ClobberMemory();
  }
  set_items(state, n);
}

void ray_boxes(benchmark::State& state, const Path& path, std::size_t n) {
  Soup soup(n);
  std::array<std::vector<float>, 3> lo, hi;
  BoxArrays boxes{};
  boxes.size = n;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < n; ++i) {
      lo[a].push_back(std::fmin(soup.corner[0][a][i], soup.corner[1][a][i]));
      hi[a].push_back(std::fmax(soup.corner[0][a][i], soup.corner[1][a][i]));
    }
    boxes.lo[a] = lo[a].data();
    boxes.hi[a] = hi[a].data();
  }
  std::vector<std::uint8_t> bits((n + 7) / 8);
  std::vector<float> nearest(n), farthest(n);
  const BoxOptions options{.path = &path};
  intervals(test_ray, boxes, bits, nearest, farthest, options);
  for (std::size_t i = 0; i < n; ++i) {
    double entry = 0.0, exit = INFINITY;
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = test_ray.direction[a], o = test_ray.origin[a];
      entry = std::fmax(entry, (lo[a][i] - o) / d);  // all directions are positive
      exit = std::fmin(exit, (hi[a][i] - o) / d);
    }
    if (std::fabs(entry - exit) > 1e-5 && (entry <= exit) != ((bits[i / 8] >> i % 8 & 1u) != 0))
      return state.SkipWithError("wrong decision");
  }
  for (auto _ : state) {
    intervals(test_ray, boxes, bits, nearest, farthest, options);
    benchmark::ClobberMemory();
  }
  set_items(state, n);
}

void register_rows(const Path& path) {
  const std::string name = path.name;
  constexpr std::size_t n = 1024;
  const std::string suffix = "/" + name + "/" + std::to_string(n);
  for (const TriangleTestInfo& info : triangle_tests)
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      benchmark::RegisterBenchmark(
          ("triangle/" + std::string(info.name) + "_" +
           std::string(grade_names[static_cast<std::size_t>(grade)]) + suffix)
              .c_str(),
          [&path, test = info.test, grade](benchmark::State& s) { ray_triangles(s, path, test, grade, n); });
  benchmark::RegisterBenchmark(("box/conservative_slab" + suffix).c_str(),
                               [&path](benchmark::State& s) { ray_boxes(s, path, n); });
}

}  // namespace
}  // namespace raylanes::bench

int main(int argc, char** argv) {
  for (const raylanes::Path& path : raylanes::paths())
    if (raylanes::supported(path)) {
      raylanes::bench::register_root_rows(path);
      raylanes::bench::register_rows(path);
    }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

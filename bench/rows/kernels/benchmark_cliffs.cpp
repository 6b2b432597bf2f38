#include "benchmark_cliffs.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <raylanes/raylanes.hpp>
#include <raylanes/roots.hpp>

#include "../../support/scenes/shapes.hpp"
#include "benchmark_roots.hpp"

namespace raylanes::bench {
namespace {

constexpr std::uint32_t cells = 500;

// Corners at whole numbers, hills 40 high or none, and a size.
const Bvh& ground(bool is_flat) {
  const auto make = [](double height) {
    Mesh mesh;
    append_grid(mesh, cells, cells, [&](double u, double v) {
      return Double3{u * cells, height * std::sin(u * 9) * std::cos(v * 11), v * cells};
    });
    return Bvh(mesh);
  };
  static const Bvh terrain = make(40), floor = make(0);
  return is_flat ? floor : terrain;
}

Mesh ball_of(int levels, double size) {
  Mesh mesh;
  append_icosphere(mesh, {0, 0, 0}, size, levels);
  return mesh;
}

Mesh soup_of(std::size_t triangles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-1.0f, 1.0f), edge(-0.02f, 0.02f);
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Float3 middle{place(random), place(random), place(random)};
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back({middle[0] + edge(random), middle[1] + edge(random), middle[2] + edge(random)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// --- One call each.

void trace_down(benchmark::State& state, double offset, TriangleTest test) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> column(1, cells - 1);
  std::vector<Ray> rays(4096);
  for (Ray& ray : rays) {
    ray.origin = {static_cast<float>(column(random) + offset), 100,
                  static_cast<float>(column(random) + offset / 2)};
    ray.direction = {0, -1, 0};
  }
  const Bvh& tree = ground(false);
  time_calls(state, rays.size(), [&] {
    for (const Ray& ray : rays) benchmark::DoNotOptimize(tree.closest(ray, {.test = test}));
  });
}

void trace_along_floor(benchmark::State& state, float height, TriangleTest test) {
  std::vector<Ray> rays(16);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].origin = {-1, height, 3.0f + 29.0f * static_cast<float>(i)};
    rays[i].direction = {1, 0, 0};
  }
  const Bvh& tree = ground(true);
  time_calls(state, rays.size(), [&] {
    for (const Ray& ray : rays) benchmark::DoNotOptimize(tree.closest(ray, {.test = test}));
  });
}

void find_closest(benchmark::State& state, float radii) {
  static const Bvh tree(ball_of(7, 1));
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::vector<Float3> points(16);
  for (Float3& p : points) {
    p = {normal(random), normal(random), normal(random)};
    const float scale = radii / std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (float& x : p) x *= scale;
  }
  std::vector<ClosestPoint> found(points.size());
  time_calls(state, points.size(), [&] { tree.closest_points(points, found); });
}

void number_a_soup(benchmark::State& state) {
  static const Mesh soup = soup_of(100'000);
  const std::vector<Float3> points{{0, 0, 0}};
  std::vector<float> numbers(1);
  for (auto _ : state) {
    state.PauseTiming();
    Bvh tree(soup);
    state.ResumeTiming();
    tree.winding_numbers(points, numbers);
  }
  state.SetItemsProcessed(state.iterations());
}

void trace_a_ball(benchmark::State& state, float size) {
  const Bvh tree(ball_of(5, static_cast<double>(size)));
  std::mt19937 random(4);
  std::uniform_real_distribution<float> place(-0.8f, 0.8f);
  std::vector<Ray> rays(256);
  for (Ray& ray : rays) {
    ray.origin = {place(random) * size, place(random) * size, -2 * size};
    ray.direction = {place(random), place(random), 2};
  }
  time_calls(state, rays.size(), [&] {
    for (const Ray& ray : rays) benchmark::DoNotOptimize(tree.closest(ray));
  });
}

// A share of numbers is `special`. In the first-level cache, aligned to its lines.
constexpr std::size_t max_roots = 3072;
using Roots = void (*)(std::span<const float>, std::span<float>);
void take_roots(benchmark::State& state, Roots roots, std::size_t n, double share, float special) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-20, 20), unit(0, 1);
  alignas(64) static float in[max_roots], out[max_roots];
  const std::span<float> x(in, n), y(out, n);
  for (float& number : x)
    number = unit(random) < share ? special : static_cast<float>(std::exp2(exponent(random)));
  time_calls(state, n, [&] { roots(x, y); });
}

// --- The table.

struct Case {
  std::string name;
  std::function<void(benchmark::State&)> run;
};

std::vector<Case> rays_and_points() {
  std::vector<Case> cases;
  for (const auto& [name, test] :
       {std::pair{"exact", TriangleTest::exact}, std::pair{"watertight", TriangleTest::watertight}}) {
    const auto add = [&, test = test, name = name](const char* what, auto run) {
      cases.push_back({std::string(what) + '/' + name, [=](benchmark::State& state) { run(state, test); }});
    };
    add("down/corners", [](benchmark::State& state, TriangleTest t) { trace_down(state, 0, t); });
    add("down/cells", [](benchmark::State& state, TriangleTest t) { trace_down(state, 0.3, t); });
    add("floor/in_plane", [](benchmark::State& state, TriangleTest t) { trace_along_floor(state, 0, t); });
    add("floor/above", [](benchmark::State& state, TriangleTest t) { trace_along_floor(state, 5e-4f, t); });
  }
  for (const int power : {0, 1, 2, 3, 4, 5, 6})
    cases.push_back({"closest/" + std::to_string(power), [=](benchmark::State& state) {
                       find_closest(state, 2 * std::pow(10.0f, static_cast<float>(power)));
                     }});
  cases.push_back({"winding/first", number_a_soup});
  for (const int power : {0, -18, -22, -26, -30, -34, -36})
    cases.push_back({"size/" + std::to_string(power), [=](benchmark::State& state) {
                       trace_a_ball(state, std::pow(10.0f, static_cast<float>(power)));
                     }});
  return cases;
}

template <Accuracy accuracy>
void within(std::span<const float> x, std::span<float> y) {
  sqrt(x, y, accuracy);
}

std::vector<Case> roots() {
  const std::pair<const char*, Roots> ways[] = {
      {"instruction", [](std::span<const float> x, std::span<float> y) { sqrt(x, y, SqrtMethod::hardware); }},
      {"correctly_rounded", within<Accuracy::correctly_rounded>},
      {"within_1_ulp", within<Accuracy::within_1_ulp>},
      {"within_2^-22", within<Accuracy::within_2_to_minus_22>},
      {"within_2^-11", within<Accuracy::within_2_to_minus_11>},
      {"reciprocal_root", [](std::span<const float> x, std::span<float> y) { rsqrt(x, y); }}};
  std::vector<Case> cases;
  for (const auto& [name, way] : ways)
    for (const auto& [special, number] : {std::pair{"zeros", 0.0f}, std::pair{"subnormals", 1e-40f}})
      for (const double share : {0.0, 1e-4, 1e-3, 0.01, 0.05, 0.2, 1.0})
        cases.push_back({std::string("roots/") + name + '/' + special + '/' + std::to_string(share),
                         [=, way = way, number = number](benchmark::State& state) {
                           take_roots(state, way, max_roots, share, number);
                         }});
  const std::pair<const char*, Roots> short_ways[] = {{"std",
                                                       [](std::span<const float> x, std::span<float> y) {
                                                         for (std::size_t i = 0; i < x.size(); ++i)
                                                           y[i] = std::sqrt(x[i]);
                                                       }},
                                                      {"raylanes", within<Accuracy::correctly_rounded>}};
  for (const auto& [name, way] : short_ways)
    for (const std::size_t n : {1u, 2u, 4u, 8u, 16u, 32u, 64u})
      cases.push_back({std::string("short/") + name + '/' + std::to_string(n),
                       [=, way = way](benchmark::State& state) { take_roots(state, way, n, 0, 0); }});
  return cases;
}

}  // namespace

void register_cliff_rows() {
  for (const std::vector<Case>& cases : {rays_and_points(), roots()})
    for (const Case& one : cases) benchmark::RegisterBenchmark(("cliff/" + one.name).c_str(), one.run);
}

}  // namespace raylanes::bench

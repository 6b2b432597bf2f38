#include <benchmark/benchmark.h>

#include <random>

#include <raylanes/raylanes.hpp>

#include "../../support/scenes/shapes.hpp"
#include "../roots/benchmark_roots.hpp"

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

// From inside a ball through its triangles, their edges or their corners: between corner 0 and the point at u and v.
void trace_from_inside(benchmark::State& state, const Double3& centre, float u, float v, TriangleTest test) {
  const double size = centre[0] == 0 ? 1 : 2;
  Mesh ball;
  append_icosphere(ball, centre, size, 7);
  const Bvh tree(ball);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.4, 0.4);
  std::vector<Ray> rays(4096);
  for (Ray& ray : rays) {
    const Index3& triangle = ball.triangles[random() % ball.triangles.size()];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto corner = [&](std::size_t k) { return ball.vertices[triangle[k]][axis]; };
      ray.origin[axis] = static_cast<float>(centre[axis] + size * place(random));
      ray.direction[axis] =
          corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0)) - ray.origin[axis];
    }
  }
  time_calls(state, rays.size(), [&] {
    for (const Ray& ray : rays) benchmark::DoNotOptimize(tree.closest(ray, {.test = test}));
  });
}

// --- The table.

std::vector<BenchmarkCase> rays_and_points() {
  std::vector<BenchmarkCase> cases;
  for (const auto& [name, test] :
       {std::pair{"exact", TriangleTest::exact}, std::pair{"watertight", TriangleTest::watertight}}) {
    const auto add = [&, test = test, name = name](const char* what, auto run) {
      cases.push_back(
          {std::string("cliff/") + what + '/' + name, [=](benchmark::State& state) { run(state, test); }});
    };
    add("down/corners", [](benchmark::State& state, TriangleTest t) { trace_down(state, 0, t); });
    add("down/cells", [](benchmark::State& state, TriangleTest t) { trace_down(state, 0.3, t); });
    const auto add_inside = [&](const char* what, const Double3& centre, float u, float v) {
      add(what, [=](benchmark::State& state, TriangleTest t) { trace_from_inside(state, centre, u, v, t); });
    };
    add_inside("inside/triangles", {0, 0, 0}, 0.3f, 0.4f), add_inside("inside/edges", {0, 0, 0}, 0.3f, 0);
    add_inside("inside/corners", {0, 0, 0}, 0, 0);
    add_inside("inside/far_triangles", {148376, 1234, -223423}, 0.3f, 0.4f);
    add_inside("inside/far_corners", {148376, 1234, -223423}, 0, 0);
    add("floor/in_plane", [](benchmark::State& state, TriangleTest t) { trace_along_floor(state, 0, t); });
    add("floor/above", [](benchmark::State& state, TriangleTest t) { trace_along_floor(state, 5e-4f, t); });
  }
  for (const int power : {0, 1, 2, 3, 4, 5, 6})
    cases.push_back({"cliff/closest/" + std::to_string(power), [=](benchmark::State& state) {
                       find_closest(state, 2 * std::pow(10.0f, static_cast<float>(power)));
                     }});
  cases.push_back({"cliff/winding/first", number_a_soup});
  for (const int power : {0, -18, -22, -26, -30, -34, -36})
    cases.push_back({"cliff/size/" + std::to_string(power), [=](benchmark::State& state) {
                       trace_a_ball(state, std::pow(10.0f, static_cast<float>(power)));
                     }});
  return cases;
}

}  // namespace

void register_cliff_rows() {
  for (const std::vector<BenchmarkCase>& cases : {rays_and_points(), root_cliffs(), root_lengths()})
    for (const BenchmarkCase& one : cases) benchmark::RegisterBenchmark(one.name.c_str(), one.run);
}

}  // namespace raylanes::bench

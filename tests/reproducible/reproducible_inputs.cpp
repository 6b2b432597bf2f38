#include "reproducible_inputs.hpp"

namespace raylanes::testing {
namespace {

using bench::between, bench::point_around, bench::ray_through, bench::SplitMix;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr Float3 far_away{1e4f, -2e4f, 3e3f};

template <class Number>
void append_specials(std::vector<Number>& numbers) {
  using Limits = std::numeric_limits<Number>;
  for (const Number x : {Number(0), Limits::denorm_min(), Limits::min(), Limits::min() / 2, Limits::max(),
                         Number(1), Number(1) - Limits::epsilon() / 2, Number(1) + Limits::epsilon(),
                         Number(2), Number(4), Limits::infinity(), Limits::quiet_NaN()}) {
    numbers.push_back(x);
    numbers.push_back(-x);
  }
}

int below(SplitMix& random, std::size_t count) {
  return static_cast<int>(random.uniform() * static_cast<double>(count));
}

double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

// Some see nothing: what is not finite, no direction, no segment.
void spoil(Ray& ray, int kind) {
  const float bad[] = {nan, infinity, -infinity};
  const auto axis = static_cast<std::size_t>(kind % 3);
  if (kind < 3) ray.origin[axis] = bad[axis];
  if (kind >= 3 && kind < 6) ray.direction[axis] = bad[axis];
  if (kind == 6) ray.direction = {0, 0, 0};
  if (kind == 7) ray.tmin = nan;
  if (kind == 8) ray.tmin = 2, ray.tmax = 1;
}

}  // namespace

std::vector<float> fixed_floats() {
  std::vector<float> numbers;
  for (std::uint32_t i = 0; i < 1u << 16; ++i) numbers.push_back(std::bit_cast<float>(i * 65521u + (i >> 3)));
  append_specials(numbers);
  return numbers;
}

std::vector<double> fixed_doubles() {
  std::vector<double> numbers;
  SplitMix random(1);
  for (int i = 0; i < 20000; ++i) numbers.push_back(std::bit_cast<double>(random.next()));
  append_specials(numbers);
  return numbers;
}

std::vector<Triangle> fixed_triangles() {
  std::vector<Triangle> triangles;
  SplitMix random(2);
  for (int i = 0; i < 203; ++i) {
    const Float3 centre = point_around(random, i % 5 == 4 ? far_away : Float3{}, 2);
    const double size = i % 3 == 0 ? power_of_two(-(i % 14)) : 1;
    Triangle triangle;
    for (Float3& corner : triangle.corner) corner = point_around(random, centre, size);
    if (i % 7 == 6)  // on a lattice, so that rays meet its edges exactly
      for (Float3& corner : triangle.corner)
        for (float& x : corner) x = static_cast<float>(static_cast<int>(2 * x));
    if (i % 29 == 28) triangle.corner[2] = triangle.corner[i % 2 == 0 ? 0 : 1];  // degenerate
    if (i % 61 == 60) triangle.corner[1][1] = nan;
    triangles.push_back(triangle);
  }
  return triangles;
}

std::vector<Box> fixed_boxes() {
  std::vector<Box> boxes;
  SplitMix random(3);
  for (int i = 0; i < 203; ++i) {
    Box box;
    box.lo = point_around(random, i % 5 == 4 ? far_away : Float3{}, 2);
    for (std::size_t axis = 0; axis < 3; ++axis)
      box.hi[axis] = box.lo[axis] + static_cast<float>(between(random, 0.1, 2));
    const auto axis = static_cast<std::size_t>(i % 3);
    if (i % 7 == 6) box.hi[axis] = box.lo[axis];        // flat
    if (i % 11 == 10) box.hi[axis] = box.lo[axis] - 1;  // empty
    if (i % 13 == 12) box.hi[axis] = infinity;
    if (i % 61 == 60) box.lo[axis] = nan;
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<oracle::Sphere> fixed_spheres() {
  std::vector<oracle::Sphere> spheres;
  SplitMix random(4);
  for (int i = 0; i < 203; ++i) {
    const Float3 centre = point_around(random, i % 5 == 4 ? far_away : Float3{}, 2);
    float radius = static_cast<float>(between(random, 0, 1.5));
    if (i % 11 == 10) radius = static_cast<float>(power_of_two(i % 24 - 12));
    if (i % 31 == 30) radius = 0;
    if (i % 37 == 36) radius = -1;
    if (i % 61 == 60) radius = nan;
    spheres.push_back({{centre[0], centre[1], centre[2], signed_square(radius)}});
  }
  return spheres;
}

std::vector<Ray> fixed_rays(std::size_t count) {
  const std::vector<Triangle> targets = fixed_triangles();
  std::vector<Ray> rays;
  SplitMix random(5);
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& target = targets[static_cast<std::size_t>(below(random, targets.size()))];
    const double u = random.uniform(), v = random.uniform() * (1 - u);
    const bool edge = i % 4 == 1, corner = i % 4 == 2;
    const Float3 from = point_around(random, i % 9 == 8 ? far_away : Float3{}, 4);
    Ray ray = ray_through(from, target, corner ? 0 : u, edge || corner ? 0 : v);
    if (i % 8 == 7) {  // along an axis, through the lattice
      ray.direction = {0, 0, 0};
      ray.direction[static_cast<std::size_t>(below(random, 3))] = random.uniform() < 0.5 ? -2.0f : 0.5f;
      for (float& x : ray.origin) x = static_cast<float>(static_cast<int>(x));
    }
    if (i % 16 == 3) ray.direction[i % 3] = i % 32 == 3 ? 0.0f : -0.0f;
    if (i % 5 == 4) ray.tmin = static_cast<float>(between(random, 0, 1.2));
    if (i % 6 == 5) ray.tmax = ray.tmin + static_cast<float>(between(random, 0, 2));
    if (i % 23 == 22) spoil(ray, static_cast<int>(i / 23 % 9));
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace raylanes::testing

// Callers of functions of arrays may let floating-point exceptions trap: no call does, and the traps are there again
// behind it. Trees and scenes: unmasked.cpp.
#include <raylanes/boxes.hpp>
#include <raylanes/points.hpp>
#include <raylanes/roots.hpp>
#include <raylanes/spheres.hpp>

#include "../query_trees.hpp"
#include "traps.hpp"

namespace raylanes::testing {
namespace {

// Roots do not mask. Normal numbers but the largest raise nothing to trap, in arrays that the instruction takes
// and in those that kernels take, tails included.
template <class T>
void take_roots(const Path* path) {
  const T least = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max() / 4;
  for (const T number : {least, 2 * least, T(0.25), T(3), most / 2, most})
    for (const std::size_t size : {1, 16, 17, 100, 1000}) {
      std::vector<T> x(size, T(3)), y(size);
      x[size / 2] = number;
      const Traps traps;
      for (const AccuracyInfo& info : accuracies) {
        sqrt(std::span<const T>(x), std::span<T>(y), info.accuracy, path);
        reciprocal(std::span<const T>(x), std::span<T>(y), info.accuracy, path);
        if (sizeof(T) == sizeof(float) || info.accuracy != Accuracy::correctly_rounded)
          rsqrt(std::span<const T>(x), std::span<T>(y), info.accuracy, path);
      }
    }
}

TEST(Trapped, roots_of_normal_numbers_are_taken) {
  if (!Traps::are_there()) GTEST_SKIP() << no_traps;
  on_each_path([&](const Path* path, int) {
    take_roots<float>(path);
    take_roots<double>(path);
  });
}

// The flags of arrays with one special number, as docs/guide/arrays.md names them. Methods refine estimates of it
// before they see that it is special: they may raise invalid and overflow. The instruction raises what IEEE 754 says.
template <class T, class Method>
void raise_flags(const Path* path, Method hardware) {
  const T infinity = std::numeric_limits<T>::infinity(), least = std::numeric_limits<T>::denorm_min();
  const auto flags_of = [](const auto& call) {
    feclearexcept(FE_ALL_EXCEPT);
    call();
    return fetestexcept(usual_traps);
  };
  for (const T number : {T(0), -T(0), infinity, -infinity, T(-2), least, std::numeric_limits<T>::quiet_NaN()})
    for (const std::size_t size : {1, 16, 17, 100, 1000})
      for (const AccuracyInfo& info : accuracies) {
        std::vector<T> values(size, T(3)), y(size);
        values[size / 2] = number;
        const std::span<const T> x(values);
        const int of_roots = flags_of([&] { sqrt(x, std::span<T>(y), info.accuracy, path); });
        EXPECT_EQ(of_roots & FE_DIVBYZERO, 0) << number << " of " << size << " on " << path->name;
        const bool is_exact = number >= 0 || std::isnan(number);
        // Doubles go to estimates sooner.
        const std::size_t few = sizeof(T) == 4 || info.accuracy == Accuracy::correctly_rounded ? 16 : 1;
        if (size <= few && is_exact) {
          EXPECT_EQ(of_roots, 0) << number << " of " << size;
        }
        const int of_reciprocals = flags_of([&] { reciprocal(x, std::span<T>(y), info.accuracy, path); });
        if (number != 0) {
          EXPECT_EQ(of_reciprocals & FE_DIVBYZERO, 0) << number << " on " << path->name;
        }
        const int of_instruction = flags_of([&] { sqrt(x, std::span<T>(y), hardware, path); });
        EXPECT_EQ(of_instruction, number < 0 ? FE_INVALID : 0) << number << " on " << path->name;
      }
}

TEST(Trapped, roots_of_special_numbers_raise_the_flags_of_the_page) {
  on_each_path([&](const Path* path, int) {
    raise_flags<float>(path, SqrtMethod::hardware);
    raise_flags<double>(path, DoubleSqrtMethod::hardware);
  });
}

TEST(Trapped, arrays_are_asked) {
  if (!Traps::are_there()) GTEST_SKIP() << no_traps;
  constexpr std::size_t n = 37;
  std::vector<float> number[9], out[6];
  Random random(505);
  for (std::vector<float>& numbers : number)
    for (std::size_t i = 0; i < n; ++i) numbers.push_back(random.number(-2, 2));
  for (std::vector<float>& numbers : out) numbers.resize(n);
  const auto at = [&](int k) { return static_cast<const float*>(number[k].data()); };
  const TriangleArrays triangles{{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}}, n};
  const BoxArrays boxes{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, n};
  const SphereArrays spheres{{at(0), at(1), at(2)}, at(3), n};
  const RayArrays rays{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, at(6), at(7), n};
  std::vector<std::uint8_t> bits((n + 7) / 8);
  const Ray along_axis = make_ray({0, 0, 0}, {1, 0, 0}), anywhere = make_ray({0, 0, 0}, {1, 0.5f, 0.25f});
  on_each_path([&](const Path* path, int) {
    const Traps traps;
    for (const Ray& ray : {along_axis, anywhere})
      for (const Grade grade : {Grade::reproducible, Grade::fast}) {
        for (const TriangleTestInfo& info : triangle_tests) {
          const TriangleOptions options{info.test, grade, path};
          closest_hit(ray, triangles, options), hit_mask(ray, triangles, bits, options);
          closest_hits(rays, floor_triangle, {bits, out[0], out[1], out[2]}, options);
        }
        for (const BoxTestInfo& info : box_tests) {
          hit_mask(ray, boxes, bits, {info.test, grade, path});
          intervals(ray, boxes, bits, out[0], out[1], {info.test, grade, path});
          hit_mask(rays, {{-1, -1, -1}, {1, 1, 1}}, bits, {info.test, grade, path});
        }
        for (const SphereTestInfo& info : sphere_tests) {
          hit_mask(ray, spheres, bits, {info.test, grade, path});
          closest_hit(ray, spheres, {info.test, grade, path});
          distances(ray, spheres, bits, out[0], out[1], {info.test, grade, path});
        }
        line_hits(ray, spheres, bits, {.path = path});
      }
    closest_point({1, 2, 3}, triangles, {.path = path});
    distances({1, 2, 3}, triangles, {out[0], {out[1], out[2], out[3]}, out[4], out[5]}, {.path = path});
  });
}

}  // namespace
}  // namespace raylanes::testing

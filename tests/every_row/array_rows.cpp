// The rows of roots, triangles, boxes and spheres.
#include <raylanes/boxes.hpp>
#include <raylanes/prepared_ray.hpp>
#include <raylanes/roots.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../dispatch/table/boxes.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "../../dispatch/table/spheres.hpp"
#include "../../dispatch/table/triangles.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "every_row.hpp"

namespace raylanes::testing {
namespace {

// --- Roots.

// Reproducible methods give the bits of scalar, others of what is positive and normal what they promise.
template <class T, class Method, std::size_t methods>
void check_roots(EveryRow& every, const RootRows<T, Method, methods>& rows,
                 const RootRows<T, Method, methods>& of_scalar,
                 const std::array<RootMethodInfo<Method>, methods>& infos,
                 long double (*exact)(long double)) {
  Source source(4);
  std::vector<T> x;
  for (std::size_t i = 0; i < most; ++i)
    x.push_back(static_cast<T>(std::exp2(double{source.number(-100, 100)})));
  std::vector<T> with_specials = x;
  for (std::size_t i = 0; i < 6; ++i)
    with_specials[11 * i + 2] = std::array{T(0),
                                           T(-0.0),
                                           std::numeric_limits<T>::infinity(),
                                           T(-1),
                                           std::numeric_limits<T>::quiet_NaN(),
                                           3 * std::numeric_limits<T>::denorm_min()}[i];
  for (std::size_t method = 0; method < methods; ++method) {
    if (!every.offers(rows.by[method], of_scalar.by[method])) continue;
    const RootPromise& promise = infos[method].promise;
    const double ulps = every.path().has_fma() ? promise.max_ulp : promise.max_ulp_without_fma;
    for (const std::size_t n : sizes) {
      std::vector<T> y(most, T(untouched)), z = y;
      const std::vector<T>& in = promise.reproducible ? with_specials : x;
      rows.by[method](in.data(), y.data(), n);
      of_scalar.by[method](in.data(), z.data(), n);
      for (std::size_t i = 0; i < most; ++i) {
        if (promise.reproducible || i >= n) {
          EXPECT_TRUE(same_bytes(y[i], z[i]) || (y[i] != y[i] && z[i] != z[i]))
              << promise.name << ' ' << in[i];
          continue;
        }
        const long double root = exact(static_cast<long double>(x[i]));
        const int last_place = std::ilogb(root) - (std::numeric_limits<T>::digits - 1);
        // A double of 11 bits more is a thousandth of an ULP from the exact root at most.
        EXPECT_LE(std::abs(std::ldexp(static_cast<long double>(y[i]) - root, -last_place)), ulps + 0.001)
            << promise.name << ' ' << in[i];
      }
    }
  }
}

// A row that wide paths alone have: the bits of the instruction.
void check_roots_in_two_passes(EveryRow& every) {
  const ArrayFunction<float> roots = kernels_of(every.path()).roots.sqrt_in_two_passes;
  EXPECT_EQ(roots != nullptr, every.path().lanes == 16);
  if (roots == nullptr) return;
  every.count(1);
  Source source(5);
  std::vector<float> x, y(700, -7.0f);
  for (std::size_t i = 0; i < y.size(); ++i) x.push_back(std::exp2(source.number(-148, 127)));
  x[300] = -1, x[301] = 0, x[302] = -0.0f, x[303] = std::numeric_limits<float>::infinity();
  for (const std::size_t n : {x.size() - 1, std::size_t{113}, std::size_t{7}, std::size_t{0}}) {
    std::fill(y.begin(), y.end(), -7.0f);
    roots(x.data(), y.data(), n);
    for (std::size_t i = 0; i < y.size(); ++i) {
      const float expected = i < n ? std::sqrt(x[i]) : -7.0f;
      EXPECT_TRUE(same_bytes(y[i], expected) || (y[i] != y[i] && expected != expected)) << x[i];
    }
  }
}

TEST_P(EveryRow, of_roots) {
  const RootKernels &rows = kernels_of(path()).roots, &of_scalar = kernels_of(scalar()).roots;
  const auto root = [](long double x) { return std::sqrt(x); };
  const auto reciprocal_root = [](long double x) { return 1 / std::sqrt(x); };
  const auto reciprocal = [](long double x) { return 1 / x; };
  check_roots(*this, rows.sqrt, of_scalar.sqrt, sqrt_methods, root);
  check_roots_in_two_passes(*this);
  check_roots(*this, rows.rsqrt, of_scalar.rsqrt, rsqrt_methods, reciprocal_root);
  check_roots(*this, rows.reciprocal, of_scalar.reciprocal, reciprocal_methods, reciprocal);
  check_roots(*this, rows.double_sqrt, of_scalar.double_sqrt, double_sqrt_methods, root);
  check_roots(*this, rows.double_rsqrt, of_scalar.double_rsqrt, double_rsqrt_methods, reciprocal_root);
  check_roots(*this, rows.double_reciprocal, of_scalar.double_reciprocal, double_reciprocal_methods,
              reciprocal);
  expect_all_called(rows.sqrt.by), expect_all_called(rows.rsqrt.by), expect_all_called(rows.reciprocal.by);
  expect_all_called(rows.double_sqrt.by), expect_all_called(rows.double_rsqrt.by);
  expect_all_called(rows.double_reciprocal.by);
}

// --- Tests over arrays.

// At most a quarter of the results compared in the fast grade may be too near to a decision.
struct Share {
  std::size_t compared = 0, all = 0;
  ~Share() { EXPECT_GE(4 * compared, 3 * all); }
};

struct Answers {
  std::vector<std::uint8_t> bits = std::vector<std::uint8_t>(most / 8 + 1, 0);
  std::vector<float> number[3] = {std::vector<float>(most, untouched), std::vector<float>(most, untouched),
                                  std::vector<float>(most, untouched)};
  Hit nearest;
  std::span<std::uint8_t> bits_of(std::size_t n) { return {bits.data(), (n + 7) / 8}; }
  std::span<float> numbers(std::size_t k, std::size_t n) { return {number[k].data(), n}; }
  bool bit(std::size_t i) const { return (bits[i / 8] >> i % 8 & 1) != 0; }
};

void compare(const Answers& mine, const Answers& scalar, const std::vector<double>& margins, Share& share,
             const std::string& name) {
  for (std::size_t i = 0; i < most; ++i) {
    ++share.all;
    if (margins[i] == doubtful) continue;
    ++share.compared;
    EXPECT_EQ(mine.bit(i), scalar.bit(i)) << name << " element " << i;
    for (std::size_t k = 0; k < 3; ++k) expect_near(mine.number[k][i], scalar.number[k][i], margins[i], name);
  }
  compare_nearest(mine.nearest, scalar.nearest, margins, name);
}

// ask(options, n, answers) of a path and of scalar, for all sizes, with and without a mask, and in both grades.
template <class Options, class Ask, class Pair>
void check(const Path& path, Options options, const std::string& name, bool exact, Ask ask, Pair pair,
           Share& share) {
  for (const Grade grade : {Grade::reproducible, Grade::fast})
    for (const LaneBits active : {LaneBits(nullptr), LaneBits(some_lanes.data())})
      for (const std::size_t n : sizes) {
        Answers mine, scalar;
        options.grade = grade, options.active = active;
        options.path = &path, ask(options, n, mine);
        options.path = &paths().front(), ask(options, n, scalar);
        compare(mine, scalar, margins_of(exact || grade == Grade::reproducible, most, pair), share, name);
      }
}

// One ray and many, and many rays and one.
template <class Options, class Rays, class Primitives, class OneRay, class OnePrimitive>
void check_shapes(const Path& path, const Options& options, const std::string& name, bool exact,
                  const Rays& rays, const Primitives& all, OneRay of_ray, OnePrimitive of_primitive) {
  Share share;
  for (std::size_t i = 0; i < most; i += 6) {
    const auto& ray = rays.elements[i];
    const auto& primitive = all.elements[i];
    check(
        path, options, name + " 1xN", exact,
        [&](const Options& o, std::size_t n, Answers& a) { of_ray(ray, all.arrays(n), o, n, a); },
        [&](std::size_t k) { return margin_of(ray, all.elements[k]); }, share);
    check(
        path, options, name + " Nx1", exact,
        [&](const Options& o, std::size_t n, Answers& a) {
          of_primitive(rays.arrays(n), primitive, o, n, a);
        },
        [&](std::size_t k) { return margin_of(rays.elements[k], primitive); }, share);
  }
}

// ask(ray, prepared ray, n) for as many primitives as prepared rays take.
template <class Ask>
void check_prepared(const Path& path, const Ask& ask) {
  for (const Ray& ray : RayColumns().elements)
    for (const std::size_t n : sizes)
      if (n <= PreparedRay::max_primitives) ask(ray, PreparedRay(ray, &path), n);
}

template <class Columns, class Options>
void check_prepared_closest(const Path& path, const Columns& columns, Options by_scalar) {
  by_scalar.path = &paths().front();
  check_prepared(path, [&](const Ray& ray, const PreparedRay& prepared, std::size_t n) {
    const auto arrays = columns.arrays(n);
    EXPECT_TRUE(same_bytes(closest_hit(prepared, arrays), closest_hit(ray, arrays, by_scalar)));
  });
}

// By the public calls: each is one row, which they do not ask for null.
TEST_P(EveryRow, of_triangles) {
  const TriangleColumns triangles;
  const Float3 one_direction{0.3f, -0.2f, 0.9f};
  for (const TriangleTestInfo& info : triangle_tests) {
    const RayColumns rays(info.test == TriangleTest::directional ? &one_direction : nullptr);
    check_shapes(
        path(), TriangleOptions{.test = info.test}, info.name, info.test == TriangleTest::exact, rays,
        triangles,
        [](const Ray& ray, const TriangleArrays& all, const auto& options, std::size_t n, Answers& a) {
          hit_mask(ray, all, a.bits_of(n), options);
          a.nearest = closest_hit(ray, all, options);
        },
        [](const RayArrays& all, const Triangle& triangle, const auto& options, std::size_t n, Answers& a) {
          closest_hits(all, triangle, {a.bits_of(n), a.numbers(0, n), a.numbers(1, n), a.numbers(2, n)},
                       options);
          Answers yes_or_no;
          hit_mask(all, triangle, yes_or_no.bits_of(n), options);
          EXPECT_EQ(yes_or_no.bits, a.bits);
        });
    count(5 * grade_names.size());
  }
  check_prepared_closest(path(), triangles, TriangleOptions{.test = TriangleTest::exact});
  count(1);
  expect_all_counted(kernels_of(path()).triangles);
}

// Boxes and spheres, whose query writes two numbers; the other one whether there is a hit.
template <class Query>
auto ask_with(const Query& query) {
  return [query](const auto& rays, const auto& primitives, const auto& options, std::size_t n, Answers& a) {
    query(rays, primitives, a.bits_of(n), a.numbers(0, n), a.numbers(1, n), options);
    Answers yes_or_no;
    hit_mask(rays, primitives, yes_or_no.bits_of(n), options);
    EXPECT_EQ(yes_or_no.bits, a.bits);
  };
}

TEST_P(EveryRow, of_boxes) {
  const auto ask = ask_with([](const auto&... call) { intervals(call...); });
  for (const BoxTestInfo& info : box_tests) {
    check_shapes(path(), BoxOptions{.test = info.test}, info.name, false, RayColumns(), BoxColumns(), ask,
                 ask);
    count(4 * grade_names.size());
  }
  const BoxColumns boxes;
  check_prepared(path(), [&](const Ray& ray, const PreparedRay& prepared, std::size_t n) {
    Answers mine, scalar;
    const std::uint32_t bits = hits(prepared, boxes.arrays(n), mine.numbers(0, n));
    intervals(ray, boxes.arrays(n), scalar.bits_of(n), scalar.numbers(0, n), scalar.numbers(1, n),
              {.test = BoxTest::conservative, .path = &paths().front()});
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ((bits >> i & 1) != 0, scalar.bit(i)) << "prepared, element " << i;
      const float expected = scalar.bit(i) ? scalar.number[0][i] : infinity;
      EXPECT_EQ(mine.number[0][i], expected) << "prepared, element " << i;
    }
  });
  count(1);
  expect_all_counted(kernels_of(path()).boxes);
}

TEST_P(EveryRow, of_spheres) {
  const auto ask = ask_with([](const auto&... call) { distances(call...); });
  const auto ask_more = [&](const Ray& ray, const SphereArrays& all, const auto& options, std::size_t n,
                            Answers& a) {
    ask(ray, all, options, n, a);
    a.nearest = closest_hit(ray, all, options);
  };
  const auto ask_lines = [](const Ray& ray, const SphereArrays& all, const auto& options, std::size_t n,
                            Answers& a) { line_hits(ray, all, a.bits_of(n), options); };
  for (const SphereTestInfo& info : sphere_tests) {
    const SphereOptions options{.test = info.test};
    check_shapes(path(), options, info.name, false, RayColumns(), SphereColumns(), ask_more, ask);
    count(5 * grade_names.size());
  }
  check_shapes(path(), SphereOptions{}, "line", false, RayColumns(), SphereColumns(), ask_lines, ask);
  count(grade_names.size());
  check_prepared_closest(path(), SphereColumns(), SphereOptions{.test = SphereTest::perpendicular});
  count(2);  // that which prepares, too
  expect_all_counted(kernels_of(path()).spheres);
}

INSTANTIATE_TEST_SUITE_P(On, EveryRow, ::testing::ValuesIn(supported_paths()), path_name);

}  // namespace
}  // namespace raylanes::testing

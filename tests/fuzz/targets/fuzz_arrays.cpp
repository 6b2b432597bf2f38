// Every triangle, box and sphere test over arrays, and prepared rays, on any path against the scalar one: the
// same bits in the reproducible grade (without FTZ and DAZ: with them the tests promise no bits); nothing is
// read or written outside the arrays, nor where the mask leaves an element out.
#include <deque>

#include <raylanes/boxes.hpp>
#include <raylanes/prepared_ray.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../../dispatch/table/boxes.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/spheres.hpp"
#include "../../../dispatch/table/triangles.hpp"
#include "../bytes.hpp"
#include "../fence.hpp"
#include "../support.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t most = 600, max_arrays = 48;

// Arrays of this run, each before a forbidden page of its own.
class Arena {
 public:
  Arena() {
    for (std::size_t i = 0; i < max_arrays; ++i) fences_.emplace_back(most * sizeof(float));
  }
  void clear() { used_ = 0; }
  template <class T>
  T* take(std::size_t count) {
    return fences_.at(used_++).template last<T>(count);
  }
  void expect_intact() const {
    for (std::size_t i = 0; i < used_; ++i) fences_[i].expect_intact("an array");
  }

 private:
  std::deque<Fence> fences_;
  std::size_t used_ = 0;
};

Arena& arena() {
  static Arena only;
  return only;
}

std::vector<const float*> soa(Coordinates& coordinates, std::size_t arrays, std::size_t n) {
  std::vector<const float*> all;
  for (std::size_t k = 0; k < arrays; ++k) {
    float* const array = arena().take<float>(n);
    for (std::size_t i = 0; i < n; ++i) array[i] = coordinates();
    all.push_back(array);
  }
  return all;
}

Ray any_ray(Bytes& bytes, Coordinates& coordinates) {
  Ray ray{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    ray.origin[axis] = coordinates(), ray.direction[axis] = coordinates();
  ray.tmin = bytes.chance(128) ? 0.0f : coordinates();
  ray.tmax = bytes.chance(128) ? std::numeric_limits<float>::infinity() : coordinates();
  return ray;
}

// The outputs of a query, filled with a pattern before the call.
constexpr std::uint8_t filling = 0x5a;
struct Answer {
  std::uint8_t* bits;
  float* numbers[3];
  Hit nearest{};

  explicit Answer(std::size_t n) : bits(arena().take<std::uint8_t>((n + 7) / 8)) {
    std::memset(bits, filling, (n + 7) / 8);
    for (float*& array : numbers) {
      array = arena().take<float>(n);
      std::memset(array, filling, 4 * n);
    }
  }
};

bool equal(const Answer& a, const Answer& b, std::size_t n) {
  bool all = std::memcmp(a.bits, b.bits, (n + 7) / 8) == 0 && same(a.nearest.t, b.nearest.t) &&
             same(a.nearest.u, b.nearest.u) && same(a.nearest.v, b.nearest.v) &&
             a.nearest.primitive == b.nearest.primitive;
  for (int k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < n; ++i) all = all && same(a.numbers[k][i], b.numbers[k][i]);
  return all;
}

// One query of a run: how to ask a path, and what it is called.
struct Query {
  std::string name;
  std::function<void(const Path&, Answer&)> ask;
};

struct Setting {
  Bytes& bytes;
  Coordinates coordinates;
  std::size_t n, grade;
  const std::uint8_t* active;
  bool one_ray;

  explicit Setting(Bytes& from) : bytes(from), coordinates(from) {
    n = bytes.chance(230) ? bytes.below(41) : bytes.below(most + 1);
    grade = bytes.below(2);
    one_ray = bytes.chance(128);
    active = nullptr;
    if (!bytes.chance(128)) return;
    auto* const mask = arena().take<std::uint8_t>((n + 7) / 8);
    for (std::size_t i = 0; i < (n + 7) / 8; ++i) mask[i] = bytes.byte();
    active = mask;
  }
  // Elements outside the mask keep the pattern of Answer: scalar is of the same text and would write there too.
  void expect_masked(const Answer& answer, const std::string& name) const {
    if (active == nullptr) return;
    const auto is_out = [&](std::size_t i) { return (active[i / 8] >> i % 8 & 1) == 0; };
    bool wrong = answer.nearest.primitive < n && is_out(answer.nearest.primitive);
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_out(i)) continue;
      wrong = wrong || ((answer.bits[i / 8] ^ filling) >> i % 8 & 1) != 0;
      for (const float* array : answer.numbers)
        wrong = wrong || std::bit_cast<std::uint32_t>(array[i]) != filling * 0x1010101u;
    }
    if (wrong) fail(name + ": an answer of an element that the mask leaves out");
  }
  RayArrays rays() {
    const auto p = soa(coordinates, 8, n);
    return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, p[6], p[7], n};
  }
};

// The numbers that the test reads: prepared from any corners, or any numbers at all.
std::vector<const float*> triangles_for(Setting& s, const TriangleRow& row, std::size_t floats, std::size_t n,
                                        const float* direction) {
  if (s.bytes.chance(64)) return soa(s.coordinates, floats, n);
  const auto corners = soa(s.coordinates, 9, n);
  std::vector<float*> out;
  for (std::size_t k = 0; k < floats; ++k) out.push_back(arena().take<float>(n));
  row.prepare(corners.data(), n, nullptr, direction, out.data());
  return {out.begin(), out.end()};
}

Query triangle_query(Setting& s, const Path& path) {
  const std::size_t test = s.bytes.below(std::size(triangle_tests));
  const bool with_u = s.bytes.chance(128), with_v = s.bytes.chance(128), closest = s.bytes.chance(128);
  const Ray ray = any_ray(s.bytes, s.coordinates);
  const auto row = [test, grade = s.grade](const Path& p) -> const TriangleRow& {
    return kernels_of(p).triangles.row[test][grade];
  };
  const std::string name =
      "triangle " + std::string(triangle_tests[test].name) + (closest ? " closest" : " any");
  const auto floats = static_cast<std::size_t>(triangle_tests[test].floats);
  const LaneBits active = s.active;
  const std::size_t n = s.n;
  if (s.one_ray) {
    const auto triangles = triangles_for(s, row(path), floats, n, &ray.direction[0]);
    return {name + " 1xN", [=](const Path& p, Answer& a) {
              if (closest)
                row(p).closest_of_triangles(ray, triangles.data(), n, active, a.nearest);
              else
                row(p).any_of_triangles(ray, triangles.data(), n, active, a.bits);
            }};
  }
  const auto arrays = triangles_for(s, row(path), floats, 1, &ray.direction[0]);
  std::vector<float> triangle;
  for (const float* array : arrays) triangle.push_back(array[0]);
  const RayArrays rays = s.rays();
  return {name + " Nx1", [=](const Path& p, Answer& a) {
            if (closest)
              row(p).closest_of_rays(rays, triangle.data(), active, a.bits, a.numbers[0],
                                     with_u ? a.numbers[1] : nullptr, with_v ? a.numbers[2] : nullptr);
            else
              row(p).any_of_rays(rays, triangle.data(), active, a.bits);
          }};
}

// Boxes and spheres are asked in the same words: yes or no, or two numbers for each.
template <class RowOf, class AnyOf, class IntervalsOf, class IntervalsOfRays>
Query interval_query(Setting& s, const std::string& name, std::size_t floats, RowOf row, AnyOf any_of,
                     IntervalsOf intervals_of, IntervalsOfRays intervals_of_rays) {
  const bool any = s.bytes.chance(128);
  const LaneBits active = s.active;
  const std::size_t n = s.n;
  if (s.one_ray) {
    const Ray ray = any_ray(s.bytes, s.coordinates);
    const auto primitives = soa(s.coordinates, floats, n);
    return {name + (any ? " any 1xN" : " interval 1xN"), [=](const Path& p, Answer& a) {
              if (any)
                (row(p).*any_of)(ray, primitives.data(), n, active, a.bits);
              else
                (row(p).*intervals_of)(ray, primitives.data(), n, active, a.bits, a.numbers[0], a.numbers[1]);
            }};
  }
  std::vector<float> primitive;
  for (std::size_t k = 0; k < floats; ++k) primitive.push_back(s.coordinates());
  const RayArrays rays = s.rays();
  return {name + (any ? " any Nx1" : " interval Nx1"), [=](const Path& p, Answer& a) {
            if (any)
              row(p).any_of_rays(rays, primitive.data(), active, a.bits);
            else
              (row(p).*intervals_of_rays)(rays, primitive.data(), active, a.bits, a.numbers[0], a.numbers[1]);
          }};
}

Query box_query(Setting& s) {
  const std::size_t test = s.bytes.below(std::size(box_tests)), grade = s.grade;
  return interval_query(
      s, "box " + std::string(box_tests[test].name), 6,
      [=](const Path& p) -> const BoxRow& { return kernels_of(p).boxes.row[test][grade]; },
      &BoxRow::any_of_boxes, &BoxRow::intervals_of_boxes, &BoxRow::intervals_of_rays);
}

// The line's test and the nearest hit are of one ray alone.
Query sphere_query(Setting& s) {
  const std::size_t test = s.bytes.below(std::size(sphere_tests)), grade = s.grade;
  const std::string name = "sphere " + std::string(sphere_tests[test].name);
  const auto row = [=](const Path& p) -> const SphereRow& { return kernels_of(p).spheres.row[test][grade]; };
  if (s.one_ray && s.bytes.chance(128)) {
    const bool line = s.bytes.chance(64);
    const Ray ray = any_ray(s.bytes, s.coordinates);
    return {line ? "sphere line" : name + " closest 1xN",
            [=, spheres = soa(s.coordinates, 4, s.n), n = s.n, active = s.active](const Path& p, Answer& a) {
              if (line)
                kernels_of(p).spheres.line_of_spheres[grade](ray, spheres.data(), n, active, a.bits);
              else
                row(p).closest_of_spheres(ray, spheres.data(), n, active, a.nearest);
            }};
  }
  return interval_query(s, name, 4, row, &SphereRow::any_of_spheres, &SphereRow::distances_of_spheres,
                        &SphereRow::distances_of_rays);
}

// Few primitives and no mask.
Query prepared_query(Setting& s) {
  const std::size_t n = s.n %= PreparedRay::max_primitives + 1, kind = s.bytes.below(3);
  s.active = nullptr, s.grade = 0;
  const Ray ray = any_ray(s.bytes, s.coordinates);
  const float end = s.bytes.chance(128) ? ray.tmax : s.coordinates();
  const auto c = soa(s.coordinates, 9, n);
  return {"prepared ray", [=](const Path& p, Answer& a) {
            PreparedRay prepared(ray, &p);
            prepared.set_tmax(end);
            if (kind == 0) {
              const std::uint32_t bits = hits(prepared, BoxArrays{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, n},
                                              std::span(a.numbers[0], n));
              std::memcpy(a.bits, &bits, (n + 7) / 8);
            } else if (kind == 1) {
              a.nearest = closest_hit(prepared, SphereArrays{{c[0], c[1], c[2]}, c[3], n});
            } else {
              a.nearest = closest_hit(
                  prepared, TriangleArrays{{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}}, n});
            }
          }};
}

Query any_query(Setting& s, const Path& path) {
  switch (s.bytes.below(4)) {
    case 0:
      return box_query(s);
    case 1:
      return sphere_query(s);
    case 2:
      return prepared_query(s);
    default:
      return triangle_query(s, path);
  }
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_arrays(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  arena().clear();
  const Path& path = *bytes.pick(fuzzed_paths());
  const bool flush = bytes.chance(96);
  Setting setting(bytes);
  const Query query = any_query(setting, path);
  Answer answer(setting.n), expected(setting.n);
  {
    const Rounding rounding(flush);
    query.ask(path, answer);
    query.ask(paths().front(), expected);
  }
  arena().expect_intact();
  setting.expect_masked(answer, query.name);
  const bool promised = setting.grade == static_cast<std::size_t>(Grade::reproducible) && !flush;
  if (promised && !equal(answer, expected, setting.n))
    fail(std::string(path.name) + ' ' + query.name + ": " + std::to_string(setting.n) +
         " answers, not those of scalar");
  return 0;
}

#include "kernel_survey.hpp"

#include "../../support/oracles/exact_box.hpp"
#include "../../support/oracles/exact_sphere.hpp"
#include "../../support/oracles/exact_triangle.hpp"
#include "../../support/rays/aim.hpp"
#include "../../support/rulers/undecided_lanes.hpp"
#include "../../support/scenes/splitmix.hpp"
#include "../../support/scenes/vector3.hpp"
#include "integers.hpp"

namespace raylanes::bench {
namespace {

Double3 scene_centre(Aim set) {
  return set == Aim::far ? Double3{1e4, -2e4, 3e3} : Double3{0, 0, 0};
}

// An exact answer: the decision, and up to three numbers in double.
struct Exact {
  bool hit;
  double number[3];
};

struct Answer {
  bool hit;
  float number[3];
};

double ulp_of(double x) {
  return std::ldexp(1.0, std::max(std::ilogb(x), -126) - 23);
}

// Collects one set of one kernel, of boxes or of others.
class Judge {
 public:
  Judge(KernelAccuracy& accuracy, Aim set, bool of_boxes)
      : accuracy_(accuracy), set_(set), of_boxes_(of_boxes) {}
  void add(const Exact& exact, const Answer& answer) {
    ++pairs_;
    if (exact.hit != answer.hit) ++(of_boxes_ && answer.hit ? extra_ : wrong_);
    if (set_ != Aim::uniform || !exact.hit || !answer.hit) return;
    std::optional<double>* const worst[] = {&accuracy_.max_t_ulp, &accuracy_.max_u_ulp, &accuracy_.max_v_ulp};
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::isnan(exact.number[k])) continue;
      const double unit = k == 0 ? ulp_of(exact.number[k]) : 0x1p-23;
      const double error = std::fabs(static_cast<double>(answer.number[k]) - exact.number[k]) / unit;
      // A NaN is the largest error there is.
      *worst[k] = std::max(worst[k]->value_or(0.0),
                           std::isnan(error) ? std::numeric_limits<double>::infinity() : error);
    }
  }
  void finish() {
    accuracy_.wrong_per_million[static_cast<std::size_t>(set_)] = per_million(wrong_);
    if (of_boxes_) accuracy_.extra_per_million[static_cast<std::size_t>(set_)] = per_million(extra_);
  }

 private:
  double per_million(std::size_t count) const {
    return 1e6 * static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(pairs_, 1));
  }

  KernelAccuracy& accuracy_;
  Aim set_;
  bool of_boxes_;
  std::size_t pairs_ = 0, wrong_ = 0, extra_ = 0;
};

constexpr double absent = std::numeric_limits<double>::quiet_NaN();

// --- Triangles

struct TrianglePair {
  Ray ray;
  Triangle triangle;
  Exact exact;
};

TrianglePair triangle_pair(Aim set, SplitMix& random) {
  TrianglePair pair{};
  const Double3 centre = scene_centre(set);
  Double3 corner[3];
  for (std::size_t c = 0; c < 3; ++c) {
    const Float3 p = to_float(point_around(random, centre, 1));
    corner[c] = to_double(p);
    pair.triangle.corner[c] = p;
  }
  const double along = random.uniform();
  const double u = set == Aim::vertices ? 0 : set == Aim::edges ? along : 1.6 * along - 0.3;
  const double v = set == Aim::vertices || set == Aim::edges ? 0 : between(random, -0.3, 1.3);
  const auto point_of_plane = [&](double from_second, double from_third) {
    Double3 point;
    for (std::size_t k = 0; k < 3; ++k)
      point[k] = corner[0][k] * (1 - from_second - from_third) + corner[1][k] * from_second +
                 corner[2][k] * from_third;
    return point;
  };
  const Double3 from = set == Aim::plane ? point_of_plane(between(random, -3, -1), between(random, -3, 3))
                                         : point_around(random, centre, 2);
  pair.ray = ray_towards(
      from, set == Aim::plane ? point_of_plane(along / 2, random.uniform() / 2) : point_of_plane(u, v));
  const oracle::ExactTriangleTest exact = oracle::exact_triangle(pair.ray, pair.triangle);
  pair.exact = {exact.hit, {exact.t.get_d(), exact.u.get_d(), exact.v.get_d()}};
  return pair;
}

std::optional<double> undecided_per_million(std::size_t test, const std::vector<TrianglePair>& pairs) {
  if (static_cast<TriangleTest>(test) != TriangleTest::exact) return {};
  UndecidedLanes lanes;
  for (const TrianglePair& pair : pairs) add_undecided_lane(pair.ray, pair.triangle, lanes);
  return lanes.per_million(&UndecidedLanes::after_floats);
}

Answer answer_of(const Path& path, TriangleTest test, Grade grade, const TrianglePair& pair) {
  TriangleArrays arrays;
  arrays.size = 1;
  for (std::size_t k = 0; k < 9; ++k) arrays.corner[k / 3][k % 3] = &pair.triangle.corner[k / 3][k % 3];
  const Hit hit = closest_hit(pair.ray, arrays, {.test = test, .grade = grade, .path = &path});
  return {hit.primitive == 0, {hit.t, hit.u, hit.v}};
}

struct IntegerPair : TrianglePair {};

Answer answer_of(const Path&, std::size_t, Grade, const IntegerPair& pair) {
  const detail::ExactHit<float> hit = decide_in_integers(pair.ray, pair.triangle);
  return {hit.hit, {hit.t, hit.u, hit.v}};
}

// --- Boxes

struct BoxPair {
  Ray ray;
  Box box;
  Exact exact;
};

BoxPair box_pair(Aim set, SplitMix& random) {
  BoxPair pair{};
  const Double3 centre = scene_centre(set);
  const Float3 a = to_float(point_around(random, centre, 1)), b = to_float(point_around(random, centre, 1));
  Double3 target;
  const auto free_axis = static_cast<std::size_t>(between(random, 0, 3));
  for (std::size_t k = 0; k < 3; ++k) {
    pair.box.lo[k] = std::min(a[k], b[k]), pair.box.hi[k] = std::max(a[k], b[k]);
    const double lo = pair.box.lo[k], hi = pair.box.hi[k];
    const bool anywhere = set == Aim::uniform || set == Aim::far || (set == Aim::edges && k == free_axis);
    target[k] = anywhere ? between(random, lo - 0.3 * (hi - lo), hi + 0.3 * (hi - lo))
                         : (random.uniform() < 0.5 ? lo : hi);
  }
  pair.ray = ray_towards(point_around(random, centre, 2), target);
  const oracle::ExactInterval exact = oracle::exact_interval(pair.ray, pair.box);
  pair.exact = {exact.hit, {exact.entry.finite.get_d(), absent, absent}};
  if (exact.entry.infinite != 0 || exact.entry.finite == 0) pair.exact.number[0] = absent;
  return pair;
}

Answer answer_of(const Path& path, BoxTest test, Grade grade, const BoxPair& pair) {
  const auto& [lo, hi] = pair.box;
  std::uint8_t bits = 0;
  float entry, exit;
  intervals(pair.ray, {{&lo[0], &lo[1], &lo[2]}, {&hi[0], &hi[1], &hi[2]}, 1}, {&bits, 1}, {&entry, 1},
            {&exit, 1}, {.test = test, .grade = grade, .path = &path});
  return {bits != 0, {entry, 0, 0}};
}

// --- Spheres

struct SpherePair {
  Ray ray;
  oracle::Sphere sphere;
  Exact exact, exact_of_line;
};

SpherePair sphere_pair(Aim set, SplitMix& random) {
  const Float3 centre = to_float(point_around(random, {0, 0, 0}, 1));
  const double radius = between(random, 0.25, 1), away = set == Aim::far ? 1e4 : 3;
  const Double3 from = add(to_double(centre), scale(point_around(random, {0, 0, 0}, 1), away * radius));
  // Sideways from the centre by up to 1.2 radii; by the radius for a tangent, whose distance from the centre
  // is then less than that by next to nothing or by much: seen from close by it is scaled up.
  const Double3 way = subtract(to_double(centre), from);
  const Double3 side = normalized(cross(way, point_around(random, {0, 0, 0}, 1)));
  const double sine = std::min(1.0, radius / length(way));
  const double reach = set == Aim::edges ? radius / std::sqrt(std::max(1e-3, 1 - sine * sine))
                                         : between(random, 0, 1.2) * radius;
  SpherePair pair{};
  pair.ray = ray_towards(from, add(to_double(centre), scale(side, reach)));
  pair.sphere = {{centre[0], centre[1], centre[2], signed_square(static_cast<float>(radius))}};
  const oracle::ExactSphere exact = oracle::exact_sphere(pair.ray, pair.sphere);
  const bool clear = exact.line_free > 0.01 * radius * radius;  // near tangents t is lost in any case
  pair.exact = {exact.hit, {clear ? exact.near : absent, absent, absent}};
  pair.exact_of_line = {exact.line_free >= 0, {absent, absent, absent}};
  return pair;
}

SphereArrays one_sphere(const SpherePair& pair) {
  const float* const p = pair.sphere.value;
  return {{p, p + 1, p + 2}, p + 3, 1};
}

Answer answer_of(const Path& path, SphereTest test, Grade grade, const SpherePair& pair) {
  std::uint8_t bits = 0;
  float near, far;
  distances(pair.ray, one_sphere(pair), {&bits, 1}, {&near, 1}, {&far, 1},
            {.test = test, .grade = grade, .path = &path});
  return {bits != 0, {near, 0, 0}};
}

// The line asks less: whether all of the line meets the ball. It answers no distance.
Answer line_answer(const Path& path, Grade grade, const SpherePair& pair) {
  std::uint8_t bits = 0;
  line_hits(pair.ray, one_sphere(pair), {&bits, 1}, {.grade = grade, .path = &path});
  return {bits != 0, {}};
}

constexpr std::size_t line = std::size(sphere_tests);  // as the number of a test

// A test by its number: what it answers and what is right for it.
Answer answer_of(const Path& path, std::size_t test, Grade grade, const TrianglePair& pair) {
  return answer_of(path, static_cast<TriangleTest>(test), grade, pair);
}
Answer answer_of(const Path& path, std::size_t test, Grade grade, const BoxPair& pair) {
  return answer_of(path, static_cast<BoxTest>(test), grade, pair);
}
Answer answer_of(const Path& path, std::size_t test, Grade grade, const SpherePair& pair) {
  if (test == line) return line_answer(path, grade, pair);
  return answer_of(path, static_cast<SphereTest>(test), grade, pair);
}
template <class Pair>
const Exact& right_answer(std::size_t, const Pair& pair) {
  return pair.exact;
}
const Exact& right_answer(std::size_t test, const SpherePair& pair) {
  return test == line ? pair.exact_of_line : pair.exact;
}

template <class Pair>
std::optional<double> undecided_per_million(std::size_t, const std::vector<Pair>&) {
  return {};
}

template <class MakePair>
void survey(Accuracies& all, const std::vector<const Path*>& paths, std::size_t pairs,
            const std::vector<Aim>& sets, MakePair make_pair, const Done& done) {
  const std::size_t tests = all[0].size();
  double step = 0;
  const auto steps = static_cast<double>(sets.size() * (paths.size() * tests + 1));
  for (const Aim set : sets) {
    SplitMix random(1 + static_cast<std::uint64_t>(set));
    using Pair = decltype(make_pair(set, random));
    std::vector<Pair> sample;
    for (std::size_t i = 0; i < pairs; ++i) sample.push_back(make_pair(set, random));
    done(++step / steps);
    for (std::size_t p = 0; p < paths.size(); ++p)
      for (std::size_t test = 0; test < tests; ++test) {
        const std::optional<double> open = undecided_per_million(test, sample);
        for (const Grade grade : {Grade::reproducible, Grade::fast}) {
          KernelAccuracy& accuracy = all[p][test][static_cast<std::size_t>(grade)];
          accuracy.undecided_per_million[static_cast<std::size_t>(set)] = open;
          Judge judge(accuracy, set, std::is_same_v<Pair, BoxPair>);
          for (const auto& pair : sample)
            judge.add(right_answer(test, pair), answer_of(*paths[p], test, grade, pair));
          judge.finish();
        }
        done(++step / steps);
      }
  }
}

Accuracies not_judged(std::size_t paths, std::size_t tests) {
  return Accuracies(paths, std::vector<std::array<KernelAccuracy, 2>>(tests));
}

const std::vector<Aim> all_sets{Aim::uniform, Aim::edges, Aim::vertices, Aim::far},
    sets_of_triangles{Aim::uniform, Aim::edges, Aim::vertices, Aim::far, Aim::plane};

}  // namespace

KernelJudgement::KernelJudgement(std::size_t paths)
    : triangles(not_judged(paths, std::size(triangle_tests))),
      integers(not_judged(1, 1)),
      boxes(not_judged(paths, std::size(box_tests))),
      spheres(not_judged(paths, line + 1)) {}

void KernelJudgement::judge(const std::vector<const Path*>& paths, std::size_t pairs, const Done& done) {
  const auto part = [&](double from, double to) {
    return [&done, from, to](double share) { done(from + (to - from) * share); };
  };
  survey(triangles, paths, pairs, sets_of_triangles, triangle_pair, part(0, 0.4));
  survey(
      integers, {&raylanes::paths().front()}, pairs, sets_of_triangles,
      [](Aim set, SplitMix& random) { return IntegerPair{triangle_pair(set, random)}; }, part(0.4, 0.5));
  survey(boxes, paths, pairs, all_sets, box_pair, part(0.5, 0.7));
  survey(spheres, paths, pairs, {Aim::uniform, Aim::edges, Aim::far}, sphere_pair, part(0.7, 1));
}

}  // namespace raylanes::bench

#include "box_judge.hpp"

namespace raylanes::testing {
namespace {

using oracle::exact_interval;
using oracle::ExactInterval;
using oracle::Extended;

constexpr double u = 0x1p-24;
const mpq_class unit_roundoff(u);

bool is_equal(float x, const Extended& exact) {
  return !(Extended(x) < exact) && !(exact < Extended(x));
}

bool is_entry(float entry, const Extended& exact) {
  if (exact.infinite != 0 || std::isinf(entry)) return is_equal(entry, exact);
  return abs(mpq_class(entry) - exact.finite) <= 4 * unit_roundoff * abs(exact.finite);
}

bool is_exit(float exit, const Extended& exact) {
  if (exact.infinite != 0 || std::isinf(exit)) return is_equal(exit, exact);
  const mpq_class excess = mpq_class(exit) - exact.finite;
  return excess >= 0 && excess <= 12 * unit_roundoff * abs(exact.finite);
}

float reach(float origin, float bound) {
  return 32 * 0x1p-24f * (std::abs(origin) + std::abs(bound));
}

Box shrunk(const Box& box, const Ray& ray) {
  Box narrow = box;
  for (int axis = 0; axis < 3; ++axis) {
    narrow.lo[axis] += reach(ray.origin[axis], box.lo[axis]);
    narrow.hi[axis] -= reach(ray.origin[axis], box.hi[axis]);
  }
  return narrow;
}

// The intervals in which entry and exit may be, in double.
struct Ranges {
  double entry_low, entry_high, exit_low, exit_high;
};

Ranges ranges_of(BoxTest test, const Ray& ray, const Box& box) {
  Ranges r{ray.tmin, ray.tmin, ray.tmax, ray.tmax};
  const double late = test == BoxTest::plain ? 4 * u : 14 * u, early = test == BoxTest::plain ? 4 * u : 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) continue;
    const double near = ((d > 0 ? box.lo : box.hi)[axis] - o) / d,
                 far = ((d > 0 ? box.hi : box.lo)[axis] - o) / d;
    const double pad = test == BoxTest::directional ? 12 * u * std::fabs(o / d) : 0;
    r.entry_low = std::max(r.entry_low, near - 4 * u * std::fabs(near) - pad);
    r.entry_high = std::max(r.entry_high, near + 4 * u * std::fabs(near));
    r.exit_low = std::min(r.exit_low, far - early * std::fabs(far));
    r.exit_high = std::min(r.exit_high, far + late * std::fabs(far) + pad);
  }
  return r;
}

// A distance in double is exact but for 2^-51 of the larger of its terms, below 2^-20 u of |o/d| and |t|.
bool is_between(double low, float x, double high, double slack) {
  return low - slack <= double(x) && double(x) <= high + slack;
}

bool has_values(const Ray& ray) {
  return std::all_of(ray.direction.begin(), ray.direction.end(),
                     [](float d) { return d == 0 || std::abs(d) >= 0x1p-96f; });
}

}  // namespace

Box enlarged(const Box& box, const Ray& ray) {
  Box wide = box;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(box.lo[axis])) wide.lo[axis] -= reach(ray.origin[axis], box.lo[axis]) + 0x1p-50f;
    if (std::isfinite(box.hi[axis])) wide.hi[axis] += reach(ray.origin[axis], box.hi[axis]) + 0x1p-50f;
  }
  return wide;
}

BoxJudgement judge(const Ray& ray, const Box& box) {
  return {exact_interval(ray, box), exact_interval(ray, enlarged(box, ray)).hit,
          exact_interval(ray, shrunk(box, ray)).hit};
}

bool is_open(BoxTest test, const BoxJudgement& judgement) {
  if (judgement.exact.hit) return test == BoxTest::plain && !judgement.meets_shrunk;
  return judgement.meets_enlarged;
}

bool is_open(const ExactInterval& exact) {
  if (exact.hit || exact.entry.infinite != 0 || exact.exit.infinite != 0) return false;
  return exact.entry.finite - exact.exit.finite <= 14 * unit_roundoff * abs(exact.exit.finite);
}

std::string fault(BoxTest test, const IntervalResult& result, const Ray& ray, const Box& box,
                  const BoxJudgement& judgement) {
  const bool hit = result.hit != 0;
  if (hit && result.hit != hit_flag) return "a hit flag that is neither 0 nor all ones";
  if (hit != judgement.exact.hit && !is_open(test, judgement)) return hit ? "hit" : "missed";
  if (!hit) return result == interval_missed ? "" : "a miss with other values than those of a miss";
  if (!judgement.exact.hit || !has_values(ray)) return "";
  const Ranges r = ranges_of(test, ray, box);
  const double slack = 0x1p-44 * (std::fabs(r.entry_high) + (std::isfinite(r.exit_high) ? r.exit_high : 0));
  if (!is_between(r.entry_low, result.from, r.entry_high, slack)) return "entry beyond its bound";
  return is_between(r.exit_low, result.to, r.exit_high, slack) ? "" : "exit beyond its bound";
}

std::string fault(const IntervalResult& result, const ExactInterval& exact) {
  if (result.hit == 0) {
    if (exact.hit) return "missed";
    return result == interval_missed ? "" : "a miss with other values than those of a miss";
  }
  if (result.hit != hit_flag) return "a hit flag that is neither 0 nor all ones";
  if (!exact.hit) return is_open(exact) ? "" : "hit";
  if (!is_entry(result.from, exact.entry)) return "entry beyond its bound";
  return is_exit(result.to, exact.exit) ? "" : "exit beyond its bound";
}

}  // namespace raylanes::testing

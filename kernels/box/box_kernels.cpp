// The ray–box tests of one path, over boxes and over rays: compiled once per path with its flags and back end; the
// table is the only symbol that leaves the object.
#include <bit>
#include <limits>

#include "../../dispatch/table/boxes.hpp"
#include "../ray/axes.hpp"
#include "../simd/table_rows.hpp"
#include "directional.hpp"
#include "slabs.hpp"

namespace raylanes {
namespace {

// One ray over boxes: which array holds the plane that it meets first is known once and for all.
struct RayOverBoxes {
  const float *lo[3], *hi[3], *near[3], *far[3];
  Floats<1> origin[3], direction[3];

  RayOverBoxes(const Ray& ray, Soa boxes, const int (&order)[3]) {
    for (int j = 0; j < 3; ++j) {
      const int axis = order[j];
      origin[j] = ray.origin[axis], direction[j] = ray.direction[axis];
      lo[j] = boxes[axis], hi[j] = boxes[3 + axis];
      const bool negative = std::bit_cast<std::uint32_t>(ray.direction[axis]) >> 31 != 0;
      near[j] = negative ? hi[j] : lo[j], far[j] = negative ? lo[j] : hi[j];
    }
  }
  template <class Slice>
  static void load(const float* const (&arrays)[3], const Slice& slice, Floats<W> (&out)[3]) {
    for (int axis = 0; axis < 3; ++axis) out[axis] = slice.load(arrays[axis]);
  }
};

// Yes or no, with the axis along which the ray moves most as the last: there a distance is NaN only if the
// plane is, and the order of the operands lets that NaN through to the comparison. So only the other two
// axes need the check for NaN and order, which is `is_box`.
template <class Ray>
inline FloatMask<W> hits(const Ray& ray, const Floats<W> (&near_plane)[3], const Floats<W> (&far_plane)[3],
                         Floats<W> tmin, Floats<W> tmax, FloatMask<W> is_box) {
  Floats<W> entry = tmin, exit = tmax;
  for (int axis = 0; axis < 2; ++axis) {
    entry = max(ray.near(axis, near_plane[axis]), entry);
    exit = min(ray.far(axis, far_plane[axis]), exit);
  }
  entry = max(entry, ray.near(2, near_plane[2]));
  exit = min(exit, ray.far(2, far_plane[2]));
  return (entry <= exit) & is_box;
}

template <class Test>
[[gnu::flatten]] void any_of_boxes(const Ray& ray, Soa boxes, std::size_t n, LaneBits active,
                                   std::uint8_t* out) {
  if (!is_valid(ray)) return store_no_hits(n, active, out);
  const int last = shear_axes(ray.direction).z;
  RayOverBoxes over(ray, boxes, {(last + 1) % 3, (last + 2) % 3, last});
  typename Test::ManyBoxes prepared(over.origin, over.direction);
  Floats<W> tmin(ray.tmin), tmax(ray.tmax);
  store_decisions(0, n, active, out, [&](const auto& slice) {
    Floats<W> near[3], far[3];
    over.load(over.near, slice, near);
    over.load(over.far, slice, far);
    FloatMask<W> is_box = (slice.load(over.lo[0]) <= slice.load(over.hi[0])) &
                          (slice.load(over.lo[1]) <= slice.load(over.hi[1]));
    return hits(prepared, near, far, tmin, tmax, is_box);
  });
}

// A box with a NaN bound, or without extent because lo > hi, is hit by nothing.
inline FloatMask<W> is_box(const Floats<W> (&lo)[3], const Floats<W> (&hi)[3]) {
  return (lo[0] <= hi[0]) & (lo[1] <= hi[1]) & (lo[2] <= hi[2]);
}

// Tests a slice; returns the decisions.
template <class Slice>
inline FloatMask<W> store_interval(const Segment<Floats<W>>& inside, FloatMask<W> may_hit, const Slice& slice,
                                   float* entry, float* exit) {
  Floats<W> infinity(std::numeric_limits<float>::infinity());
  FloatMask<W> hit = (inside.tmin <= inside.tmax) & may_hit;
  slice.store(select(hit, inside.tmin, infinity), entry);
  slice.store(select(hit, inside.tmax, -infinity), exit);
  return hit;
}

template <class Test>
[[gnu::flatten]] void intervals_of_boxes(const Ray& ray, Soa boxes, std::size_t n, LaneBits active,
                                         std::uint8_t* out, float* entry, float* exit) {
  RayOverBoxes over(ray, boxes, {0, 1, 2});
  typename Test::Ray prepared(over.origin, over.direction);
  const Segment<Floats<W>> segment = broadcast_segment(ray);
  store_decisions(0, n, active, out, [&](const auto& slice) {
    Floats<W> lo[3], hi[3], near[3], far[3];
    over.load(over.lo, slice, lo), over.load(over.hi, slice, hi);
    over.load(over.near, slice, near), over.load(over.far, slice, far);
    return store_interval(clip_to_slabs<W>(prepared, near, far, segment), is_box(lo, hi), slice, entry, exit);
  });
}

// The bits and entries of intervals_of_boxes() by ConservativeSlabs. Boxes from the first on: N of them, or as many as
// `count` says.
template <int N, bool is_whole>
inline std::uint32_t hits_from(const detail::RayAmong& ray, Soa arrays, std::size_t first, std::size_t count,
                               float* entry) {
  using V = Floats<N>;
  const auto load = [&](std::uint32_t k) {
    if constexpr (is_whole) return V::load(arrays[k] + first);
    return V::load(arrays[k] + first, count, V(std::numeric_limits<float>::quiet_NaN()));
  };
  V tmin(ray.ray.tmin), tmax(ray.ray.tmax), infinity(std::numeric_limits<float>::infinity());
  const auto clip = [&](std::size_t axis) {
    V origin(ray.ray.origin[axis]), inverse(ray.inverse[axis]);
    V in = load(ray.first[axis]), out = load(ray.last[axis]);
    tmin = max((in - origin) * inverse, tmin);
    tmax = min((out - origin) * V(ray.far_inverse[axis]), tmax);
    return flip(in, sign_of(inverse)) <= flip(out, sign_of(inverse));  // lo <= hi
  };
  FloatMask<N> is_box = clip(0);
  is_box = is_box & clip(1);
  is_box = is_box & clip(2);
  FloatMask<N> hit = (tmin <= tmax) & is_box;
  if (entry != nullptr) {
    V entered = select(hit, tmin, infinity);
    if constexpr (is_whole)
      entered.store(entry + first);
    else
      entered.store(entry + first, count);
  }
  return bits(hit) << first;
}

[[gnu::flatten, gnu::noinline]] std::uint32_t hits_among_any(const detail::RayAmong& ray, Soa arrays,
                                                             std::size_t n, float* entry) {
  constexpr int most = W < 8 ? W : 8, few = W < 4 ? W : 4;
  std::size_t i = 0;
  std::uint32_t hits = 0;
  for (; n - i >= most; i += most) hits |= hits_from<most, true>(ray, arrays, i, most, entry);
  if (most > few && n - i >= few) hits |= hits_from<few, true>(ray, arrays, i, few, entry), i += few;
  if (i < n) hits |= hits_from<few, false>(ray, arrays, i, n - i, entry);
  return hits;
}
// A whole node needs no loop, and no registers of the caller's.
[[gnu::flatten]] std::uint32_t hits_among_boxes(const detail::RayAmong& ray, const BoxArrays& boxes,
                                                float* entry) {
  static_assert(offsetof(BoxArrays, hi) == sizeof boxes.lo);
  Soa arrays = reinterpret_cast<Soa>(&boxes);
  if constexpr (W >= 8)
    if (boxes.size == 8) return hits_from<8, true>(ray, arrays, 0, 8, entry);
  return hits_among_any(ray, arrays, boxes.size, entry);
}

// One box under rays.
struct BoxUnderRays {
  Floats<W> lo[3], hi[3];
  FloatMask<W> valid;
  explicit BoxUnderRays(const float* box) {
    broadcast(box, lo);
    broadcast(box + 3, hi);
    valid = is_box(lo, hi);
  }
  // Each ray chooses the planes that it meets first and last by the sign bit of its reciprocal direction.
  template <class Test>
  Segment<Floats<W>> clip(const RayColumns& rays) const {
    typename Test::Ray prepared(rays.origin, rays.direction);
    Floats<W> near[3], far[3];
    for (int axis = 0; axis < 3; ++axis) {
      near[axis] = select_negative(prepared.inverse[axis], hi[axis], lo[axis]);
      far[axis] = select_negative(prepared.inverse[axis], lo[axis], hi[axis]);
    }
    return clip_to_slabs<W>(prepared, near, far, {rays.tmin, rays.tmax});
  }
};

template <class Test>
[[gnu::flatten]] void any_of_rays(const RayArrays& rays, const float* box, LaneBits active,
                                  std::uint8_t* out) {
  BoxUnderRays under(box);
  store_decisions(0, rays.size, active, out, [&](const auto& slice) {
    RayColumns loaded(rays, slice);
    Segment<Floats<W>> inside = under.clip<Test>(loaded);
    return (inside.tmin <= inside.tmax) & under.valid & loaded.are_valid();
  });
}

template <class Test>
[[gnu::flatten]] void intervals_of_rays(const RayArrays& rays, const float* box, LaneBits active,
                                        std::uint8_t* out, float* entry, float* exit) {
  BoxUnderRays under(box);
  store_decisions(0, rays.size, active, out, [&](const auto& slice) {
    RayColumns loaded(rays, slice);
    return store_interval(under.clip<Test>(loaded), under.valid & loaded.are_valid(), slice, entry, exit);
  });
}

struct MakeRow {
  template <class Test>
  constexpr BoxRow operator()() const {
    return {any_of_boxes<Test>, any_of_rays<Test>, intervals_of_boxes<Test>, intervals_of_rays<Test>};
  }
};

constexpr BoxKernels all_kernels(BoxKernels rows) {
  rows.hits = hits_among_boxes;
  return rows;
}

using BoxTests = TestList<ConservativeSlabs, PlainSlabs, DirectionalSlabs>;
static_assert(is_complete(BoxTests{}, box_tests),
              "each box test needs one type, with the numbers that it reads");

}  // namespace

RAYLANES_UNIT_TABLE(BoxKernels, boxes, all_kernels(rows_of<BoxKernels>(BoxTests{}, MakeRow{})))
}  // namespace raylanes

// The order in which packets take the rays of a batch: by runs of consecutive rays, and these by tiles. If rays come in
// tiles, they are taken as they come. Otherwise they are sorted by cells of some rays each on the faces of the cube
// around the apex, along a curve that keeps neighbours together (Morton 1966). So any order of rays makes compact
// packets.
#pragma once

#include "frusta.hpp"

namespace raylanes {
namespace {

inline constexpr int max_vectors = 32;  // of a packet: a bit of a mask each
inline constexpr std::size_t max_packet_rays = max_vectors * W;
inline constexpr std::size_t max_sorted_rays = rays_of_an_origin;
inline constexpr int rays_of_a_cell = 4;
// So many consecutive rays are ordered as one, by the first of them, where they lie together, as in a picture row by
// row: a quarter of the work.
inline constexpr std::uint32_t rays_of_a_run = 4;
inline constexpr int side_bits = 8;
// For all major axes together: each has less than twice the cells that it needs.
inline constexpr std::size_t max_cells = 2 * max_sorted_rays / rays_of_a_cell + 2 * major_axes;
inline constexpr std::uint32_t vectors_ahead = 4;

// Runs of four consecutive rays of the batch, or of one. Behind the last run are copies of it for `vectors_ahead`
// vectors: prefetches look at vectors to come.
struct RayRuns {
  const std::uint32_t* first;  // the first ray of each run
  std::uint32_t size;
  bool of_four;

  std::uint32_t per_vector() const { return of_four ? std::uint32_t{W / 4} : std::uint32_t{W}; }
  // The lanes that the first n runs of a vector are.
  std::uint32_t lanes(std::uint32_t n) const {
    if (!of_four || n >= per_vector()) return first_lanes<W>(of_four ? W : n);
    std::uint32_t lanes = 0;
    for (int lane = 0; lane < W; ++lane)
      lanes |= std::uint32_t{strip_of_lane<W>(lane) < static_cast<int>(n)} << lane;
    return lanes;
  }
  // The vector of rays whose runs begin there.
  template <int N = W>
  RayColumns columns(const Ray* batch, const std::uint32_t* run) const {
    if constexpr (N >= 4)
      if (of_four) {
        const void* places[N / 4];
        for (int k = 0; k < N / 4; ++k) places[k] = batch + run[k];
        return RayColumns(places);
      }
    const Ray* rays[N];
    for (int lane = 0; lane < N; ++lane) rays[lane] = batch + run[lane];
    return RayColumns(rays);
  }
  // The index of one of them in the batch.
  std::size_t index(const std::uint32_t* run, int lane) const {
    return of_four ? run[strip_of_lane<W>(lane)] + static_cast<std::size_t>(row_in_strip<W>(lane))
                   : run[lane];
  }
};

// The major axis of a ray, as a number, and its slopes there, roughly. Coherent rays have the place where they pass the
// apex instead of slopes, as shares of the reach. Rays that no packet can have get any numbers.
struct AxisSlopes {
  using V = Floats<W>;
  V axis, x, y;
  std::uint32_t usual;  // the others have no such slopes

  template <SharedApex apex>
  AxisSlopes(const RayColumns& rays, const ApexOfRays<apex>& of) {
    Vec3<V> direction(rays.direction[0], rays.direction[1], rays.direction[2]);
    LaneAxes<V> axes(direction);
    Vec3<V> d = axes.permute<true>(direction);
    V size = abs(d.z), inverse = reciprocal_estimate(size);
    V slope_x = d.x * inverse, slope_y = d.y * inverse;
    axis = axes.number() + axes.number() + select(axes.swapped, V(1.0f), V(0.0f));
    x = within_one(slope_x), y = within_one(slope_y);
    usual = bits((abs(x - slope_x) <= V(0x1p-10f)) & (abs(y - slope_y) <= V(0x1p-10f)));
    if constexpr (apex == SharedApex::none) {
      const auto way = [&](int k) { return rays.origin[k] - V(of.at[k]); };
      const Vec3<V> o = axes.permute<true>(Vec3<V>(way(0), way(1), way(2)));
      const V z = o.z * select(axes.swapped, V(-1.0f), V(1.0f)), share = reciprocal_estimate(V(of.reach));
      x = within_one((o.x - slope_x * z) * share), y = within_one((o.y - slope_y * z) * share);
    }
  }

 private:
  // NaN becomes −1.
  static V within_one(V x) { return min(max(x, V(-1.0f)), V(1.0f)); }
};

// The range of the slopes of rays of one major axis.
struct SlopeRange {
  std::uint32_t count = 0;
  float lo_x = 1.0f, hi_x = -1.0f, lo_y = 1.0f, hi_y = -1.0f;

  float width() const { return hi_x > lo_x ? hi_x - lo_x : 0.0f; }
  float height() const { return hi_y > lo_y ? hi_y - lo_y : 0.0f; }
  // The square of the distance of neighbours, if they were spread evenly.
  float spacing() const {
    const float length = width() > height() ? width() : height();
    const float rays = static_cast<float>(count), area = width() * height(), least = length * length / rays;
    return (area > least ? area : least) / rays;
  }
};

// Cells of slopes of one major axis: powers of two of them along each side, about as long as wide.
struct SlopeGrid {
  float lo_x, lo_y, scale_x, scale_y, max_x, max_y;  // a cell is (slope − lo) · scale, from 0 to max
  // The curve begins with so many bits of the side along which cells are short that the rest of the area is about as
  // long as wide. Then it alternates bits of both sides, and ends with the bits that one side has more.
  bool short_x;
  int first_bits, square_bits;
  std::uint32_t first_cell;

  // Returns the number of cells.
  std::uint32_t set(const SlopeRange& range, std::uint32_t first) {
    float width = range.width() + 1e-6f, height = range.height() + 1e-6f;
    int x_bits = 0, y_bits = 0;
    while ((std::uint32_t{rays_of_a_cell} << (x_bits + y_bits)) < range.count) {
      const bool halve_x = (width >= height && x_bits < side_bits) || y_bits == side_bits;
      (halve_x ? x_bits : y_bits) += 1;
      (halve_x ? width : height) *= 0.5f;
    }
    lo_x = range.lo_x, lo_y = range.lo_y, scale_x = 1.0f / width, scale_y = 1.0f / height;
    first_cell = first;
    max_x = static_cast<float>((1 << x_bits) - 1), max_y = static_cast<float>((1 << y_bits) - 1);
    // Cells are about square but where one side has no bits left.
    const bool is_stretched = x_bits == side_bits || y_bits == side_bits;
    short_x = is_stretched && width < height;
    const int short_bits = short_x ? x_bits : y_bits, long_bits = short_x ? y_bits : x_bits;
    float stretch = short_x ? height / width : width / height;
    for (first_bits = 0; is_stretched && first_bits < short_bits && first_bits < 2 && stretch > 1.4f;
         ++first_bits)
      stretch *= 0.5f;
    square_bits = short_bits - first_bits < long_bits ? short_bits - first_bits : long_bits;
    return 1u << (x_bits + y_bits);
  }

  FloatBits<W> cells(Floats<W> x, Floats<W> y) const {
    using B = FloatBits<W>;
    B cell_x = whole((x - Floats<W>(lo_x)) * Floats<W>(scale_x), max_x),
      cell_y = whole((y - Floats<W>(lo_y)) * Floats<W>(scale_y), max_y);
    B along_short = short_x ? cell_x : cell_y, along_long = short_x ? cell_y : cell_x;
    B first = along_short & low_bits(first_bits),
      then = bits_of(number(along_short - first) * power_of_2(-first_bits));
    B low_short = then & low_bits(square_bits), low_long = along_long & low_bits(square_bits);
    Floats<W> interleaved = number(spread(low_long) | shift_left<1>(spread(low_short))),
              beyond = number((then - low_short) + (along_long - low_long));
    Floats<W> rest = multiply_add<Grade::fast>(beyond, power_of_2(square_bits), interleaved);
    return first + (bits_of(rest * power_of_2(first_bits)) + B(first_cell));
  }

 private:
  static FloatBits<W> low_bits(int count) { return FloatBits<W>((1u << count) - 1u); }
  static Floats<W> power_of_2(int n) {
    return as<float>(FloatBits<W>(static_cast<std::uint32_t>(127 + n) << 23));
  }
  // Small whole numbers as floats, and again: of 2^23 and more the last bit is 1.
  static FloatBits<W> bits_of(Floats<W> x) {
    return as<std::uint32_t>(x + Floats<W>(0x1p23f)) & FloatBits<W>(0x7fffffu);
  }
  static Floats<W> number(FloatBits<W> x) {
    return as<float>(x | FloatBits<W>(0x4b000000u)) - Floats<W>(0x1p23f);
  }
  static FloatBits<W> whole(Floats<W> x, float most) {
    return bits_of(min(max(x - Floats<W>(0.5f), Floats<W>(0.0f)), Floats<W>(most)));
  }
  // A zero before each of eight bits.
  static FloatBits<W> spread(FloatBits<W> x) {
    x = (x | shift_left<4>(x)) & FloatBits<W>(0x0f0fu);
    x = (x | shift_left<2>(x)) & FloatBits<W>(0x3333u);
    return (x | shift_left<1>(x)) & FloatBits<W>(0x5555u);
  }
};

class TileOrder {
  using V = Floats<W>;

 public:
  // In scratch memory.
  struct Memory {
    float axis[max_sorted_rays + W], x[max_sorted_rays + W], y[max_sorted_rays + W];
    std::uint32_t cell[max_sorted_rays + W], first[max_sorted_rays + (vectors_ahead + 1) * W];
    std::uint32_t end[max_cells + 1];  // of the rays of a cell
    SlopeGrid grid[major_axes];
  };

  // For at most max_sorted_rays.
  template <SharedApex apex>
  TileOrder(Memory& memory, const Ray* rays, std::size_t count, const ApexOfRays<apex>& of)
      : memory_(memory), rays_(rays), count_(count), step_(rays_of_a_run) {
    if (count >= max_packet_rays && apex != SharedApex::none && are_tiles(of)) {
      for (std::uint32_t i = 0; i < count / step_; ++i) memory.first[i] = step_ * i;
    } else {
      sort(of);
    }
    if (W < static_cast<int>(rays_of_a_run)) split_runs();
    const std::size_t runs = count_ / step_;
    for (std::size_t i = 0; i < (vectors_ahead + 1) * W; ++i) memory.first[runs + i] = memory.first[runs - 1];
  }
  // Rays behind the last whole run are in none.
  RayRuns runs() const {
    return {memory_.first, static_cast<std::uint32_t>(count_ / step_), step_ == rays_of_a_run};
  }
  std::size_t rays_in_runs() const { return count_ / step_ * step_; }

 private:
  static constexpr std::size_t samples = 16, min_rays_of_runs = samples * rays_of_a_run;
  static_assert(samples % W == 0);

  template <SharedApex apex>
  void sort(const ApexOfRays<apex>& of) {
    if (count_ < min_rays_of_runs) step_ = 1;
    find_slopes(of);
    if (step_ != 1 && !are_compact_runs(of)) {
      step_ = 1;
      find_slopes(of);
    }
    cells_ = 0;
    for (int axis = 0; axis < major_axes; ++axis)
      if (range_[axis].count != 0) cells_ += memory_.grid[axis].set(range_[axis], cells_);
    for (std::uint32_t cell = 0; cell <= cells_; ++cell) memory_.end[cell] = 0;
    find_cells();
    sort_cells();
  }
  // Whether rays come in tiles: a few packets of consecutive rays are sampled.
  template <SharedApex apex>
  [[gnu::noinline]] bool are_tiles(const ApexOfRays<apex>& of) const {
    constexpr std::size_t max_packets = 4;
    constexpr float max_spread = 16.0f;
    const std::size_t packets = count_ / max_packet_rays;
    const std::size_t sampled = packets < max_packets ? packets : max_packets;
    std::size_t compact = 0, of_one_axis = 0;
    for (std::size_t packet = 0; packet < sampled; ++packet) {
      const std::size_t begin = packet * packets / sampled * max_packet_rays;
      SlopeRange range;
      V apart(0.0f);
      bool is_one_axis = true;
      for (std::size_t i = 0; i < samples; i += W) {
        const auto here = [&](std::size_t lane) { return begin + (i + lane) * (max_packet_rays / samples); };
        const auto next = [&](std::size_t lane) { return here(lane) + 1; };
        const AxisSlopes a(columns(here), of), b(columns(next), of);
        apart = apart + abs(b.x - a.x) + abs(b.y - a.y);
        float axis[W];
        a.axis.store(axis);
        is_one_axis &= all((a.axis == V(axis[0])) & (b.axis == a.axis));
        include(range, a, first_lanes<W>(W));
      }
      const float between = sum_of_lanes(apart) / samples, side = range.width() + range.height();
      of_one_axis += is_one_axis;
      compact += is_one_axis && side * side <= max_spread * max_packet_rays * between * between;
    }
    return of_one_axis != 0 && 4 * compact >= 3 * of_one_axis;
  }
  // The slopes of the first ray of each run.
  template <SharedApex apex>
  [[gnu::noinline, gnu::flatten]] void find_slopes(const ApexOfRays<apex>& of) {
    for (SlopeRange& range : range_) range = SlopeRange();
    const std::size_t count = count_ / step_;
    for (std::size_t i = 0; i < count; i += W) {
      const AxisSlopes slopes(
          columns([&](std::size_t lane) { return step_ * (i + lane < count ? i + lane : count - 1); }), of);
      slopes.axis.store(memory_.axis + i), slopes.x.store(memory_.x + i), slopes.y.store(memory_.y + i);
      for (std::uint32_t left = first_lanes<W>(count - i); left != 0;) {
        const float axis = memory_.axis[i + static_cast<std::size_t>(std::countr_zero(left))];
        const std::uint32_t same = bits(slopes.axis == V(axis)) & left;
        left &= ~same;
        include(range_[static_cast<int>(axis)], slopes, same);
      }
    }
    for (SlopeRange& range : range_) range.count *= step_;
  }
  // Whether most runs of some that are sampled are no longer than they would be in any even picture.
  template <SharedApex apex>
  [[gnu::noinline]] bool are_compact_runs(const ApexOfRays<apex>& of) const {
    constexpr float longest = 6.0f;
    std::size_t compact = 0;
    for (std::size_t i = 0; i < samples; i += W) {
      const auto first = [&](std::size_t lane) {
        return (i + lane) % samples * (count_ / samples) / step_ * step_;
      };
      const auto last = [&](std::size_t lane) { return first(lane) + step_ - 1; };
      const AxisSlopes begin(columns(first), of), end(columns(last), of);
      float axis[W], length[W];
      V x = end.x - begin.x, y = end.y - begin.y;
      begin.axis.store(axis);
      select(begin.axis == end.axis, x * x + y * y, V(std::numeric_limits<float>::infinity())).store(length);
      for (std::size_t lane = 0; lane < W; ++lane)
        compact += length[lane] <= longest * longest * range_[static_cast<int>(axis[lane])].spacing();
    }
    return 4 * compact >= 3 * samples;
  }
  // The rays of these indices.
  template <class Index>
  RayColumns columns(Index index) const {
    const Ray* lines[W];
    for (std::size_t lane = 0; lane < W; ++lane) lines[lane] = rays_ + index(lane);
    return RayColumns(lines);
  }
  static void include(SlopeRange& range, const AxisSlopes& slopes, std::uint32_t lanes) {
    // Not std::popcount: where that is no instruction it is a call.
    if (lanes == first_lanes<W>(W))
      range.count += W;
    else
      for (int lane = 0; lane < W; ++lane) range.count += lanes >> lane & 1u;
    auto taken = FloatMask<W>::from_bits(lanes & slopes.usual);
    const auto widen = [&](V slope, float& lo, float& hi) {
      lo = min(Floats<1>(min_lane(select(taken, slope, V(1.0f)))), Floats<1>(lo)).raw;
      hi = max(Floats<1>(largest_lane(select(taken, slope, V(-1.0f)))), Floats<1>(hi)).raw;
    };
    widen(slopes.x, range.lo_x, range.hi_x), widen(slopes.y, range.lo_y, range.hi_y);
  }
  [[gnu::noinline, gnu::flatten]] void find_cells() {
    for (std::size_t i = 0; i < count_ / step_; i += W) {
      V axes = V::load(memory_.axis + i), x = V::load(memory_.x + i), y = V::load(memory_.y + i), cells(0.0f);
      for (std::uint32_t left = first_lanes<W>(W); left != 0;) {
        const float axis = memory_.axis[i + static_cast<std::size_t>(std::countr_zero(left))];
        auto same = axes == V(axis);
        left &= ~bits(same);
        cells = select(same, as<float>(memory_.grid[static_cast<int>(axis)].cells(x, y)), cells);
      }
      as<std::uint32_t>(cells).store(memory_.cell + i);
    }
  }
  [[gnu::noinline]] void sort_cells() {
    const std::size_t count = count_ / step_;
    for (std::size_t i = 0; i < count; ++i) ++memory_.end[memory_.cell[i] + 1];
    for (std::uint32_t cell = 0; cell < cells_; ++cell) memory_.end[cell + 1] += memory_.end[cell];
    for (std::size_t i = 0; i < count; ++i)
      memory_.first[memory_.end[memory_.cell[i]]++] = static_cast<std::uint32_t>(i) * step_;
  }
  // If a vector has no room for a run.
  void split_runs() {
    const std::size_t runs = step_ == 1 ? 0 : count_ / step_;
    for (std::size_t i = runs; i-- > 0;)
      for (std::uint32_t k = step_; k-- > 0;) memory_.first[step_ * i + k] = memory_.first[i] + k;
    if (runs != 0) count_ = step_ * runs, step_ = 1;
  }

  Memory& memory_;
  const Ray* rays_;
  std::size_t count_;
  std::uint32_t step_;  // the rays of a run
  SlopeRange range_[major_axes];
  std::uint32_t cells_;
};

}  // namespace
}  // namespace raylanes

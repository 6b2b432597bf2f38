// Rays of a point in the order of tiles. If they come in tiles, they are taken as they come. Otherwise they are sorted
// by cells of some rays each on the faces of the cube around the point, along a curve that keeps neighbours together
// (Morton 1966). So any order of rays makes groups and packets that are compact.
#pragma once

#include "packet_rays.hpp"

namespace raylanes {
namespace {

inline constexpr std::size_t max_sorted_rays = rays_of_an_origin;
inline constexpr int rays_of_a_cell = 4;
// So many that follow each other are ordered as one, by the first of them, where they lie together, as in a picture row
// by row: a quarter of the work.
inline constexpr std::uint32_t rays_of_a_strip = 4;
inline constexpr int side_bits = 8;
// For all faces together: each has less than twice the cells that it needs.
inline constexpr std::size_t max_cells = 2 * max_sorted_rays / rays_of_a_cell + 2 * cube_faces;

// The face that a ray goes through, as a number, and its slopes there, roughly; of a coherent packet where rays pass
// the point, as shares of the reach. For rays that no packet can have: anything.
struct FacesOfRays {
  GroupFloats face, x, y;
  std::uint32_t usual;  // the others have no such slopes

  template <SharedApex apex>
  FacesOfRays(const RayColumns& rays, const ApexOfRays<apex>& of) {
    Vec3<GroupFloats> direction(rays.direction[0], rays.direction[1], rays.direction[2]);
    LaneAxes<GroupFloats> axes(direction);
    Vec3<GroupFloats> d = axes.permute<true>(direction);
    GroupFloats size = abs(d.z), inverse = reciprocal_estimate(size);
    GroupFloats slope_x = d.x * inverse, slope_y = d.y * inverse;
    face = axes.number() + axes.number() + select(axes.swapped, GroupFloats(1.0f), GroupFloats(0.0f));
    x = within_one(slope_x), y = within_one(slope_y);
    usual = bits((abs(x - slope_x) <= GroupFloats(0x1p-10f)) & (abs(y - slope_y) <= GroupFloats(0x1p-10f)));
    if constexpr (apex == SharedApex::none) {
      const auto way = [&](int axis) { return rays.origin[axis] - GroupFloats(of.at[axis]); };
      const Vec3<GroupFloats> o = axes.permute<true>(Vec3<GroupFloats>(way(0), way(1), way(2)));
      const GroupFloats z = o.z * select(axes.swapped, GroupFloats(-1.0f), GroupFloats(1.0f));
      const GroupFloats share = reciprocal_estimate(GroupFloats(of.reach));
      x = within_one((o.x - slope_x * z) * share), y = within_one((o.y - slope_y * z) * share);
    }
  }

 private:
  // NaN becomes −1.
  static GroupFloats within_one(GroupFloats x) { return min(max(x, GroupFloats(-1.0f)), GroupFloats(1.0f)); }
};

// The range of the slopes of a face's rays.
struct FaceRange {
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

// The grid of a face: powers of two of cells along each side, about as long as wide.
struct FaceGrid {
  float lo_x, lo_y, scale_x, scale_y, max_x, max_y;  // a cell is (slope − lo) · scale, from 0 to most
  // The curve begins with so many bits of the side along which cells are short that the rest of the area is about as
  // long as wide. Then it alternates bits of both sides, and ends with the bits that one side has more.
  bool short_x;
  int first_bits, square_bits;
  std::uint32_t first_cell;

  // Returns the number of cells.
  std::uint32_t set(const FaceRange& range, std::uint32_t first) {
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

  FloatBits<group_lanes> cells(GroupFloats x, GroupFloats y) const {
    using B = FloatBits<group_lanes>;
    B cell_x = whole((x - GroupFloats(lo_x)) * GroupFloats(scale_x), max_x),
      cell_y = whole((y - GroupFloats(lo_y)) * GroupFloats(scale_y), max_y);
    B along_short = short_x ? cell_x : cell_y, along_long = short_x ? cell_y : cell_x;
    B first = along_short & low_bits(first_bits),
      then = bits_of(number(along_short - first) * power_of_2(-first_bits));
    B low_short = then & low_bits(square_bits), low_long = along_long & low_bits(square_bits);
    GroupFloats by_turns = number(spread(low_long) | shift_left<1>(spread(low_short))),
                beyond = number((then - low_short) + (along_long - low_long));
    GroupFloats rest = multiply_add<Grade::fast>(beyond, power_of_2(square_bits), by_turns);
    return first + (bits_of(rest * power_of_2(first_bits)) + B(first_cell));
  }

 private:
  static FloatBits<group_lanes> low_bits(int count) { return FloatBits<group_lanes>((1u << count) - 1u); }
  static GroupFloats power_of_2(int n) {
    return as<float>(FloatBits<group_lanes>(static_cast<std::uint32_t>(127 + n) << 23));
  }
  // Small whole numbers as floats, and again: of 2^23 and more the last bit is 1.
  static FloatBits<group_lanes> bits_of(GroupFloats x) {
    return as<std::uint32_t>(x + GroupFloats(0x1p23f)) & FloatBits<group_lanes>(0x7fffffu);
  }
  static GroupFloats number(FloatBits<group_lanes> x) {
    return as<float>(x | FloatBits<group_lanes>(0x4b000000u)) - GroupFloats(0x1p23f);
  }
  static FloatBits<group_lanes> whole(GroupFloats x, float most) {
    return bits_of(min(max(x - GroupFloats(0.5f), GroupFloats(0.0f)), GroupFloats(most)));
  }
  // A zero before each of eight bits.
  static FloatBits<group_lanes> spread(FloatBits<group_lanes> x) {
    x = (x | shift_left<4>(x)) & FloatBits<group_lanes>(0x0f0fu);
    x = (x | shift_left<2>(x)) & FloatBits<group_lanes>(0x3333u);
    return (x | shift_left<1>(x)) & FloatBits<group_lanes>(0x5555u);
  }
};

class TileOrder {
 public:
  // In scratch memory.
  struct Memory {
    float face[max_sorted_rays + group_lanes], x[max_sorted_rays + group_lanes],
        y[max_sorted_rays + group_lanes];
    std::uint32_t cell[max_sorted_rays + group_lanes],
        first[max_sorted_rays + (groups_ahead + 1) * group_lanes];
    std::uint32_t end[max_cells + 1];  // of the rays of a cell
    FaceGrid grid[cube_faces];
  };

  // For at most max_sorted_rays.
  template <SharedApex apex>
  TileOrder(Memory& memory, const Ray* rays, std::size_t count, const ApexOfRays<apex>& of)
      : memory_(memory), rays_(rays), count_(count), step_(rays_of_a_strip) {
    if (count >= rays_of_a_packet && apex != SharedApex::none && are_tiles(of)) {
      for (std::uint32_t i = 0; i < count / step_; ++i) memory.first[i] = step_ * i;
    } else {
      sort(of);
    }
    if (group_lanes < static_cast<int>(rays_of_a_strip)) one_by_one();
    pad();
  }
  // Those behind the last whole strip are in none.
  RayUnits units() const {
    return {memory_.first, static_cast<std::uint32_t>(count_ / step_), step_ == rays_of_a_strip};
  }
  std::size_t rays_in_units() const { return count_ / step_ * step_; }

 private:
  template <SharedApex apex>
  void sort(const ApexOfRays<apex>& of) {
    if (count_ < min_of_strips) step_ = 1;
    look(of);
    if (step_ != 1 && !are_strips(of)) {
      step_ = 1;
      look(of);
    }
    set_grids();
    find_cells();
    sort_cells();
  }
  // Whether runs of a packet's rays, a few of which are looked at, are compact.
  template <SharedApex apex>
  [[gnu::noinline]] bool are_tiles(const ApexOfRays<apex>& of) const {
    constexpr std::size_t max_runs = 4;
    constexpr float max_spread = 16.0f;
    const std::size_t runs = count_ / rays_of_a_packet, looked = runs < max_runs ? runs : max_runs;
    std::size_t compact = 0, of_one_face = 0;
    for (std::size_t run = 0; run < looked; ++run) {
      const std::size_t begin = run * runs / looked * rays_of_a_packet;
      FaceRange range;
      GroupFloats apart(0.0f);
      bool is_one_face = true;
      for (std::size_t i = 0; i < looked_at; i += group_lanes) {
        const auto here = [&](std::size_t lane) {
          return begin + (i + lane) * (rays_of_a_packet / looked_at);
        };
        const auto next = [&](std::size_t lane) { return here(lane) + 1; };
        const FacesOfRays a(columns(here), of), b(columns(next), of);
        apart = apart + abs(b.x - a.x) + abs(b.y - a.y);
        float face[group_lanes];
        a.face.store(face);
        is_one_face &= all((a.face == GroupFloats(face[0])) & (b.face == a.face));
        include(range, a, first_lanes<group_lanes>(group_lanes));
      }
      const float between = sum_of_lanes(apart) / looked_at, side = range.width() + range.height();
      of_one_face += is_one_face;
      compact += is_one_face && side * side <= max_spread * rays_of_a_packet * between * between;
    }
    return of_one_face != 0 && 4 * compact >= 3 * of_one_face;
  }
  template <SharedApex apex>
  [[gnu::noinline, gnu::flatten]] void look(const ApexOfRays<apex>& of) {
    for (FaceRange& range : range_) range = FaceRange();
    const std::size_t count = count_ / step_;
    for (std::size_t i = 0; i < count; i += group_lanes) {
      const FacesOfRays faces(
          columns([&](std::size_t lane) { return step_ * (i + lane < count ? i + lane : count - 1); }), of);
      faces.face.store(memory_.face + i), faces.x.store(memory_.x + i), faces.y.store(memory_.y + i);
      for (std::uint32_t left = first_lanes<group_lanes>(count - i); left != 0;) {
        const float face = memory_.face[i + static_cast<std::size_t>(std::countr_zero(left))];
        const std::uint32_t same = bits(faces.face == GroupFloats(face)) & left;
        left &= ~same;
        include(range_[static_cast<int>(face)], faces, same);
      }
    }
    for (FaceRange& range : range_) range.count *= step_;
  }
  static constexpr std::size_t looked_at = 16, min_of_strips = looked_at * rays_of_a_strip,
                               rays_of_a_packet = max_groups * group_lanes;
  static_assert(looked_at % group_lanes == 0);
  // Whether most strips of some that are looked at are no longer than they would be in any even picture.
  template <SharedApex apex>
  [[gnu::noinline]] bool are_strips(const ApexOfRays<apex>& of) const {
    constexpr float longest = 6.0f;
    std::size_t compact = 0;
    for (std::size_t i = 0; i < looked_at; i += group_lanes) {
      const auto first = [&](std::size_t lane) {
        return (i + lane) % looked_at * (count_ / looked_at) / step_ * step_;
      };
      const auto last = [&](std::size_t lane) { return first(lane) + step_ - 1; };
      const FacesOfRays begin(columns(first), of), end(columns(last), of);
      float face[group_lanes], length[group_lanes];
      GroupFloats x = end.x - begin.x, y = end.y - begin.y;
      begin.face.store(face);
      select(begin.face == end.face, x * x + y * y, GroupFloats(std::numeric_limits<float>::infinity()))
          .store(length);
      for (std::size_t lane = 0; lane < group_lanes; ++lane)
        compact += length[lane] <= longest * longest * range_[static_cast<int>(face[lane])].spacing();
    }
    return 4 * compact >= 3 * looked_at;
  }
  // The rays of these numbers.
  template <class Number>
  RayColumns columns(Number number) const {
    const Ray* lines[group_lanes];
    for (std::size_t lane = 0; lane < group_lanes; ++lane) lines[lane] = rays_ + number(lane);
    return RayColumns(lines);
  }
  static float sum_of_lanes(GroupFloats a) {
    float x[group_lanes], sum = 0.0f;
    a.store(x);
    for (const float lane : x) sum += lane;
    return sum;
  }
  static void include(FaceRange& range, const FacesOfRays& faces, std::uint32_t lanes) {
    // Not std::popcount: where that is no instruction it is a call.
    if (lanes == first_lanes<group_lanes>(group_lanes))
      range.count += group_lanes;
    else
      for (int lane = 0; lane < group_lanes; ++lane) range.count += lanes >> lane & 1u;
    auto taken = FloatMask<group_lanes>::from_bits(lanes & faces.usual);
    GroupFloats least(-1.0f), most(1.0f);
    const auto widen = [&](GroupFloats slope, float& lo, float& hi) {
      lo = min(Floats<1>(min_lane(select(taken, slope, most))), Floats<1>(lo)).raw;
      hi = max(Floats<1>(largest_lane(select(taken, slope, least))), Floats<1>(hi)).raw;
    };
    widen(faces.x, range.lo_x, range.hi_x), widen(faces.y, range.lo_y, range.hi_y);
  }

  void set_grids() {
    cells_ = 0;
    for (int face = 0; face < cube_faces; ++face)
      if (range_[face].count != 0) cells_ += memory_.grid[face].set(range_[face], cells_);
    for (std::uint32_t cell = 0; cell <= cells_; ++cell) memory_.end[cell] = 0;
  }
  [[gnu::noinline, gnu::flatten]] void find_cells() {
    for (std::size_t i = 0; i < count_ / step_; i += group_lanes) {
      GroupFloats faces = GroupFloats::load(memory_.face + i);
      GroupFloats x = GroupFloats::load(memory_.x + i), y = GroupFloats::load(memory_.y + i), cells(0.0f);
      for (std::uint32_t left = first_lanes<group_lanes>(group_lanes); left != 0;) {
        const float face = memory_.face[i + static_cast<std::size_t>(std::countr_zero(left))];
        auto same = faces == GroupFloats(face);
        left &= ~bits(same);
        cells = select(same, as<float>(memory_.grid[static_cast<int>(face)].cells(x, y)), cells);
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
  // If a group has no room for a strip.
  void one_by_one() {
    const std::size_t strips = step_ == 1 ? 0 : count_ / step_;
    for (std::size_t i = strips; i-- > 0;)
      for (std::uint32_t k = step_; k-- > 0;) memory_.first[step_ * i + k] = memory_.first[i] + k;
    if (strips != 0) count_ = step_ * strips, step_ = 1;
  }
  void pad() {
    const std::size_t count = count_ / step_;
    for (std::size_t i = 0; i < (groups_ahead + 1) * group_lanes; ++i)
      memory_.first[count + i] = memory_.first[count - 1];
  }

  Memory& memory_;
  const Ray* rays_;
  std::size_t count_;
  std::uint32_t step_;
  FaceRange range_[cube_faces];
  std::uint32_t cells_;
};

}  // namespace
}  // namespace raylanes

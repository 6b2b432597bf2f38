// Rays of doubles that share an origin, or end at a point, moved to the frame in registers.
#pragma once

#include "../ray/ray_columns.hpp"
#include "../traverse/packet/frusta.hpp"
#include "doubles_together.hpp"

namespace raylanes {
namespace {

struct DoublePacketBatch : DoublesTogether {
  Double3 apex;  // the origin of all, or where all end
  double scale;  // of the frame
  bool ends_there = false;

  // How far a line passes an apex where it ends, at most, in the frame, and by how much t is off there; docs/exact.md,
  // part 7.
  float apex_offset() const { return ends_there ? 0x1p-47f : 0.0f; }
  double t_error() const { return ends_there ? 0x1p-52 : 0.0; }

  // Turns rays round if they end at the apex. If a segment lies between its points, 1 − t is exact.
  template <class V>
  void look_from_apex(V (&row)[row_floats]) const {
    if (!ends_there) return;
    V begin = row[3];
    row[3] = V(1.0) - row[7], row[7] = V(1.0) - begin;
    for (int k = 4; k < 7; ++k) row[k] = -row[k];
  }
  // Which rays have the apex, and are no farther from it than offsets bear.
  template <class V>
  MaskOf<V> have_apex(const V (&row)[row_floats]) const {
    auto have = row[3] <= row[7];
    for (int k = 0; k < 3; ++k) {
      V at(apex[static_cast<std::size_t>(k)]);
      have = have & (ends_there ? (at - row[k] == -row[4 + k]) & (abs(row[4 + k]) * V(scale) <= V(32.0))
                                : row[k] == at);
    }
    return ends_there ? have & (row[7] <= V(1.0)) : have;
  }
};

// Rays of the batch from `first` on in the frame, the last one again behind the end of `size`: of those without the
// apex, or with unusual numbers, no numbers.
[[gnu::noinline, gnu::flatten]] void move_rays(const DoublePacketBatch& batch, const Float3& origin,
                                               std::size_t first, std::size_t size, Ray* moved) {
  constexpr int N = W == 1 ? 1 : W / 2;
  using V = Doubles<N>;
  using Words = Lanes<std::uint64_t, N>;
  constexpr std::uint64_t exponent_bits = 0x7ff0000000000000ull, twice_one = 0x7fe0000000000000ull;
  V column[4][2];
  for (int half = 0; half < W / N; ++half) {
    const void* rows[N];
    for (std::size_t lane = 0; lane < N; ++lane) {
      const std::size_t i = first + static_cast<std::size_t>(half * N) + lane;
      rows[lane] = batch.doubles + (i < size ? i : size - 1);
    }
    V row[row_floats];
    load_rows(rows, row);
    batch.look_from_apex(row);
    const V* const d = row + 4;
    V largest = max(max(abs(d[0]), abs(d[1])), abs(d[2])), end = min(row[7], V(largest_double)), zero(0.0);
    // Maxima and minima forget NaN.
    auto is_usual = (abs(d[0]) <= V(0x1p400)) & (abs(d[1]) <= V(0x1p400)) & (abs(d[2]) <= V(0x1p400)) &
                    (largest >= V(0x1p-400)) & (row[3] >= zero) & (row[3] <= end) & batch.have_apex(row);
    const Words exponent = as<std::uint64_t>(largest) & Words(exponent_bits);
    const V of_direction = as<double>(Words(twice_one) - exponent),
            of_t = as<double>(exponent) * V(batch.scale);
    for (int k = 0; k < 3; ++k) column[k][half] = d[k] * of_direction;
    column[3][half] = select(is_usual, rounded_up_in_frame(end, of_t), V(-1.0));
  }
  const auto floats = [&](int k) { return floats_of<W>([&](int half) { return column[k][half]; }, 1); };
  const Floats<W> columns[row_floats] = {Floats<W>(origin[0]),
                                         Floats<W>(origin[1]),
                                         Floats<W>(origin[2]),
                                         Floats<W>(0.0f),
                                         floats(0),
                                         floats(1),
                                         floats(2),
                                         floats(3)};
  void* rows[W];
  for (std::size_t lane = 0; lane < W; ++lane) rows[lane] = moved + first + lane;
  store_rows(rows, columns);
}

}  // namespace
}  // namespace raylanes

// Rays of doubles that share an origin, moved to the frame in registers.
#pragma once

#include "../ray/ray_columns.hpp"
#include "../traverse/packet/frusta.hpp"
#include "doubles_together.hpp"

namespace raylanes {
namespace {

struct DoublePacketBatch : DoublesTogether {
  Double3 origin;  // of all
  double scale;    // of the frame
};

// Rays of the batch from `first` on in the frame, the last one again behind the end of `size`: of those without that
// origin, or with unusual numbers, no numbers.
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
    const V* const d = row + 4;
    V largest = max(max(abs(d[0]), abs(d[1])), abs(d[2])), end = min(row[7], V(largest_double)), zero(0.0);
    // Maxima and minima forget NaN.
    auto is_usual = (abs(d[0]) <= V(0x1p400)) & (abs(d[1]) <= V(0x1p400)) & (abs(d[2]) <= V(0x1p400)) &
                    (largest >= V(0x1p-400)) & (row[3] >= zero) & (row[3] <= end) & (row[3] <= row[7]);
    for (std::size_t k = 0; k < 3; ++k) is_usual = is_usual & (row[k] == V(batch.origin[k]));
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

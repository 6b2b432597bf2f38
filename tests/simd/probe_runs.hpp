// Operations of the vocabulary on arrays: one register of each operand after the other. For the objects of a path.
#pragma once

#include "../../kernels/simd/vocabulary.hpp"
#include "vocabulary_probe.hpp"

namespace raylanes {
namespace {

template <class R, int N>
inline void write(Lanes<R, N> result, void* to) {
  result.store(static_cast<R*>(to));
}

// Truth values: lane i gets bit i of the mask; the last lane all bits from its own on, so that a bit too many
// is seen.
template <class T, int N>
inline void write(Mask<T, N> result, void* to) {
  using Integer = typename BitsOf<T>::type;
  const std::uint32_t lane_bits = bits(result);
  for (int i = 0; i < N; ++i) static_cast<Integer*>(to)[i] = i + 1 < N ? lane_bits >> i & 1u : lane_bits >> i;
}

// One truth value for the register.
template <class T, int N>
struct Uniform {
  bool value;
};
template <class T, int N>
inline void write(Uniform<T, N> result, void* to) {
  for (int i = 0; i < N; ++i) static_cast<typename BitsOf<T>::type*>(to)[i] = result.value ? 1u : 0u;
}

template <class T, int N, int Arity, class Operation>
void run(const void* const* operands, void* results, std::size_t n) {
  const auto lanes = [&](int operand, std::size_t i) {
    return Lanes<T, N>::load(static_cast<const T*>(operands[operand]) + i);
  };
  for (std::size_t i = 0; i < n; i += N) {
    void* const to = static_cast<T*>(results) + i;
    const Operation operation;
    if constexpr (Arity == 1)
      write(operation(lanes(0, i)), to);
    else if constexpr (Arity == 2)
      write(operation(lanes(0, i), lanes(1, i)), to);
    else if constexpr (Arity == 3)
      write(operation(lanes(0, i), lanes(1, i), lanes(2, i)), to);
    else
      write(operation(lanes(0, i), lanes(1, i), lanes(2, i), lanes(3, i)), to);
  }
}

template <class T, int N>
void run_broadcast(const void* const* operands, void* results, std::size_t n) {
  for (std::size_t i = 0; i < n; i += N)
    Lanes<T, N>(static_cast<const T*>(operands[0])[i]).store(static_cast<T*>(results) + i);
}

// Loads and stores of some lanes. The first word of the first operand's registers says which: its lowest bits are the
// bits of a mask, or modulo N + 1 their number. Then the values; of loads the fillers.
template <class T, int N>
Mask<T, N> some_lanes(const void* words, std::size_t i) {
  return Mask<T, N>::from_bits(
      static_cast<std::uint32_t>(static_cast<const typename BitsOf<T>::type*>(words)[i]) & ((1u << N) - 1u));
}
template <class T, int N>
std::size_t some_count(const void* words, std::size_t i) {
  return static_cast<std::size_t>(static_cast<const typename BitsOf<T>::type*>(words)[i] % (N + 1));
}
template <class T, int N, auto lanes_of>
void run_partial_load(const void* const* operands, void* results, std::size_t n) {
  for (std::size_t i = 0; i < n; i += N)
    Lanes<T, N>::load(static_cast<const T*>(operands[1]) + i, lanes_of(operands[0], i),
                      Lanes<T, N>::load(static_cast<const T*>(operands[2]) + i))
        .store(static_cast<T*>(results) + i);
}
template <class T, int N, auto lanes_of>
void run_partial_store(const void* const* operands, void* results, std::size_t n) {
  for (std::size_t i = 0; i < n; i += N)
    Lanes<T, N>::load(static_cast<const T*>(operands[1]) + i)
        .store(static_cast<T*>(results) + i, lanes_of(operands[0], i));
}

// Number k of row i is the value of lane i with k added to its bits; register i of the operand looks at number i % 8.
template <int N>
struct EightOf {
  float row[N][row_floats];
  explicit EightOf(const float* values) {
    for (int i = 0; i < N; ++i)
      for (std::uint32_t k = 0; k < row_floats; ++k)
        row[i][k] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(values[i]) + k);
  }
};
template <int N>
void run_load_rows(const void* const* operands, void* results, std::size_t n) {
  for (std::size_t i = 0; i < n; i += N) {
    const EightOf<N> eight(static_cast<const float*>(operands[0]) + i);
    const void* rows[N];
    for (int lane = 0; lane < N; ++lane) rows[lane] = eight.row[lane];
    Floats<N> columns[row_floats];
    load_rows(rows, columns);
    columns[i / N % row_floats].store(static_cast<float*>(results) + i);
  }
}
// Row j has the bits of lane j, of which number k has k more.
template <int N>
void run_load_double_rows(const void* const* operands, void* results, std::size_t n) {
  for (std::size_t i = 0; i < n; i += N) {
    std::uint64_t row[N][row_floats];
    for (int lane = 0; lane < N; ++lane)
      for (int k = 0; k < row_floats; ++k)
        row[lane][k] = static_cast<const std::uint64_t*>(operands[0])[i + static_cast<std::size_t>(lane)] +
                       static_cast<std::uint64_t>(k);
    const void* rows[N];
    for (int lane = 0; lane < N; ++lane) rows[lane] = row[lane];
    Lanes<double, N> columns[row_floats];
    load_rows(rows, columns);
    columns[i / N % row_floats].store(static_cast<double*>(results) + i);
  }
}
template <int N>
void run_store_rows(const void* const* operands, void* results, std::size_t n) {
  for (std::size_t i = 0; i < n; i += N) {
    const EightOf<N> eight(static_cast<const float*>(operands[0]) + i);
    Floats<N> columns[row_floats];
    for (int k = 0; k < row_floats; ++k) {
      float column[N];
      for (int lane = 0; lane < N; ++lane) column[lane] = eight.row[lane][k];
      columns[k] = Floats<N>::load(column);
    }
    float back[N][row_floats];
    void* rows[N];
    for (int lane = 0; lane < N; ++lane) rows[lane] = back[lane];
    store_rows(rows, columns);
    for (std::size_t lane = 0; lane < N; ++lane)
      static_cast<float*>(results)[i + lane] = back[lane][i / N % row_floats];
  }
}
// The index that the vocabulary gives a lane's record. Fewer than four lanes have no strips.
template <int N>
constexpr int record_of_lane(int lane) {
  return 4 * strip_of_lane<N>(lane) + row_in_strip<N>(lane);
}
template <int N>
void run_load_strips(const void* const* operands, void* results, std::size_t n) {
  if constexpr (N < 4) return run_load_rows<N>(operands, results, n);
  for (std::size_t i = 0; i < n; i += N) {
    const EightOf<N> eight(static_cast<const float*>(operands[0]) + i);
    float records[N][row_floats];
    for (int lane = 0; lane < N; ++lane)
      for (int k = 0; k < row_floats; ++k) records[record_of_lane<N>(lane)][k] = eight.row[lane][k];
    Floats<N> columns[row_floats];
    if constexpr (N >= 4) {
      const void* strips[N / 4];
      for (int strip = 0; strip < N / 4; ++strip) strips[strip] = records[4 * strip];
      load_strips(strips, columns);
    }
    columns[i / N % row_floats].store(static_cast<float*>(results) + i);
  }
}
// Both halves of the numbers, four at a time.
template <int N>
void run_store_strips(const void* const* operands, void* results, std::size_t n) {
  if constexpr (N < 4) return run_store_rows<N>(operands, results, n);
  for (std::size_t i = 0; i < n; i += N) {
    const EightOf<N> eight(static_cast<const float*>(operands[0]) + i);
    const std::size_t asked = i / N % row_floats;
    Floats<N> columns[4];
    for (std::size_t k = 0; k < 4; ++k) {
      float column[N];
      for (int lane = 0; lane < N; ++lane) column[lane] = eight.row[lane][asked / 4 * 4 + k];
      columns[k] = Floats<N>::load(column);
    }
    float records[N][4];
    if constexpr (N >= 4) {
      void* strips[N / 4];
      for (int strip = 0; strip < N / 4; ++strip) strips[strip] = records[4 * strip];
      store_strips(strips, columns);
    }
    for (int lane = 0; lane < N; ++lane)
      static_cast<float*>(results)[i + static_cast<std::size_t>(lane)] =
          records[record_of_lane<N>(lane)][asked % 4];
  }
}
// Behind the packed words their number.
template <int N>
void run_compress(const void* const* operands, void* results, std::size_t n) {
  for (std::size_t i = 0; i < n; i += N) {
    const auto words = FloatBits<N>::load(static_cast<const std::uint32_t*>(operands[1]) + i);
    auto* const to = static_cast<std::uint32_t*>(results) + i;
    const int count = compress_store(to, some_lanes<float, N>(operands[0], i), words);
    for (int lane = count; lane < N; ++lane) to[lane] = static_cast<std::uint32_t>(count);
  }
}

}  // namespace
}  // namespace raylanes

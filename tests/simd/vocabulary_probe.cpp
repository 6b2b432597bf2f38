// The vocabulary's operations as functions on arrays, compiled once per path with the flags and back end of
// the units of kernels/. The table is the only symbol that leaves the object.
#include "vocabulary_probe.hpp"

#include "../../kernels/simd/vocabulary.hpp"
#include "probe_runs.hpp"

namespace raylanes {
namespace {

template <class T, int N, int Arity, class Operation>
constexpr Probe probe(const char* operation, Operation) {
  return {operation, Arity, run<T, N, Arity, Operation>};
}

template <std::size_t Count>
struct ProbeList {
  Probe probes[Count];
};
template <class... Probes>
constexpr ProbeList<sizeof...(Probes)> list_of(Probes... probes) {
  return {{probes...}};
}

template <class T, int N>
constexpr auto number_probes() {
  using All = Uniform<T, N>;
  return list_of(
      probe<T, N, 1>("load_store", [](auto a) { return a; }), Probe{"broadcast", 1, run_broadcast<T, N>},  //
      Probe{"load_mask", 3, run_partial_load<T, N, some_lanes<T, N>>},
      Probe{"load_first", 3, run_partial_load<T, N, some_count<T, N>>},
      Probe{"store_mask", 2, run_partial_store<T, N, some_lanes<T, N>>},
      Probe{"store_first", 2, run_partial_store<T, N, some_count<T, N>>},
      probe<T, N, 1>("bits_again", [](auto a) { return Mask<T, N>::from_bits(bits(a > Lanes<T, N>(T(0)))); }),
      probe<T, N, 2>("add", [](auto a, auto b) { return a + b; }),
      probe<T, N, 2>("subtract", [](auto a, auto b) { return a - b; }),
      probe<T, N, 2>("multiply", [](auto a, auto b) { return a * b; }),
      probe<T, N, 2>("divide", [](auto a, auto b) { return a / b; }),
      probe<T, N, 1>("negate", [](auto a) { return -a; }),
      probe<T, N, 1>("sqrt", [](auto a) { return sqrt(a); }),
      probe<T, N, 1>("rsqrt_estimate", [](auto a) { return select(in_domain(a), rsqrt_estimate(a), a); }),
      probe<T, N, 1>("abs", [](auto a) { return abs(a); }),
      probe<T, N, 2>("min", [](auto a, auto b) { return min(a, b); }),
      probe<T, N, 2>("max", [](auto a, auto b) { return max(a, b); }),
      probe<T, N, 2>("less", [](auto a, auto b) { return a < b; }),
      probe<T, N, 2>("less_equal", [](auto a, auto b) { return a <= b; }),
      probe<T, N, 2>("greater", [](auto a, auto b) { return a > b; }),
      probe<T, N, 2>("greater_equal", [](auto a, auto b) { return a >= b; }),
      probe<T, N, 2>("equal", [](auto a, auto b) { return a == b; }),
      probe<T, N, 3>("mask_and", [](auto a, auto b, auto c) { return (a < b) & (b < c); }),
      probe<T, N, 3>("mask_or", [](auto a, auto b, auto c) { return (a < b) | (b < c); }),
      probe<T, N, 2>("mask_not", [](auto a, auto b) { return ~(a < b); }),
      probe<T, N, 3>("select", [](auto a, auto b, auto c) { return select(a < b, c, a); }),
      probe<T, N, 1>("bits", [](auto a) { return a > Lanes<T, N>(T(0)); }),
      probe<T, N, 1>("any", [](auto a) { return All{any(a > Lanes<T, N>(T(0)))}; }),
      probe<T, N, 1>("all", [](auto a) { return All{all(a > Lanes<T, N>(T(0)))}; }),
      // A complement must not set bits above the last lane, where any and all could see them.
      probe<T, N, 1>("any_of_complement", [](auto a) { return All{any(~(a > Lanes<T, N>(T(0))))}; }),
      probe<T, N, 1>("all_of_complement", [](auto a) { return All{all(~(a > Lanes<T, N>(T(0))))}; }),
      probe<T, N, 1>("as_integer", [](auto a) { return as<typename BitsOf<T>::type>(a); }),
      probe<T, N, 3>("multiply_add_reproducible",
                     [](auto a, auto b, auto c) { return multiply_add<Grade::reproducible>(a, b, c); }),
      probe<T, N, 3>("multiply_add_fast",
                     [](auto a, auto b, auto c) { return multiply_add<Grade::fast>(a, b, c); }),
      probe<T, N, 4>("difference_of_products_reproducible",
                     [](auto a, auto b, auto c, auto d) {
                       return difference_of_products<Grade::reproducible>(a, b, c, d);
                     }),
      probe<T, N, 4>("difference_of_products_fast", [](auto a, auto b, auto c, auto d) {
        return difference_of_products<Grade::fast>(a, b, c, d);
      }));
}

// Estimates where they are defined, elsewhere the operand.
template <class V>
inline auto in_domain(V size) {
  return ((size >= V(0x1p-126f)) & (size <= V(0x1p125f))) | ~(size == size);
}
template <int N>
constexpr auto float_probes() {
  return list_of(
      Probe{"load_rows", 1, run_load_rows<N>}, Probe{"store_rows", 1, run_store_rows<N>},
      Probe{"load_strips", 1, run_load_strips<N>}, Probe{"store_strips", 1, run_store_strips<N>},
      Probe{"compress_store", 2, run_compress<N>},
      probe<float, N, 1>("reciprocal_estimate",
                         [](auto a) { return select(in_domain(abs(a)), reciprocal_estimate(a), a); }),
      probe<float, N, 3>("select_negative", [](auto s, auto a, auto b) { return select_negative(s, a, b); }),
      probe<float, N, 2>("subtract_by_multipliers",
                         [](auto a, auto b) { return subtract_by_multipliers(a, b, opaque_one<N>()); }));
}

template <class T, int N>
constexpr auto fused_probes() {
  return list_of(probe<T, N, 3>("fused", [](auto a, auto b, auto c) { return fused(a, b, c); }));
}

template <class T>
inline constexpr int last_bit = static_cast<int>(sizeof(T)) * 8 - 1;

template <class T, int N, class Number>
constexpr auto integer_probes() {
  return list_of(probe<T, N, 1>("load_store", [](auto a) { return a; }),
                 Probe{"broadcast", 1, run_broadcast<T, N>},
                 probe<T, N, 2>("add", [](auto a, auto b) { return a + b; }),
                 probe<T, N, 2>("subtract", [](auto a, auto b) { return a - b; }),
                 probe<T, N, 2>("and", [](auto a, auto b) { return a & b; }),
                 probe<T, N, 2>("or", [](auto a, auto b) { return a | b; }),
                 probe<T, N, 2>("xor", [](auto a, auto b) { return a ^ b; }),
                 probe<T, N, 2>("max", [](auto a, auto b) { return max(a, b); }),
                 probe<T, N, 1>("shift_left_1", [](auto a) { return shift_left<1>(a); }),
                 probe<T, N, 1>("shift_left_11", [](auto a) { return shift_left<11>(a); }),
                 probe<T, N, 1>("shift_left_last", [](auto a) { return shift_left<last_bit<T>>(a); }),
                 probe<T, N, 1>("shift_right_1", [](auto a) { return shift_right<1>(a); }),
                 probe<T, N, 1>("shift_right_11", [](auto a) { return shift_right<11>(a); }),
                 probe<T, N, 1>("shift_right_last", [](auto a) { return shift_right<last_bit<T>>(a); }),
                 probe<T, N, 1>("as_number", [](auto a) { return as<Number>(a); }));
}

template <class T, int N>
constexpr auto numbers = number_probes<T, N>();
template <class T, int N, class Number>
constexpr auto integers = integer_probes<T, N, Number>();

#if defined(__AVX2__) && defined(__FMA__)
// Register i of the operand looks at half i % 2 of the eight lanes that have its lane i / 2 % 4.
void run_eight_of_lane(const void* const* operands, void* results, std::size_t n) {
  for (std::size_t i = 0; i < n; i += 4) {
    const auto four = Floats<4>::load(static_cast<const float*>(operands[0]) + i);
    const Floats<8> each[] = {eight_of_lane<0>(four), eight_of_lane<1>(four), eight_of_lane<2>(four),
                              eight_of_lane<3>(four)};
    float eight[8];
    each[i / 8 % 4].store(eight);
    for (std::size_t lane = 0; lane < 4; ++lane)
      static_cast<float*>(results)[i + lane] = eight[i / 4 % 2 * 4 + lane];
  }
}
template <class T>
constexpr auto four_probes() {
  return list_of(probe<T, 4, 1>("permute_1203", [](auto a) { return permute<1, 2, 0, 3>(a); }),
                 probe<T, 4, 1>("permute_2031", [](auto a) { return permute<2, 0, 3, 1>(a); }),
                 probe<T, 4, 1>("permute_3333", [](auto a) { return permute<3, 3, 3, 3>(a); }),
                 probe<T, 4, 2>("blend_1000", [](auto a, auto b) { return blend<8>(a, b); }),
                 probe<T, 4, 2>("blend_0110", [](auto a, auto b) { return blend<6>(a, b); }));
}
constexpr auto four_floats_probes() {
  return list_of(Probe{"eight_of_lane", 1, run_eight_of_lane},
                 probe<float, 4, 1>("four_floats",
                                    [](auto a) {
                                      float x[4];
                                      a.store(x);
                                      return four_floats(x[0], x[1], x[2], x[3]);
                                    }),
                 probe<float, 4, 2>("permute_by",
                                    [](auto a, auto order) { return permute(a, as<std::uint32_t>(order)); }),
                 probe<float, 4, 2>("add_as_doubles", [](auto a, auto b) {
                   return to_four_floats(to_four_doubles(a) + to_four_doubles(b));
                 }));
}
template <int k>
constexpr auto column = [](auto a, auto b, auto c, auto d) {
  Lanes<double, 4> columns[3];
  three_columns(a, b, c, d, columns);
  return columns[k];
};
constexpr auto four_doubles_probes() {
  return list_of(
      probe<double, 4, 4>("four_sums", [](auto a, auto b, auto c, auto d) { return four_sums(a, b, c, d); }),
      probe<double, 4, 4>("column_0", column<0>), probe<double, 4, 4>("column_1", column<1>),
      probe<double, 4, 4>("column_2", column<2>), probe<double, 4, 1>("four_doubles", [](auto a) {
        double x[4];
        a.store(x);
        return four_doubles(x[0], x[1], x[2], x[3]);
      }));
}
constexpr auto eight_words_probes() {
  using Words = FloatBits<8>;
  const auto sort = [](auto a) { return sort_descending_signed(a); };
  return list_of(
      probe<std::uint32_t, 8, 2>("permute_by", [](auto a, auto order) { return permute(a, order); }),
      probe<std::uint32_t, 8, 1>("min_unsigned", [](auto a) { return Words(min_unsigned(in_memory(a))); }),
      probe<std::uint32_t, 8, 1>("sort_descending_signed", sort),
      probe<std::uint32_t, 8, 1>("sort_zeros_and_ones", sort));
}
#endif

template <std::size_t Count>
constexpr ProbeGroup group(const char* element, int lanes, const ProbeList<Count>& list) {
  return {element, lanes, list.probes, Count};
}

template <int N>
constexpr auto rows_of_doubles = list_of(Probe{"load_rows", 1, run_load_double_rows<N>});
template <int N>
constexpr auto reciprocals = float_probes<N>();
template <class T, int N>
[[maybe_unused]] constexpr auto fused_numbers = fused_probes<T, N>();

#if defined(__AVX2__) && defined(__FMA__)
template <class T>
constexpr auto fours = four_probes<T>();
constexpr auto fours_of_floats = four_floats_probes();
constexpr auto fours_of_doubles = four_doubles_probes();
constexpr auto eights_of_words = eight_words_probes();
#endif

struct GroupList {
  ProbeGroup groups[24];
  std::size_t count;

  constexpr void add(const ProbeGroup& group) { groups[count++] = group; }
};

// Lanes of 32 bits, and half as many of 64, which fill the same register.
template <int N>
constexpr void add_groups(GroupList& list) {
  constexpr int half = N > 1 ? N / 2 : 1;
  list.add(group("float", N, numbers<float, N>));
  list.add(group("float", N, reciprocals<N>));
  list.add(group("double", half, numbers<double, half>));
  list.add(group("double", half, rows_of_doubles<half>));
  list.add(group("uint32", N, integers<std::uint32_t, N, float>));
  list.add(group("uint64", half, integers<std::uint64_t, half, double>));
  if constexpr (has_fma) {
    list.add(group("float", N, fused_numbers<float, N>));
    list.add(group("double", half, fused_numbers<double, half>));
  }
}

template <int N>
constexpr GroupList all_groups() {
  GroupList list{};
  add_groups<N>(list);
  if constexpr (N == 16) add_groups<N / 2>(list);  // the registers that a node of a tree fills
#if defined(__AVX2__) && defined(__FMA__)
  list.add(group("node float", 4, fours<float>)), list.add(group("node float", 4, fours_of_floats));
  list.add(group("node double", 4, fours<double>)), list.add(group("node double", 4, fours_of_doubles));
  list.add(group("node word", 8, eights_of_words));
#endif
  return list;
}

constexpr GroupList groups = all_groups<native_lanes>();

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_PROBES_OF(path) RAYLANES_JOIN(path, _probes)

extern constinit const ProbeTable RAYLANES_PROBES_OF(RAYLANES_PATH_NAME);
constinit const ProbeTable RAYLANES_PROBES_OF(RAYLANES_PATH_NAME) = {groups.groups, groups.count,
                                                                     native_lanes, has_fma};

}  // namespace detail
}  // namespace raylanes

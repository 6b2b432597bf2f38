// The vocabulary's meaning in plain scalar code, operation by operation, on the bits of the operands.
#pragma once

#include "../support/testing.hpp"
#include "../support/system/fused.hpp"

namespace raylanes::testing {

// The unsigned integer as wide as T.
template <class T>
using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

// One register's worth of each operand.
template <class T>
struct Register {
  std::size_t lanes;
  std::size_t index;  // of the register in the arrays
  const Bits<T>* operand[4];
};

// The values that the operands run through.
enum class Inputs : std::uint8_t {
  values,  // extremes in all combinations, and random bits
  masks    // zeros and ones, so that all 2^lanes masks occur
};

template <class T>
struct Reference {
  std::string operation;
  int arity;
  Inputs inputs;
  bool rounds;  // the result is a rounded number: IEEE leaves the sign and the payload of a NaN free
  // Writes the expected results; leaves alone what the operation must leave alone.
  std::function<void(const Register<T>&, Bits<T>* expected)> apply;
  double tolerance = 0.0;  // relative error allowed
};

// An operation lane by lane; f takes the bits of its operands and gives the bits of the result, or a
// truth value.
template <class T, int Arity, class F>
Reference<T> lanewise(const char* operation, bool rounds, F f) {
  return {operation, Arity, Inputs::values, rounds, [f](const Register<T>& r, Bits<T>* expected) {
            for (std::size_t i = 0; i < r.lanes; ++i) {
              const auto at = [&](int k) { return r.operand[k][i]; };
              if constexpr (Arity == 1) expected[i] = f(at(0));
              if constexpr (Arity == 2) expected[i] = f(at(0), at(1));
              if constexpr (Arity == 3) expected[i] = f(at(0), at(1), at(2));
              if constexpr (Arity == 4) expected[i] = f(at(0), at(1), at(2), at(3));
            }
          }};
}

// The same for rounded arithmetic: f takes and gives numbers.
template <class T, int Arity, class F>
Reference<T> rounded(const char* operation, F f) {
  return lanewise<T, Arity>(operation, true, [f](auto... operands) {
    return std::bit_cast<Bits<T>>(static_cast<T>(f(std::bit_cast<T>(operands)...)));
  });
}

// An estimate of f within 1.5·2^-12 where the operand, or its magnitude, is in [2^-126, 2^125] or NaN;
// elsewhere the operand.
template <class T, class F>
Reference<T> estimated(const char* operation, bool of_magnitude, F f) {
  Reference<T> reference = rounded<T, 1>(operation, [of_magnitude, f](T a) {
    const T size = of_magnitude ? std::fabs(a) : a;
    return size < T(0x1p-126f) || size > T(0x1p125f) ? a : f(a);
  });
  reference.tolerance = 1.5 * 0x1p-12;
  return reference;
}

// The same for a truth value of numbers.
template <class T, int Arity, class F>
Reference<T> decided(const char* operation, F f) {
  return lanewise<T, Arity>(operation, false, [f](auto... operands) {
    return f(std::bit_cast<T>(operands)...) ? Bits<T>(1) : Bits<T>(0);
  });
}

// A truth value of a whole mask, given in all lanes; f takes the number of its lanes that are true and of
// all.
template <class T, class F>
Reference<T> reduced(const char* operation, F f) {
  return {operation, 1, Inputs::masks, false, [f](const Register<T>& r, Bits<T>* expected) {
            std::size_t set = 0;
            for (std::size_t i = 0; i < r.lanes; ++i) set += std::bit_cast<T>(r.operand[0][i]) > T(0);
            for (std::size_t i = 0; i < r.lanes; ++i) expected[i] = f(set, r.lanes) ? 1 : 0;
          }};
}

// Checks that hold for numbers and integers alike.
template <class T>
std::vector<Reference<T>> memory_references() {
  const auto repeated = [](const Register<T>& r, Bits<T>* expected) {
    for (std::size_t i = 0; i < r.lanes; ++i) expected[i] = r.operand[0][0];
  };
  return {lanewise<T, 1>("load_store", false, [](auto a) { return a; }),
          {"broadcast", 1, Inputs::values, false, repeated}};
}

// Loads and stores of some lanes, which the first word of the register says: as a mask, or modulo lanes + 1 as
// their number. Stores leave the other lanes alone.
template <class T>
std::vector<Reference<T>> partial_references() {
  std::vector<Reference<T>> list;
  for (const bool by_mask : {true, false}) {
    const auto takes_part = [by_mask](const Register<T>& r, std::size_t lane) {
      const Bits<T> word = r.operand[0][0];
      return by_mask ? (word >> lane & 1u) != 0 : lane < word % (r.lanes + 1);
    };
    const auto load = [takes_part](const Register<T>& r, Bits<T>* expected) {
      for (std::size_t i = 0; i < r.lanes; ++i) expected[i] = r.operand[takes_part(r, i) ? 1 : 2][i];
    };
    const auto store = [takes_part](const Register<T>& r, Bits<T>* expected) {
      for (std::size_t i = 0; i < r.lanes; ++i)
        if (takes_part(r, i)) expected[i] = r.operand[1][i];
    };
    list.push_back({by_mask ? "load_mask" : "load_first", 3, Inputs::values, false, load});
    list.push_back({by_mask ? "store_mask" : "store_first", 2, Inputs::values, false, store});
  }
  return list;
}

// float and double; `fuses`: the path has fused multiply-add.
template <class T>
std::vector<Reference<T>> number_references(bool fuses) {
  using B = Bits<T>;
  constexpr B sign = B(1) << (sizeof(T) * 8 - 1);
  const auto less = [](B a, B b) { return std::bit_cast<T>(a) < std::bit_cast<T>(b); };
  const auto multiply_add = [](T a, T b, T c) { return a * b + c; };
  const auto fused = [](T a, T b, T c) { return fused_multiply_add(a, b, c); };
  const auto difference = [](T a, T b, T c, T d) { return a * b - c * d; };
  const auto kahan = [](T a, T b, T c, T d) {
    const T cd = c * d;
    return fused_multiply_add(a, b, -cd) + fused_multiply_add(-c, d, cd);
  };
  std::vector<Reference<T>> list = memory_references<T>();
  const std::vector<Reference<T>> rest = {
      rounded<T, 2>("add", [](T a, T b) { return a + b; }),
      rounded<T, 2>("subtract", [](T a, T b) { return a - b; }),
      rounded<T, 2>("multiply", [](T a, T b) { return a * b; }),
      rounded<T, 2>("divide", [](T a, T b) { return a / b; }),
      rounded<T, 1>("sqrt", [](T a) { return std::sqrt(a); }),
      estimated<T>("rsqrt_estimate", false, [](T a) { return T(1) / std::sqrt(a); }),
      lanewise<T, 1>("negate", false, [](B a) { return a ^ sign; }),
      lanewise<T, 1>("abs", false, [](B a) { return a & ~sign; }),
      lanewise<T, 2>("min", false, [less](B a, B b) { return less(a, b) ? a : b; }),
      lanewise<T, 2>("max", false, [less](B a, B b) { return less(b, a) ? a : b; }),
      decided<T, 2>("less", [](T a, T b) { return a < b; }),
      decided<T, 2>("less_equal", [](T a, T b) { return a <= b; }),
      decided<T, 2>("greater", [](T a, T b) { return a > b; }),
      decided<T, 2>("greater_equal", [](T a, T b) { return a >= b; }),
      decided<T, 2>("equal", [](T a, T b) { return a == b; }),
      decided<T, 3>("mask_and", [](T a, T b, T c) { return a < b && b < c; }),
      decided<T, 3>("mask_or", [](T a, T b, T c) { return a < b || b < c; }),
      decided<T, 2>("mask_not", [](T a, T b) { return !(a < b); }),
      lanewise<T, 3>("select", false, [less](B a, B b, B c) { return less(a, b) ? c : a; }),
      {"bits", 1, Inputs::masks, false, decided<T, 1>("", [](T a) { return a > T(0); }).apply},
      {"bits_again", 1, Inputs::masks, false, decided<T, 1>("", [](T a) { return a > T(0); }).apply},
      reduced<T>("any", [](auto set, auto) { return set > 0; }),
      reduced<T>("all", [](auto set, auto lanes) { return set == lanes; }),
      reduced<T>("any_of_complement", [](auto set, auto lanes) { return set < lanes; }),
      reduced<T>("all_of_complement", [](auto set, auto) { return set == 0; }),
      lanewise<T, 1>("as_integer", false, [](B a) { return a; }),
      rounded<T, 3>("multiply_add_reproducible", multiply_add),
      fuses ? rounded<T, 3>("multiply_add_fast", fused) : rounded<T, 3>("multiply_add_fast", multiply_add),
      rounded<T, 4>("difference_of_products_reproducible", difference),
      fuses ? rounded<T, 4>("difference_of_products_fast", kahan)
            : rounded<T, 4>("difference_of_products_fast", difference)};
  list.insert(list.end(), rest.begin(), rest.end());
  const std::vector<Reference<T>> partial = partial_references<T>();
  list.insert(list.end(), partial.begin(), partial.end());
  const auto row_number = [](const Register<T>& r, B* expected) {
    for (std::size_t i = 0; i < r.lanes; ++i) expected[i] = r.operand[0][i] + static_cast<B>(r.index % 8);
  };
  list.push_back({"load_rows", 1, Inputs::values, false, row_number});
  if constexpr (sizeof(T) == 4) {
    list.push_back(estimated<T>("reciprocal_estimate", true, [](T a) { return T(1) / a; }));
    list.push_back(lanewise<T, 3>("select_negative", false, [](B s, B a, B b) { return s & sign ? a : b; }));
    list.push_back({"store_rows", 1, Inputs::values, false, row_number});
    list.push_back({"load_strips", 1, Inputs::values, false, row_number});
    list.push_back({"store_strips", 1, Inputs::values, false, row_number});
    const auto packed = [](const Register<T>& r, B* expected) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < r.lanes; ++i)
        if ((r.operand[0][0] >> i & 1u) != 0) expected[count++] = r.operand[1][i];
      std::fill(expected + count, expected + r.lanes, static_cast<B>(count));
    };
    list.push_back({"compress_store", 2, Inputs::values, false, packed});
    list.push_back(rounded<T, 2>("subtract_by_multipliers", [](T a, T b) { return a - b; }));
  }
  if (fuses) list.push_back(rounded<T, 3>("fused", fused));
  return list;
}

// Operations on four floats or doubles, on paths with has_node_lanes.
template <class T>
std::vector<Reference<T>> four_references() {
  using B = Bits<T>;
  const auto permuted = [](const char* operation, std::array<std::size_t, 4> order) {
    return Reference<T>{operation, 1, Inputs::values, false, [order](const Register<T>& r, B* expected) {
                          for (std::size_t i = 0; i < 4; ++i) expected[i] = r.operand[0][order[i]];
                        }};
  };
  const auto blended = [](const char* operation, std::array<std::size_t, 4> chosen) {
    return Reference<T>{operation, 2, Inputs::values, false, [chosen](const Register<T>& r, B* expected) {
                          for (std::size_t i = 0; i < 4; ++i) expected[i] = r.operand[chosen[i]][i];
                        }};
  };
  std::vector<Reference<T>> list = {permuted("permute_1203", {1, 2, 0, 3}),
                                    permuted("permute_2031", {2, 0, 3, 1}),
                                    permuted("permute_3333", {3, 3, 3, 3}),
                                    blended("blend_1000", {0, 0, 0, 1}), blended("blend_0110", {0, 1, 1, 0})};
  if constexpr (sizeof(T) == 4) {
    list.push_back({"eight_of_lane", 1, Inputs::values, false, [](const Register<T>& r, B* expected) {
                      for (std::size_t i = 0; i < 4; ++i) expected[i] = r.operand[0][r.index / 2 % 4];
                    }});
    list.push_back(lanewise<T, 1>("four_floats", false, [](B a) { return a; }));
    list.push_back({"permute_by", 2, Inputs::values, false, [](const Register<T>& r, B* expected) {
                      for (std::size_t i = 0; i < 4; ++i) expected[i] = r.operand[0][r.operand[1][i] & 3u];
                    }});
    list.push_back(rounded<T, 2>("add_as_doubles", [](T a, T b) {
      return static_cast<T>(static_cast<double>(a) + static_cast<double>(b));
    }));
  } else {
    list.push_back({"four_sums", 4, Inputs::values, true, [](const Register<T>& r, B* expected) {
                      for (std::size_t i = 0; i < 4; ++i) {
                        const auto at = [&](std::size_t lane) {
                          return std::bit_cast<T>(r.operand[i][lane]);
                        };
                        expected[i] = std::bit_cast<B>((at(0) + at(1)) + (at(2) + at(3)));
                      }
                    }});
    const auto column = [](const char* operation, std::size_t k) {
      return Reference<T>{operation, 4, Inputs::values, false, [k](const Register<T>& r, B* expected) {
                            for (std::size_t i = 0; i < 4; ++i) expected[i] = r.operand[i][k];
                          }};
    };
    list.insert(list.end(), {column("column_0", 0), column("column_1", 1), column("column_2", 2),
                             lanewise<T, 1>("four_doubles", false, [](B a) { return a; })});
  }
  return list;
}

// Operations on eight words on the same paths. Zeros and ones in all orders prove a sorting network
// (Knuth).
inline std::vector<Reference<std::uint32_t>> eight_word_references() {
  using Words = Register<std::uint32_t>;
  const auto permuted = [](const Words& r, std::uint32_t* expected) {
    for (std::size_t i = 0; i < 8; ++i) expected[i] = r.operand[0][r.operand[1][i] & 7u];
  };
  const auto sorted = [](const Words& r, std::uint32_t* expected) {
    std::copy_n(r.operand[0], 8, expected);
    std::sort(expected, expected + 8, [](std::uint32_t a, std::uint32_t b) {
      return static_cast<std::int32_t>(a) > static_cast<std::int32_t>(b);
    });
  };
  const auto least = [](const Words& r, std::uint32_t* expected) {
    std::fill_n(expected, 8, *std::min_element(r.operand[0], r.operand[0] + 8));
  };
  return {{"permute_by", 2, Inputs::values, false, permuted},
          {"min_unsigned", 1, Inputs::values, false, least},
          {"sort_descending_signed", 1, Inputs::values, false, sorted},
          {"sort_zeros_and_ones", 1, Inputs::masks, false, sorted}};
}

// std::uint32_t and std::uint64_t.
template <class T>
std::vector<Reference<T>> integer_references() {
  constexpr int last = static_cast<int>(sizeof(T)) * 8 - 1;
  std::vector<Reference<T>> list = memory_references<T>();
  const std::vector<Reference<T>> rest = {
      lanewise<T, 2>("add", false, [](T a, T b) { return a + b; }),
      lanewise<T, 2>("subtract", false, [](T a, T b) { return a - b; }),
      lanewise<T, 2>("and", false, [](T a, T b) { return a & b; }),
      lanewise<T, 2>("or", false, [](T a, T b) { return a | b; }),
      lanewise<T, 2>("xor", false, [](T a, T b) { return a ^ b; }),
      lanewise<T, 2>("max", false, [](T a, T b) { return a < b ? b : a; }),
      lanewise<T, 1>("shift_left_1", false, [](T a) { return a << 1; }),
      lanewise<T, 1>("shift_left_11", false, [](T a) { return a << 11; }),
      lanewise<T, 1>("shift_left_last", false, [](T a) { return a << last; }),
      lanewise<T, 1>("shift_right_1", false, [](T a) { return a >> 1; }),
      lanewise<T, 1>("shift_right_11", false, [](T a) { return a >> 11; }),
      lanewise<T, 1>("shift_right_last", false, [](T a) { return a >> last; }),
      lanewise<T, 1>("as_number", false, [](T a) { return a; })};
  list.insert(list.end(), rest.begin(), rest.end());
  return list;
}

}  // namespace raylanes::testing

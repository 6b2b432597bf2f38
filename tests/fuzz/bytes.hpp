// The source of a fuzz target's decisions and numbers: the bytes it was given, and when they are used up
// a generator that they seed. So a few bytes fill arrays of any size, and each byte still steers something.
#pragma once

#include "../../bench/support/scenes/splitmix.hpp"
#include "../support/testing.hpp"

namespace raylanes::testing {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : given_(data, size), generator_(hash_of(given_)) {}

  std::uint8_t byte() {
    if (next_ < given_.size()) return given_[next_++];
    if (left_ == 0) generated_ = generator_.next(), left_ = 8;
    const auto low = static_cast<std::uint8_t>(generated_);
    generated_ >>= 8, --left_;
    return low;
  }
  template <class Word>
  Word word() {
    Word w = 0;
    for (std::size_t i = 0; i < sizeof w; ++i) w = static_cast<Word>(w << 8 | byte());
    return w;
  }
  bool chance(int of_256) { return byte() < of_256; }
  // In [0, count); 1 <= count <= 65536.
  std::size_t below(std::size_t count) {
    return count <= 256 ? byte() * count >> 8 : word<std::uint16_t>() * count >> 16;
  }
  template <class T, std::size_t n>
  const T& pick(const T (&choices)[n]) {
    return choices[below(n)];
  }
  template <class Container>
  const auto& pick(const Container& choices) {
    return choices[below(choices.size())];
  }

  // Any bits: special values, powers of two, small multiples of a half, repetitions and neighbours of earlier
  // numbers, and what is left of the bytes as it is.
  template <class T>
  T number() {
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    T x = 0;
    const std::uint8_t kind = byte();
    const Bits earlier = std::bit_cast<Bits>(static_cast<T>(earlier_[kind % earlier_.size()]));
    if (kind < 80) {
      x = std::bit_cast<T>(word<Bits>());
    } else if (kind < 120) {
      x = special<T>();
    } else if (kind < 150) {
      x = power_of_two<T>();
    } else if (kind < 180) {
      x = std::bit_cast<T>(earlier);
    } else if (kind < 190) {
      x = std::bit_cast<T>(kind % 2 == 0 ? earlier + 1 : earlier - 1);
    } else {
      x = static_cast<T>(static_cast<int>(byte()) - 128) / 2;
    }
    earlier_[count_++ % earlier_.size()] = static_cast<double>(x);
    return x;
  }

 private:
  static std::uint64_t hash_of(std::span<const std::uint8_t> bytes) {
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
    for (const std::uint8_t b : bytes) hash = (hash ^ b) * 0x100000001b3u;
    return hash;
  }
  template <class T>
  T special() {
    using Limits = std::numeric_limits<T>;
    const T values[] = {0,
                        1,
                        Limits::quiet_NaN(),
                        Limits::signaling_NaN(),
                        Limits::infinity(),
                        Limits::max(),
                        static_cast<T>(3e38),
                        static_cast<T>(2e38),
                        Limits::min(),
                        Limits::min() / 2,
                        Limits::denorm_min(),
                        Limits::epsilon(),
                        1 - Limits::epsilon() / 2,
                        1 + Limits::epsilon(),
                        static_cast<T>(1e30),
                        static_cast<T>(1e-30)};
    const std::uint8_t which = byte();
    const T value = values[which % std::size(values)];
    return which < 128 ? value : -value;
  }
  template <class T>
  T power_of_two() {
    constexpr int mantissa = std::numeric_limits<T>::digits - 1;
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    const Bits sign = static_cast<Bits>(byte() & 1u) << (8 * sizeof(T) - 1);
    const Bits exponent = sizeof(T) == 4 ? byte() : word<std::uint16_t>() & 0x7ffu;
    return std::bit_cast<T>(sign | exponent << mantissa);
  }

  std::span<const std::uint8_t> given_;
  std::size_t next_ = 0;
  bench::SplitMix generator_;
  std::uint64_t generated_ = 0;
  int left_ = 0;
  std::array<double, 16> earlier_{};
  std::size_t count_ = 0;
};

}  // namespace raylanes::testing

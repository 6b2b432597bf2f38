// Takes the place of GMP's C++ interface where there is no GMP, as for Windows: what the tests use of it, by the
// integers of Boost. Fractions are exact; they are not reduced, but for powers of two.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <compare>
#include <concepts>
#include <ostream>
#include <utility>

class mpz_class {
 public:
  using Integer =
      boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

  mpz_class() = default;
  template <class T>
  requires(std::is_arithmetic_v<T>) mpz_class(T value) : value_(value) {}
  mpz_class(Integer value) : value_(std::move(value)) {}

  const Integer& value() const { return value_; }
  friend mpz_class operator<<(const mpz_class& a, unsigned long bits) { return Integer(a.value_ << bits); }
  mpz_class& operator<<=(unsigned long bits) { return *this = *this << bits; }

 private:
  Integer value_ = 0;
};

// n·2^e/d, d odd and positive, n odd or 0.
class mpq_class {
  using Integer = mpz_class::Integer;

 public:
  mpq_class() = default;
  template <std::integral T>
  mpq_class(T value) : n_(value) {
    reduce();
  }
  template <std::floating_point T>
  mpq_class(T value) {
    int exponent = 0;
    n_ = static_cast<long long>(std::ldexp(std::frexp(value, &exponent), 63)), e_ = exponent - 63;
    reduce();
  }
  mpq_class(const mpz_class& n, const mpz_class& d = 1) : n_(n.value()), d_(d.value()) {
    if (d_ < 0) n_ = -n_, d_ = -d_;
    reduce();
  }

  // Rounded to zero, as GMP does.
  double get_d() const {
    if (n_ == 0) return 0.0;
    const Integer magnitude = abs(n_);
    const long shift = 54 + static_cast<long>(msb(d_)) - static_cast<long>(msb(magnitude));
    Integer quotient = shifted(magnitude, shift) / d_;
    const long excess = static_cast<long>(msb(quotient)) - 52;
    quotient >>= static_cast<unsigned>(excess);
    const double truncated = std::ldexp(quotient.convert_to<double>(), static_cast<int>(e_ - shift + excess));
    return n_ < 0 ? -truncated : truncated;
  }
  const Integer& odd_numerator() const { return n_; }
  const Integer& odd_denominator() const { return d_; }
  long exponent() const { return e_; }

  friend mpq_class operator-(mpq_class a) {
    a.n_ = -a.n_;
    return a;
  }
  friend mpq_class operator*(const mpq_class& a, const mpq_class& b) {
    return {a.n_ * b.n_, a.e_ + b.e_, a.d_ * b.d_};
  }
  friend mpq_class operator/(const mpq_class& a, const mpq_class& b) {
    return {b.n_ < 0 ? -a.n_ * b.d_ : a.n_ * b.d_, a.e_ - b.e_, a.d_ * abs(b.n_)};
  }
  friend mpq_class operator+(const mpq_class& a, const mpq_class& b) {
    const long e = std::min(a.e_, b.e_);
    const Integer x = shifted(a.n_, a.e_ - e), y = shifted(b.n_, b.e_ - e);
    if (a.d_ == b.d_) return {x + y, e, a.d_};
    return {x * b.d_ + y * a.d_, e, a.d_ * b.d_};
  }
  friend mpq_class operator-(const mpq_class& a, const mpq_class& b) { return a + -b; }
  mpq_class& operator+=(const mpq_class& b) { return *this = *this + b; }
  mpq_class& operator-=(const mpq_class& b) { return *this = *this - b; }
  mpq_class& operator*=(const mpq_class& b) { return *this = *this * b; }
  mpq_class& operator/=(const mpq_class& b) { return *this = *this / b; }

  friend int sgn(const mpq_class& a) { return a.n_.sign(); }
  friend int cmp(const mpq_class& a, const mpq_class& b) { return sgn(a - b); }
  friend mpq_class abs(const mpq_class& a) { return sgn(a) < 0 ? -a : a; }
  friend bool operator==(const mpq_class& a, const mpq_class& b) { return cmp(a, b) == 0; }
  friend std::strong_ordering operator<=>(const mpq_class& a, const mpq_class& b) { return cmp(a, b) <=> 0; }
  friend std::ostream& operator<<(std::ostream& out, const mpq_class& a) {
    return out << a.n_ << " * 2^" << a.e_ << " / " << a.d_;
  }

 private:
  mpq_class(Integer n, long e, Integer d) : n_(std::move(n)), d_(std::move(d)), e_(e) { reduce(); }
  static Integer shifted(const Integer& x, long bits) {
    return bits < 0 ? Integer(x >> static_cast<unsigned>(-bits)) : Integer(x << static_cast<unsigned>(bits));
  }
  static long make_odd(Integer& x) {
    const auto zeros = lsb(abs(x));
    x >>= zeros;  // of a negative number, too, as nothing is left over
    return static_cast<long>(zeros);
  }
  void reduce() {
    if (n_ == 0) {
      d_ = 1, e_ = 0;
      return;
    }
    e_ += make_odd(n_) - make_odd(d_);
    if (msb(d_) < 4096) return;
    const Integer divisor = gcd(n_, d_);
    n_ /= divisor, d_ /= divisor;
  }

  Integer n_ = 0, d_ = 1;
  long e_ = 0;
};

// With 256 bits, as the tests have it.
class mpf_class {
  using Float = boost::multiprecision::number<
      boost::multiprecision::cpp_bin_float<256, boost::multiprecision::digit_base_2>,
      boost::multiprecision::et_off>;

 public:
  mpf_class(const mpq_class& x, int /*bits*/)
      : value_(ldexp(Float(x.odd_numerator()), static_cast<int>(x.exponent())) / Float(x.odd_denominator())) {
  }
  mpf_class(Float value) : value_(std::move(value)) {}

  double get_d() const { return value_.convert_to<double>(); }
  friend mpf_class sqrt(const mpf_class& a) { return Float(sqrt(a.value_)); }
  friend mpf_class operator+(const mpf_class& a, const mpf_class& b) { return Float(a.value_ + b.value_); }
  friend mpf_class operator-(const mpf_class& a, const mpf_class& b) { return Float(a.value_ - b.value_); }

 private:
  Float value_;
};

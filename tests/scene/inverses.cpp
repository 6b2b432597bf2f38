// The inverses of instances, which the scenes' oracle takes over, against rational numbers.
#include <gmpxx.h>

#include "../support/level.hpp"
#include "../support/random_input.hpp"
#include "scene_oracle.hpp"

namespace raylanes::testing {
namespace {

// Row by row; by Cramer's rule. False if there is none.
bool exact_inverse(const Transform& transform, mpq_class (&inverse)[3][4]) {
  mpq_class a[3][4];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) a[i][j] = transform.row[i][j];
  const auto cofactor = [&](int i, int j) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return mpq_class(a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1]);
  };
  const mpq_class determinant =
      a[0][0] * cofactor(0, 0) + a[0][1] * cofactor(0, 1) + a[0][2] * cofactor(0, 2);
  if (determinant == 0) return false;
  for (int i = 0; i < 3; ++i) {
    inverse[i][3] = 0;
    for (int j = 0; j < 3; ++j) {
      inverse[i][j] = cofactor(j, i) / determinant;
      inverse[i][3] -= inverse[i][j] * a[j][3];
    }
  }
  return true;
}

void expect_inverse(const Transform& transform, int& tested) {
  const Instance instance(0, transform, 1);
  mpq_class exact[3][4];
  const bool exists = exact_inverse(transform, exact);
  if (instance.doubt < 0) return;
  ASSERT_TRUE(exists) << "an inverse of a singular transform";
  ++tested;
  for (int i = 0; i < 3; ++i) {
    mpq_class terms = 0;  // of the translation
    for (int j = 0; j < 3; ++j) {
      // A cofactor is one rounding off, as products of floats are exact; the determinant and the quotient are within
      // the share that the instance names.
      const mpq_class error = abs(mpq_class(instance.inverse[3 * j + i]) - exact[i][j]),
                      bound = mpq_class(instance.doubt) * abs(exact[i][j]);
      EXPECT_LE(error, bound) << i << ", " << j;
      terms += abs(exact[i][j] * mpq_class(transform.row[j][3]));
    }
    const mpq_class error = abs(mpq_class(instance.inverse[9 + i]) - exact[i][3]);
    const mpq_class bound = mpq_class(instance.doubt + 0x1p-50) * terms;
    EXPECT_LE(error, bound) << i;
  }
}

TEST(Inverses, are_those_of_rational_numbers_but_for_their_doubt) {
  Random random(47);
  int tested = 0;
  for (int round = 0; round < 2000; ++round) {
    Transform transform = random_transform(random, random.chance(0.5) ? 1.0f : 0x1p-10f, 100);
    // Nearly flat along some direction, by up to the limit beyond which there is no inverse.
    if (random.chance(0.5))
      for (int j = 0; j < 3; ++j)
        transform.row[2][j] =
            transform.row[0][j] + transform.row[1][j] +
            random.number(-1, 1) * std::ldexp(1.0f, -static_cast<int>(random.number(0, 30)));
    expect_inverse(transform, tested);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tested, 1500);
}

TEST(Inverses, of_singular_transforms_are_none) {
  const Transform flat{{{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}}};
  EXPECT_LT(Instance(0, flat, 1).doubt, 0.0);
  EXPECT_LT(Instance(0, Transform{{{0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}}}, 1).doubt, 0.0);
}

// One row is the sum of the others, of numbers whose products doubles round.
TEST(Instance, has_no_inverse_where_rational_numbers_have_none) {
  Random random(85);
  for (std::size_t i = 0; i < by_level(600); ++i) {
    Transform transform;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t row = 0; row < 2; ++row)
        transform.row[row][k] = static_cast<float>(random.integer(-8388607, 8388607));
      transform.row[2][k] = transform.row[0][k] + transform.row[1][k];
    }
    ASSERT_LT(Instance(0, transform, 1).doubt, 0) << i;
  }
}

}  // namespace
}  // namespace raylanes::testing

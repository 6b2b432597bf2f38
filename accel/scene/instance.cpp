#include "instance.hpp"

#include "../../dispatch/table/tree_view.hpp"
#include "bounded_tree_arrays.hpp"

namespace raylanes {
namespace {

// The inverse by cofactors. Products of two floats are exact in doubles, so the inverse is as good as the determinant,
// whose error is at most 2^-51 of the sum of its terms' sizes. Returns the relative error; negative if there is no
// inverse.
double invert(const Transform& transform, double (&inverse)[13]) {
  double a[3][4];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) a[i][j] = static_cast<double>(transform.row[i][j]);
  const auto cofactor = [&](int i, int j) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
  };
  double determinant = 0.0, size = 0.0;
  for (int j = 0; j < 3; ++j) {
    const double term = a[0][j] * cofactor(0, j);
    determinant += term, size += std::abs(term);
  }
  // NaN and infinity end here, too; in the translation, at the bounds.
  if (!(std::abs(determinant) > 0x1p-48 * size)) return -1.0;
  for (int i = 0; i < 3; ++i) {
    double* const row = inverse + i;
    for (int j = 0; j < 3; ++j) row[3 * j] = cofactor(j, i) / determinant;
    row[9] = -((row[0] * a[0][3] + row[3] * a[1][3]) + row[6] * a[2][3]);
  }
  return 0x1p-50 * (size / std::abs(determinant)) + 0x1p-49;
}

// For paddings, which are multiplied by coordinates that may be zero.
float float_at_most(double x) {
  return static_cast<float>(std::min(x, double{std::numeric_limits<float>::max()}));
}

}  // namespace

Instance::Instance(std::uint32_t geometry_, const Transform& transform_, std::uint32_t mask_)
    : PlacedTree{}, transform(transform_), doubt(invert(transform_, inverse)) {
  geometry = geometry_, mask = mask_;
  const Transform identity;
  is_identity = std::memcmp(&transform, &identity, sizeof identity) == 0;
}

// With A the matrix, R its inverse, b the translation: a ray's origin o' in the part's space is at most |R|·(|o| +
// |b|); rounding moves it by 2^-24 of that. A hit p' at t has t·|d'| <= |p'| + |o'|, so rounding the direction
// moves it by 2^-24 of that; an inverse that is wrong by a share moves it by that share of the same. A takes all
// of it back to the scene. Doubled, which is more than the roundings here take.
// A triangle test that rounds moves a hit by less than rounded_hit_share of its reach in the part's space, which is at
// most |o'| + |p'|.
InstanceBounds bounds_of(const Instance& instance, const Box& part, float slack) {
  constexpr InstanceBounds none{empty_box, 0.0f};
  if (instance.doubt < 0.0 || !is_visited(part)) return none;
  double reach = 0.0, origin = 0.0, most = 0.0;  // of |R|, of |R|·|b|, of the part
  for (int i = 0; i < 3; ++i) {
    double sum = 0.0, moved = 0.0;
    for (int j = 0; j < 3; ++j) {
      const double r = std::abs(instance.inverse[3 * j + i]);
      sum += r, moved += r * std::abs(static_cast<double>(instance.transform.row[j][3]));
    }
    reach = std::max(reach, sum), origin = std::max(origin, moved);
    most = std::max({most, std::abs(static_cast<double>(part.lo[static_cast<std::size_t>(i)])),
                     std::abs(static_cast<double>(part.hi[static_cast<std::size_t>(i)]))});
  }
  if (instance.is_identity)
    return {part, slack, {rounded_hit_share, float_at_most(1.0001 * rounded_hit_share * most)}};
  const double wrong = 2.0 * (0x1p-24 + instance.doubt),
               of_origin = 2.0 * wrong + 2.0 * static_cast<double>(slack);
  InstanceBounds bounds{};
  double largest_row = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const float(&row)[4] = instance.transform.row[i];
    double lo = static_cast<double>(row[3]), hi = lo, size = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
      const double a = static_cast<double>(row[j]), at_lo = a * static_cast<double>(part.lo[j]),
                   at_hi = a * static_cast<double>(part.hi[j]);
      lo += std::min(at_lo, at_hi), hi += std::max(at_lo, at_hi), size += std::abs(a);
    }
    const double pad = size * (of_origin * origin + wrong * most + 0x1p-140) +
                       0x1p-50 * (std::abs(static_cast<double>(row[3])) + size * most);
    largest_row = std::max(largest_row, size);
    bounds.box.lo[i] = float_below(float_or_infinity(lo - pad));
    bounds.box.hi[i] = float_above(float_or_infinity(hi + pad));
  }
  bounds.share = float_at_most(largest_row * reach * of_origin * 1.0001);
  const double of_rounding = 1.0001 * largest_row * static_cast<double>(rounded_hit_share);
  bounds.rounded = {float_at_most(of_rounding * reach), float_at_most(of_rounding * (origin + most))};
  return is_visited(bounds.box) ? bounds : none;
}

}  // namespace raylanes

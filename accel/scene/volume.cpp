// The volumes that geometries of triangles enclose.
#include "volume.hpp"

#include "../mesh/bounding_boxes.hpp"
#include "geometry.hpp"

namespace raylanes {
namespace {

// A sum that keeps what is lost by each addition (Neumaier 1974).
class Sum {
 public:
  void add(double x) {
    const double sum = sum_ + x;
    lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  double get() const { return sum_ + lost_; }

 private:
  double sum_ = 0.0, lost_ = 0.0;
};

// Six times the signed volume between a triangle and a point; exactly 0 if two corners are equal.
template <class T>
double six_volumes(const T* corners, const double (&from)[3]) {
  double a[3], b[3], c[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const double origin = double{corners[k]};
    a[k] = origin - from[k], b[k] = double{corners[3 + k]} - origin, c[k] = double{corners[6 + k]} - origin;
  }
  const auto minor = [&](std::size_t y, std::size_t z) { return b[y] * c[z] - b[z] * c[y]; };
  return (a[0] * minor(1, 2) + a[1] * minor(2, 0)) + a[2] * minor(0, 1);
}

}  // namespace

template <class T>
double volume_of(std::span<const T> corners, const BoxOf<T>& box) {
  double middle[3];
  for (std::size_t k = 0; k < 3; ++k) middle[k] = 0.5 * double{box.lo[k]} + 0.5 * double{box.hi[k]};
  Sum sum;
  for (std::size_t at = 0; at < corners.size(); at += 9) sum.add(six_volumes(corners.data() + at, middle));
  return std::abs(sum.get()) / 6.0;
}
template double volume_of(std::span<const float> corners, const Box& box);
template double volume_of(std::span<const double> corners, const BoxD& box);

double Geometry::volume() const {
  const double known = volume_;
  if (known >= 0.0) return known;
  std::vector<float> corners(9 * mesh_triangles());
  put_corners(corners.data());
  const double volume = volume_of<float>(corners, bounds());
  volume_ = volume;
  return volume;
}

}  // namespace raylanes

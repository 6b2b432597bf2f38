// Winding numbers of points: crossings of a ray from each, and the boundary seen against the ray.
#pragma once

#include "../../dispatch/table/winding.hpp"
#include "../batch/sort_keys.hpp"
#include "point_places.hpp"

namespace raylanes {

// Rounding moves numbers by far less, so that a number farther than this and its accuracy from ½ says whether the point
// is inside.
inline constexpr double rounding_of_windings = 0x1p-24;

// Adds what the boundary lacks to the crossings of points; one object a thread.
template <class T>
class Windings {
 public:
  Windings(const Points<T>& points, const BoundaryView& boundary, const WindingKernels& kernels)
      : points_(points),
        boundary_(boundary),
        boundary_terms_(is_float<T> ? kernels.boundary_terms : kernels.boundary_terms_of_doubles) {}

  // The numbers of the points from `begin` on that have these places; anything for inactive ones, 0 for those that are
  // not finite. Accuracies fall from round to round: a point's number is of the first round that decides whether the
  // point is inside, or of the last one.
  std::span<const double> find(std::size_t begin, std::span<const PointPlace> places,
                               std::span<const double> accuracy_of_rounds) {
    numbers_.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) numbers_[i] = 0.5 * places[i].halves;
    if (boundary_.node_count == 0) return numbers_;
    wait(begin, places);
    for (const double accuracy : accuracy_of_rounds) {
      if (waiting_.empty()) break;
      find_terms(begin, accuracy);
      std::size_t left = 0;
      for (std::size_t k = 0; k < waiting_.size(); ++k) {
        const std::size_t i = waiting_[k].index;
        numbers_[i] = 0.5 * places[i].halves + terms_[k];
        if (!(std::fabs(numbers_[i] - 0.5) > accuracy + rounding_of_windings)) waiting_[left++] = waiting_[k];
      }
      waiting_.resize(left);
    }
    return numbers_;
  }

 private:
  struct Waiting {
    std::uint32_t index;  // in the places
    std::uint16_t side;
  };

  static bool is_finite(const PointOf<T>& point) {
    return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
  }

  // All active points, neighbours together: points of a vector walk the boundary together. A point outside of the box
  // has the side that is nearest.
  void wait(std::size_t begin, std::span<const PointPlace> places) {
    order_.resize(places.size()), waiting_.clear();
    order_points(points_.view, begin, points_.bounds, points_.active, order_);
    for (const std::uint64_t next : order_) {
      const auto i = static_cast<std::uint32_t>(next);
      if (!points_.takes_part(begin + i)) continue;
      std::uint16_t side = places[i].side;
      if (side == outside_box) {
        const PointOf<T> at = points_.view[begin + i];
        if (!is_finite(at)) continue;
        side = static_cast<std::uint16_t>(NearestSide(at, points_.bounds).side);
      }
      waiting_.push_back({i, side});
    }
  }

  // The boundary's terms of those that wait.
  void find_terms(std::size_t begin, double accuracy) {
    terms_.resize(waiting_.size());
    BoundaryBatch batch;
    batch.accuracy = accuracy;
    for (std::size_t side = 0; side < std::size(directions_to_sides<T>); ++side) {
      indices_.clear();
      for (auto& column : columns_) column.clear();
      for (std::size_t k = 0; k < waiting_.size(); ++k) {
        if (waiting_[k].side != side) continue;
        const PointOf<T> point = points_.view[begin + waiting_[k].index];
        indices_.push_back(k);
        for (std::size_t axis = 0; axis < 3; ++axis) columns_[axis].push_back(double_of(point[axis]));
      }
      results_.resize(indices_.size());
      for (std::size_t axis = 0; axis < 3; ++axis) batch.points[axis] = columns_[axis].data();
      batch.size = indices_.size(), batch.terms = results_.data();
      batch.axis = static_cast<int>(side / 2), batch.sign = side % 2 == 0 ? -1.0 : 1.0;
      boundary_terms_(boundary_, batch);
      for (std::size_t k = 0; k < indices_.size(); ++k) terms_[indices_[k]] = results_[k];
    }
  }

  const Points<T>& points_;
  const BoundaryView boundary_;
  void (*const boundary_terms_)(const BoundaryView&, const BoundaryBatch&);
  std::vector<Waiting> waiting_;
  std::vector<double> numbers_, terms_, results_, columns_[3];
  std::vector<std::size_t> indices_;
  std::vector<std::uint64_t> order_;
};

}  // namespace raylanes

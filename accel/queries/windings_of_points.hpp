// Winding numbers of points: crossings of a ray from each, and the boundary seen against the ray.
#pragma once

#include <cmath>
#include <memory>
#include <mutex>

#include "../../dispatch/table/winding.hpp"
#include "../../dispatch/text_of.hpp"
#include "../batch/point_order.hpp"
#include "../mesh/boundary_tree.hpp"
#include "point_places.hpp"

namespace raylanes {

// Rounding moves numbers by far less, so that a number farther than this and its accuracy from ½ decides.
inline constexpr double rounding_of_windings = 0x1p-24;

// The winding numbers of some points of a batch, one object a thread. Sink takes them:
//   put(point, number, is_on)   is_on: whether the point is on a triangle
//   next_accuracy(i)            the accuracy of round i, from 0 on
//   is_done(number, accuracy)   whether a number of that accuracy will do
template <class T, class Sink>
class Windings {
 public:
  Windings(const ListMaker<T>& maker, const Points<T>& points, const BoundaryTree& boundary,
           const WindingKernels& kernels, const Sink& sink)
      : maker_(maker), points_(points), boundary_(boundary.view()), kernels_(kernels), sink_(sink) {}

  // Takes the numbers of active points from `begin` on, by their places.
  void find(std::size_t begin, std::span<const PointPlace> places, TraceCounters* counters) {
    for (std::size_t i = 0; i < places.size(); ++i)
      if (points_.takes_part(begin + i)) wait(begin + i, places[i]);
    count_on(counters);
    if (boundary_.node_count > 0) bring_neighbours_together(begin, begin + places.size());
    for (int round = 0; !waiting_.empty(); ++round) {
      const double accuracy = sink_.next_accuracy(round);
      add_boundary(accuracy);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < waiting_.size(); ++i) {
        const double number = waiting_[i].crossings + terms_[i];
        if (accuracy == 0.0 || boundary_.node_count == 0 || sink_.is_done(number, accuracy))
          sink_.put(waiting_[i].point, number, waiting_[i].is_on);
        else
          waiting_[kept++] = waiting_[i];
      }
      waiting_.resize(kept);
    }
  }

 private:
  struct Waiting {
    std::size_t point;
    std::uint16_t side;
    bool is_on;
    double crossings;
  };
  // Rays of points on triangles, which are some of those that wait.
  struct RaysOfPointsOn : Points<T> {
    std::span<const Waiting> waiting;
    std::span<const std::size_t> on;

    bool takes_part(std::size_t) const { return true; }
    RayOf<T> operator[](std::size_t i) const {
      const Waiting& point = waiting[on[i]];
      return {this->view[point.point], 0, directions_to_sides<T>[point.side]};
    }
  };

  static bool is_finite(const PointOf<T>& point) {
    return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
  }

  // A point outside of the box has the side that is nearest, or is no number.
  void wait(std::size_t point, PointPlace place) {
    if (place.side == outside_box) {
      const PointOf<T> at = points_.view[point];
      if (!is_finite(at)) return sink_.put(point, 0.0, false);
      place.side = static_cast<std::uint16_t>(NearestSide(at, points_.bounds).side);
    }
    if (place.is_on) on_.push_back(waiting_.size());
    waiting_.push_back({point, place.side, place.is_on, static_cast<double>(place.crossings)});
  }
  // The crossings of points on triangles, those at the point itself half.
  void count_on(TraceCounters* counters) {
    ListMaker<T> maker = maker_;
    maker.stop = ListStop::never;
    const RaysOfPointsOn rays{points_, waiting_, on_};
    each_list<ListEntryOf<T>>(
        maker, rays, 0, on_.size(), counters, [&](std::size_t i, std::span<ListEntryOf<T>> list) {
          for (const ListEntryOf<T>& crossing : distinct(list))
            waiting_[on_[i]].crossings +=
                (crossing.leaf_triangle == no_leaf_triangle ? 0.5 : 1.0) * crossing.side;
        });
    on_.clear();
  }

  // Points of a vector walk the boundary together.
  void bring_neighbours_together(std::size_t begin, std::size_t end) {
    order_.resize(end - begin), place_.assign(end - begin, 0), sorted_.clear();
    order_points(points_.view, begin, points_.bounds, points_.active, order_);
    for (std::size_t i = 0; i < waiting_.size(); ++i)
      place_[waiting_[i].point - begin] = static_cast<std::uint32_t>(i + 1);
    for (const std::uint64_t next : order_)
      if (const std::uint32_t i = place_[static_cast<std::uint32_t>(next)]; i > 0)
        sorted_.push_back(waiting_[i - 1]);
    waiting_.swap(sorted_);
  }

  void add_boundary(double accuracy) {
    terms_.assign(waiting_.size(), 0.0);
    if (boundary_.node_count == 0) return;
    BoundaryBatch batch;
    batch.accuracy = accuracy;
    for (std::size_t side = 0; side < std::size(directions_to_sides<T>); ++side) {
      indices_.clear();
      for (auto& column : columns_) column.clear();
      for (std::size_t i = 0; i < waiting_.size(); ++i) {
        if (waiting_[i].side != side) continue;
        const PointOf<T> point = points_.view[waiting_[i].point];
        indices_.push_back(i);
        for (std::size_t k = 0; k < 3; ++k) columns_[k].push_back(double_of(point[k]));
      }
      results_.resize(indices_.size());
      for (std::size_t k = 0; k < 3; ++k) batch.points[k] = columns_[k].data();
      batch.size = indices_.size(), batch.terms = results_.data();
      batch.axis = static_cast<int>(side / 2), batch.sign = side % 2 == 0 ? -1.0 : 1.0;
      (is_float<T> ? kernels_.boundary_terms : kernels_.boundary_terms_of_doubles)(boundary_, batch);
      for (std::size_t i = 0; i < indices_.size(); ++i) terms_[indices_[i]] = results_[i];
    }
  }

  const ListMaker<T>& maker_;
  const Points<T>& points_;
  BoundaryView boundary_;
  const WindingKernels& kernels_;
  Sink sink_;
  std::vector<Waiting> waiting_, sorted_;
  std::vector<std::size_t> on_;  // which of them are on triangles, until they are counted
  std::vector<double> terms_, results_, columns_[3];
  std::vector<std::size_t> indices_;
  std::vector<std::uint64_t> order_;
  std::vector<std::uint32_t> place_;
};

template <class T>
struct WindingNumbers {
  std::span<T> numbers;
  double accuracy;

  double next_accuracy(int) const { return accuracy; }
  bool is_done(double, double) const { return true; }
  void put(std::size_t point, double number, bool) const {
    constexpr double least = 0x1p-100;  // modes may flush what is smaller
    numbers[point] = std::fabs(number) < least ? T(0) : static_cast<T>(number);
  }
};

// Coarse numbers decide most points; the others have finer ones, at last without expansions.
struct InsideByWinding {
  std::span<Location> locations;

  double next_accuracy(int round) const {
    constexpr double accuracy[] = {0x1p-2, 0x1p-7, 0x1p-20, 0.0};
    return accuracy[round];
  }
  bool is_done(double number, double accuracy) const {
    return std::fabs(number - 0.5) > accuracy + rounding_of_windings;
  }
  void put(std::size_t point, double number, bool is_on) const {
    locations[point] = is_on ? Location::on : number >= 0.5 ? Location::inside : Location::outside;
  }
};

using KeptBoundary = std::shared_ptr<const BoundaryTree>;

// The boundary of a tree, which keeps it; found once, by the corners of triangles() in the order of primitives.
// `progress`, if not null, hears of that.
template <class Triangles>
KeptBoundary boundary_of(KeptBoundary& kept, int threads, const Triangles& triangles,
                         const Progress* progress) {
  static std::mutex reading;  // of all trees: held for a moment
  {
    const std::lock_guard<std::mutex> one_at_a_time(reading);
    if (kept != nullptr) return kept;
  }
  constexpr double share_of_loops = 0.8;  // fewer where there is much of a boundary
  const StepProgress finding(progress, 0.0, share_of_loops), ordering(progress, share_of_loops, 1.0);
  const auto loops = boundary_loops(triangles(), finding.get());
  auto found = std::make_shared<const BoundaryTree>(loops, threads, ordering.get());
  const std::lock_guard<std::mutex> one_at_a_time(reading);
  if (kept == nullptr) kept = std::move(found);
  return kept;
}

// Hears of the boundary that is found before the first points are asked for: half of a call's progress, if that takes
// long enough for a report.
class BoundaryProgress {
 public:
  explicit BoundaryProgress(const Progress* whole) : whole_(whole) {
    if (whole != nullptr && *whole) hears_ = [this](double share) { hear(share); };
  }
  BoundaryProgress(const BoundaryProgress&) = delete;
  BoundaryProgress& operator=(const BoundaryProgress&) = delete;
  const Progress* get() const { return hears_ ? &hears_ : nullptr; }
  StepProgress rest() const { return {whole_, end_, 1.0}; }

 private:
  void hear(double share) {
    if (end_ == 0.0) (*whole_)(0.0);
    end_ = 0.5;
    (*whole_)(share * end_);
  }

  const Progress* whole_;
  Progress hears_;
  double end_ = 0.0;
};

// `box` is around the tree; boundary(progress) returns the tree's boundary.
template <class T, class Tree, class Sink, class Options, class Boundary>
void find_windings(const char* call, const Tree& tree, const BoxOf<T>& box, const VertexRecords<T>& points,
                   const Options& options, const Sink& sink, const Boundary& boundary) {
  ListMaker<T> maker = checked_maker(call, ListKind::sides, tree, options);
  maker.stop = ListStop::at_origin;
  const WindingKernels& kernels = kernels_of(checked_path(options.path)).winding;
  const QuietFloats quiet;
  const BoundaryProgress before_points(options.progress);
  const KeptBoundary of_tree = boundary(before_points.get());
  const StepProgress of_points = before_points.rest();
  maker.progress = of_points.get();
  const Points<T> all{points, box, options.active};
  over_parts(plan_of(maker), points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    Windings<T, Sink> windings(maker, all, *of_tree, kernels, sink);
    PointPlaces<T> places(maker, all);
    for (std::size_t size; begin < end; begin += size) {
      size = std::min(places.at_once, end - begin);
      windings.find(begin, places.find(begin, begin + size, counters), counters);
    }
  });
}

template <class T>
void require_windings(const VertexRecords<T>& points, std::span<T> numbers, const WindingOptions& options) {
  require_points("winding_numbers", points);
  require_size("winding_numbers", "numbers", numbers.size(), "points", points.count);
  if (!(options.accuracy >= 0.0))
    throw std::invalid_argument("winding_numbers: accuracy " + text_of(options.accuracy) +
                                ", allowed are 0 and positive numbers");
}

}  // namespace raylanes

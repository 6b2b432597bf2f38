// Winding numbers: crossings of a ray from each point, and the boundary seen against the ray.
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "../../dispatch/table/winding.hpp"
#include "../../dispatch/text_of.hpp"
#include "../batch/point_order.hpp"
#include "../mesh/boundary_tree.hpp"
#include "point_places.hpp"
#include "winding.hpp"

namespace raylanes {
namespace {

// The triangles of a tree in the order of their primitives, each once.
std::vector<Corners> triangles_of(const TreeLeaves& tree) {
  const auto* const leaves = static_cast<const LeafBlock<9>*>(tree.corners.blocks());
  const std::vector<std::uint64_t> places = tree.corners.places();
  std::vector<Corners> triangles;
  triangles.reserve(places.size());
  for (const std::uint64_t place : places) {
    const std::size_t lane = place & 0xffffffffu;
    const LeafBlock<9>& leaf = leaves[lane / tree_width];
    Corners& corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) corners.vertex[k / 3][k % 3] = leaf.number[k][lane % tree_width];
  }
  return triangles;
}

// Rounding moves numbers by far less, so that a number farther than this and its accuracy from ½ decides.
constexpr double rounding = 0x1p-24;

// The winding numbers of some points of a batch, one object a thread. Sink takes them:
//   put(point, number, is_on)   is_on: whether the point is on a triangle
//   next_accuracy(i)            the accuracy of round i, from 0 on
//   is_done(number, accuracy)   whether a number of that accuracy will do
template <class Sink>
class Windings {
 public:
  struct Place {
    std::int64_t winding = 0;
    bool is_on = false;
  };
  static constexpr bool wants_sides = true;

  Windings(const ListMaker<float>& maker, const Points<float>& points, const BoundaryTree& boundary,
           const WindingKernels& kernels, const Sink& sink)
      : maker_(maker), points_(points), boundary_(boundary.view()), kernels_(kernels), sink_(sink) {}

  static Place on() { return {0, true}; }
  template <class Side>
  Place of_crossings(std::span<const Hit> crossings, Side side) const {
    return {sum_of_sides(crossings, side), false};
  }
  void put(std::size_t point, Place place, std::size_t side) {
    if (place.is_on) on_.push_back(waiting_.size());
    waiting_.push_back(
        {point, static_cast<std::uint8_t>(side), place.is_on, static_cast<double>(place.winding)});
  }
  void put_outside(std::size_t point) {
    const Float3 at = points_.view[point];
    if (is_finite(at))
      put(point, {}, NearestSide(at, points_.bounds).side);
    else
      sink_.put(point, 0.0, false);
  }

  void finish(std::size_t begin, std::size_t end, TraceCounters* counters) {
    count_on(counters);
    if (boundary_.node_count > 0) bring_neighbours_together(begin, end);
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
    std::uint8_t side;
    bool is_on;
    double crossings;
  };
  // Rays of points on triangles, which are some of those that wait.
  struct RaysOfPointsOn : Points<float> {
    std::span<const Waiting> waiting;
    std::span<const std::size_t> on;

    bool takes_part(std::size_t) const { return true; }
    Ray operator[](std::size_t i) const {
      const Waiting& point = waiting[on[i]];
      return {view[point.point], 0.0f, directions_to_sides<float>[point.side]};
    }
  };

  static bool is_finite(const Float3& point) {
    return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
  }

  // The crossings of points on triangles, those at the point itself half.
  void count_on(TraceCounters* counters) {
    ListMaker<float> maker = maker_;
    maker.kind = ListKind::crossings;
    const RaysOfPointsOn rays{points_, waiting_, on_};
    each_list(maker, rays, 0, on_.size(), counters, [&](std::size_t i, std::span<Hit> list) {
      for (const Hit& crossing : distinct(list))
        waiting_[on_[i]].crossings += (crossing.v != 0.0f ? 0.5 : 1.0) * (crossing.u > 0.0f ? 1.0 : -1.0);
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
    for (std::size_t side = 0; side < std::size(directions_to_sides<float>); ++side) {
      indices_.clear();
      for (auto& column : columns_) column.clear();
      for (std::size_t i = 0; i < waiting_.size(); ++i) {
        if (waiting_[i].side != side) continue;
        const Float3 point = points_.view[waiting_[i].point];
        indices_.push_back(i);
        for (std::size_t k = 0; k < 3; ++k) columns_[k].push_back(double_of(point[k]));
      }
      results_.resize(indices_.size());
      for (std::size_t k = 0; k < 3; ++k) batch.points[k] = columns_[k].data();
      batch.size = indices_.size(), batch.terms = results_.data();
      batch.axis = static_cast<int>(side / 2), batch.sign = side % 2 == 0 ? -1.0 : 1.0;
      kernels_.boundary_terms(boundary_, batch);
      for (std::size_t i = 0; i < indices_.size(); ++i) terms_[indices_[i]] = results_[i];
    }
  }

  const ListMaker<float>& maker_;
  const Points<float>& points_;
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

struct Numbers {
  std::span<float> numbers;
  double accuracy;

  double next_accuracy(int) const { return accuracy; }
  bool is_done(double, double) const { return true; }
  void put(std::size_t point, double number, bool) const {
    constexpr double least = 0x1p-100;  // modes may flush what is smaller
    numbers[point] = std::fabs(number) < least ? 0.0f : static_cast<float>(number);
  }
};

// Coarse numbers decide most points; the others have finer ones, at last without expansions.
struct Insides {
  std::span<Location> locations;

  double next_accuracy(int round) const {
    constexpr double accuracy[] = {0x1p-2, 0x1p-7, 0x1p-20, 0.0};
    return accuracy[round];
  }
  bool is_done(double number, double accuracy) const { return std::fabs(number - 0.5) > accuracy + rounding; }
  void put(std::size_t point, double number, bool is_on) const {
    locations[point] = is_on ? Location::on : number >= 0.5 ? Location::inside : Location::outside;
  }
};

// The boundary of the tree's triangles; found once.
std::shared_ptr<const BoundaryTree> boundary_of(const TracedTree& tree) {
  static std::mutex reading;  // of all trees: held for a moment
  if (tree.leaves == nullptr) return std::make_shared<const BoundaryTree>();
  {
    const std::lock_guard<std::mutex> one_at_a_time(reading);
    if (tree.leaves->boundary != nullptr) return tree.leaves->boundary;
  }
  auto found = std::make_shared<const BoundaryTree>(boundary_loops(triangles_of(*tree.leaves)));
  const std::lock_guard<std::mutex> one_at_a_time(reading);
  if (tree.leaves->boundary == nullptr) tree.leaves->boundary = std::move(found);
  return tree.leaves->boundary;
}

template <class Sink, class Options>
void find_windings(const char* call, const TracedTree& tree, const VertexView& points, const Options& options,
                   const Sink& sink) {
  const ListMaker<float> maker = checked_maker(call, ListKind::places, tree, options);
  const WindingKernels& kernels = kernels_of(checked_path(options.path)).winding;
  const QuietFloats quiet;
  const std::shared_ptr<const BoundaryTree> boundary = boundary_of(tree);
  const Points<float> all{points, maker.tree.bounds, options.active};
  const PointPlaces<float, Windings<Sink>> places(maker, all);
  over_parts(plan_of(maker), points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    Windings<Sink> windings(maker, all, *boundary, kernels, sink);
    places.find(begin, end, counters, windings);
  });
}

}  // namespace

void locate_by_winding(const TracedTree& tree, VertexView points, std::span<Location> locations,
                       const LocateOptions& options) {
  find_windings("locate", tree, points, options, Insides{locations});
}

void TriangleTree::winding_numbers(VertexView points, std::span<float> numbers,
                                   const WindingOptions& options) const {
  require_points("winding_numbers", points);
  require_size("winding_numbers", "numbers", numbers.size(), "points", points.count);
  if (!(options.accuracy >= 0.0))
    throw std::invalid_argument("winding_numbers: accuracy " + text_of(options.accuracy) +
                                ", allowed are 0 and positive numbers");
  find_windings("winding_numbers", traced(), points, options, Numbers{numbers, options.accuracy});
}

}  // namespace raylanes

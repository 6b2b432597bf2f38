#include "locations.hpp"

#include <raylanes/doubles.hpp>

#include "../../dispatch/checked.hpp"
#include "../batch/checked_call.hpp"
#include "windings.hpp"

namespace raylanes {
namespace {

// The six rays of a vote, one behind the other. From outside of the box one of them at most has crossings.
template <class T>
struct RaysOfVotes : Points<T> {
  static constexpr std::size_t of_a_point = 6;

  bool takes_part(std::size_t ray) const { return Points<T>::takes_part(ray / of_a_point); }
  RayOf<T> operator[](std::size_t ray) const {
    return {this->view[ray / of_a_point], 0, directions_to_sides<T>[ray % of_a_point]};
  }
};

// The bits of PointPlace::halves that decide by a rule: all of them, or whether the crossings are odd.
std::int32_t bits_that_decide(InsideRule rule) {
  return rule == InsideRule::nonzero ? ~0 : 2;
}
Location location_of(const PointPlace& place, std::int32_t deciding) {
  return place.is_on ? Location::on : (place.halves & deciding) != 0 ? Location::inside : Location::outside;
}

// The verdict of most of the rays of a point; `on` only if each of them says so.
template <class T>
void locate_by_vote(const ListMaker<T>& maker, const RaysOfVotes<T>& rays, std::span<Location> locations) {
  constexpr std::size_t n = RaysOfVotes<T>::of_a_point;
  const std::int32_t deciding = bits_that_decide(InsideRule::vote);
  over_parts(
      plan_of(maker), locations.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
        std::size_t inside = 0;
        each_list<ListEntryOf<T>>(
            maker, rays, n * begin, n * end, counters, [&](std::size_t ray, std::span<ListEntryOf<T>> list) {
              const Location location = location_of(place_by_own_ray<T>(list, 0), deciding);
              inside = (ray % n == 0 ? 0 : inside) + (location == Location::inside ? 1 : 0);
              if (ray % n != n - 1) return;
              locations[ray / n] = location == Location::on ? location
                                   : 2 * inside > n         ? Location::inside
                                                            : Location::outside;
            });
      });
}

template <class T, class Options>
ListMaker<T> maker_of_sides(const char* call, const Surface<T>& surface, const Options& options) {
  ListMaker<T> maker =
      checked_maker<T>(call, ListKind::sides, surface.tree, surface.has_parts, options, ~0u, Facing::any);
  maker.stop = ListStop::at_origin;
  return maker;
}

// `progress`, if not null, hears of the search for the boundary.
template <class T>
KeptBoundary boundary_of(const Surface<T>& surface, int threads, const Progress* progress) {
  if (surface.boundary == nullptr) return std::make_shared<const BoundaryTree>();
  static std::mutex reading;  // of all trees: held for a moment
  {
    const std::lock_guard<std::mutex> one_at_a_time(reading);
    if (*surface.boundary != nullptr) return *surface.boundary;
  }
  constexpr double share_of_loops = 0.8;  // fewer where there is much of a boundary
  const StepProgress finding(progress, 0.0, share_of_loops), ordering(progress, share_of_loops, 1.0);
  const auto loops = boundary_loops(surface.triangles(), finding.get());
  auto found = std::make_shared<const BoundaryTree>(loops, threads, ordering.get());
  const std::lock_guard<std::mutex> one_at_a_time(reading);
  if (*surface.boundary == nullptr) *surface.boundary = std::move(found);
  return *surface.boundary;
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

// Calls put(point, number, place) for each active point. `accuracy_of_rounds` as in Windings.
template <class T, class Options, class Put>
void each_winding(const char* call, const Surface<T>& surface, const VertexRecords<T>& points,
                  const Options& options, std::span<const double> accuracy_of_rounds, const Put& put) {
  ListMaker<T> maker = maker_of_sides(call, surface, options);
  const WindingKernels& kernels = kernels_of(checked_path(options.path)).winding;
  const BoundaryProgress before_points(options.progress);
  const KeptBoundary boundary = boundary_of(surface, options.threads, before_points.get());
  const StepProgress of_points = before_points.rest();
  maker.progress = of_points.get();
  const Points<T> all{points, surface.tree.bounds, options.active};
  over_parts(plan_of(maker), points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    Windings<T> windings(all, boundary->view(), kernels);
    each_places<T>(maker, all, begin, end, true, counters,
                   [&](std::size_t first, std::span<const PointPlace> places) {
                     const std::span<const double> numbers = windings.find(first, places, accuracy_of_rounds);
                     for (std::size_t i = 0; i < places.size(); ++i)
                       if (all.takes_part(first + i)) put(first + i, numbers[i], places[i]);
                   });
  });
}

}  // namespace

template <class T>
void locate_points(const Surface<T>& surface, const VertexRecords<T>& points, std::span<Location> locations,
                   const LocateOptions& given) {
  const CheckedPoints<T> call("locate", points, "locations", locations, given.active);
  LocateOptions options = given;
  options.active = call.active;
  checked_index("locate", "rule", options.rule, inside_rule_names.size());
  if (options.rule == InsideRule::winding) {
    // Coarse numbers decide most points; the others have finer ones, at last without expansions.
    constexpr double accuracy_of_rounds[] = {0x1p-2, 0x1p-7, 0x1p-20, 0.0};
    return each_winding("locate", surface, points, options, accuracy_of_rounds,
                        [&](std::size_t point, double number, const PointPlace& place) {
                          locations[point] = place.is_on     ? Location::on
                                             : number >= 0.5 ? Location::inside
                                                             : Location::outside;
                        });
  }
  const ListMaker<T> maker = maker_of_sides("locate", surface, options);
  const Points<T> all{points, surface.tree.bounds, options.active};
  if (options.rule == InsideRule::vote) return locate_by_vote(maker, RaysOfVotes<T>{all}, locations);
  const std::int32_t deciding = bits_that_decide(options.rule);
  over_parts(plan_of(maker), points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    each_places<T>(maker, all, begin, end, false, counters,
                   [&](std::size_t first, std::span<const PointPlace> places) {
                     for (std::size_t i = 0; i < places.size(); ++i)
                       if (all.takes_part(first + i)) locations[first + i] = location_of(places[i], deciding);
                   });
  });
}

void require_accuracy(double accuracy) {
  if (!(accuracy >= 0.0))
    throw std::invalid_argument("winding_numbers: accuracy " + text_of(accuracy) +
                                ", allowed are 0 and positive numbers");
}

template <class T>
void find_winding_numbers(const Surface<T>& surface, const VertexRecords<T>& points, std::span<T> numbers,
                          const WindingOptions& given) {
  const CheckedPoints<T> call("winding_numbers", points, "numbers", numbers, given.active);
  WindingOptions options = given;
  options.active = call.active;
  require_accuracy(options.accuracy);
  const double accuracy_of_rounds[] = {options.accuracy};
  each_winding(
      "winding_numbers", surface, points, options, accuracy_of_rounds,
      [&](std::size_t point, double number, const PointPlace&) { numbers[point] = winding_of<T>(number); });
}

template void locate_points(const Surface<float>&, const VertexView&, std::span<Location>,
                            const LocateOptions&);
template void locate_points(const Surface<double>&, const VertexViewD&, std::span<Location>,
                            const LocateOptions&);
template void find_winding_numbers(const Surface<float>&, const VertexView&, std::span<float>,
                                   const WindingOptions&);
template void find_winding_numbers(const Surface<double>&, const VertexViewD&, std::span<double>,
                                   const WindingOptions&);

}  // namespace raylanes

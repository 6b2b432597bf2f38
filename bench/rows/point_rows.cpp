#include "point_rows.hpp"

#include <raylanes/bvh.hpp>
#include <raylanes/closed_mesh.hpp>
#include <raylanes/kdtree.hpp>

#include "../contenders/fast_winding.hpp"
#include "../contenders/rivals.hpp"
#include "../support/oracles/exact_rays.hpp"
#include "../support/scenes/splitmix.hpp"

namespace raylanes::bench {
namespace {

using Points = std::span<const Float3>;
constexpr std::size_t points_of_cgal = 5000, max_judged = 200;

struct PointAnswers {
  std::vector<Location> locations = {};
  std::vector<double> squared = {};   // of closest points
  std::vector<float> distances = {};  // signed
  std::vector<float> windings = {};
};

// A contender, its row, and the points that it has: all, or a sample of them, one a call.
struct Entry {
  PointRow row;
  Points points;
  std::function<void(Points, PointAnswers&)> work;
  std::size_t of;  // the entry whose time its own is compared with
  PointAnswers answers = {};
};

// Some of n numbers, at random, in any order.
std::vector<std::size_t> sample(std::size_t n, std::size_t count) {
  SplitMix random(1);
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < std::min(n, count); ++k)
    numbers.push_back(static_cast<std::size_t>(random.uniform() * static_cast<double>(n)));
  return numbers;
}

double boundary_edges_of(const Mesh& mesh) {
  const ClosedReport report = closed_report(mesh.vertices, mesh.triangles, 0);
  return static_cast<double>(report.open + 2 * report.inconsistent);
}

// The trees of a scene, ours and others', made when they are asked first.
class PointRace {
 public:
  PointRace(const Scene& scene, const PointRowsOptions& options)
      : scene_(scene),
        options_(options),
        bvh_(scene.mesh),
        kd_(scene.mesh),
        is_closed_(holes_of(scene.mesh, options.rule).empty()),
        boundary_edges_(boundary_edges_of(scene.mesh)) {}

  std::vector<PointRow> run(PointKind kind) {
    points_ = points_of(scene_, kind, options_);
    numbers_ = sample(points_.size(), points_of_cgal);
    some_.clear(), truths_.clear(), sums_.clear();
    for (const std::size_t i : numbers_) some_.push_back(points_[i]);
    std::vector<PointRow> rows;
    for (const PointQuery query : options_.queries)
      for (PointRow& row : run(kind, query)) rows.push_back(std::move(row));
    return rows;
  }

 private:
  std::vector<PointRow> run(PointKind kind, PointQuery query) {
    std::vector<Entry> entries;
    const auto add = [&](const char* name, const char* path, Points points, std::size_t of, auto work) {
      const std::size_t per_call = is_sample(points) ? 1 : points.size();
      entries.push_back({{query, kind, name, path, points.size(), per_call}, points, std::move(work), of});
    };
    const std::size_t ours = options_.paths.size() - 1;
    for (const auto& [name, tree] : {Named{"bvh", &bvh_}, Named{"kdtree", &kd_}})
      for (const Path* path : options_.paths)
        add(name, path->name, points_, ours, our_work(*tree, query, path));
    if (options_.against_embree && query == PointQuery::closest) {
      if (!embree_) embree_ = std::make_unique<EmbreePoints>(scene_.mesh);
      add("embree", "", points_, ours,
          [this](Points points, PointAnswers& answers) { embree_->closest(points, answers.squared); });
    }
    if (options_.against_cgal && query == PointQuery::closest) {
      if (!cgal_) cgal_ = std::make_unique<CgalPoints>(scene_.mesh);
      add("cgal", "", points_, ours,
          [this](Points points, PointAnswers& answers) { cgal_->closest(points, answers.squared); });
    }
    if (options_.against_barill && query == PointQuery::winding)
      add("barill", "", points_, ours, [this](Points points, PointAnswers& answers) {
        std::vector<double> numbers(points.size());
        summed().numbers(points, options_.beta, numbers);
        answers.windings.assign(numbers.begin(), numbers.end());
      });
    // CGAL takes one point a call. Ours is timed with one point a call, too, on the same part of the points.
    if (options_.against_cgal && query == PointQuery::inside) {
      if (!cgal_sides_)
        cgal_sides_ = std::make_unique<CgalContender>(scene_.mesh.vertices, scene_.mesh.triangles);
      const std::size_t lone = entries.size();
      const Path* const path = options_.paths.back();
      add("bvh", path->name, some_, lone,
          [work = our_work(bvh_, query, path)](Points points, PointAnswers& answers) {
            PointAnswers one{.locations = std::vector<Location>(1)};
            for (std::size_t i = 0; i < points.size(); ++i)
              work(points.subspan(i, 1), one), answers.locations[i] = one.locations[0];
          });
      add("cgal", "", some_, lone,
          [this](Points points, PointAnswers& answers) { cgal_sides_->locate(points, answers.locations); });
    }
    return timed(entries, entries[ours]);
  }

  struct Named {
    const char* name;
    const TriangleTree* tree;
  };
  std::function<void(Points, PointAnswers&)> our_work(const TriangleTree& tree, PointQuery query,
                                                      const Path* path) const {
    const int threads = options_.threads;
    const InsideRule rule = options_.rule;
    if (query == PointQuery::inside)
      return [=, &tree](Points points, PointAnswers& answers) {
        tree.locate(VertexView(points.data(), points.size()), answers.locations,
                    {.rule = rule, .path = path, .threads = threads});
      };
    if (query == PointQuery::signed_distance)
      return [=, &tree](Points points, PointAnswers& answers) {
        tree.signed_distances(VertexView(points.data(), points.size()), answers.distances,
                              {.rule = rule, .path = path, .threads = threads});
      };
    if (query == PointQuery::winding)
      return [=, accuracy = options_.accuracy, &tree](Points points, PointAnswers& answers) {
        answers.windings.resize(points.size());
        tree.winding_numbers(VertexView(points.data(), points.size()), answers.windings,
                             {.accuracy = accuracy, .path = path, .threads = threads});
      };
    return [=, &tree](Points points, PointAnswers& answers) {
      std::vector<ClosestPoint> closest(points.size());
      tree.closest_points(VertexView(points.data(), points.size()), closest,
                          {.path = path, .threads = threads});
      for (std::size_t i = 0; i < closest.size(); ++i) answers.squared[i] = closest[i].distance_squared;
    };
  }

  std::vector<PointRow> timed(std::vector<Entry>& entries, const Entry& ours) {
    std::vector<std::function<void()>> contenders;
    for (Entry& entry : entries) {
      const std::size_t n = entry.points.size();
      entry.answers.locations.resize(n), entry.answers.distances.resize(n);
      if (entry.row.query == PointQuery::closest) entry.answers.squared.resize(n);
      contenders.push_back([&entry] { entry.work(entry.points, entry.answers); });
    }
    const std::vector<Timing> timings = take_turns(contenders, {options_.seconds, 5});
    for (Entry& entry : entries) complete(entry);
    std::vector<PointRow> rows;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      PointRow& row = entries[i].row;
      row.mpoints_per_second = static_cast<double>(row.points) / timings[i].median_seconds * 1e-6;
      row.spread = timings[i].spread;
      if (i != entries[i].of) row.behind = speed_ratio(timings[entries[i].of], timings[i]);
      judge(entries[i], ours);
      rows.push_back(row);
    }
    return rows;
  }

  // Whether these are the points of CGAL, in an order of their own even if they are all.
  bool is_sample(Points points) const { return points.data() == some_.data(); }

  // Signed distances are squares and places, too.
  static void complete(Entry& entry) {
    if (entry.row.query != PointQuery::signed_distance) return;
    for (std::size_t i = 0; i < entry.points.size(); ++i) {
      const auto distance = static_cast<double>(entry.answers.distances[i]);
      entry.answers.squared.push_back(distance * distance);
      entry.answers.locations[i] = distance < 0   ? Location::inside
                                   : distance > 0 ? Location::outside
                                                  : Location::on;
    }
  }

  FastWinding& summed() {
    if (!summed_) summed_ = std::make_unique<FastWinding>(scene_.mesh);
    return *summed_;
  }

  // The first points of the sample, the same for all contenders. Each edge of the boundary may be off by 2^-40, and a
  // chord of a loop by 2^-24 at a distance of 2^-26 of its length (docs/winding.md).
  void judge_windings(Entry& entry, const Entry& ours) {
    PointRow& row = entry.row;
    if (row.is_ours() && entry.answers.windings != ours.answers.windings)
      row.largest_difference = std::numeric_limits<double>::infinity();
    if (sums_.empty())
      for (std::size_t k = 0; k < std::min(some_.size(), max_judged); ++k)
        sums_.push_back(oracle::winding_sum(scene_.mesh.vertices, scene_.mesh.triangles, some_[k]));
    const double allowed = options_.accuracy + 0x1p-40 * boundary_edges_ + 0x1p-24;
    for (std::size_t k = 0; k < sums_.size(); ++k)
      row.judge_winding(entry.answers.windings[numbers_[k]], sums_[k], allowed);
  }

  void judge(Entry& entry, const Entry& ours) {
    PointRow& row = entry.row;
    const PointAnswers& answers = entry.answers;
    if (row.query == PointQuery::winding) return judge_windings(entry, ours);
    const bool has_all = !is_sample(entry.points);
    if (!answers.squared.empty())
      row.largest_difference =
          largest_difference(ours.answers.squared, answers.squared, diagonal_of(scene_.mesh));
    if (row.query == PointQuery::closest) return;
    if (row.is_ours() && has_all && answers.locations != ours.answers.locations)
      row.largest_difference = std::numeric_limits<double>::infinity();
    const auto count = [&](Location location) {
      return static_cast<std::size_t>(
          std::count(answers.locations.begin(), answers.locations.end(), location));
    };
    row.inside = count(Location::inside), row.on = count(Location::on), row.is_closed = is_closed_;
    // The first points of the sample, the same for all contenders.
    for (std::size_t k = 0; k < std::min(some_.size(), max_judged); ++k) {
      if (k == truths_.size())
        truths_.push_back(
            oracle::exact_location(scene_.mesh, some_[k], {0.31f, -0.73f, 0.59f}, options_.rule));
      ++row.judged, row.wrong += truths_[k] == answers.locations[has_all ? numbers_[k] : k] ? 0 : 1;
    }
  }

  const Scene& scene_;
  const PointRowsOptions& options_;
  const Bvh bvh_;
  const KdTree kd_;
  const bool is_closed_;
  const double boundary_edges_;
  std::unique_ptr<FastWinding> summed_;
  std::unique_ptr<EmbreePoints> embree_;
  std::unique_ptr<CgalPoints> cgal_;
  std::unique_ptr<CgalContender> cgal_sides_;
  std::vector<Float3> points_, some_;
  std::vector<std::size_t> numbers_;  // which points `some_` are
  std::vector<Location> truths_;      // of the first of these
  std::vector<oracle::WindingSum> sums_;
};

}  // namespace

void PointRow::judge_winding(float number, const oracle::WindingSum& sum, double allowed) {
  if (!sum.is_judge()) return;
  const double error = std::abs(static_cast<double>(number) - sum.number);
  const bool is_right = error <= allowed + 0x1p-24 * std::abs(sum.number) + 3 * sum.error;
  ++judged, wrong += is_right ? 0 : 1;
  winding_error =
      std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(winding_error, error);
}

double largest_difference(std::span<const double> a, std::span<const double> b, double diagonal) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;  // infinite ones as well
    const double difference = std::abs(std::sqrt(a[i]) - std::sqrt(b[i])) / diagonal;
    most = std::isnan(difference) ? std::numeric_limits<double>::infinity() : std::max(most, difference);
  }
  return most;
}

std::string holes_of(const Mesh& mesh, InsideRule rule) {
  const ClosedReport report = closed_report(mesh.vertices, mesh.triangles, 0);
  const bool means_something = rule == InsideRule::nonzero || rule == InsideRule::winding
                                   ? report.has_winding_numbers()
                                   : report.has_parity();
  if (means_something) return "";
  return "not closed: " + std::to_string(report.open) + " edges are open, " +
         std::to_string(report.inconsistent) + " inconsistent;\ninside depends on the rays' direction" +
         (rule == InsideRule::vote ? ", six of them vote\n" : ", unlike --rule winding\n");
}

std::vector<Float3> points_of(const Scene& scene, PointKind kind, const PointRowsOptions& options) {
  const Box box = bounds_of(scene.mesh);
  if (kind == PointKind::grid) return points_of(box, options.grid);
  SplitMix random(27);
  const double off = 0.01 * diagonal_of(scene.mesh);
  std::vector<Float3> points(options.count);
  for (Float3& point : points) {
    const std::size_t triangles = scene.mesh.triangles.size();
    const auto triangle = static_cast<std::size_t>(random.uniform() * static_cast<double>(triangles));
    const double v = 1 - std::sqrt(random.uniform()), u = random.uniform() * (1 - v);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto corner = [&](std::size_t k) {
        return static_cast<double>(scene.mesh.vertices[scene.mesh.triangles[triangle][k]][axis]);
      };
      const double lo = static_cast<double>(box.lo[axis]), extent = static_cast<double>(box.hi[axis]) - lo;
      const double x = kind == PointKind::box ? lo + (1.2 * random.uniform() - 0.1) * extent
                                              : (1 - u - v) * corner(0) + u * corner(1) + v * corner(2) +
                                                    (2 * random.uniform() - 1) * off / std::sqrt(3.0);
      point[axis] = static_cast<float>(x);
    }
  }
  return points;
}

std::vector<PointRow> measure_points(const Scene& scene, const PointRowsOptions& options) {
  PointRace race(scene, options);
  std::vector<PointRow> rows;
  for (const PointKind kind : options.kinds)
    for (PointRow& row : race.run(kind)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace raylanes::bench

// Queries that tell how far they are: the same bytes, shares that rise, what a report throws; and the sizes of parts.
#include <atomic>
#include <chrono>
#include <mutex>

#include <raylanes/closed_mesh.hpp>
#include <raylanes/numbers.hpp>

#include "../../accel/batch/in_parallel.hpp"
#include "../support/reports.hpp"
#include "both_trees.hpp"

namespace raylanes::testing {
namespace {

template <class Tree>
class ReportedQueries : public ::testing::Test {};
TYPED_TEST_SUITE(ReportedQueries, SavedKinds, TreeKindNames);

// Options with threads and a progress.
template <class Options>
Options reported(int threads, const Progress* progress) {
  Options options;
  options.threads = threads, options.progress = progress;
  return options;
}

template <class Tree>
struct Asked {
  static constexpr bool is_double = has_doubles<Tree>;
  using T = std::conditional_t<is_double, double, float>;
  using Trace = std::conditional_t<is_double, TraceOptionsD, TraceOptions>;
  using Closest = std::conditional_t<is_double, ClosestPointOptionsD, ClosestPointOptions>;
  using Distances = std::conditional_t<is_double, SignedDistanceOptionsD, SignedDistanceOptions>;

  const Tree& tree;
  std::vector<RayOf<T>> rays;
  std::vector<PointOf<T>> points;
  std::vector<std::uint8_t> active;
  int threads;

  Asked(const Tree& tree_, std::vector<RayOf<T>> rays_, int threads_)
      : tree(tree_), rays(std::move(rays_)), active(rays.size() / 8 + 1, 0xdb), threads(threads_) {
    for (const auto& ray : rays) points.push_back(ray.origin);
  }

  void expect_rays() const {
    const std::size_t n = rays.size();
    expect_reported<HitOf<T>>("closest", n, [&](auto& hits, const Progress* progress) {
      tree.closest(rays, hits, reported<Trace>(threads, progress));
    });
    expect_reported<HitOf<T>>("closest after", n, [&](auto& hits, const Progress* progress) {
      tree.closest(rays, hits, reported<Trace>(threads, nullptr));
      auto options = reported<Trace>(threads, progress);
      options.after = hits, options.active = active.data();
      tree.closest(rays, hits, options);
    });
    expect_reported("occluded", [&](const Progress* progress) {
      std::vector<std::uint8_t> occluded(n, 7);
      auto options = reported<Trace>(threads, progress);
      options.active = active.data();
      tree.occluded(rays, occluded, options);
      return bytes_of(occluded);
    });
    expect_reported<std::uint8_t>("occluded_from", n, [&](auto& occluded, const Progress* progress) {
      tree.occluded_from({3, 3, 3}, points, occluded, {}, reported<Trace>(threads, progress));
    });
    expect_reported("all_hits", [&](const Progress* progress) {
      const auto lists = tree.all_hits(rays, reported<ListOptions>(threads, progress));
      return bytes_of(lists.offsets) + bytes_of(lists.items);
    });
    expect_reported("crossings", [&](const Progress* progress) {
      const auto lists = tree.crossings(rays, reported<ListOptions>(threads, progress));
      return bytes_of(lists.offsets) + bytes_of(lists.items);
    });
    expect_reported<CrossingCount>("count_crossings", n, [&](auto& counts, const Progress* progress) {
      tree.count_crossings(rays, counts, reported<ListOptions>(threads, progress));
    });
  }
  void expect_points() const {
    const std::size_t n = points.size();
    for (const InsideRule rule : {InsideRule::parity, InsideRule::vote, InsideRule::winding})
      expect_reported<Location>("locate", n, [&](auto& locations, const Progress* progress) {
        auto options = reported<LocateOptions>(threads, progress);
        options.rule = rule;
        tree.locate(points, locations, options);
      });
    expect_reported<T>("winding_numbers", n, [&](auto& numbers, const Progress* progress) {
      tree.winding_numbers(points, numbers, reported<WindingOptions>(threads, progress));
    });
    expect_reported<ClosestPointOf<T>>("closest_points", n, [&](auto& closest, const Progress* progress) {
      auto options = reported<Closest>(threads, progress);
      options.active = active.data();
      tree.closest_points(points, closest, options);
    });
    expect_reported<T>("signed_distances", n, [&](auto& distances, const Progress* progress) {
      tree.signed_distances(points, distances, reported<Distances>(threads, progress));
    });
  }
};

TYPED_TEST(ReportedQueries, have_the_same_bytes) {
  const auto mesh = soup_for<TypeParam>(300, 3);
  const auto tree = built<TypeParam>(mesh);
  for (const int threads : {1, 2, 0})
    for (const std::size_t n : {0u, 1u, 63u, 65u, 3001u}) {
      SCOPED_TRACE(::testing::Message() << n << " on " << threads);
      const Asked<TypeParam> asked(tree, rays_for(mesh, n, 5), threads);
      asked.expect_rays();
      asked.expect_points();
    }
}

// More points than are ordered at once, in several steps on one thread: inactive ones, and bits of masks in each.
TYPED_TEST(ReportedQueries, order_many_points_in_steps) {
  const auto mesh = soup_for<TypeParam>(20, 3);
  const auto tree = built<TypeParam>(mesh);
  for (const int threads : {1, 2}) {
    const Asked<TypeParam> asked(tree, rays_for(mesh, 270005, 5), threads);
    expect_reported<ClosestPointOf<typename Asked<TypeParam>::T>>(
        "closest_points", asked.points.size(), [&](auto& closest, const Progress* progress) {
          auto options = reported<typename Asked<TypeParam>::Closest>(threads, progress);
          options.active = asked.active.data();
          tree.closest_points(asked.points, closest, options);
        });
  }
}

// The first winding numbers find the boundary, in half of the shares; given up, it is found by the next call.
TYPED_TEST(ReportedQueries, find_the_boundary_first) {
  using Of = Asked<TypeParam>;
  const auto mesh = soup_for<TypeParam>(3000, 6);
  const auto tree = built<TypeParam>(mesh), other = built<TypeParam>(mesh);
  const Of asked(tree, rays_for(mesh, 10, 7), 1);
  std::vector<typename Of::T> numbers(10), expected(10);
  other.winding_numbers(asked.points, expected);
  const Progress gives_up = [](double share) {
    if (share > 0 && share < 0.5) throw std::runtime_error("enough");
  };
  EXPECT_THROW(tree.winding_numbers(asked.points, numbers, reported<WindingOptions>(1, &gives_up)),
               std::runtime_error);
  Reports reports;
  tree.winding_numbers(asked.points, numbers, reported<WindingOptions>(1, &reports.progress));
  reports.expect_whole();
  EXPECT_TRUE(std::ranges::any_of(reports.shares, [](double share) { return share > 0 && share < 0.5; }));
  EXPECT_TRUE(same_bytes(numbers, expected));
}

TEST(ReportedParts, of_closed_report_may_be_given_up) {
  const Mesh mesh = triangle_soup(3000, 0.4f, 3);
  double last = 0;
  std::size_t reports = 0;
  const Progress progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1.0);
    last = share, ++reports;
  };
  EXPECT_EQ(closed_report(mesh.vertices, mesh.triangles, 3, &progress).open,
            closed_report(mesh.vertices, mesh.triangles).open);
  EXPECT_GE(reports, 1u);
  const Progress gives_up = [](double) { throw std::runtime_error("enough"); };
  EXPECT_THROW(closed_report(mesh.vertices, mesh.triangles, 3, &gives_up), std::runtime_error);
}

// Results of rounded tests may depend on which rays are traced together: their parts are as large as without reports.
TEST(ReportedParts, of_rounded_tests_are_those_of_other_calls) {
  const Mesh mesh = triangle_soup(20000, 0.1f, 3);
  const Bvh tree(mesh);
  const std::vector<Ray> rays = rays_for(mesh, 65536, 4);  // for at least 20 ms
  std::vector<Hit> hits(rays.size());
  const auto reports_of = [&](TriangleTest test, TraversalMode mode) {
    Reports reports;
    tree.closest(rays, hits, {.test = test, .mode = mode, .progress = &reports.progress});
    reports.expect_whole();
    return reports.shares.size();
  };
  EXPECT_EQ(reports_of(TriangleTest::moller_trumbore, TraversalMode::automatic), 2u);
  EXPECT_EQ(reports_of(TriangleTest::watertight, TraversalMode::stream), 2u);
}

struct Part {
  std::size_t begin, end;
};

// Parts of n elements that take so many seconds each, in the order of their ends.
std::vector<Part> parts_of(
    std::size_t n, const PartSizes& sizes, int threads, double seconds_each,
    const Progress& progress = [](double) {}) {
  std::vector<Part> parts;
  std::mutex adding;
  in_reported_parts(n, sizes, threads, progress, [&](std::size_t begin, std::size_t end) {
    std::this_thread::sleep_for(
        std::chrono::duration<double>(seconds_each * static_cast<double>(end - begin)));
    const std::lock_guard lock(adding);
    parts.push_back({begin, end});
  });
  return parts;
}
void expect_each_once(std::vector<Part> parts, std::size_t n) {
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.begin < b.begin; });
  std::size_t end = 0;
  for (const Part& part : parts) {
    EXPECT_EQ(part.begin, end);
    EXPECT_LT(part.begin, part.end);
    end = part.end;
  }
  EXPECT_EQ(end, n);
}

TEST(ReportedParts, have_each_element_once) {
  for (const int threads : {1, 2, 3, 0})
    for (const std::size_t n : {0u, 1u, 64u, 65u, 100000u})
      for (const PartSizes& sizes : {PartSizes{64, 1, 4096}, PartSizes{500, 500, 500}}) {
        const std::vector<Part> parts = parts_of(n, sizes, threads, 0);
        expect_each_once(parts, n);
        for (const Part& part : parts)
          EXPECT_TRUE(part.end == n || part.end - part.begin <= sizes.most) << part.end - part.begin;
        EXPECT_TRUE(parts.empty() || parts[0].end <= sizes.first);
      }
}

// Sleeping takes at least its time, so that parts of 2 ms an element have at most 10 elements after the first one.
TEST(ReportedParts, take_about_20_ms) {
  for (const int threads : {1, 2}) {
    std::vector<double> shares;
    const auto parts =
        parts_of(100, {8, 1, 1000}, threads, 0.002, [&](double share) { shares.push_back(share); });
    expect_each_once(parts, 100);
    for (const Part& part : parts) EXPECT_LE(part.end - part.begin, 10u);
    EXPECT_GE(shares.size(), 6u);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  }
}

TEST(ReportedParts, grow_by_16_at_most) {
  std::size_t last = 4;
  for (const Part& part : parts_of(100000, {4, 1, 100000}, 1, 0)) {
    EXPECT_LE(part.end - part.begin, 16 * last);
    last = part.end - part.begin;
  }
}

TEST(ReportedParts, end_on_every_thread_when_one_throws) {
  for (const int threads : {1, 2})
    for (const bool by_progress : {false, true}) {
      std::atomic<std::size_t> parts{0};
      const Progress progress = [&](double share) {
        if (by_progress && share > 0) throw std::runtime_error("enough");
      };
      EXPECT_THROW(in_reported_parts(100000, {1, 1, 10}, threads, progress,
                                     [&](std::size_t, std::size_t end) {
                                       ++parts;
                                       std::this_thread::sleep_for(std::chrono::milliseconds(4));
                                       if (!by_progress && end > 20) throw std::runtime_error("enough");
                                     }),
                   std::runtime_error);
      EXPECT_LT(parts, 100u);
    }
}

// A report may work on threads, too: it must not take up a part, and report within itself.
TEST(ReportedParts, may_be_told_to_who_works_on_threads) {
  bool is_told = false;
  std::size_t reports = 0;
  const Progress progress = [&](double) {
    EXPECT_FALSE(is_told);
    is_told = true, ++reports;
    in_parallel(64, 1, 0, [](std::size_t, std::size_t) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    });
    is_told = false;
  };
  expect_each_once(parts_of(60, {4, 1, 4}, 0, 0.003, progress), 60);
  EXPECT_GE(reports, 3u);
}

}  // namespace
}  // namespace raylanes::testing

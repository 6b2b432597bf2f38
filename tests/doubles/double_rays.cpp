// Rays of doubles against rational arithmetic, on every path.
#include <gtest/gtest.h>

#include <random>

#include "../support/filtered.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/in_flight.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

BvhD tree_of(const DoubleMesh& mesh, const BuildOptions& options = {}) {
  return BvhD(mesh.vertices, mesh.triangles, options);
}
HitD first_of(const std::vector<HitD>& hits) {
  return hits.empty() ? HitD() : hits[0];
}
std::string text_of(const RayD& ray) {
  char line[400];
  std::snprintf(line, sizeof line, "o %a %a %a d %a %a %a t %a %a", ray.origin[0], ray.origin[1],
                ray.origin[2], ray.direction[0], ray.direction[1], ray.direction[2], ray.tmin, ray.tmax);
  return line;
}

// Each case with what rational arithmetic gives, found once.
struct Known {
  DoubleCase with;
  BvhD tree;
  std::vector<HitD> first[3];
  std::vector<std::vector<HitD>> all;
  std::vector<std::vector<CrossingD>> crossings;
};
const std::vector<Known>& known_cases() {
  static const std::vector<Known> known = [] {
    std::vector<Known> all;
    for (DoubleCase& with : double_cases(by_level<std::size_t>(100, 400, 1600))) {
      Known k{std::move(with), {}, {}, {}, {}};
      k.tree = tree_of(k.with.mesh);
      for (const RayD& ray : k.with.rays) {
        k.all.push_back(exact_double_hits(k.with.mesh, ray));
        k.first[0].push_back(first_of(k.all.back()));
        for (const Facing facing : {Facing::front, Facing::back})
          k.first[static_cast<std::size_t>(facing)].push_back(
              first_of(exact_double_hits(k.with.mesh, ray, facing)));
        k.crossings.push_back(exact_double_crossings(k.with.mesh, ray));
      }
      all.push_back(std::move(k));
    }
    return all;
  }();
  return known;
}

template <class Check>
void on_each_case(const Check& check, bool in_turn = false) {
  const std::vector<const Path*> paths = paths_with_own_queries();
  for (std::size_t p = 0; p < paths.size(); ++p)
    for (std::size_t i = 0; i < known_cases().size(); ++i) {
      if (in_turn && i % paths.size() != p) continue;
      SCOPED_TRACE(known_cases()[i].with.name + " on " + paths[p]->name);
      check(known_cases()[i], *paths[p]);
    }
}
// Thousands of rays, together and in flight: below level all each case on one path, all paths in turn.
template <class Check>
void on_large_cases(const Check& check) {
  on_each_case(
      [&](const Known& known, const Path& path) {
        check(known, path);
        let_rays_fly(known.tree);
        check(known, path);
        let_rays_fly(known.tree, false);
      },
      by_level(true, true, false));
}

TEST(DoubleRays, nearest_hits_are_those_of_rational_arithmetic) {
  on_each_case([](const Known& known, const Path& path) {
    for (const Facing facing : {Facing::any, Facing::front, Facing::back}) {
      std::vector<HitD> hits(known.with.rays.size());
      known.tree.closest(known.with.rays, hits, {.path = &path, .facing = facing});
      for (std::size_t i = 0; i < hits.size(); ++i)
        ASSERT_TRUE(same_bytes(hits[i], known.first[static_cast<std::size_t>(facing)][i]))
            << i << " facing " << static_cast<int>(facing) << ' ' << text_of(known.with.rays[i]) << ": "
            << hits[i].t << ' ' << hits[i].primitive << ", not "
            << known.first[static_cast<std::size_t>(facing)][i].t << ' '
            << known.first[static_cast<std::size_t>(facing)][i].primitive;
    }
  });
}

TEST(DoubleRays, occlusion_and_single_calls_agree_with_nearest_hits) {
  on_each_case([](const Known& known, const Path& path) {
    for (const Facing facing : {Facing::any, Facing::front, Facing::back}) {
      const TraceOptionsD options{.path = &path, .facing = facing};
      std::vector<std::uint8_t> occluded(known.with.rays.size());
      known.tree.occluded(known.with.rays, occluded, options);
      for (std::size_t i = 0; i < occluded.size(); ++i) {
        const HitD& hit = known.first[static_cast<std::size_t>(facing)][i];
        ASSERT_EQ(occluded[i], hit ? 1 : 0) << text_of(known.with.rays[i]);
        ASSERT_EQ(known.tree.occluded(known.with.rays[i], options), static_cast<bool>(hit));
        ASSERT_TRUE(same_bytes(known.tree.closest(known.with.rays[i], options), hit));
      }
    }
  });
}

TEST(DoubleRays, skip_a_triangle_each) {
  on_each_case([](const Known& known, const Path& path) {
    const std::vector<RayD>& rays = known.with.rays;
    std::vector<HitD> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    const std::vector<HitD>& skip = known.first[0];
    known.tree.closest(rays, hits, {.path = &path, .skip = skip});
    known.tree.occluded(rays, occluded, {.path = &path, .skip = skip});
    const RayLists<HitD> lists = known.tree.all_hits(rays, {.path = &path, .skip = skip});
    const RayLists<CrossingD> crossings = known.tree.crossings(rays, {.path = &path, .skip = skip});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      std::vector<HitD> left = known.all[i];
      std::erase_if(left, [&](const HitD& hit) { return hit.primitive == skip[i].primitive; });
      std::vector<CrossingD> crossed = known.crossings[i];
      std::erase_if(crossed, [&](const CrossingD& c) { return c.primitive == skip[i].primitive; });
      ASSERT_TRUE(same_bytes(hits[i], first_of(left))) << text_of(rays[i]);
      ASSERT_EQ(occluded[i] != 0, !left.empty()) << text_of(rays[i]);
      ASSERT_TRUE(same_bytes(lists[i], left)) << text_of(rays[i]);
      ASSERT_TRUE(std::ranges::equal(crossings[i], crossed)) << text_of(rays[i]);
      ASSERT_TRUE(same_bytes(known.tree.closest(rays[i], {.path = &path, .skip = skip[i]}), hits[i]));
      ASSERT_EQ(known.tree.occluded(rays[i], {.path = &path, .skip = skip[i]}), !left.empty());
    }
  });
}

// So many rays are traced as streams, if most begin in the box. Rational arithmetic has judged single calls.
TEST(DoubleRays, large_batches_agree_with_single_calls) {
  on_large_cases([](const Known& known, const Path& path) {
    const std::vector<RayD> rays = aimed_rays(known.with.mesh, 5000, 77, 0.9);
    const TraceOptionsD options{.path = &path};
    std::vector<HitD> hits(rays.size()), of_threads(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    known.tree.closest(rays, hits, options);
    known.tree.closest(rays, of_threads, {.path = &path, .threads = 2});
    ASSERT_TRUE(same_bytes(hits, of_threads));
    known.tree.occluded(rays, occluded, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const HitD hit = known.tree.closest(rays[i], options);
      ASSERT_TRUE(same_bytes(hits[i], hit)) << text_of(rays[i]);
      ASSERT_EQ(occluded[i], hit ? 1 : 0) << text_of(rays[i]);
    }
  });
}

// With all triangles of both sides they go as streams or packets.
TEST(DoubleRays, large_batches_skip_a_triangle_each_or_keep_to_a_side) {
  on_large_cases([](const Known& known, const Path& path) {
    for (const std::vector<RayD>& rays :
         {aimed_rays(known.with.mesh, 5000, 78, 0.9), aimed_rays_from_points(known.with.mesh, 400, 100, 6)}) {
      std::vector<HitD> first(rays.size()), hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      known.tree.closest(rays, first, {.path = &path});
      for (TraceOptionsD options : {TraceOptionsD{.path = &path, .skip = first},
                                    TraceOptionsD{.path = &path, .facing = Facing::back}}) {
        known.tree.closest(rays, hits, options);
        known.tree.occluded(rays, occluded, options);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (options.facing == Facing::any) options.skip = first[i];
          const HitD hit = known.tree.closest(rays[i], options);
          ASSERT_TRUE(same_bytes(hits[i], hit)) << text_of(rays[i]);
          ASSERT_EQ(occluded[i], hit ? 1 : 0) << text_of(rays[i]);
        }
      }
    }
  });
}

// Those are traced as packets.
TEST(DoubleRays, rays_from_a_point_have_the_hits_of_rational_arithmetic) {
  on_each_case([](const Known& known, const Path& path) {
    const std::vector<RayD> rays = aimed_rays_from_points(known.with.mesh, 200, 100, 5);
    std::vector<HitD> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    known.tree.closest(rays, hits, {.path = &path});
    known.tree.occluded(rays, occluded, {.path = &path});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const HitD hit = first_of(exact_double_hits(known.with.mesh, rays[i]));
      ASSERT_TRUE(same_bytes(hits[i], hit)) << text_of(rays[i]);
      ASSERT_EQ(occluded[i], hit ? 1 : 0) << text_of(rays[i]);
    }
  });
}

// Among rays from a point that hit the mesh.
TEST(DoubleRays, from_a_point_without_an_end_or_a_direction_miss) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN(), far = HUGE_VAL;
  const RayD odd[] = {{{0, 0, 3}, 0, {0, 0, -1}, nothing}, {{0, 0, 3}, nothing, {0, 0, -1}, far},
                      {{0, 0, 3}, far, {0, 0, -1}, far},   {{0, 0, 3}, 0, {nothing, 0, -1}, far},
                      {{0, 0, 3}, 0, {0, far, -1}, far},   {{0, 0, 3}, 0, {0, 0, 0}, far},
                      {{0, 0, 3}, 4, {0, 0, -1}, 1},       {{0, nothing, 3}, 0, {0, 0, -1}, far}};
  const std::vector<Double3> corners{{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}};
  const std::vector<Index3> triangles{{0, 1, 2}};
  const BvhD tree(corners, triangles);
  for (const Path* path : paths_with_own_queries())
    for (const RayD& ray : odd) {
      std::vector<RayD> rays(100, RayD{{0, 0, 3}, 0, {0, 0, -1}, far});
      for (std::size_t i = 1; i < rays.size(); i += 3) rays[i] = ray;
      std::vector<HitD> hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      tree.closest(rays, hits, {.path = path}), tree.occluded(rays, occluded, {.path = path});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(static_cast<bool>(hits[i]), i % 3 != 1) << path->name << ' ' << text_of(rays[i]);
        ASSERT_EQ(occluded[i], i % 3 != 1 ? 1 : 0) << path->name << ' ' << text_of(rays[i]);
      }
    }
}

TEST(DoubleRays, batches_from_points_agree_with_single_calls) {
  on_large_cases([](const Known& known, const Path& path) {
    for (const std::size_t run :
         {std::size_t{64}, std::size_t{700}, by_level<std::size_t>(2000, 17000, 40000)}) {
      const std::size_t count = run < 1000 ? 3 * run + 50 : run + 50;
      const std::vector<RayD> rays = aimed_rays_from_points(known.with.mesh, count, run, run);
      std::vector<HitD> hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      known.tree.closest(rays, hits, {.path = &path, .threads = run == 700 ? 2 : 1});
      known.tree.occluded(rays, occluded, {.path = &path});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const HitD hit = known.tree.closest(rays[i], {.path = &path});
        ASSERT_TRUE(same_bytes(hits[i], hit)) << i << " of runs of " << run << ": " << text_of(rays[i]);
        ASSERT_EQ(occluded[i], hit ? 1 : 0) << i << ' ' << text_of(rays[i]);
      }
    }
  });
}

TEST(DoubleRays, lists_and_next_hits_are_those_of_rational_arithmetic) {
  on_each_case([](const Known& known, const Path& path) {
    const std::vector<RayD>& rays = known.with.rays;
    const RayLists<HitD> lists = known.tree.all_hits(rays, {.path = &path});
    ASSERT_EQ(lists.size(), rays.size());
    std::vector<HitD> last(rays.size(), HitD{-infinity, 0, 0, 0, 0});
    for (std::size_t i = 0; i < rays.size(); ++i)
      ASSERT_TRUE(same_bytes(lists[i], std::span<const HitD>(known.all[i]))) << text_of(rays[i]);
    for (std::size_t step = 0; step < 8; ++step) {
      known.tree.closest(rays, last, {.path = &path, .after = last});
      for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(same_bytes(last[i], step < known.all[i].size() ? known.all[i][step] : HitD()))
            << "step " << step << ' ' << text_of(rays[i]);
    }
  });
}

TEST(DoubleRays, crossings_are_those_of_rational_arithmetic) {
  on_each_case([](const Known& known, const Path& path) {
    const std::vector<RayD>& rays = known.with.rays;
    const RayLists<CrossingD> lists = known.tree.crossings(rays, {.path = &path});
    std::vector<CrossingCount> counts(rays.size());
    known.tree.count_crossings(rays, counts, {.path = &path});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(
          std::equal(lists[i].begin(), lists[i].end(), known.crossings[i].begin(), known.crossings[i].end()))
          << text_of(rays[i]);
      CrossingCount count;
      for (const CrossingD& crossing : known.crossings[i]) ++count.crossings, count.winding += crossing.side;
      ASSERT_EQ(counts[i], count) << text_of(rays[i]);
    }
  });
}

TEST(DoubleRays, builders_and_threads_change_nothing) {
  for (const Known& known : known_cases()) {
    SCOPED_TRACE(known.with.name);
    for (std::size_t builder = 0; builder < tree_builder_names.size(); ++builder) {
      if (static_cast<TreeBuilder>(builder) == TreeBuilder::spatial_splits) continue;
      BuildOptions options;
      options.builder = static_cast<TreeBuilder>(builder), options.threads = 2,
      options.optimize = builder % 2 == 0;
      const BvhD tree = tree_of(known.with.mesh, options);
      std::vector<HitD> hits(known.with.rays.size());
      tree.closest(known.with.rays, hits, {.threads = 2});
      ASSERT_TRUE(same_bytes(hits, known.first[0]));
    }
  }
}

TEST(DoubleRays, refitted_trees_are_those_of_the_new_mesh) {
  const std::vector<Known>& known = known_cases();
  for (const Known& now : known)
    for (const Known& before : known) {
      if (now.with.mesh.triangles.size() != before.with.mesh.triangles.size()) continue;
      SCOPED_TRACE(before.with.name + " to " + now.with.name);
      BvhD tree = tree_of(before.with.mesh);
      tree.refit(now.with.mesh.vertices, now.with.mesh.triangles);
      std::vector<HitD> hits(now.with.rays.size());
      tree.closest(now.with.rays, hits);
      ASSERT_TRUE(same_bytes(hits, now.first[0]));
    }
}

TEST(DoubleRays, filters_see_each_hit_once) {
  for (const Known& known : known_cases()) {
    SCOPED_TRACE(known.with.name);
    std::vector<std::size_t> seen(known.with.rays.size());
    const HitFilterD third = [&](std::span<const std::size_t> rays, std::span<const HitD> hits,
                                 std::span<std::uint8_t> rejected) {
      for (std::size_t k = 0; k < rays.size(); ++k) {
        const std::size_t at = seen[rays[k]]++;
        ASSERT_TRUE(same_bytes(hits[k], known.all[rays[k]][at]));
        rejected[k] = at < 2 ? 1 : 0;
      }
    };
    std::vector<HitD> hits(known.with.rays.size());
    known.tree.closest(known.with.rays, hits, third);
    std::vector<std::uint8_t> occluded(known.with.rays.size());
    seen.assign(seen.size(), 0);
    known.tree.occluded(known.with.rays, occluded, third);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      ASSERT_TRUE(same_bytes(hits[i], known.all[i].size() > 2 ? known.all[i][2] : HitD()));
      ASSERT_EQ(occluded[i], known.all[i].size() > 2 ? 1 : 0);
    }
  }
}

TEST(DoubleRays, filters_are_taken_by_every_call) {
  Random random(840);
  const auto point = [&] {
    Double3 made;
    for (double& x : made) x = double{random.number(-1, 1)} + 1e-9 * double{random.number(-1, 1)};
    return made;
  };
  DoubleMesh mesh;
  for (std::size_t i = 0; i < by_level(150); ++i) {
    const Double3 a = point(), b = point(), c = point();
    append(mesh, a, b, c);
  }
  std::vector<RayD> rays(by_level(200));
  for (RayD& ray : rays) ray.origin = point(), ray.direction = point();
  const BvhD tree = tree_of(mesh);
  for (const Path* path : paths_with_own_queries())
    expect_filtered<HitD>(tree, rays, TraceOptionsD{.path = path}, [&](const RayD& ray) {
      return tree.all_hits(std::vector<RayD>{ray}, {.path = &paths().front()}).items;
    });
}

}  // namespace
}  // namespace raylanes::testing

// Every query of rays: of all triangles, of one side, by masks, and of all but one for each ray. Rational numbers say
// what each returns, on every tree of floats and of doubles, on every path and in every mode, of many rays and alone.
#include "../../oracles/closest_crossing_oracle.hpp"
#include "../../oracles/peeled.hpp"
#include "../../support/filtered.hpp"
#include "../../traverse/reference/in_flight.hpp"
#include "../../traverse/reference/traced.hpp"
#include "../masked_mesh.hpp"
#include "worlds.hpp"

namespace raylanes::testing {
namespace {

// Words of triangles for a mask of 6: a third is not there, the last eighth has none.
std::vector<std::uint32_t> some_masks(std::size_t triangles) {
  std::vector<std::uint32_t> masks(triangles - triangles / 8);
  for (std::size_t i = 0; i < masks.size(); ++i) masks[i] = i % 3 == 0 ? 9 : i % 3 == 1 ? 2 : 5;
  return masks;
}
constexpr std::uint32_t seeing = 6;
// The results of rays for which some triangles are there.
template <class T>
struct Expected {
  Facing facing;
  std::vector<std::uint32_t> skip, masks;
  std::vector<std::vector<HitOf<T>>> hits, closest_crossings;
  std::vector<std::vector<CrossingOf<T>>> crossings;
  std::vector<std::uint8_t> occluded;
  std::vector<CrossingCount> counts;

  Expected(const MeshOf<T>& of_all, const std::vector<RayOf<T>>& rays, Facing side,
           std::vector<std::uint32_t> skipped = {}, std::vector<std::uint32_t> masked = {})
      : facing(side), skip(std::move(skipped)), masks(std::move(masked)) {
    const MeshOf<T> mesh = seen_by(of_all, masks, seeing);
    for (const RayOf<T>& ray : rays) {
      const std::uint32_t without = skip.empty() ? no_primitive : skip[hits.size()];
      const auto is_skipped = [&](const auto& at) { return at.primitive == without; };
      auto all = oracle_hits(mesh, ray);
      auto& of_ray = hits.emplace_back(side == Facing::any ? all : oracle_hits(mesh, ray, side));
      std::erase_if(all, is_skipped), std::erase_if(of_ray, is_skipped);
      occluded.push_back(of_ray.empty() ? 0 : 1);
      auto& crossed = crossings.emplace_back(oracle::exact_crossings(mesh, ray));
      auto& passed = closest_crossings.emplace_back(oracle_closest_crossings(mesh, ray, all, crossed));
      std::erase_if(passed, [&](const auto& crossing) {
        return std::ranges::find(of_ray, crossing.primitive, &HitOf<T>::primitive) == of_ray.end();
      });
      std::erase_if(crossed, [&](const auto& crossing) {
        return is_skipped(crossing) ||
               (side != Facing::any && crossing.side != (side == Facing::front ? -1 : 1));
      });
      CrossingCount& count = counts.emplace_back();
      for (const auto& crossing : crossed) ++count.crossings, count.winding += crossing.side;
    }
  }
  HitOf<T> nearest(std::size_t ray) const {
    const auto& of_ray = hits[ray % hits.size()];
    return of_ray.empty() ? HitOf<T>() : of_ray[0];
  }
};

// A primitive for each ray: mostly that of its nearest hit or the next, of some rays another one or none.
template <class T>
std::vector<std::uint32_t> some_skips(const Expected<T>& all) {
  std::vector<std::uint32_t> skip;
  for (const auto& hits : all.hits) {
    const std::size_t i = skip.size(), last = std::max<std::size_t>(hits.size(), 1) - 1;
    skip.push_back(i % 5 == 4 || hits.empty() ? (i % 2 == 0 ? no_primitive : static_cast<std::uint32_t>(i))
                                              : hits[i % 7 == 6 ? last : std::min(i % 2, last)].primitive);
  }
  return skip;
}

// Nearest hits and occlusion, in every mode, counted and not.
template <class T, class Tree>
void expect_nearest(const Tree& tree, const std::vector<RayOf<T>>& rays, const Expected<T>& expected,
                    TraceOptionsOf<T> options) {
  const std::vector<std::uint32_t> skip =
      expected.skip.empty() ? expected.skip : repeated(expected.skip, rays.size());
  options.facing = expected.facing, options.skip = skip;
  options.mask = seeing, options.masks = expected.masks;
  const auto expect = [&] {
    std::vector<HitOf<T>> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size(), 7);
    tree.closest(rays, hits, options);
    tree.occluded(rays, occluded, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const HitOf<T> wanted = expected.nearest(i);
      ASSERT_TRUE(same_bytes(hits[i], wanted))
          << "ray " << i << ": " << hits[i].primitive << " at " << hits[i].t << ", not " << wanted.primitive
          << " at " << wanted.t;
      ASSERT_EQ(occluded[i], wanted ? 1 : 0) << "ray " << i;
    }
  };
  if constexpr (requires { options.mode; }) {
    TraceCounters counters;
    for (std::size_t mode = 0; mode < traversal_mode_names.size(); ++mode)
      for (const bool counts : {false, true}) {
        options.mode = static_cast<TraversalMode>(mode), options.counters = counts ? &counters : nullptr;
        SCOPED_TRACE(std::string(traversal_mode_names[mode]) + (counts ? ", counted" : ""));
        if (!counts || has_counters()) expect();
      }
  } else {
    for (const bool fly : {false, true}) let_rays_fly(tree, fly), expect();
    let_rays_fly(tree, false);
  }
}

template <class T, class Tree>
void expect_calls(const Tree& tree, const std::vector<RayOf<T>>& rays, const Expected<T>& expected,
                  const Path* path) {
  for (std::size_t i = 0; i < rays.size(); i += 3) {
    TraceOptionsOf<T> options{.path = path, .facing = expected.facing};
    options.mask = seeing, options.masks = expected.masks;
    if (!expected.skip.empty()) options.skip = expected.skip[i];
    const HitOf<T> wanted = expected.nearest(i);
    EXPECT_TRUE(same_bytes(tree.closest(rays[i], options), wanted)) << "ray " << i;
    EXPECT_EQ(tree.occluded(rays[i], options), static_cast<bool>(wanted)) << "ray " << i;
  }
}

template <class T, class Tree>
void expect_lists(const Tree& tree, const std::vector<RayOf<T>>& rays, const Expected<T>& expected,
                  const Path* path) {
  const std::vector<std::uint32_t> skip =
      expected.skip.empty() ? expected.skip : repeated(expected.skip, rays.size());
  for (const std::uint32_t most : {~0u, 0u, 2u, 65u}) {
    const ListOptions options{.max_count = most,
                              .facing = expected.facing,
                              .path = path,
                              .skip = skip,
                              .mask = seeing,
                              .masks = expected.masks};
    const auto all = tree.all_hits(rays, options);
    const auto crossed = tree.crossings(rays, options);
    std::vector<CrossingCount> counts(rays.size());
    tree.count_crossings(rays, counts, options);
    ASSERT_TRUE(all.size() == rays.size() && crossed.size() == rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::size_t k = i % expected.hits.size();
      const auto first = [&](const auto& list) {
        return std::span(list).first(std::min<std::size_t>(most, list.size()));
      };
      ASSERT_TRUE(same_bytes(all[i], first(expected.hits[k])))
          << "ray " << i << ": " << all[i].size() << " hits, not " << expected.hits[k].size();
      ASSERT_TRUE(std::ranges::equal(crossed[i], first(expected.crossings[k])))
          << "ray " << i << ": " << crossed[i].size() << " crossings, not " << expected.crossings[k].size();
      ASSERT_EQ(counts[i], expected.counts[k]) << "ray " << i;
    }
  }
}

// Hits and crossings after others, until there are no more.
template <class T, class Tree>
void expect_after(const Tree& tree, const std::vector<RayOf<T>>& rays, const Expected<T>& expected,
                  TraceOptionsOf<T> options) {
  options.facing = expected.facing, options.skip = expected.skip;
  options.mask = seeing, options.masks = expected.masks;
  expect_peeled(rays, expected.hits, options, hits_of(tree, rays, expected.skip));
  expect_peeled(rays, expected.closest_crossings, options, closest_crossings_of(tree, rays, expected.skip));
}

template <class T, class Tree>
void expect_all(const Tree& tree, const Path* path, const std::vector<RayOf<T>>& rays,
                const Expected<T>& expected, bool many) {
  expect_nearest<T>(tree, rays, expected, {.path = path});
  expect_calls<T>(tree, rays, expected, path);
  expect_lists<T>(tree, rays, expected, path);
  expect_after<T>(tree, rays, expected, {.path = path});
  if (!many) return;
  expect_nearest<T>(tree, repeated(rays), expected, {.path = path, .threads = 2});
  expect_lists<T>(tree, repeated(rays), expected, path);
  TraceOptionsOf<T> together{.path = path, .threads = 2};
  if constexpr (requires { together.mode; }) together.mode = TraversalMode::stream;
  expect_after<T>(tree, rays, expected, together);
}

template <class T>
class EveryQuery : public ::testing::Test {
 public:
  // Rational numbers of doubles take longer.
  static std::size_t rays(std::size_t all) {
    return std::is_same_v<T, float> ? all / (exhaustive() ? 2 : 3) : all / (exhaustive() ? 3 : 5);
  }
};
TYPED_TEST_SUITE(EveryQuery, Numbers, NumberNames);

// Below level all, fewer batches are of many rays; at level quick, which emulated processors have, all take fewer ways.
TYPED_TEST(EveryQuery, returns_what_rational_numbers_say) {
  using T = TypeParam;
  for (const World<T>& world : worlds<T>(this->rays(180))) {
    SCOPED_TRACE(world.name);
    if constexpr (std::is_same_v<
                      T, float>)  // every test and grade, on paths that share queries with others, too
      if (world.may_flush) expect_brute_force(world.mesh, world.rays);
    const Expected<T> all(world.mesh, world.rays, Facing::any);
    EXPECT_GT(std::ranges::count(all.occluded, 1), 3) << "the rays are aimed badly";
    const std::vector<std::uint32_t> skip = some_skips(all);
    const std::vector<std::uint32_t> masks = some_masks(world.mesh.triangles.size());
    const Expected<T> cases[] = {all,
                                 {world.mesh, world.rays, Facing::front},
                                 {world.mesh, world.rays, Facing::back, skip, masks},
                                 {world.mesh, world.rays, Facing::any, skip},
                                 {world.mesh, world.rays, Facing::any, {}, masks}};
    for (const Expected<T>& expected : cases) {
      const bool is_all = expected.facing == Facing::any && expected.skip.empty() && expected.masks.empty();
      each_tree(world.mesh, [&](const auto& tree, const Path* path) {
        for (const FloatMode mode : float_modes) {
          const bool may_flush = world.may_flush && !quick() && (is_all || std::is_same_v<T, float>);
          if (mode == FloatMode::flush && !may_flush) continue;
          SCOPED_TRACE(std::string(facing_names[static_cast<std::size_t>(expected.facing)]) +
                       (expected.skip.empty() ? ", " : ", without some, ") +
                       (expected.masks.empty() ? "" : "masked, ") + name_of(mode));
          const FloatModeScope scope(mode);
          expect_all<T>(tree, path, world.rays, expected,
                        expected.facing != Facing::back && by_level(is_all, mode == FloatMode::ieee, true));
        }
      });
      if (this->HasFailure()) return;
    }
  }
}

TYPED_TEST(EveryQuery, of_trees_by_every_builder) {
  using T = TypeParam;
  const World<T> world = std::move(worlds<T>(this->rays(180))[0]);
  const Expected<T> expected(world.mesh, world.rays, Facing::any);
  for (std::size_t i = 0; i < 2 * tree_builder_names.size(); ++i) {
    const BuildOptions options{
        .builder = static_cast<TreeBuilder>(i / 2), .threads = 2, .optimize = i % 2 == 1};
    if (std::is_same_v<T, double> && options.builder == TreeBuilder::spatial_splits) continue;
    SCOPED_TRACE(tree_builder_names[i / 2]);
    const auto tree = tree_of<T>(world.mesh, options);
    expect_nearest<T>(tree, world.rays, expected, {.threads = 2});
    expect_lists<T>(tree, world.rays, expected, nullptr);
  }
}

// Segments from a light, which sees the other side, and filters of chosen triangles.
TYPED_TEST(EveryQuery, of_shadows_and_filters) {
  using T = TypeParam;
  const World<T> world = std::move(worlds<T>(this->rays(180))[0]);
  const PointOf<T> light{T(0.1), T(0.2), 3};
  std::vector<PointOf<T>> points;
  std::vector<RayOf<T>> to_points;
  for (const RayOf<T>& ray : world.rays) {
    points.push_back(ray.origin);
    to_points.push_back(segment_to<T>(light, ray.origin));
  }
  const auto skip = some_skips(Expected<T>(world.mesh, to_points, Facing::any));
  const Expected<T> shadows[] = {
      {world.mesh, to_points, Facing::front},
      {world.mesh, to_points, Facing::back},
      {world.mesh, to_points, Facing::any, skip},
      {world.mesh, to_points, Facing::any, {}, some_masks(world.mesh.triangles.size())}};
  for (const Expected<T>& dark : shadows) {
    const Expected<T> expected(world.mesh, world.rays, dark.facing, dark.skip, dark.masks);
    each_tree(world.mesh, [&](const auto& tree, const Path* path) {
      TraceOptionsOf<T> options{.path = path, .facing = dark.facing, .skip = dark.skip};
      options.mask = seeing, options.masks = dark.masks;
      TraceOptionsOf<T> from_light = options;
      if (dark.facing != Facing::any)
        from_light.facing = dark.facing == Facing::front ? Facing::back : Facing::front;
      std::vector<std::uint8_t> occluded(points.size());
      tree.occluded_from(light, points, occluded, {0, 1}, from_light);
      EXPECT_EQ(occluded, dark.occluded);
      std::vector<HitOf<T>> hits(points.size());
      tree.closest(world.rays, hits, reject_even<HitOf<T>>, options);
      tree.occluded(world.rays, occluded, reject_even<HitOf<T>>, options);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        HitOf<T> wanted;
        for (const HitOf<T>& hit : expected.hits[i])
          if (!wanted && hit.primitive % 2 != 0) wanted = hit;
        ASSERT_TRUE(same_bytes(wanted, hits[i])) << "ray " << i;
        ASSERT_EQ(occluded[i], wanted ? 1 : 0) << "ray " << i;
      }
    });
  }
}

// A filter that is asked about some triangles alone is that filter with an answer for the others.
TYPED_TEST(EveryQuery, asks_filters_about_some_triangles) {
  using T = TypeParam;
  const World<T> world = std::move(worlds<T>(this->rays(360))[0]);
  const std::vector<std::uint32_t> masks = some_masks(world.mesh.triangles.size());
  constexpr std::uint32_t asking = 2;
  const auto is_asked = [&](const HitOf<T>& hit) {
    return hit.primitive >= masks.size() || (masks[hit.primitive] & asking) != 0;
  };
  const Expected<T> expected(world.mesh, world.rays, Facing::any, {}, masks);
  std::size_t let_by = 0;
  each_tree(world.mesh, [&](const auto& tree, const Path* path) {
    TraceOptionsOf<T> options{.path = path};
    options.mask = seeing, options.filter_mask = asking, options.masks = masks;
    const auto reject_asked = [&](std::span<const std::size_t>, std::span<const HitOf<T>> hits,
                                  std::span<std::uint8_t> rejected) {
      for (std::size_t k = 0; k < hits.size(); ++k) {
        EXPECT_TRUE(is_asked(hits[k]));
        rejected[k] = 1;
      }
    };
    const auto rejects = [&](const HitOf<T>& hit) {
      EXPECT_TRUE(is_asked(hit));
      return true;
    };
    std::vector<HitOf<T>> hits(world.rays.size());
    std::vector<std::uint8_t> occluded(world.rays.size());
    tree.closest(world.rays, hits, reject_asked, options);
    tree.occluded(world.rays, occluded, reject_asked, options);
    auto within = hits;
    auto occluded_within = occluded;
    const auto rejects_any = [&](std::size_t, const HitOf<T>& hit) { return rejects(hit); };
    tree.closest(world.rays, within, rejects_any, options);
    tree.occluded(world.rays, occluded_within, rejects_any, options);
    EXPECT_TRUE(same_bytes(within, hits));
    EXPECT_EQ(occluded_within, occluded);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      HitOf<T> wanted;
      for (const HitOf<T>& hit : expected.hits[i])
        if (!wanted && !is_asked(hit)) wanted = hit;
      let_by += wanted && !same_bytes(wanted, expected.nearest(i)) ? 1 : 0;
      ASSERT_TRUE(same_bytes(wanted, hits[i])) << "ray " << i;
      ASSERT_EQ(occluded[i], wanted ? 1 : 0) << "ray " << i;
      if (i % 3 != 0) continue;
      EXPECT_TRUE(same_bytes(tree.closest(world.rays[i], rejects, options), wanted)) << "ray " << i;
      EXPECT_EQ(tree.occluded(world.rays[i], rejects, options), static_cast<bool>(wanted)) << "ray " << i;
    }
  });
  EXPECT_GT(let_by, 0u);
}

TYPED_TEST(EveryQuery, takes_filters_in_every_call) {
  using T = TypeParam;
  const World<T> world = std::move(worlds<T>(this->rays(300))[0]);
  each_tree(world.mesh, [&](const auto& tree, const Path* path) {
    expect_filtered<HitOf<T>>(tree, world.rays, TraceOptionsOf<T>{.path = path},
                              [&](const RayOf<T>& ray) { return oracle_hits(world.mesh, ray); });
  });
}

}  // namespace
}  // namespace raylanes::testing

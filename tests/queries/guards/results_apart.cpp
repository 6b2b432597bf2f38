// Calls may read where they write: skips, hits to look behind and masks are taken as they were before, rays and points
// are refused before anything is written. Rays may also be parts that lie apart.
#include "../../support/filtered.hpp"
#include "kinds.hpp"

namespace raylanes::testing {
namespace {

template <class K>
class ResultsApart : public ::testing::Test {};
using Kinds = ::testing::Types<BvhKind, KdTreeKind, BvhDKind, SceneKind, SpheresKind>;
TYPED_TEST_SUITE(ResultsApart, Kinds);

// check(options) in each mode, on one thread and on three.
template <class K, class Check>
void each_way(const Check& check) {
  for (const int threads : {1, 3})
    for (std::size_t mode = 0; mode < (K::has_modes ? traversal_mode_names.size() : 1); ++mode) {
      SCOPED_TRACE(::testing::Message() << threads << " threads, mode " << traversal_mode_names[mode]);
      typename K::Options options;
      options.threads = threads;
      if constexpr (K::has_modes) options.mode = static_cast<TraversalMode>(mode);
      check(options);
    }
}
// check(call), where call(rays, hits, options) finds hits in one of the ways that a kind has.
template <class K, class Check>
void each_call(const K& kind, const Check& check) {
  using Hits = HitRecords<typename K::Hit>;
  using Options = typename K::Options;
  check("closest",
        [&](const auto& rays, Hits hits, const Options& by) { kind.tree.closest(rays, hits, by); });
  check("filter", [&](const auto& rays, Hits hits, const Options& by) {
    kind.tree.closest(rays, hits, reject_even<typename K::Hit>, by);
  });
  if constexpr (K::has_crossings)
    check("crossing", [&](const auto& rays, Hits hits, const Options& by) {
      kind.tree.closest_crossing(rays, hits, by);
    });
}

TYPED_TEST(ResultsApart, skips_and_hits_behind_are_read_as_they_were) {
  using Hit = typename TypeParam::Hit;
  const TypeParam kind;
  const auto rays = make_rays<typename TypeParam::T>();
  std::vector<Hit> first(n), expected(n);
  kind.tree.closest(rays, first);
  each_call(kind, [&](const char* name, const auto& call) {
    each_way<TypeParam>([&](const typename TypeParam::Options& options) {
      for (const bool skips : {true, false}) {
        SCOPED_TRACE(::testing::Message() << name << (skips ? ", skip" : ", after"));
        const auto ask = [&](const std::vector<Hit>& array, std::size_t at, HitRecords<Hit> to) {
          const HitRecords<Hit> given(const_cast<Hit*>(array.data()) + at, n);
          auto by = options;
          if (skips)
            by.skip = given;
          else
            by.after = given;
          call(rays, to, by);
        };
        ask(first, 0, expected);
        for (std::size_t at = 0; at <= 2 * room; ++at) {
          std::vector<Hit> hits = within(first, at);
          ask(hits, at, HitRecords<Hit>(hits.data() + room, n));
          hits.erase(hits.begin(), hits.begin() + room), hits.resize(n);
          ASSERT_TRUE(same_bytes(hits, expected)) << "at " << at;
        }
      }
    });
  });
}

TYPED_TEST(ResultsApart, masks_and_indices_are_read_as_they_were) {
  using Hit = typename TypeParam::Hit;
  const TypeParam kind;
  const auto rays = make_rays<typename TypeParam::T>();
  Random random(704);
  std::vector<std::uint8_t> mask(n / 8);
  for (std::uint8_t& bits : mask) bits = static_cast<std::uint8_t>(random.integer(0, 255));
  each_way<TypeParam>([&](typename TypeParam::Options options) {
    std::vector<Hit> expected(n), hits(n);
    std::vector<std::uint8_t> occluded(n + 8), wanted(n, 9);
    auto* const bytes = reinterpret_cast<std::uint8_t*>(hits.data());
    for (const std::size_t at : {std::size_t{0}, n / 2, n - mask.size()}) {
      std::ranges::copy(mask, bytes + at), std::ranges::copy(mask, occluded.data() + at);
      options.active = mask.data();
      expected = hits, wanted = occluded;
      kind.tree.closest(rays, expected, options),
          kind.tree.occluded(rays, std::span(wanted).first(n), options);
      options.active = bytes + at;
      kind.tree.closest(rays, hits, options);
      EXPECT_TRUE(same_bytes(hits, expected)) << at;
      options.active = occluded.data() + at;
      kind.tree.occluded(rays, std::span(occluded).first(n), options);
      EXPECT_EQ(occluded, wanted) << at;
    }
  });
}

TYPED_TEST(ResultsApart, rays_and_points_are_refused) {
  using Hit = typename TypeParam::Hit;
  using T = typename TypeParam::T;
  using Ray = RayOf<T>;
  const TypeParam kind;
  std::vector<Ray> rays = make_rays<T>();
  const std::vector<Ray> given = rays;
  auto* const bytes = reinterpret_cast<std::byte*>(rays.data());
  const RayColumns<Ray> columns(rays);
  const auto arrays = columns.view();
  const RayRecords<Ray> from(rays.data(), 1000);
  const VertexRecords<T> points(rays.data(), 1000);
  for (const std::size_t at : {std::size_t{0}, std::size_t{1}, sizeof(Ray) - 1, 1000 * sizeof(Ray) - 1}) {
    const HitRecords<Hit> over(bytes + at, 1000);
    const std::span<std::uint8_t> dark(reinterpret_cast<std::uint8_t*>(bytes) + at, 1000);
    EXPECT_THROW(kind.tree.closest(from, over), std::invalid_argument) << at;
    EXPECT_THROW(kind.tree.closest(from, over, reject_even<Hit>), std::invalid_argument) << at;
    EXPECT_THROW(kind.tree.occluded(from, dark), std::invalid_argument) << at;
    EXPECT_THROW(kind.tree.occluded(from, dark, reject_even<Hit>), std::invalid_argument) << at;
    if (at > sizeof(Ray)) continue;
    EXPECT_THROW(kind.tree.occluded_from({}, points, dark), std::invalid_argument) << at;
    EXPECT_THROW(kind.tree.occluded_from({}, points, dark, reject_even<Hit>), std::invalid_argument) << at;
  }
  for (std::size_t k = 0; k < 8; ++k) {
    auto* const column = const_cast<T*>(columns.column[k].data());
    const std::span<std::uint8_t> dark(reinterpret_cast<std::uint8_t*>(column) + 5, n);
    EXPECT_THROW(kind.tree.occluded(arrays, dark), std::invalid_argument) << k;
  }
  EXPECT_TRUE(same_bytes(rays, given));
  EXPECT_TRUE(std::ranges::equal(columns.column[5], RayColumns<Ray>(given).column[5]));
}

// Fields of the same records share no bytes.
TYPED_TEST(ResultsApart, fields_of_records_may_be_rays_and_hits) {
  using Hit = typename TypeParam::Hit;
  using Ray = RayOf<typename TypeParam::T>;
  struct Traced {
    Hit before;
    Ray ray;
    Hit hit;
  };
  const TypeParam kind;
  const std::vector<Ray> rays = make_rays<typename TypeParam::T>();
  std::vector<Traced> traced(n);
  for (std::size_t i = 0; i < n; ++i) traced[i].ray = rays[i];
  const RayRecords<Ray> from(&traced[0].ray, n, sizeof(Traced));
  std::vector<Hit> expected(n), hits(n);
  kind.tree.closest(rays, expected);
  for (Hit* const to : {&traced[0].before, &traced[0].hit}) {
    const HitRecords<Hit> out(to, n, sizeof(Traced));
    kind.tree.closest(from, out);
    for (std::size_t i = 0; i < n; ++i) hits[i] = out[i];
    EXPECT_TRUE(same_bytes(hits, expected));
  }
  // Hits that lie farther apart than rays meet these at last.
  EXPECT_THROW(kind.tree.closest(from, HitRecords<Hit>(&traced[0].hit, n, sizeof(Traced) + 4)),
               std::invalid_argument);
}

// Rays whose numbers lie apart, at any address, one part of them for all rays; and their refusals.
TYPED_TEST(ResultsApart, rays_may_be_parts) {
  using Hit = typename TypeParam::Hit;
  using T = typename TypeParam::T;
  using Ray = RayOf<T>;
  const TypeParam kind;
  const std::vector<Ray> given = make_rays<T>();
  std::vector<unsigned char> bytes(n * sizeof(Ray) + 1);
  std::memcpy(bytes.data() + 1, given.data(), n * sizeof(Ray));
  const auto part = [&](std::size_t number, bool is_of_all) {
    return RayParts::Part{bytes.data() + 1 + number * sizeof(T), is_of_all ? 0 : sizeof(Ray)};
  };
  for (unsigned of_all = 0; of_all < 16; ++of_all) {
    const auto is_of_all = [&](unsigned k) { return (of_all >> k & 1u) != 0; };
    RayParts parts{part(0, is_of_all(0)), part(4, is_of_all(1)), part(3, is_of_all(2)), part(7, is_of_all(3)),
                   n};
    if (is_of_all(2)) parts.tmin = {};
    if (is_of_all(3)) parts.tmax = {};
    std::vector<Ray> rays = given;
    for (Ray& ray : rays) {
      if (is_of_all(0)) ray.origin = rays[0].origin;
      if (is_of_all(1)) ray.direction = rays[0].direction;
    }
    std::vector<Hit> expected(n), hits(n), kept(n);
    std::vector<std::uint8_t> dark(n), occluded(n);
    kind.tree.closest(rays, expected), kind.tree.occluded(rays, dark);
    for (const int threads : {1, 3}) {
      typename TypeParam::Options options;
      options.threads = threads;
      kind.tree.closest(parts, hits, options), kind.tree.occluded(parts, occluded, options);
      EXPECT_TRUE(same_bytes(hits, expected)) << of_all;
      EXPECT_EQ(occluded, dark) << of_all;
    }
    kind.tree.closest(rays, expected, reject_even<Hit>), kind.tree.closest(parts, kept, reject_even<Hit>);
    EXPECT_TRUE(same_bytes(kept, expected)) << of_all;
  }
  RayParts parts{part(0, false), part(4, false), part(3, false), part(7, false), n};
  const std::span<std::uint8_t> over(bytes.data() + 1 + 7 * sizeof(T) + sizeof(T) - 1, n);
  EXPECT_THROW(kind.tree.occluded(parts, over), std::invalid_argument);
  std::vector<std::uint8_t> dark(n);
  parts.direction.first = nullptr;
  EXPECT_THROW(kind.tree.occluded(parts, dark), std::invalid_argument);
  parts = {{nullptr, 0}, part(4, false), {}, {}, n};
  EXPECT_THROW(kind.tree.occluded(parts, dark), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing

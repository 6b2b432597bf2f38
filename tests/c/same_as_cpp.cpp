// The C functions write the bytes that the classes return, for every option, on every path; and nothing else.
#include "as_cpp.hpp"
#include "queries.hpp"

namespace raylanes::testing {
namespace {

using Kinds = ::testing::Types<float, double, Scene, SceneD>;
TYPED_TEST_SUITE(CCalls, Kinds);

TYPED_TEST(CCalls, write_the_results_of_the_classes) {
  each_query(QueriesOf<TypeParam>::of_rays(), [&](const auto& query) {
    using Query = std::decay_t<decltype(query)>;
    this->template each_ray_option<typename Query::Options>([&](const auto& c, const auto& options) {
      for (const std::size_t gap : {0, query.has_stride ? 7 : 0})
        this->template expect_same<typename Query::Result>(
            query.name, gap,
            [&](auto& to) {
              return query.of_c(this->c_tree.get(), this->rays_of_c.data(), count, this->rays_of_c.stride(),
                                to.data(), gap == 0 ? 0 : to.stride(), &c);
            },
            [&](auto& to) { query.of_cpp(this->cpp_tree, this->rays, to, options); });
    });
  });
}

TYPED_TEST(CCalls, write_the_shadows_of_the_classes) {
  using C = CallsOf<TypeParam>;
  using Number = typename C::Number;
  const auto light = this->rays[0].origin, direction = this->rays[1].direction;
  std::vector<PointOf<Number>> places;
  for (const auto& ray : this->rays) places.push_back(ray.origin);
  Apart<PointOf<Number>> c_points(places, 5);
  Apart<PointOf<Number>> from({light}, 0), towards({direction}, 0);
  for (const SegmentEndsOf<Number> ends : {SegmentEndsOf<Number>{}, {Number(0.25), Number(0.75)}})
    this->template each_ray_option<typename C::Trace>([&](const auto& c, const auto& options) {
      this->template expect_same<std::uint8_t>(
          "occluded_from", 0,
          [&](auto& occluded) {
            return C::occluded_from(this->c_tree.get(), static_cast<const Number*>(from.data()),
                                    c_points.data(), count, c_points.stride(), ends.start, ends.end,
                                    static_cast<std::uint8_t*>(occluded.data()), &c);
          },
          [&](auto& occluded) {
            this->cpp_tree.occluded_from(light, this->points(), occluded, ends, options);
          });
      this->template expect_same<std::uint8_t>(
          "occluded_towards", 0,
          [&](auto& occluded) {
            return C::occluded_towards(this->c_tree.get(), static_cast<const Number*>(towards.data()),
                                       c_points.data(), count, c_points.stride(),
                                       static_cast<std::uint8_t*>(occluded.data()), &c);
          },
          [&](auto& occluded) {
            this->cpp_tree.occluded_towards(direction, this->points(), occluded, options);
          });
    });
}

TYPED_TEST(CCalls, write_the_hits_of_one_ray) {
  using C = CallsOf<TypeParam>;
  using Hit = HitOfKind<TypeParam>;
  auto* const tree = this->c_tree.get();
  const auto check = [&](const raylanes_ray_options* c, std::size_t i, const Hit& expected,
                         const typename C::Trace& by) {
    Apart<RayOf<typename C::Number>> memory({this->rays[i]}, 0);
    const auto* const ray = static_cast<const typename C::CRay*>(memory.data());
    Apart<Hit> hit(1);
    auto* const to = static_cast<typename C::CHit*>(hit.data());
    const auto& cpp = this->rays[i];
    std::uint8_t occluded = 7;
    ASSERT_EQ(C::closest1(tree, ray, to, c), RAYLANES_OK);
    EXPECT_TRUE(same_bytes(hit.values()[0], expected)) << i;
    ASSERT_EQ(C::occluded1(tree, ray, &occluded, c), RAYLANES_OK);
    EXPECT_EQ(occluded, this->cpp_tree.occluded(cpp, by) ? 1 : 0) << i;
    if constexpr (requires { C::calls_create; }) {
      typename C::Calls* calls = nullptr;
      ASSERT_EQ(C::calls_create(&calls, tree, c), RAYLANES_OK);
      ASSERT_EQ(C::calls_closest(calls, ray, to), RAYLANES_OK);
      EXPECT_TRUE(same_bytes(hit.values()[0], expected)) << i;
      ASSERT_EQ(C::calls_occluded(calls, ray, &occluded), RAYLANES_OK);
      EXPECT_EQ(occluded, this->cpp_tree.occluded(cpp, by) ? 1 : 0) << i;
      C::calls_destroy(calls);
    }
    // Behind the hit there is the next one.
    raylanes_ray_options behind = c != nullptr ? *c : default_ray_options();
    behind.after = &expected;
    typename C::Trace after = by;
    after.after = expected;
    ASSERT_EQ(C::closest1(tree, ray, to, &behind), RAYLANES_OK);
    EXPECT_TRUE(same_bytes(hit.values()[0], this->cpp_tree.closest(cpp, after))) << i;
    ASSERT_EQ(C::closest_crossing1(tree, ray, to, c), RAYLANES_OK);
    EXPECT_TRUE(same_bytes(hit.values()[0], this->cpp_tree.closest_crossing(cpp, by))) << i;
  };
  std::vector<Hit> hits(count);
  this->cpp_tree.closest(this->rays, hits);
  for (std::size_t i = 0; i < count; ++i) {
    check(nullptr, i, hits[i], {});
    raylanes_ray_options c = default_ray_options();
    c.skip = &hits[i].primitive;
    typename C::Trace by;
    by.skip = hits[i];
    check(&c, i, this->cpp_tree.closest(this->rays[i], by), by);
  }
}

TYPED_TEST(CCalls, make_the_lists_of_the_classes) {
  each_query(QueriesOf<TypeParam>::of_lists(), [&](const auto& query) {
    this->template each_ray_option<ListOptions>([&](raylanes_ray_options c, ListOptions options) {
      if (std::string_view(query.name) == "stretches") c.facing = 0, options.facing = Facing::any;
      for (const std::size_t most : {std::size_t{0}, std::size_t{2}, std::size_t{1} << 32, SIZE_MAX}) {
        c.max_count = most;
        options.max_count = static_cast<std::uint32_t>(std::min<std::size_t>(most, 0xffffffffu));
        this->expect_lists(made<ListsOfC>([&](raylanes_lists** lists) {
                             query.of_c(this->c_tree.get(), this->rays_of_c.data(), count,
                                        this->rays_of_c.stride(), lists, &c);
                           }),
                           query.of_cpp(this->cpp_tree, this->rays, options));
      }
    });
  });
}

TYPED_TEST(CCalls, look_up_the_points_of_the_classes) {
  each_query(QueriesOf<TypeParam>::of_points(), [&](const auto& query) {
    using Query = std::decay_t<decltype(query)>;
    this->template each_point_option<typename Query::Options>([&](const auto& c, const auto& options) {
      this->template expect_same<typename Query::Result>(
          query.name, 0,
          [&](auto& to) {
            return query.of_c(this->c_tree.get(), this->rays_of_c.data(), count, this->rays_of_c.stride(),
                              to.data(), 0, &c);
          },
          [&](auto& to) { query.of_cpp(this->cpp_tree, this->points(), to, options); });
    });
  });
}

TYPED_TEST(CCalls, ask_the_filters_of_the_classes) {
  using C = CallsOf<TypeParam>;
  using Hit = HitOfKind<TypeParam>;
  using Number = typename C::Number;
  auto* const tree = this->c_tree.get();
  const auto light = this->rays[0].origin;
  std::size_t kept = 0;
  this->template each_ray_option<typename C::Trace>([&](raylanes_ray_options c, typename C::Trace options) {
    c.filter = reject_in_c<Hit>;
    const HitFilterOf<Hit> filter = reject_in_cpp<Hit>;
    if (c.after != nullptr) c.after = nullptr, options.after = {};  // filters look behind hits themselves
    this->template expect_same<Hit>(
        "closest", 0,
        [&](auto& to) {
          return C::closest(tree, this->rays_of_c.data(), count, this->rays_of_c.stride(), to.data(), 0, &c);
        },
        [&](auto& to) {
          this->cpp_tree.closest(this->rays, to, filter, options);
          for (const Hit& hit : to) kept += hit ? 1 : 0;
        });
    const auto expect_dark = [&](const char* what, const auto& of_c, const auto& of_cpp) {
      this->template expect_same<std::uint8_t>(
          what, 0, [&](auto& to) { return of_c(static_cast<std::uint8_t*>(to.data())); }, of_cpp);
    };
    const auto& from = this->points();
    expect_dark(
        "occluded",
        [&](std::uint8_t* to) {
          return C::occluded(tree, this->rays_of_c.data(), count, this->rays_of_c.stride(), to, &c);
        },
        [&](auto& to) { this->cpp_tree.occluded(this->rays, to, filter, options); });
    expect_dark(
        "occluded_from",
        [&](std::uint8_t* to) {
          return C::occluded_from(tree, light.data(), from.first, count, from.stride, Number(0.125), 1, to,
                                  &c);
        },
        [&](auto& to) {
          this->cpp_tree.occluded_from(light, from, to, filter, {Number(0.125), 1}, options);
        });
    expect_dark(
        "occluded_towards",
        [&](std::uint8_t* to) {
          return C::occluded_towards(tree, light.data(), from.first, count, from.stride, to, &c);
        },
        [&](auto& to) { this->cpp_tree.occluded_towards(light, from, to, filter, options); });
  });
  EXPECT_GT(kept, count);
  raylanes_ray_options c = default_ray_options();
  c.filter = reject_in_c<Hit>;
  for (const auto& ray : this->rays) {
    const auto rejects = [](const Hit& hit) { return is_rejected(0, hit); };
    const void* const given = &ray;
    Hit hit;
    void* const to = &hit;
    std::uint8_t occluded = 7;
    ASSERT_EQ(C::closest1(tree, static_cast<const typename C::CRay*>(given),
                          static_cast<typename C::CHit*>(to), &c),
              RAYLANES_OK);
    EXPECT_TRUE(same_bytes(hit, this->cpp_tree.closest(ray, rejects)));
    ASSERT_EQ(C::occluded1(tree, static_cast<const typename C::CRay*>(given), &occluded, &c), RAYLANES_OK);
    EXPECT_EQ(occluded, this->cpp_tree.occluded(ray, rejects) ? 1 : 0);
  }
}

TYPED_TEST(CCalls, have_the_bounds_of_the_classes) {
  const auto box = this->cpp_tree.bounds();
  PointOf<NumberOfKind<TypeParam>> lo{}, hi{};
  ASSERT_EQ(CallsOf<TypeParam>::bounds(this->c_tree.get(), lo.data(), hi.data()), RAYLANES_OK);
  EXPECT_TRUE(same_bytes(lo, box.lo) && same_bytes(hi, box.hi));
}

}  // namespace
}  // namespace raylanes::testing

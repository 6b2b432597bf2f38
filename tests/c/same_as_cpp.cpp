// The C functions write the bytes that the classes return, for every option, on every path; and nothing else.
#include "as_cpp.hpp"
#include "queries.hpp"

namespace raylanes::testing {
namespace {

using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CCalls, Numbers);

TYPED_TEST(CCalls, write_the_results_of_the_classes) {
  Apart<RayOf<TypeParam>>& from = this->rays_of_c;
  const auto expect = [&](const auto& query, const auto& elements, const auto& c, const auto& options) {
    for (const std::size_t gap : {0, query.has_stride ? 7 : 0})
      this->template expect_same<typename std::decay_t<decltype(query)>::Result>(
          query.name, gap,
          [&](auto& to) {
            return query.of_c(this->tree_of_c.get(), from.data(), count, from.stride(), to.data(),
                              gap == 0 ? 0 : to.stride(), &c);
          },
          [&](auto& to) { query.of_cpp(this->cpp_tree, elements, to, options); });
  };
  each_query(QueriesOf<TypeParam>::of_rays(), [&](const auto& query) {
    this->template each_ray_option<typename std::decay_t<decltype(query)>::Options>(
        [&](const auto& c, const auto& options) { expect(query, this->rays, c, options); });
  });
  each_query(QueriesOf<TypeParam>::of_points(), [&](const auto& query) {
    this->template each_point_option<typename std::decay_t<decltype(query)>::Options>(
        [&](const auto& c, const auto& options) { expect(query, this->points(), c, options); });
  });
}

TYPED_TEST(CCalls, write_the_shadows_of_the_classes) {
  using C = CallsOf<TypeParam>;
  const auto light = this->rays[0].origin, direction = this->rays[1].direction;
  std::vector<PointOf<TypeParam>> places;
  for (const auto& ray : this->rays) places.push_back(ray.origin);
  Apart<PointOf<TypeParam>> c_points(places, 5);
  Apart<PointOf<TypeParam>> from({light}, 0), towards({direction}, 0);
  for (const SegmentEndsOf<TypeParam> ends : {SegmentEndsOf<TypeParam>{}, {TypeParam(0.25), TypeParam(0.75)}})
    this->template each_ray_option<typename C::Trace>([&](const auto& c, const auto& options) {
      this->template expect_same<std::uint8_t>(
          "occluded_from", 0,
          [&](auto& occluded) {
            return C::occluded_from(this->tree_of_c.get(), static_cast<const TypeParam*>(from.data()),
                                    c_points.data(), count, c_points.stride(), ends.start, ends.end,
                                    static_cast<std::uint8_t*>(occluded.data()), &c);
          },
          [&](auto& occluded) {
            this->cpp_tree.occluded_from(light, this->points(), occluded, ends, options);
          });
      this->template expect_same<std::uint8_t>(
          "occluded_towards", 0,
          [&](auto& occluded) {
            return C::occluded_towards(this->tree_of_c.get(), static_cast<const TypeParam*>(towards.data()),
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
  using Hit = HitOf<TypeParam>;
  auto* const tree = this->tree_of_c.get();
  const auto check = [&](const raylanes_ray_options* c, std::size_t i, const Hit& expected,
                         bool is_occluded) {
    Apart<RayOf<TypeParam>> ray({this->rays[i]}, 0);
    Apart<Hit> hit(1);
    std::uint8_t occluded = 7;
    const void* const given = ray.data();
    ASSERT_EQ(C::closest1(tree, static_cast<const typename C::CRay*>(given),
                          static_cast<typename C::CHit*>(hit.data()), c),
              RAYLANES_OK);
    EXPECT_TRUE(same_bytes(hit.values()[0], expected)) << i;
    ASSERT_EQ(C::occluded1(tree, static_cast<const typename C::CRay*>(given), &occluded, c), RAYLANES_OK);
    EXPECT_EQ(occluded, is_occluded ? 1 : 0) << i;
    typename C::Calls* calls = nullptr;
    ASSERT_EQ(C::calls_create(&calls, tree, c), RAYLANES_OK);
    ASSERT_EQ(C::calls_closest(calls, static_cast<const typename C::CRay*>(given),
                               static_cast<typename C::CHit*>(hit.data())),
              RAYLANES_OK);
    EXPECT_TRUE(same_bytes(hit.values()[0], expected)) << i;
    ASSERT_EQ(C::calls_occluded(calls, static_cast<const typename C::CRay*>(given), &occluded), RAYLANES_OK);
    EXPECT_EQ(occluded, is_occluded ? 1 : 0) << i;
    C::calls_destroy(calls);
    // Behind the hit there is the next one.
    raylanes_ray_options behind = c != nullptr ? *c : default_ray_options();
    behind.after = &expected;
    ASSERT_EQ(C::closest1(tree, static_cast<const typename C::CRay*>(given),
                          static_cast<typename C::CHit*>(hit.data()), &behind),
              RAYLANES_OK);
    const auto* const skip = static_cast<const std::uint32_t*>(behind.skip);
    const auto& cpp = this->rays[i];
    EXPECT_TRUE(same_bytes(hit.values()[0],
                           skip == nullptr ? this->cpp_tree.closest(cpp, {.after = expected})
                                           : this->cpp_tree.closest(cpp, {.skip = *skip, .after = expected})))
        << i;
    ASSERT_EQ(C::closest_crossing1(tree, static_cast<const typename C::CRay*>(given),
                                   static_cast<typename C::CHit*>(hit.data()), c),
              RAYLANES_OK);
    EXPECT_TRUE(same_bytes(hit.values()[0], skip == nullptr
                                                ? this->cpp_tree.closest_crossing(cpp)
                                                : this->cpp_tree.closest_crossing(cpp, {.skip = *skip})))
        << i;
  };
  std::vector<Hit> hits(count);
  this->cpp_tree.closest(this->rays, hits);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& ray = this->rays[i];
    check(nullptr, i, hits[i], this->cpp_tree.occluded(ray));
    raylanes_ray_options c = default_ray_options();
    c.skip = &hits[i].primitive;
    check(&c, i, this->cpp_tree.closest(ray, {.skip = hits[i]}),
          this->cpp_tree.occluded(ray, {.skip = hits[i]}));
  }
}

TYPED_TEST(CCalls, make_the_lists_of_the_classes) {
  Apart<RayOf<TypeParam>>& from = this->rays_of_c;
  each_query(QueriesOf<TypeParam>::of_lists(), [&](const auto& query) {
    this->template each_ray_option<ListOptions>([&](raylanes_ray_options c, ListOptions options) {
      for (const std::size_t most : {std::size_t{0}, std::size_t{2}, std::size_t{1} << 32, SIZE_MAX}) {
        c.max_count = most;
        options.max_count = static_cast<std::uint32_t>(std::min<std::size_t>(most, 0xffffffffu));
        this->expect_lists(made<ListsOfC>([&](raylanes_lists** lists) {
                             query.of_c(this->tree_of_c.get(), from.data(), count, from.stride(), lists, &c);
                           }),
                           query.of_cpp(this->cpp_tree, this->rays, options));
      }
    });
  });
}

TYPED_TEST(CCalls, write_the_corners_and_the_box_of_the_classes) {
  using C = CallsOf<TypeParam>;
  std::vector<HitOf<TypeParam>> hits(count);
  this->cpp_tree.closest(this->rays, hits);
  this->template expect_same<typename C::Corners>(
      "corners", 0,
      [&](auto& corners) {
        return C::corners(this->tree_of_c.get(), &hits[0].primitive, count, sizeof hits[0],
                          static_cast<TypeParam*>(corners.data()));
      },
      [&](auto& corners) { this->cpp_tree.corners(hits, corners); });
  const auto box = this->cpp_tree.bounds();
  PointOf<TypeParam> lo{}, hi{};
  ASSERT_EQ(C::bounds(this->tree_of_c.get(), lo.data(), hi.data()), RAYLANES_OK);
  EXPECT_TRUE(same_bytes(lo, box.lo) && same_bytes(hi, box.hi));
}

TYPED_TEST(CCalls, build_refit_and_save_the_trees_of_the_classes) {
  using C = CallsOf<TypeParam>;
  const auto saved = [](const auto& tree) {
    std::ostringstream file;
    tree.save(file);
    return file.str();
  };
  const auto saved_by_c = [](const auto* tree) {
    std::size_t size = 0;
    EXPECT_EQ(C::save(tree, nullptr, 0, &size), RAYLANES_SMALL_BUFFER);
    Apart<char> bytes(size);
    EXPECT_EQ(C::save(tree, bytes.data(), size, &size), RAYLANES_OK);
    const std::vector<char> all = bytes.values();
    return std::string(all.begin(), all.end());
  };
  const auto& given = this->mesh;
  for (std::int32_t builder = 0; builder < 6; ++builder) {
    if (std::is_same_v<TypeParam, double> && builder == RAYLANES_BUILDER_SPATIAL_SPLITS) continue;
    SCOPED_TRACE(tree_builder_names[static_cast<std::size_t>(builder)]);
    raylanes_build_options c;
    raylanes_init_build_options(&c, sizeof c);
    c.builder = builder, c.optimize = builder % 2, c.threads = builder % 3;
    c.choose = builder == 5, c.rays = 1e6;
    const BuildOptions options{.builder = static_cast<TreeBuilder>(builder),
                               .optimize = builder % 2 == 1,
                               .choose = builder == 5,
                               .rays = 1e6};
    typename C::Tree tree(given.vertices, given.triangles, options);
    const auto of_c = made<TreeOfC<TypeParam>>([&](auto** address) {
      C::create(address, given.vertices.data(), given.vertices.size(), 0, given.triangles.data(),
                given.triangles.size(), 0, &c);
    });
    EXPECT_EQ(saved(tree), saved_by_c(of_c.get()));
    auto other = given.vertices;
    for (auto& vertex : other) std::swap(vertex[0], vertex[2]);
    Apart<PointOf<TypeParam>> moved(other, 4);
    tree.refit(other, given.triangles);
    ASSERT_EQ(C::refit(of_c.get(), moved.data(), other.size(), moved.stride(), given.triangles.data(),
                       given.triangles.size(), 0, 2),
              RAYLANES_OK);
    const std::string bytes = saved(tree);
    EXPECT_EQ(bytes, saved_by_c(of_c.get()));
    Apart<char> file(std::vector<char>(bytes.begin(), bytes.end()), 0);
    const auto loaded =
        made<TreeOfC<TypeParam>>([&](auto** address) { C::load(address, file.data(), bytes.size()); });
    EXPECT_EQ(bytes, saved_by_c(loaded.get()));
  }
}

}  // namespace
}  // namespace raylanes::testing

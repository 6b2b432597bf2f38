// The C functions write the bytes that the classes return, for every option, on every path; and nothing else.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "../../dispatch/table/numbers.hpp"
#include "../doubles/double_cases.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "apart.hpp"
#include "calls.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t count = 150;

template <class Number>
struct Input;
template <>
struct Input<float> {
  Mesh mesh = triangle_soup(300, 0.3f, 11);
  std::vector<Ray> rays = mixed_rays(mesh, count, 2, {0, 0, 0}, 12);
};
template <>
struct Input<double> {
  DoubleMesh mesh = moved(triangle_soup(300, 0.3f, 11), 3, {1e6, 0, -1e6});
  std::vector<RayD> rays = aimed_rays(mesh, count, 12);
};

template <class Number>
class CCalls : public ::testing::Test, public Input<Number> {
 public:
  using OfNumber = CallsOf<Number>;
  using HitOfNumber = HitOf<Number>;

  typename OfNumber::Tree cpp_tree{this->mesh.vertices, this->mesh.triangles};
  TreeOfC<Number> tree_of_c = made<TreeOfC<Number>>([&](auto** tree_address) {
    Apart<PointOf<Number>> vertices(this->mesh.vertices, 5);
    Apart<Index3> triangles(this->mesh.triangles, 3);
    EXPECT_EQ(OfNumber::create(tree_address, vertices.data(), this->mesh.vertices.size(), vertices.stride(),
                               triangles.data(), this->mesh.triangles.size(), triangles.stride(), nullptr),
              RAYLANES_OK);
  });
  Apart<RayOf<Number>> rays_of_c{this->rays, 4};

  // Calls check(options of C, of C++) with each option that queries of rays have.
  template <class Options, class Check>
  void each_ray_option(const Check& check) {
    std::vector<HitOfNumber> hits(count);
    cpp_tree.closest(this->rays, hits);
    Random random(13);
    const std::vector<std::vector<std::uint8_t>> masks = masks_for(count, random);
    for (const Path* path : supported_paths())
      for (const int threads : {1, 2, 0})
        for (std::int32_t variant = 0; variant < 6; ++variant) {
          SCOPED_TRACE(std::string(path->name) + ", variant " + std::to_string(variant));
          raylanes_ray_options c = default_ray_options();
          Options options;
          c.path = path->name, options.path = path;
          c.threads = options.threads = threads;
          if (variant < 3) c.facing = variant, options.facing = static_cast<Facing>(variant);
          if (variant == 3) c.active = options.active = masks[5].data();
          if (variant == 4) c.skip = &hits[0].primitive, c.skip_stride = sizeof hits[0], options.skip = hits;
          if constexpr (requires { options.after; })
            if (variant == 5) c.after = hits.data(), c.after_stride = sizeof hits[0], options.after = hits;
          check(c, options);
        }
  }
  // Calls check(options of C, of C++) with each path and rule.
  template <class Options, class Check>
  void each_point_option(const Check& check) {
    for (const Path* path : supported_paths())
      for (std::int32_t variant = 0; variant < 5; ++variant) {
        SCOPED_TRACE(std::string(path->name) + ", variant " + std::to_string(variant));
        raylanes_point_options c = default_point_options();
        Options options;
        c.path = path->name, options.path = path;
        c.threads = options.threads = variant % 3;
        if constexpr (requires { options.rule; })
          c.rule = variant % 4, options.rule = static_cast<InsideRule>(c.rule);
        if constexpr (requires { options.max_distance; })
          if (variant > 1) c.max_distance = options.max_distance = Number(0.25) * Number(variant);
        if constexpr (requires { options.accuracy; })
          if (variant > 1) c.accuracy = options.accuracy = 0.01 * variant;
        check(c, options);
      }
  }
  // Both results with the same bytes before, of which inactive elements keep theirs.
  template <class Result, class OfC, class OfCpp>
  void expect_same(std::size_t gap, const OfC& of_c, const OfCpp& of_cpp) {
    Apart<Result> results(count, gap);
    std::vector<Result> expected = results.values();
    ASSERT_EQ(of_c(results), RAYLANES_OK) << raylanes_last_message();
    of_cpp(expected);
    EXPECT_TRUE(same_bytes(results.values(), expected));
  }
  template <class Item>
  void expect_lists(const ListsOfC& lists, const RayLists<Item>& expected) {
    ASSERT_NE(lists, nullptr) << raylanes_last_message();
    const std::size_t* const offsets = raylanes_lists_offsets(lists.get());
    EXPECT_TRUE(same_bytes(std::vector(offsets, offsets + count + 1), expected.offsets));
    const auto* const items = static_cast<const Item*>(raylanes_lists_items(lists.get()));
    EXPECT_TRUE(same_bytes(std::vector<Item>(items, items + expected.items.size()), expected.items));
  }
  auto points() const { return VertexRecords<Number>(this->rays.data(), count, sizeof(RayOf<Number>)); }
};
using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CCalls, Numbers);

TYPED_TEST(CCalls, write_the_hits_of_the_classes) {
  using C = CallsOf<TypeParam>;
  using Hit = HitOf<TypeParam>;
  auto* const tree = this->tree_of_c.get();
  Apart<RayOf<TypeParam>>& c_rays = this->rays_of_c;
  this->template each_ray_option<typename C::Trace>([&](const auto& c, const auto& options) {
    this->template expect_same<Hit>(
        7,
        [&](auto& hits) {
          return C::closest(tree, c_rays.data(), count, c_rays.stride(), hits.data(), hits.stride(), &c);
        },
        [&](auto& hits) { this->cpp_tree.closest(this->rays, hits, options); });
    this->template expect_same<Hit>(
        0,
        [&](auto& hits) {
          return C::closest_crossing(tree, c_rays.data(), count, c_rays.stride(), hits.data(), 0, &c);
        },
        [&](auto& hits) { this->cpp_tree.closest_crossing(this->rays, hits, options); });
    this->template expect_same<std::uint8_t>(
        0,
        [&](auto& occluded) {
          return C::occluded(tree, c_rays.data(), count, c_rays.stride(),
                             static_cast<std::uint8_t*>(occluded.data()), &c);
        },
        [&](auto& occluded) { this->cpp_tree.occluded(this->rays, occluded, options); });
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
  using C = CallsOf<TypeParam>;
  auto* const tree = this->tree_of_c.get();
  Apart<RayOf<TypeParam>>& c_rays = this->rays_of_c;
  this->template each_ray_option<ListOptions>([&](raylanes_ray_options c, ListOptions options) {
    for (const std::size_t most : {std::size_t{0}, std::size_t{2}, std::size_t{1} << 32, SIZE_MAX}) {
      c.max_count = most;
      options.max_count = static_cast<std::uint32_t>(std::min<std::size_t>(most, 0xffffffffu));
      this->expect_lists(made<ListsOfC>([&](raylanes_lists** lists) {
                           C::all_hits(tree, c_rays.data(), count, c_rays.stride(), lists, &c);
                         }),
                         this->cpp_tree.all_hits(this->rays, options));
      this->expect_lists(made<ListsOfC>([&](raylanes_lists** lists) {
                           C::crossings(tree, c_rays.data(), count, c_rays.stride(), lists, &c);
                         }),
                         this->cpp_tree.crossings(this->rays, options));
    }
  });
}

TYPED_TEST(CCalls, count_the_crossings_of_the_classes) {
  using C = CallsOf<TypeParam>;
  this->template each_ray_option<ListOptions>([&](const auto& c, const auto& options) {
    this->template expect_same<CrossingCount>(
        0,
        [&](auto& counts) {
          return C::count_crossings(this->tree_of_c.get(), this->rays_of_c.data(), count,
                                    this->rays_of_c.stride(),
                                    static_cast<raylanes_crossing_count*>(counts.data()), &c);
        },
        [&](auto& counts) { this->cpp_tree.count_crossings(this->rays, counts, options); });
  });
}

TYPED_TEST(CCalls, write_the_corners_and_the_box_of_the_classes) {
  using C = CallsOf<TypeParam>;
  std::vector<HitOf<TypeParam>> hits(count);
  this->cpp_tree.closest(this->rays, hits);
  this->template expect_same<typename C::Corners>(
      0,
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

TYPED_TEST(CCalls, write_the_places_of_the_classes) {
  using C = CallsOf<TypeParam>;
  auto* const tree = this->tree_of_c.get();
  Apart<RayOf<TypeParam>>& c_rays = this->rays_of_c;
  this->template each_point_option<LocateOptions>([&](const auto& c, const auto& options) {
    this->template expect_same<Location>(
        0,
        [&](auto& locations) {
          return C::locate(tree, c_rays.data(), count, c_rays.stride(),
                           static_cast<std::uint8_t*>(locations.data()), &c);
        },
        [&](auto& locations) { this->cpp_tree.locate(this->points(), locations, options); });
  });
  this->template each_point_option<WindingOptions>([&](const auto& c, const auto& options) {
    this->template expect_same<TypeParam>(
        0,
        [&](auto& numbers) {
          return C::winding_numbers(tree, c_rays.data(), count, c_rays.stride(),
                                    static_cast<TypeParam*>(numbers.data()), &c);
        },
        [&](auto& numbers) { this->cpp_tree.winding_numbers(this->points(), numbers, options); });
  });
}

TYPED_TEST(CCalls, write_the_distances_of_the_classes) {
  using C = CallsOf<TypeParam>;
  auto* const tree = this->tree_of_c.get();
  Apart<RayOf<TypeParam>>& c_rays = this->rays_of_c;
  this->template each_point_option<typename C::Distances>([&](const auto& c, const auto& options) {
    this->template expect_same<TypeParam>(
        0,
        [&](auto& distances) {
          return C::signed_distances(tree, c_rays.data(), count, c_rays.stride(),
                                     static_cast<TypeParam*>(distances.data()), &c);
        },
        [&](auto& distances) { this->cpp_tree.signed_distances(this->points(), distances, options); });
  });
  this->template each_point_option<typename C::Closest>([&](const auto& c, const auto& options) {
    this->template expect_same<ClosestPointOf<TypeParam>>(
        0,
        [&](auto& closest) {
          return C::closest_points(tree, c_rays.data(), count, c_rays.stride(),
                                   static_cast<typename C::CClosestPoint*>(closest.data()), &c);
        },
        [&](auto& closest) { this->cpp_tree.closest_points(this->points(), closest, options); });
  });
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

// Trees of C and of C++ over one mesh, and options as both take them, to compare what calls write.
#pragma once

#include <raylanes/numbers.hpp>

#include "../doubles/double_cases.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "apart.hpp"
#include "calls.hpp"

namespace raylanes::testing {

inline constexpr std::size_t count = 150;

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
  void expect_same(const char* what, std::size_t gap, const OfC& of_c, const OfCpp& of_cpp) {
    Apart<Result> results(count, gap);
    std::vector<Result> expected = results.values();
    ASSERT_EQ(of_c(results), RAYLANES_OK) << what << ": " << raylanes_last_message();
    of_cpp(expected);
    EXPECT_TRUE(same_bytes(results.values(), expected)) << what;
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

}  // namespace raylanes::testing

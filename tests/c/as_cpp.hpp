// Trees and scenes of C and of C++ over one input, and options as both take them, to compare what calls write.
#pragma once

#include <raylanes/numbers.hpp>

#include "../doubles/double_cases.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "apart.hpp"
#include "calls.hpp"

namespace raylanes::testing {

inline constexpr std::size_t count = 150;

template <class Number, class AnyMesh>
TreeOfC<Number> c_tree_of(const AnyMesh& mesh) {
  return made<TreeOfC<Number>>([&](auto** tree) {
    Apart<PointOf<Number>> vertices(mesh.vertices, 5);
    Apart<Index3> triangles(mesh.triangles, 3);
    EXPECT_EQ(CallsOf<Number>::create(tree, vertices.data(), mesh.vertices.size(), vertices.stride(),
                                      triangles.data(), mesh.triangles.size(), triangles.stride(), nullptr),
              RAYLANES_OK);
  });
}

template <class Kind>
struct Input;
template <>
struct Input<float> {
  Mesh mesh = triangle_soup(300, 0.3f, 11);
  std::vector<Ray> rays = mixed_rays(mesh, count, 2, {0, 0, 0}, 12);
  Bvh cpp_tree{mesh};
  TreeOfC<float> c_tree = c_tree_of<float>(mesh);
};
template <>
struct Input<double> {
  DoubleMesh mesh = moved(triangle_soup(300, 0.3f, 11), 3, {1e6, 0, -1e6});
  std::vector<RayD> rays = aimed_rays(mesh, count, 12);
  BvhD cpp_tree{mesh.vertices, mesh.triangles};
  TreeOfC<double> c_tree = c_tree_of<double>(mesh);
};
// A mesh and a tree, each where it was made and elsewhere, turned, enlarged, in a mirror, with several masks.
template <class Kind, class AnyMesh>
struct SceneInput {
  AnyMesh mesh, ball;
  std::vector<RayOf<NumberOfKind<Kind>>> rays;
  Kind cpp_tree;
  TreeOfC<Kind> c_tree = made<TreeOfC<Kind>>([](auto** scene) { CallsOf<Kind>::create(scene); });

  SceneInput(AnyMesh of_mesh, AnyMesh of_ball, std::vector<RayOf<NumberOfKind<Kind>>> of_rays)
      : mesh(std::move(of_mesh)), ball(std::move(of_ball)), rays(std::move(of_rays)) {
    using C = CallsOf<Kind>;
    using Number = typename C::Number;
    using PlaceBy = typename C::PlaceBy;
    const auto tree = c_tree_of<Number>(ball);
    Apart<PointOf<Number>> vertices(mesh.vertices, 5);
    Apart<Index3> triangles(mesh.triangles, 3);
    cpp_tree.add(mesh.vertices, mesh.triangles);
    cpp_tree.add(typename CallsOf<Number>::Tree(ball.vertices, ball.triangles));
    std::uint32_t geometry = 7, instance = 7;
    EXPECT_EQ(C::add_mesh(c_tree.get(), vertices.data(), mesh.vertices.size(), vertices.stride(),
                          triangles.data(), mesh.triangles.size(), triangles.stride(), nullptr, &geometry),
              RAYLANES_OK);
    EXPECT_EQ(geometry, 0u);
    EXPECT_EQ(C::add_tree(c_tree.get(), tree.get(), &geometry), RAYLANES_OK);
    EXPECT_EQ(geometry, 1u);
    const PlaceBy transforms[] = {{},
                                  {},
                                  {{{0, -1, 0, 0.5f}, {1, 0, 0, 0.25f}, {0, 0, 1, -0.5f}}},
                                  {{{-2, 0, 0.5f, 0}, {0, 1, 0, 1}, {0, 0, 0.5f, 0}}}};
    for (std::uint32_t i = 0; i < 8; ++i) {
      const PlaceBy& transform = transforms[i % 4];
      const std::uint32_t mask = i % 3 == 0 ? ~0u : i % 3;
      cpp_tree.place(i / 4, transform, mask);
      EXPECT_EQ(C::place(c_tree.get(), i / 4, i == 0 ? nullptr : transform.row[0], mask, &instance),
                RAYLANES_OK);
      EXPECT_EQ(instance, i);
    }
    cpp_tree.update();
    EXPECT_EQ(C::update(c_tree.get(), 0), RAYLANES_OK);
  }
};
inline Mesh soup_in_scene() {
  return triangle_soup(200, 0.3f, 11);
}
inline Mesh ball_in_scene() {
  return ellipsoid(1, {0, 0, 0}, {1, 0.5f, 0.75f});
}
template <>
struct Input<Scene> : SceneInput<Scene, Mesh> {
  Input()
      : SceneInput(soup_in_scene(), ball_in_scene(), mixed_rays(soup_in_scene(), count, 2, {0, 0, 0}, 12)) {}
};
template <>
struct Input<SceneD> : SceneInput<SceneD, DoubleMesh> {
  static DoubleMesh soup() { return moved(soup_in_scene(), 1, {0.1, 0, -0.1}); }
  Input() : SceneInput(soup(), moved(ball_in_scene(), 1.1, {0, 0.2, 0}), aimed_rays(soup(), count, 12)) {}
};

template <class Kind>
class CCalls : public ::testing::Test, public Input<Kind> {
 public:
  Apart<RayOf<NumberOfKind<Kind>>> rays_of_c{this->rays, 4};

  // Calls check(options of C, of C++) with each option that queries of rays have.
  template <class Options, class Check>
  void each_ray_option(const Check& check) {
    std::vector<HitOfKind<Kind>> hits(count);
    this->cpp_tree.closest(this->rays, hits);
    Random random(13);
    const std::vector<std::vector<std::uint8_t>> masks = masks_for(count, random);
    for (const Path* path : supported_paths())
      for (const int threads : {1, 2, 0})
        for (std::int32_t variant = 0; variant < 7; ++variant) {
          SCOPED_TRACE(std::string(path->name) + ", variant " + std::to_string(variant));
          raylanes_ray_options c = default_ray_options();
          Options options;
          c.path = path->name, options.path = path;
          c.threads = options.threads = threads;
          if (variant < 3) c.facing = variant, options.facing = static_cast<Facing>(variant);
          if (variant == 3) c.active = options.active = masks[5].data();
          if (variant == 4) {
            c.skip = &hits[0].primitive, options.skip = hits;
            if (threads == 1 || std::is_arithmetic_v<Kind>) c.skip_stride = sizeof hits[0];
          }
          if constexpr (requires { options.after; })
            if (variant == 5) c.after = hits.data(), c.after_stride = sizeof hits[0], options.after = hits;
          if constexpr (requires { options.mask; })
            if (variant == 6) c.mask = options.mask = 2;
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
          if (variant > 1) c.max_distance = options.max_distance = NumberOfKind<Kind>(variant) / 4;
        if constexpr (requires { options.accuracy; })
          if (variant > 1) c.accuracy = options.accuracy = 0.01 * variant;
        if constexpr (requires { options.mask; })
          if (variant == 3) c.mask = options.mask = 2;
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
    const std::vector<Item> all(items, items + expected.items.size());
    if constexpr (requires(Item item) { item == item; })  // with bytes between numbers
      EXPECT_TRUE(all == expected.items);
    else
      EXPECT_TRUE(same_bytes(all, expected.items));
  }
  auto points() const {
    return VertexRecords<NumberOfKind<Kind>>(this->rays.data(), count, sizeof this->rays[0]);
  }
};

}  // namespace raylanes::testing

// The closest crossing of rays and a surface: each once at edges and corners, and nowhere where rays only touch.
#include "../oracles/closest_crossing_oracle.hpp"
#include "worlds/worlds.hpp"

namespace raylanes::testing {
namespace {

// A closed mesh that does not cross itself is entered and left by turns, and left at last, though crossings of one
// rounded t come in any order.
TEST(ClosestCrossing, enter_and_leave_by_turns) {
  std::size_t touched = 0;
  for (const Mesh& mesh : {cube(-1, 1), dented_cube(), double_fan(9, 0.3f), double_fan(30, 0.0f)}) {
    std::vector<Ray> rays = aimed_rays(mesh, by_level(300), 3, 206);
    for (Ray& ray : rays) ray.tmin = 0, ray.tmax = infinity;
    for (const Ray& ray : touching_rays(mesh, by_level(4000), 207)) rays.push_back(ray);
    for (const Ray& ray : rays)
      touched += oracle_hits(mesh, ray).size() > oracle_closest_crossings(mesh, ray).size() ? 1 : 0;
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      std::vector<Location> locations(rays.size());
      tree.locate(VertexView(rays.data(), rays.size(), sizeof(Ray)), locations, {.path = path});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (locations[i] == Location::on) continue;
        int winding = locations[i] == Location::inside ? 1 : 0;
        float t = 0;
        for (Hit hit = tree.closest_crossing(rays[i], {.path = path}); hit;
             hit = tree.closest_crossing(rays[i], {.path = path, .after = HitView(&hit, 1)})) {
          ASSERT_TRUE(hit.t == t || winding == 0 || winding == 1) << i << " before " << hit.t;
          ASSERT_GE(hit.t, t) << i;
          winding -= oracle::exact_hit(rays[i], oracle::corners_of(mesh, hit.primitive)).side, t = hit.t;
        }
        EXPECT_EQ(winding, 0) << i;
      }
    });
  }
  EXPECT_GT(touched, 100u);
}

struct Flight {
  Ray ray;
  Facing facing;
  float t;  // of the crossing; infinity: there is none
};
void expect_flights(const Mesh& mesh, std::initializer_list<Flight> flights) {
  const Bvh bvh(mesh);
  const KdTree cells(mesh);
  for (const auto& [ray, facing, t] : flights) {
    const auto text = [&, &along = ray] {
      return ::testing::Message() << along.origin[0] << ' ' << along.origin[1] << ' ' << along.origin[2]
                                  << " along " << along.direction[0] << ' ' << along.direction[1] << ' '
                                  << along.direction[2];
    };
    EXPECT_EQ(bvh.closest_crossing(ray, {.facing = facing}).t, t) << text();
    EXPECT_EQ(cells.closest_crossing(ray, {.facing = facing}).t, t) << text();
  }
}

TEST(ClosestCrossing, of_a_box) {
  expect_flights(cube(-1, 1),
                 {
                     {make_ray({0, 0, 0}, {1, 0, 0}), Facing::back, 1},          // through a diagonal
                     {make_ray({0, 0, 0}, {1, 1, 0}), Facing::back, 1},          // through an edge
                     {make_ray({0, 0, 0}, {1, 1, 1}), Facing::back, 1},          // through a corner
                     {make_ray({-3, 0, 0}, {1, 0, 0}), Facing::front, 2},        //
                     {make_ray({-3, 0, 0}, {1, 0, 0}), Facing::back, 4},         //
                     {make_ray({-3, -1, 0}, {1, 1, 0}), Facing::any, infinity},  //
                     {make_ray({-3, -1, 0}, {1, -1, 0}), Facing::any, infinity},
                     {make_ray({2, 0, 0}, {-1, 1, 0}), Facing::any, infinity},  // touches an edge
                     {make_ray({2, 3, 0}, {-1, -2, 0}), Facing::front, 1},      // enters by an edge
                     {make_ray({2, 3, 0}, {-1, -2, 0}, 0, 0.75f), Facing::any, infinity},
                     {make_ray({-3, 0.5f, 0.25f}, {1, 0, 0}, 2.5f), Facing::any, 4},
                 });
}

// Rays in the solid that touch an edge of the dent, or its tip, go on.
TEST(ClosestCrossing, of_a_dented_cube) {
  expect_flights(dented_cube(), {
                                    {make_ray({0, 0, -1}, {0, 0, 1}), Facing::back, 1},  // by the tip
                                    {make_ray({-1, 0, 0}, {1, 0, 0}), Facing::back, 3},  // touches the tip
                                    {make_ray({-1, 0.5f, 0}, {1, -0.5f, 0}), Facing::back, 3},
                                    {make_ray({0, 0, 1}, {1, 1, 0}), Facing::front, 1},   // into an edge
                                    {make_ray({0, 0, 1}, {1, 1, 0}), Facing::back, 2},    // out by another
                                    {make_ray({0, 0, 3}, {0, 0, -1}), Facing::front, 3},  // by the tip
                                });
}

TEST(ClosestCrossing, of_two_overlapping_cubes) {
  Mesh mesh = cube(-1, 1);
  append(mesh, cube(0, 2));
  expect_flights(mesh, {
                           {make_ray({-3, 0.5f, 0.25f}, {1, 0, 0}), Facing::front, 2},
                           {make_ray({-3, 0.5f, 0.25f}, {1, 0, 0}, 2.5f), Facing::front, 3},
                           {make_ray({-3, 0.5f, 0.25f}, {1, 0, 0}), Facing::back, 4},
                           {make_ray({0.5f, 0.5f, 0.5f}, {1, 1, 1}), Facing::back, 0.5f},
                           {make_ray({0.5f, 0.5f, 0.5f}, {1, 1, 1}, 0.75f), Facing::back, 1.5f},
                           {make_ray({0.5f, 0.5f, 0.5f}, {1, 0, 0}), Facing::back, 0.5f},
                       });
}

// Layers less than an ULP apart are two crossings, also through their edges.
TEST(ClosestCrossing, of_a_sheet_thinner_than_an_ulp) {
  const float z = 1, above = std::nextafter(1.0f, 2.0f);
  Mesh mesh;
  for (const float at : {z, above})
    for (const Triangle& t : {make_triangle({-4, -4, at}, {4, -4, at}, {4, 4, at}),
                              make_triangle({-4, -4, at}, {4, 4, at}, {-4, 4, at})})
      append(mesh, at == z ? make_triangle(t.corner[0], t.corner[2], t.corner[1]) : t);
  const Bvh bvh(mesh);
  const Ray ray = make_ray({0, 0, -1000000}, {0, 0, 1});
  std::vector<Hit> passed;
  for (Hit hit = bvh.closest_crossing(ray); hit; hit = bvh.closest_crossing(ray, {.after = HitView(&hit, 1)}))
    passed.push_back(hit);
  ASSERT_EQ(passed.size(), 2u);
  EXPECT_EQ(passed[0].t, passed[1].t);
}

}  // namespace
}  // namespace raylanes::testing

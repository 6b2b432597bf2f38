#include "worlds.hpp"

#include "../../../bench/support/scenes/shapes.hpp"
#include "../../oracles/closest_crossing_oracle.hpp"

namespace raylanes::testing {

Mesh dented_cube() {
  Mesh mesh = cube(-2, 2);
  std::erase_if(mesh.triangles, [&](const Index3& t) {
    return std::ranges::all_of(t, [&](std::uint32_t i) { return mesh.vertices[i][2] == 2; });
  });
  const Float3 rim[] = {{-2, -2, 2}, {2, -2, 2}, {2, 2, 2}, {-2, 2, 2}};
  for (std::size_t k = 0; k < 4; ++k) append(mesh, make_triangle(rim[k], rim[(k + 1) % 4], {0, 0, 0}));
  return mesh;
}

namespace {

World<float> soup(float size, std::size_t rays) {
  Mesh mesh = triangle_soup(by_level(200), size, 161);
  std::vector<Ray> aimed = aimed_rays(mesh, rays, 2, 162);
  return {"soup of " + std::to_string(size), std::move(mesh), std::move(aimed)};
}

World<float> solids_in_each_other(std::size_t rays) {
  Mesh mesh = double_fan(30, 0.25f);
  append(mesh, turned_over(mesh, 1, 1));
  append(mesh, double_fan(30, 0.0f));
  append(mesh, ellipsoid(1, {0, 0, 0}));
  append(mesh, cube(-1, 1));
  return {"solids in each other", mesh, aimed_rays(mesh, rays, 3, 164)};
}

// Triangles with two corners, on a line, and their backs; each three times.
World<float> folded_triangles(std::size_t rays) {
  Mesh mesh = ellipsoid(0, {0, 0, 0}, {1, 1, 1});
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(),
                       {{0, 0, 0}, {0.5f, 0, 0}, {0.25f, 0, 0}, {1, 0, 0}, {0.25f, 1, 0}});
  append(mesh, mesh);
  for (std::uint32_t copy = 0; copy < 3; ++copy)
    mesh.triangles.insert(mesh.triangles.end(),
                          {{n, n + 1, n + 2}, {n, n + 1, n + 1}, {n, n + 3, n + 4}, {n + 3, n, n + 4}});
  return {"folded triangles", mesh, aimed_rays(mesh, rays, 2, 36)};
}

World<float> rays_in_planes() {
  World<float> world{"rays in planes", integer_grid(3), {}};
  append(world.mesh, cube(1, 2));
  for (int x = -1; x < 8; x += 2)
    for (int y = -1; y < 8; ++y)
      for (const Float3& d : std::initializer_list<Float3>{
               {1, 0, 0}, {0, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {1, 2, 0}, {0, 0, 1}, {1, 0, 1}, {1, -1, 1}}) {
        const float tmin[] = {0.0f, -8.0f, 0x1p-20f};  // the last one leaves out what is at the origin
        const Float3 origin{0.25f * float(x), 0.5f * float(y), (x + y) % 3 == 0 ? 1.0f : 0.0f};
        world.rays.push_back(make_ray(origin, d, tmin[world.rays.size() % 3]));
      }
  return world;
}

// Triangles so flat that the sign of a determinant in floats, or in doubles, is noise; rays along the longest edge, and
// across it at a corner.
World<float> slivers(std::size_t rays) {
  Random random(165);
  World<float> world{"slivers", {}, {}};
  while (world.rays.size() < rays) {
    const Float3 a = random.point(1), b = random.point(1);
    const float share = random.number(0, 1);
    Float3 c;
    for (std::size_t axis = 0; axis < 3; ++axis) c[axis] = a[axis] + share * (b[axis] - a[axis]);
    append(world.mesh, a, b, c);
    for (const Float3& other : {b, random.point(1)}) {
      Ray ray = make_ray(a, {});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ray.direction[axis] = std::nextafter(other[axis] - a[axis], random.chance(0.5) ? 9.0f : -9.0f);
        ray.origin[axis] = c[axis] - ray.direction[axis];
      }
      world.rays.push_back(ray);
    }
  }
  append(world.mesh, cube(-0.5f, 0.5f));
  return world;
}

// Floats do not decide whether these triangles are behind a ray's begin, but mostly their side.
World<float> rays_that_begin_on_triangles(std::size_t rays) {
  World<float> world{"rays that begin on triangles", double_fan(12, 0.25f), {}};
  append(world.mesh, triangle_soup(by_level(60), 0.5f, 167));
  Random random(168);
  for (const Float3& point : points_around(world.mesh, rays, 1, 169))
    world.rays.push_back(make_ray(point, random.point(1), random.chance(0.5) ? 0.0f : -1.0f));
  // A subnormal t may be flushed.
  std::erase_if(world.rays, [&](const Ray& ray) {
    return std::ranges::any_of(oracle_hits(world.mesh, ray),
                               [](const Hit& hit) { return std::fpclassify(hit.t) == FP_SUBNORMAL; });
  });
  return world;
}

// Planes that are 1e-6 apart at coordinates of 1e6, and planes whose t differ by an ULP or not at all.
World<float> layers(bool far_away, std::size_t rays) {
  World<float> world{far_away ? "layers at 1e6" : "layers of one t", {}, {}};
  const float at = far_away ? 1e6f : 0.0f;
  Random random(39);
  for (int i = 0; i < 40; ++i) {
    const float z = far_away ? 1e-6f * static_cast<float>(i) : std::ldexp(static_cast<float>(i % 20), -30);
    append(world.mesh, {at - 4, at - 4, z}, {at + 8, at - 4, z}, {at - 4, at + 8, z});
  }
  for (std::size_t i = 0; i < rays; ++i) {
    const float aslant = far_away ? 1e-3f : 1.0f;
    world.rays.push_back(
        make_ray({at + random.number(-1, 1), at + random.number(-1, 1), random.number(-1, 1)},
                 {random.number(-aslant, aslant), random.number(-aslant, aslant),
                  random.chance(0.5) ? 1.0f : random.number(-2, -0.5f)},
                 -2));
  }
  return world;
}

// Planes of k-d trees, beside which all is by some units in the last place, or far from zero, where the distance to a
// plane is all rounding.
World<float> walls(bool far_away, std::size_t rays) {
  World<float> world{far_away ? "walls far away" : "walls missed by little", lattice_walls(2),
                     lattice_rays(2, rays, 34)};
  Random random(33);
  const auto change = [&](Float3& p) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (far_away && axis != 1)
        p[axis] += axis == 0 ? 4e6f : -4e6f;
      else
        for (int i = random.integer(0, 3); i > 0 && p[axis] != 0; --i)
          p[axis] = std::nextafter(p[axis], random.chance(0.5) ? 9.0f : -9.0f);
  };
  for (Float3& vertex : world.mesh.vertices) change(vertex);
  for (Ray& ray : world.rays) change(ray.origin);
  for (std::size_t i = 0; i < world.rays.size() && far_away; i += 3)
    for (std::size_t axis = 0; axis < 3; ++axis) {  // through all of the distance
      world.rays[i].direction[axis] += world.rays[i].origin[axis];
      world.rays[i].origin[axis] = 0;
    }
  return world;
}

// A terrain over a flat floor with a wall, and rays along its axes: through its corners and edges, in the plane of the
// floor, and just beside that.
constexpr std::uint32_t terrain_cells = 24;

// Cells of a third, so that coordinates are not integers. The floor, which lies at 0.1, has more cells in a row than a
// search looks at one by one.
Mesh terrain_over_a_floor() {
  Mesh mesh;
  Random random(61);
  const auto place = [](double share) { return share * terrain_cells / 3; };
  bench::append_grid(mesh, terrain_cells, terrain_cells, [&](double u, double v) {
    return bench::Double3{place(u), place(v), random.real(1, 2)};
  });
  bench::append_grid(mesh, terrain_cells, terrain_cells, [&](double u, double v) {
    return bench::Double3{place(u), place(v), 0.1};
  });
  bench::append_grid(mesh, 2, 2, [&](double u, double v) {
    return bench::Double3{6.25, place(u), 0.75 * v};
  });
  return mesh;
}

std::vector<Ray> rays_along_axes(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  const float floor = 0.1f, heights[] = {floor,         floor,
                                         floor,         std::nextafter(floor, 1.0f),
                                         floor + 1e-6f, std::nextafter(floor, 0.0f),
                                         0.0f};
  const Float3 along_floor[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {1, 0.5f, 0}, {-1, 1, 0}};
  while (rays.size() < count) {
    const Triangle t = random.triangle_of(mesh);
    const float u = 0.5f * static_cast<float>(random.integer(0, 2)), v = random.chance(0.5) ? 1 - u : 0.0f;
    Float3 at;
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = (1 - u - v) * t.corner[0][k] + u * t.corner[1][k] + v * t.corner[2][k];
    if (random.chance(0.5)) {
      rays.push_back(make_ray({at[0], at[1], 10}, {0, 0, random.chance(0.9) ? -1.0f : -0x1p-40f}));
    } else {
      const Float3 d = along_floor[random.integer(0, 5)];
      const float back = random.chance(0.8) ? 12.0f : 0.0f;
      rays.push_back(make_ray({at[0] - back * d[0], at[1] - back * d[1], heights[random.integer(0, 6)]}, d));
    }
    if (random.chance(0.1)) rays.back().tmin = random.chance(0.5) ? 9.0f : -1.0f;
  }
  return rays;
}

World<float> rays_that_touch(std::size_t rays) {
  Mesh mesh = dented_cube();
  append(mesh, cube(-1, 1));
  append(mesh, cube(0, 1));
  append(mesh, turned_over(mesh, 0.5, 209));
  return {"rays that touch", mesh, touching_rays(mesh, rays, 204)};
}

}  // namespace

template <class T>
std::vector<World<T>> worlds(std::size_t rays) {
  std::vector<World<T>> all;
  const auto add = [&](const World<float>& world) {
    all.push_back({world.name, mesh_of<T>(world.mesh), rays_of<T>(world.rays),
                   world.may_flush || std::is_same_v<T, double>});
  };
  for (const float size : {0.5f, 0.2f, 2.0f}) add(soup(size, rays));
  Random random(33);
  const Mesh terrain = terrain_over_a_floor();
  add({"grid", integer_grid(5), grid_rays(5, rays, random)});
  add({"walls on a lattice", lattice_walls(2), lattice_rays(2, rays, 163)});
  add({"terrain, along axes", terrain, rays_along_axes(terrain, rays, 63)});
  add(solids_in_each_other(rays)), add(folded_triangles(rays)), add(rays_in_planes()), add(slivers(rays));
  add(rays_that_begin_on_triangles(rays)), add(rays_that_touch(rays));
  add(layers(false, rays)), add(layers(true, rays)), add(walls(false, rays)), add(walls(true, rays));
  const auto [needles, across] = needles_and_slivers(80, 15);
  add({"needles", needles, aimed_rays(needles, rays, 2, 37)});
  add({"diagonals", across, aimed_rays(across, rays, 2, 38)});
  for (const float scaling : {1e-30f, 1e-12f, 1e12f, 1e30f}) {
    ScaledScene scene(30, rays, 166, scaling);
    add({"scaled by " + std::to_string(std::log10(scaling)), scene.mesh, scene.rays,
         ScaledScene::numbers_hold_at(scaling)});
  }
  if constexpr (std::is_same_v<T, double>) {
    for (DoubleCase& c : double_cases(rays))
      all.push_back({c.name, std::move(c.mesh), std::move(c.rays), false});
    const DoubleMesh mesh = moved(double_fan(24, 0.3f), 1e-3, {5e6, 4e5, -5e6});
    all.push_back({"runs from points", mesh, aimed_rays_from_points(mesh, 2 * rays, 100, 5)});
  }
  return all;
}
template std::vector<World<float>> worlds(std::size_t rays);
template std::vector<World<double>> worlds(std::size_t rays);

}  // namespace raylanes::testing

// From a point to infinity, at a vertex, an edge or anywhere: crossings are odd from inside, even from outside, and the
// sum of their sides is that of the solid, whatever the direction. 10^5 rays, or about as many as RAYLANES_PARITY_RAYS
// names: those that are more go to one tree on one path each, in turn.
#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t rays_of_a_point = 20;

std::string_view name_of(Location location) {
  return location_names[static_cast<std::size_t>(location)];
}
std::string to_text(const Ray& ray) {
  char text[200];
  const auto &o = ray.origin, &d = ray.direction;
  std::snprintf(text, sizeof text, "from %a, %a, %a along %a, %a, %a", double{o[0]}, double{o[1]},
                double{o[2]}, double{d[0]}, double{d[1]}, double{d[2]});
  return text;
}

// Rays end where t is the largest float: with a direction of 2^-149 that is before a solid of some units ends.
bool reaches_all(const Float3& direction) {
  return std::ranges::any_of(direction, [](float x) { return std::abs(x) > 0x1p-120f; });
}

struct Round {
  const Mesh& mesh;
  int winding;  // of the inside
  std::vector<Float3> points;
  std::vector<Ray> rays;

  Round(const Mesh& of, int of_inside, std::size_t count, std::uint64_t seed)
      : mesh(of), winding(of_inside), points(points_around(of, count, 1.5f, seed)) {
    Random random(seed + 1);
    for (const Float3& point : points)
      for (std::size_t k = 0; k < rays_of_a_point; ++k)
        rays.push_back(make_ray(point, direction(point, k, random)));
  }

  // Returns how many rays were judged.
  template <class Tree>
  std::size_t expect_parity(const Tree& tree, const Path* path, std::size_t some_points) const {
    const auto some = std::span(points).first(some_points);
    const auto all_rays = std::span(rays).first(some.size() * rays_of_a_point);
    std::vector<Location> locations(some.size());
    std::vector<CrossingCount> counts(all_rays.size());
    tree.locate(some, locations, {.path = path, .threads = 2});
    tree.count_crossings(all_rays, counts, {.path = path});
    std::size_t judged = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const Location location = locations[i / rays_of_a_point];
      if (location == Location::on || !reaches_all(all_rays[i].direction)) continue;
      const bool inside = location == Location::inside;
      ++judged;
      const CrossingCount& count = counts[i];
      if (count.crossings % 2 == (inside ? 1 : 0) && count.winding == (inside ? winding : 0)) continue;
      ADD_FAILURE() << name_of(location) << ", but " << count.crossings << " crossings, " << count.winding
                    << " in sum: " << to_text(all_rays[i]);
    }
    return judged;
  }

 private:
  Float3 direction(const Float3& point, std::size_t k, Random& random) const {
    if (k == 0) return {0, 0, 1};
    if (k == 1) return {-1, 0, 0};
    const Triangle t = random.triangle_of(mesh);
    const bool middle = random.chance(0.5);
    Float3 way{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      way[axis] = (middle ? 0.5f * (t.corner[0][axis] + t.corner[1][axis]) : t.corner[0][axis]) - point[axis];
    return way;
  }
};

struct Solid {
  Mesh mesh;
  int winding = 1;
};

std::vector<Solid> solids() {
  std::vector<Solid> all{
      {ellipsoid(3, {0, 0, 0})}, {double_fan(30, 0.25f)}, {double_fan(31, 0.4f), -1}, {cube(-1, 1)}};
  for (Index3& t : all[2].mesh.triangles) std::swap(t[1], t[2]);
  return all;
}

// Rays of other seeds until there are so many.
void expect_parity_of_more(std::size_t wanted) {
  constexpr std::size_t points_of_a_round = 5000;
  std::size_t judged = 0, turn = 0;
  const std::vector<Solid> all = solids();
  for (std::uint64_t seed = 1000; judged < wanted && !::testing::Test::HasFailure(); seed += 2) {
    const Solid& solid = all[seed / 2 % all.size()];
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Round round(solid.mesh, solid.winding, points_of_a_round, seed);
    std::size_t at = 0, trees = 0;
    each_tree(solid.mesh, [&](const auto&, const Path*) { ++trees; });
    each_tree(solid.mesh, [&](const auto& tree, const Path* path) {
      if (at++ == turn % trees) judged += round.expect_parity(tree, path, points_of_a_round);
    });
    turn += 5;  // no divisor of the numbers of solids and trees
  }
  std::printf("%zu rays judged\n", judged);
}

TEST(Parity, holds_for_rays_at_vertices_and_edges_from_any_point) {
  const std::size_t count = by_level<std::size_t>(20, 1250, 2000),
                    of_each_tree = std::min<std::size_t>(count, 300);
  for (const Solid& solid : solids()) {
    const Round round(solid.mesh, solid.winding, count, 54);
    const Bvh bvh(solid.mesh);
    for (const Path* path : paths_with_own_queries()) round.expect_parity(bvh, path, count);
    each_tree(solid.mesh,
              [&](const auto& tree, const Path* path) { round.expect_parity(tree, path, of_each_tree); });
  }
  if (const char* const asked = std::getenv("RAYLANES_PARITY_RAYS"))
    expect_parity_of_more(std::strtoull(asked, nullptr, 10));
}

}  // namespace
}  // namespace raylanes::testing

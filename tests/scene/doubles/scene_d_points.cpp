// Points in scenes of doubles: closest points within their bounds by rational numbers, parts and places exactly,
// normals and corners of hits.
#include <raylanes/surface.hpp>

#include "../../../bench/support/oracles/exact_point.hpp"
#include "../../doubles/double_point_cases.hpp"
#include "../../queries/query_trees.hpp"
#include "scene_d_oracle.hpp"

namespace raylanes::testing {
namespace {

// As SceneClosestPointD says; with the identity corners stay as they are.
Double3 placed(const TransformD& transform, const Double3& point) {
  if (ExactMap(transform).is_identity) return point;
  Double3 at;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [a, b, c, d] = transform.row[i];
    at[i] = ((a * point[0] + b * point[1]) + c * point[2]) + d;
  }
  return at;
}

// The triangles of all instances that a mask sees as one mesh.
struct PlacedMesh {
  DoubleMesh mesh;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> number;  // of an instance and a primitive

  explicit PlacedMesh(const PartsD& parts, std::uint32_t mask = ~0u) {
    for (std::uint32_t i = 0; i < parts.scene.instance_count(); ++i) {
      if ((parts.scene.mask_of(i) & mask) == 0) continue;
      const DoubleMesh& part = parts.meshes[parts.scene.geometry_of(i)];
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const Double3& vertex : part.vertices)
        mesh.vertices.push_back(placed(parts.scene.transform_of(i), vertex));
      for (std::uint32_t k = 0; k < part.triangles.size(); ++k) {
        const Index3& t = part.triangles[k];
        number[{i, k}] = static_cast<std::uint32_t>(mesh.triangles.size());
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      }
    }
  }
};

void expect_closest(const PartsD& parts, const std::vector<Double3>& points, std::uint32_t mask) {
  const PlacedMesh all(parts, mask);
  std::vector<std::vector<SceneClosestPointD>> by_path;
  on_each_path([&](const Path* path, int threads) {
    std::vector<SceneClosestPointD> closest(points.size());
    parts.scene.closest_points(points, closest, {.path = path, .threads = threads, .mask = mask});
    for (std::size_t i = 0; i < points.size(); i += 3)
      EXPECT_TRUE(same_bytes(parts.scene.closest_point(points[i], {.path = path, .mask = mask}), closest[i]));
    by_path.push_back(closest);
  });
  for (const auto& closest : by_path) EXPECT_TRUE(same_bytes(closest, by_path[0]));
  std::vector<TriangleD> corners(points.size());
  parts.scene.corners(PrimitiveView(by_path[0]), corners, 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SceneClosestPointD& found = by_path[0][i];
    ASSERT_TRUE(found && (parts.scene.mask_of(found.instance) & mask) != 0) << i;
    const std::uint32_t number = all.number.at({found.instance, found.primitive});
    const ClosestPointD as_one{found.distance_squared, found.distance, found.point, found.u, found.v, number};
    ASSERT_EQ(oracle::fault_of_closest_point(all.mesh, points[i], as_one), "") << "point " << i;
    ASSERT_TRUE(same_bytes(TriangleCorners<double>(oracle::corners_of(all.mesh, number)),
                           std::to_array(corners[i].corner)))
        << i;
    for (const double most : {0.5 * found.distance, found.distance * 1.0001}) {
      const SceneClosestPointD near =
          parts.scene.closest_point(points[i], {.max_distance = most, .mask = mask});
      ASSERT_TRUE(
          same_bytes(near, found.distance == 0 || most > found.distance ? found : SceneClosestPointD()));
    }
  }
}

PartsD nested_solids(Random& random, double scale, const Double3& offset) {
  PartsD parts;
  parts.add(moved(cube(-1, 1), 1, {})), parts.add(moved(ellipsoid(1, {0, 0, 0}), 2, {}));
  for (std::uint32_t i = 0; i < 9; ++i) {
    TransformD to;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j)
        to.row[k][j] =
            scale * (k == j ? 1 + 0.25 * i : random.real(-0.2, 0.2)) * (k == 0 && i % 4 == 3 ? -1 : 1);
      to.row[k][3] = offset[k] + scale * random.real(-1, 1);
    }
    parts.scene.place(i % 2, i < 3 && offset[0] == 0 && scale == 1 ? TransformD() : to, 1u << i % 3);
  }
  parts.scene.update();
  return parts;
}
// The same within another scene, as it is, and turned and larger.
PartsD within_another(const PartsD& parts) {
  PartsD outer;
  outer.add(moved(cube(-1, 1), 1, {})), outer.add(parts);
  const TransformD turned{{{0, -1.25, 0, 0}, {1.25, 0, 0, 0}, {0, 0, 1.25, 0}}};
  outer.scene.place(1, turned, 0b011), outer.scene.place(1), outer.scene.update();
  return outer;
}
std::vector<Double3> points_of(const PartsD& parts, std::size_t count) {
  std::vector<Double3> points = points_for(PlacedMesh(parts).mesh, count, 91);
  std::erase_if(points, [](const Double3& p) { return std::abs(p[0]) > 1e200; });
  return points;
}

struct Place {
  double scale;
  Double3 offset;
};
const Place places[] = {{1, {0, 0, 0}}, {1, {5e5, 4.6e6, 30}}, {1e-90, {0, 0, 0}}, {1e90, {0, 0, 0}}};

TEST(PointsInScenesOfDoubles, have_closest_points_within_bounds) {
  for (const auto& [scale, offset] : places) {
    SCOPED_TRACE(scale);
    Random random(191);
    const PartsD single = nested_solids(random, scale, offset),
                 parts = scale == 1 ? within_another(single) : single;
    const std::vector<Double3> points = points_of(parts, by_level<std::size_t>(15, 30, 150));
    for (const std::uint32_t mask : {~0u, 0b010u}) expect_closest(parts, points, mask);
    for (const double bad : {std::nan(""), HUGE_VAL})
      EXPECT_TRUE(same_bytes(parts.scene.closest_point({0, bad, 0}), SceneClosestPointD()));
    EXPECT_FALSE(parts.scene.closest_point(points[0], {.mask = 0b1000}));
  }
}

// The instances that contain a point, innermost first, by rational numbers.
std::vector<ContainingPart> parts_at(const PartsD& parts, const Double3& point, std::uint32_t mask) {
  std::vector<std::pair<mpq_class, ContainingPart>> found;
  for (std::uint32_t i = 0; i < parts.scene.instance_count(); ++i) {
    if ((parts.scene.mask_of(i) & mask) == 0) continue;
    const std::uint32_t geometry = parts.scene.geometry_of(i);
    const TransformD transform = parts.scene.transform_of(i);
    const Location location =
        oracle::exact_location(parts.meshes[geometry], ExactMap(transform).of_point(point), {3, -7, 2});
    if (location == Location::outside) continue;
    const auto six_volumes = [](const Double3& a, const Double3& b, const Double3& c) {
      return mpq_class(
          oracle::dot(oracle::to_vector(a), oracle::cross(oracle::to_vector(b), oracle::to_vector(c))));
    };
    mpq_class volume = 0;
    for (std::size_t k = 0; k < parts.meshes[geometry].triangles.size(); ++k) {
      const auto corners = oracle::corners_of(parts.meshes[geometry], k);
      volume += six_volumes(corners[0], corners[1], corners[2]);
    }
    Double3 row[3];
    for (std::size_t k = 0; k < 3; ++k) std::copy_n(transform.row[k], 3, row[k].begin());
    found.push_back({abs(mpq_class(volume * six_volumes(row[0], row[1], row[2]))), {geometry, i, location}});
  }
  std::ranges::stable_sort(found, {}, [](const auto& part) -> const mpq_class& { return part.first; });
  std::vector<ContainingPart> sorted;
  for (const auto& [volume, part] : found) sorted.push_back(part);
  return sorted;
}

TEST(PointsInScenesOfDoubles, are_in_the_parts_that_rational_numbers_say) {
  std::size_t in_several = 0, on = 0;
  for (const auto& [scale, offset] : places) {
    SCOPED_TRACE(scale);
    Random random(192);
    const PartsD single = nested_solids(random, scale, offset),
                 parts = scale == 1 ? within_another(single) : single;
    const std::vector<Double3> points = points_of(parts, by_level<std::size_t>(30, 60, 200));
    for (const std::uint32_t mask : {~0u, 0b101u})
      on_each_path([&](const Path* path, int threads) {
        const LocateOptions by{.path = path, .threads = threads, .mask = mask};
        std::vector<ContainingPart> innermost(points.size());
        std::vector<Location> locations(points.size());
        std::vector<double> numbers(points.size()), distances(points.size());
        std::vector<SceneClosestPointD> closest(points.size());
        const auto lists = parts.scene.containing_parts(points, by);
        parts.scene.innermost_parts(points, innermost, by);
        parts.scene.locate(points, locations, by);
        parts.scene.winding_numbers(points, numbers, {.path = path, .threads = threads, .mask = mask});
        parts.scene.signed_distances(points, distances, {.path = path, .threads = threads, .mask = mask});
        parts.scene.closest_points(points, closest, {.path = path, .mask = mask});
        for (std::size_t i = 0; i < points.size(); ++i) {
          const std::vector<ContainingPart> wanted = parts_at(parts, points[i], mask);
          ASSERT_TRUE(std::ranges::equal(lists[i], wanted)) << i;
          ASSERT_EQ(innermost[i], wanted.empty() ? ContainingPart() : wanted[0]) << i;
          const bool touches = std::ranges::any_of(
              wanted, [](const ContainingPart& part) { return part.location == Location::on; });
          const bool is_inside = std::ranges::any_of(
              wanted, [](const ContainingPart& part) { return part.location == Location::inside; });
          ASSERT_EQ(locations[i], is_inside ? Location::inside
                                  : touches ? Location::on
                                            : Location::outside)
              << i;
          if (!touches) {
            ASSERT_NEAR(numbers[i], static_cast<double>(wanted.size()), 1e-9) << i;
            ASSERT_EQ(std::abs(distances[i]), std::max(closest[i].distance, 0x1p-1022)) << i;
          }
          ASSERT_EQ((distances[i] > 0) - (distances[i] < 0), touches ? 0 : is_inside ? -1 : 1) << i;
          in_several += wanted.size() > 1, on += touches;
        }
      });
  }
  EXPECT_GT(in_several, 20u);
  EXPECT_GT(on, 20u);
}

TEST(PointsInScenesOfDoubles, normals_and_corners_are_those_of_moved_triangles) {
  Random random(193);
  const PartsD parts = nested_solids(random, 1, {5e5, 4.6e6, 30});
  std::vector<SceneHitD> hits;
  for (std::uint32_t i = 0; i < 9; ++i) hits.push_back({1, 0, 0, i, parts.scene.geometry_of(i), i});
  hits.push_back({}), hits.push_back({1, 0, 0, 1u << 20, 0, 0}), hits.push_back({1, 0, 0, 0, 0, 9});
  std::vector<Double3> normals(hits.size());
  std::vector<TriangleD> triangles(hits.size());
  parts.scene.normals(hits, normals, 2), parts.scene.corners(hits, triangles);
  for (std::size_t k = 0; k < hits.size(); ++k) {
    if (k >= 9) {
      EXPECT_TRUE(std::isnan(normals[k][0]) && std::isnan(triangles[k].corner[2][1])) << k;
      continue;
    }
    const bool is_mirrored = hits[k].instance % 4 == 3;
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(normals[k][axis], unit_normal(triangles[k])[axis] * (is_mirrored ? -1 : 1), 1e-7) << k;
  }
  EXPECT_THROW(parts.scene.normals(hits, std::span(normals).first(3)), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing

// Refits that collapse triangles to segments and points, near and far: everything a tree says is what a tree that is
// built from the same vertices says, byte for byte, and closest points are on the triangles that are left.
#include <raylanes/kdtree.hpp>
#include <raylanes/scene.hpp>

#include "../../bench/support/oracles/exact_point.hpp"
#include "../traverse/reference/in_flight.hpp"
#include "refitted.hpp"

namespace raylanes::testing {
namespace {

template <class T>
class Collapsed : public Refitted<T> {
 public:
  using typename Refitted<T>::AnyMesh;
  using typename Refitted<T>::Rays;
  using Points = std::vector<PointOf<T>>;

  // A share of the triangles gets two or three equal corners, half of them at a point far away.
  static AnyMesh collapsed(AnyMesh mesh, double share, double size, Random& random) {
    const auto far = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto x = static_cast<T>(0.9 * std::min(size * 1e20, double{std::numeric_limits<T>::max()}));
    mesh.vertices.push_back({x, -x, x});
    for (Index3& t : mesh.triangles) {
      if (!random.chance(share)) continue;
      const std::uint32_t at = random.chance(0.5) ? far : t[0];
      const Index3 ways[] = {{at, at, at}, {at, at, t[2]}, {t[1], at, at}, {at, t[1], at}};
      t = ways[random.index(4)];
    }
    return mesh;
  }
  static AnyMesh scaled(AnyMesh mesh, double by) {
    for (auto& vertex : mesh.vertices)
      for (T& x : vertex) x = static_cast<T>(x * by);
    return mesh;
  }
  // About the mesh, at its corners, and far away.
  static Points points_for(const AnyMesh& mesh, std::size_t count, double size, Random& random) {
    Points points{{0, 0, 0}, {static_cast<T>(-0.0), 0, 0}};
    while (points.size() < count) {
      PointOf<T>& point = points.emplace_back();
      for (T& x : point) x = static_cast<T>(random.real(-1.5, 1.5) * size);
      if (random.chance(0.3)) point = mesh.vertices[random.index(mesh.vertices.size())];
      if (random.chance(0.3)) point[random.index(3)] = points[points.size() - 2][0];
      for (int i = random.integer(0, 9); i > 0; --i) {
        points.push_back(points.back());
        points.back()[1] += static_cast<T>(0.01 * size);
      }
    }
    return points;
  }

  static void expect_as_built(const typename Refitted<T>::Tree& tree, const AnyMesh& mesh, const Rays& rays,
                              const Points& points, const char* when) {
    SCOPED_TRACE(when);
    const auto built = Refitted<T>::tree_of(mesh);
    const auto reloaded = loaded<typename Refitted<T>::Tree>(saved(tree));
    for (const Path* path : paths_with_own_queries()) {
      SCOPED_TRACE(path->name);
      const std::vector<Answer> expected = answers_of(built, rays, points, path);
      expect_same(answers_of(tree, rays, points, path), expected);
      expect_same(answers_of(reloaded, rays, points, path), expected);
      if constexpr (Refitted<T>::has_floats)
        expect_same(answers_of(KdTree(mesh), rays, points, path), expected);
    }
    EXPECT_TRUE(std::isfinite(tree.sah_cost()) && tree.sah_cost() >= 0);
    EXPECT_TRUE(std::isfinite(tree.report().overlap) && tree.report().overlap >= 0);
  }
};
TYPED_TEST_SUITE(Collapsed, Numbers, NumberNames);

TYPED_TEST(Collapsed, answer_as_trees_that_are_built) {
  constexpr double most = std::is_same_v<TypeParam, float> ? 1e30 : 1e300;
  Random random(901);
  for (const std::size_t size : {1u, 2u, 7u, 20u, 300u})
    for (const double scaling : {1.0, most, 1 / most})
      for (const double share : {0.2, 0.7, 1.0}) {
        SCOPED_TRACE(::testing::Message() << size << " triangles of " << scaling << ", " << share);
        const Mesh of_floats = size == 20 ? ellipsoid(0, {0, 0, 0}) : triangle_soup(size, 0.5f, size);
        const auto mesh = this->scaled(this->mesh_of(of_floats), scaling);
        const auto one = this->collapsed(mesh, share, scaling, random),
                   other = this->collapsed(mesh, 0.5, scaling, random);
        auto rays = this->rays_to(mesh, 60, 902);
        const auto points = this->points_for(one, by_level<std::size_t>(100, 200, 800), scaling, random);
        auto tree =
            this->tree_of(mesh, {.builder = size == 7 ? TreeBuilder::morton : TreeBuilder::binned_sah});
        tree.refit(one.vertices, one.triangles);
        this->expect_as_built(tree, one, rays, points, "once");
        tree.refit(other.vertices, other.triangles, 2);
        this->expect_as_built(tree, other, rays, points, "again");
        tree.refit(mesh.vertices, mesh.triangles);
        this->expect_as_built(tree, mesh, rays, points, "grown again");
        EXPECT_EQ(tree.decay(), 1);
        tree = this->tree_of(one);
        tree.refit(other.vertices, other.triangles);
        this->expect_as_built(tree, other, rays, points, "others come back");
        if (this->HasFailure()) return;
      }
}

// By rational numbers, over the triangles that are left.
TYPED_TEST(Collapsed, closest_points_are_those_of_other_triangles) {
  Random random(903);
  const auto mesh = this->mesh_of(ellipsoid(1, {0, 0, 0})), with = this->collapsed(mesh, 0.4, 1, random);
  auto tree = this->tree_of(mesh);
  tree.refit(with.vertices, with.triangles);
  auto points = this->points_for(mesh, 60, 1, random);
  std::vector<ClosestPointOf<TypeParam>> found(points.size());
  tree.closest_points(points, found);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const oracle::Vector p = oracle::to_vector(points[i]);
    mpq_class least = -1, of_found = -1;
    for (std::uint32_t t = 0; t < with.triangles.size(); ++t) {
      const auto corner = [&](std::size_t k) { return with.vertices[with.triangles[t][k]]; };
      if (corner(0) == corner(1) || corner(1) == corner(2) || corner(2) == corner(0)) continue;
      const mpq_class square =
          oracle::exact_square_of_distance(oracle::operator-(oracle::to_vector(corner(0)), p),
                                           oracle::operator-(oracle::to_vector(corner(1)), p),
                                           oracle::operator-(oracle::to_vector(corner(2)), p));
      if (least < 0 || square < least) least = square;
      if (t == found[i].primitive) of_found = square;
    }
    ASSERT_GE(of_found, 0) << "point " << i << " has a triangle that is no longer there";
    ASSERT_LE(abs(of_found - least), mpq_class(0x1p-40));
    ASSERT_LE(abs(mpq_class(found[i].distance_squared) - least), mpq_class(0x1p-40));
  }
}

// Two triangles, one of which becomes a segment or a far point.
TYPED_TEST(Collapsed, of_two_triangles_one_is_left) {
  using T = TypeParam;
  std::vector<PointOf<T>> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}, {3, 1, 0}, {4, 0, 0}};
  const std::vector<Index3> triangles{{0, 1, 2}, {3, 4, 5}};
  typename TestFixture::Tree tree(vertices, triangles);
  vertices[5] = vertices[4];
  tree.refit(vertices, triangles);
  EXPECT_NEAR(double{tree.closest_point({3, 0.5f, 1}).distance_squared}, 5.25, 1e-9);
  vertices[3] = vertices[4] = vertices[5] = {static_cast<T>(std::is_same_v<T, float> ? 1e30 : 1e300), 0, 0};
  tree.refit(vertices, triangles);
  EXPECT_EQ(tree.closest_point({0.25f, 0.25f, 0.5f}).distance_squared, 0.25);
  EXPECT_EQ(tree.bounds().hi, (PointOf<T>{1, 1, 0}));
  // Zeros of both signs are one corner.
  vertices[3] = {0, 0, 2}, vertices[4] = {static_cast<T>(-0.0), 0, 2}, vertices[5] = {0, 1, 2};
  tree.refit(vertices, triangles);
  EXPECT_EQ(tree.closest_point({0, 0, 2}).primitive, 0u);
  for (auto& vertex : vertices) vertex[2] = static_cast<T>(-0.0);
  tree.refit(vertices, triangles);
  EXPECT_TRUE(same_bytes(tree.bounds(), this->tree_of({vertices, triangles}).bounds()));
}

// So large that its rays fly, before the refit.
TYPED_TEST(Collapsed, as_a_whole_have_no_hits) {
  auto mesh = this->soup(200, 0.5f, 907);
  auto tree = this->tree_of(mesh);
  let_rays_fly(tree);
  const auto rays = this->rays_to(mesh, 100, 908);
  for (auto& vertex : mesh.vertices) vertex = mesh.vertices[0];
  tree.refit(mesh.vertices, mesh.triangles);
  for (const Path* path : paths_with_own_queries()) {
    std::vector<HitOf<TypeParam>> hits(rays.size(), {1, 0, 0, 0});
    std::vector<std::uint8_t> occluded(rays.size(), 1);
    tree.closest(rays, hits, {.path = path}), tree.occluded(rays, occluded, {.path = path});
    EXPECT_EQ(std::ranges::count_if(hits, [](const auto& hit) { return static_cast<bool>(hit); }), 0);
    EXPECT_EQ(std::ranges::count(occluded, 0), std::ssize(rays));
  }
}

TEST(CollapsedInScenes, answer_as_scenes_with_trees_that_are_built) {
  Random random(904);
  using Floats = Collapsed<float>;
  const Mesh mesh = triangle_soup(60, 0.5f, 905);
  for (const double share : {0.4, 1.0}) {
    const Mesh then = Floats::collapsed(mesh, share, 1, random);
    const std::vector<Ray> rays = mixed_rays(mesh, 300, 3, {0, 0, 0}, 906);
    const auto hits_of = [&](Scene& scene) {
      scene.update();
      std::vector<SceneHit> hits(rays.size());
      scene.closest(rays, hits);
      return hits;
    };
    Scene scene, built;
    scene.add(Bvh(mesh)), built.add(Bvh(then));
    for (Scene* each : {&scene, &built}) each->place(0), each->add(Bvh(mesh)), each->place(1);
    scene.refit(0, then.vertices, then.triangles);
    EXPECT_TRUE(same_bytes(hits_of(scene), hits_of(built)));
    EXPECT_TRUE(same_bytes(scene.bounds(), built.bounds()));
    scene.refit(0, mesh.vertices, mesh.triangles);
    built.refit(0, mesh.vertices, mesh.triangles);
    EXPECT_TRUE(same_bytes(hits_of(scene), hits_of(built)));
  }
}

}  // namespace
}  // namespace raylanes::testing

// Scenes of C beside the classes: changes, files, reports, normals, which part; of floats also spheres and the caller's
// primitives.
#include "as_cpp.hpp"

namespace raylanes::testing {
namespace {

template <class Kind>
class CScenesOfAny : public CCalls<Kind> {
 public:
  std::string saved_by_c() const {
    using C = CallsOf<Kind>;
    std::size_t size = 0;
    EXPECT_EQ(C::save(this->c_tree.get(), nullptr, 0, &size), RAYLANES_SMALL_BUFFER);
    Apart<char> bytes(size);
    EXPECT_EQ(C::save(this->c_tree.get(), bytes.data(), size, &size), RAYLANES_OK);
    const std::vector<char> all = bytes.values();
    return std::string(all.begin(), all.end());
  }
  std::string saved() const {
    std::ostringstream file;
    this->cpp_tree.save(file);
    return file.str();
  }
};
using Kinds = ::testing::Types<Scene, SceneD>;
TYPED_TEST_SUITE(CScenesOfAny, Kinds);

TYPED_TEST(CScenesOfAny, are_saved_as_the_class_is) {
  using C = CallsOf<TypeParam>;
  const std::string file = this->saved();
  EXPECT_EQ(this->saved_by_c(), file);
  Apart<char> bytes(std::vector<char>(file.begin(), file.end()), 0);
  const auto loaded =
      made<TreeOfC<TypeParam>>([&](auto** scene) { C::load(scene, bytes.data(), file.size()); });
  ASSERT_NE(loaded, nullptr);
  std::vector<HitOfKind<TypeParam>> hits(count), expected(count);
  this->cpp_tree.closest(this->rays, expected);
  C::closest(loaded.get(), this->rays.data(), count, 0, hits.data(), 0, nullptr);
  EXPECT_TRUE(same_bytes(hits, expected));
}

TYPED_TEST(CScenesOfAny, follow_changes_of_the_class) {
  using C = CallsOf<TypeParam>;
  using Number = typename C::Number;
  auto moved = this->ball;
  for (auto& vertex : moved.vertices) std::swap(vertex[0], vertex[2]);
  auto& of_cpp = this->cpp_tree;
  of_cpp.refit(1, moved.vertices, moved.triangles, 2), of_cpp.move(5, {}), of_cpp.set_moving(1);
  of_cpp.set_mask(2, 7), of_cpp.replace(0, typename CallsOf<Number>::Tree(moved.vertices, moved.triangles));
  of_cpp.update();
  Apart<PointOf<Number>> vertices(moved.vertices, 3);
  const auto tree = c_tree_of<Number>(moved);
  auto* const scene = this->c_tree.get();
  EXPECT_EQ(C::refit(scene, 1, vertices.data(), moved.vertices.size(), vertices.stride(),
                     moved.triangles.data(), moved.triangles.size(), 0, 2),
            RAYLANES_OK);
  EXPECT_EQ(C::move(scene, 5, nullptr), RAYLANES_OK);
  EXPECT_EQ(C::set_moving(scene, 1, 3), RAYLANES_OK);
  EXPECT_EQ(C::set_mask(scene, 2, 7), RAYLANES_OK);
  EXPECT_EQ(C::replace_tree(scene, 0, tree.get()), RAYLANES_OK);
  EXPECT_EQ(C::update(scene, 1), RAYLANES_OK);
  EXPECT_EQ(this->saved_by_c(), this->saved());
  const SceneReport expected = of_cpp.report();
  raylanes_scene_report report;
  EXPECT_EQ(C::describe(scene, &report, sizeof report), RAYLANES_OK);
  EXPECT_EQ(std::memcmp(&report, &expected, sizeof report), 0);
  EXPECT_EQ(C::bytes(scene), of_cpp.bytes());
}

class CScenes : public CCalls<Scene> {};

// A square in the middle of a box, to see through from one side.
bool hits_square(std::uint32_t primitive, const Ray& ray, Hit& hit) {
  const float t = (0.25f * static_cast<float>(primitive) - ray.origin[2]) / ray.direction[2];
  if (!(t >= ray.tmin && t <= ray.tmax)) return false;
  hit.t = t, hit.u = 0.125f, hit.v = 0.5f;
  return true;
}
int32_t hits_square_in_c(void*, std::uint32_t primitive, const raylanes_ray* ray, raylanes_hit* hit) {
  Ray given;
  Hit found;
  std::memcpy(static_cast<void*>(&given), ray, sizeof given);
  const bool is_hit = hits_square(primitive, given, found);
  std::memcpy(hit, &found, sizeof found);
  return is_hit ? 1 : 0;
}

TEST_F(CScenes, have_the_spheres_and_primitives_of_the_class) {
  std::vector<Sphere> spheres(40);
  std::vector<Box> boxes;
  Random random(14);
  for (Sphere& sphere : spheres) sphere = {random.point(2), random.number(-0.1f, 0.5f)};
  for (std::size_t i = 0; i < 9; ++i) {
    const float z = 0.25f * static_cast<float>(i);
    boxes.push_back({{-1, -1, z}, {1, 1, z}});
  }
  const auto test = hits_square;
  const Transform turned{{{0, 0, 1, 0}, {1, 0, 0, 0.5f}, {0, 1, 0, 0}}};
  cpp_tree.add(SphereTree(spheres)),
      cpp_tree.add(BoundedTree(boxes, {.max_in_leaf = 3, .slack = 0.25f}), test);
  cpp_tree.place(2, turned), cpp_tree.place(3, {}, 2), cpp_tree.place(3, turned), cpp_tree.update();
  Apart<Sphere> c_spheres(spheres, 3);
  Apart<Box> c_boxes(boxes, 5);
  raylanes_build_options options;
  raylanes_init_build_options(&options, sizeof options);
  options.max_in_leaf = 3, options.slack = 0.25f;
  raylanes_scene* const scene = c_tree.get();
  std::uint32_t part = 0;
  EXPECT_EQ(
      raylanes_scene_add_spheres(scene, c_spheres.data(), spheres.size(), c_spheres.stride(), nullptr, &part),
      RAYLANES_OK);
  EXPECT_EQ(raylanes_scene_add_primitives(scene, c_boxes.data(), boxes.size(), c_boxes.stride(),
                                          hits_square_in_c, nullptr, &options, &part),
            RAYLANES_OK);
  EXPECT_EQ(part, 3u);
  for (const auto& [geometry, transform, mask] :
       {std::tuple(2u, &turned, ~0u), {3u, static_cast<const Transform*>(nullptr), 2u}, {3u, &turned, ~0u}})
    EXPECT_EQ(raylanes_scene_place(scene, geometry, transform == nullptr ? nullptr : transform->row[0], mask,
                                   &part),
              RAYLANES_OK);
  EXPECT_EQ(raylanes_scene_update(scene, 1), RAYLANES_OK);
  std::size_t found[4] = {};
  each_ray_option<TraceOptions>([&](const auto& c, const auto& by) {
    if (by.facing != Facing::any) return;  // which spheres refuse
    expect_same<SceneHit>(
        "closest", 0,
        [&](auto& to) { return raylanes_scene_closest(scene, rays.data(), count, 0, to.data(), 0, &c); },
        [&](auto& to) {
          cpp_tree.closest(rays, to, by);
          for (const SceneHit& hit : to)
            if (hit.geometry < 4) ++found[hit.geometry];
        });
    expect_lists(made<ListsOfC>([&](raylanes_lists** lists) {
                   raylanes_scene_all_hits(scene, rays.data(), count, 0, lists, &c);
                 }),
                 cpp_tree.all_hits(rays, {.active = by.active, .skip = by.skip, .mask = by.mask}));
  });
  EXPECT_TRUE(found[2] > count && found[3] > count);
}

TYPED_TEST(CScenesOfAny, change_as_the_classes_do) {
  using C = CallsOf<TypeParam>;
  using Number = typename C::Number;
  auto& scene = this->cpp_tree;
  auto* const of_c = this->c_tree.get();
  auto turned = this->ball;
  for (auto& vertex : turned.vertices) std::swap(vertex[0], vertex[2]);
  const typename C::PlaceBy raised{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0.25f}}};
  scene.replace(0, typename CallsOf<Number>::Tree(turned.vertices, turned.triangles));
  scene.move(5, {}), scene.move(0, raised), scene.set_mask(2, 7), scene.update();
  auto tree = c_tree_of<Number>(turned);
  auto copy = made<TreeOfC<TypeParam>>([&](auto** to) { C::copy(to, of_c); });
  EXPECT_EQ(C::replace_tree(of_c, 0, tree.get()), RAYLANES_OK);
  tree.reset();
  EXPECT_EQ(C::move(of_c, 5, nullptr), RAYLANES_OK);
  EXPECT_EQ(C::move(of_c, 0, raised.row[0]), RAYLANES_OK);
  EXPECT_EQ(C::set_mask(of_c, 2, 7), RAYLANES_OK);
  EXPECT_EQ(C::update(of_c, 1), RAYLANES_OK);
  EXPECT_EQ(C::bytes(of_c), scene.bytes());
  std::vector<HitOfKind<TypeParam>> hits(count), of_copy(count);
  scene.closest(this->rays, hits);
  this->template expect_same<HitOfKind<TypeParam>>(
      "closest", 0,
      [&](auto& to) { return C::closest(of_c, this->rays.data(), count, 0, to.data(), 0, nullptr); },
      [&](auto& to) { scene.closest(this->rays, to); });
  C::closest(copy.get(), this->rays.data(), count, 0, of_copy.data(), 0, nullptr);
  EXPECT_FALSE(same_bytes(hits, of_copy));
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    std::uint32_t geometry = 7, mask = 7;
    typename C::PlaceBy transform;
    EXPECT_EQ(C::geometry_of(of_c, i, &geometry), RAYLANES_OK);
    EXPECT_EQ(C::mask_of(of_c, i, &mask), RAYLANES_OK);
    EXPECT_EQ(C::transform_of(of_c, i, transform.row[0]), RAYLANES_OK);
    EXPECT_TRUE(geometry == scene.geometry_of(i) && mask == scene.mask_of(i));
    EXPECT_TRUE(same_bytes(transform, scene.transform_of(i)));
  }
  for (const std::size_t apart : {std::size_t{0}, sizeof hits[0]}) {
    this->template expect_same<PointOf<Number>>(
        "normals", 0,
        [&](auto& to) {
          return C::normals(of_c, hits.data(), count, apart, static_cast<Number*>(to.data()), 2);
        },
        [&](auto& to) { scene.normals(hits, to); });
    this->template expect_same<typename C::Corners>(
        "corners", 0,
        [&](auto& to) {
          return C::corners(of_c, hits.data(), count, apart, static_cast<Number*>(to.data()), 2);
        },
        [&](auto& to) { scene.corners(hits, to); });
  }
}

TYPED_TEST(CScenesOfAny, know_the_parts_that_the_classes_know) {
  using C = CallsOf<TypeParam>;
  auto* const scene = this->c_tree.get();
  std::size_t found = 0;
  this->template each_point_option<LocateOptions>([&](const auto& c, const auto& by) {
    const auto from = this->points();
    Apart<ContainingPart> parts(count);
    void* const to = parts.data();
    ASSERT_EQ(C::innermost_parts(scene, from.first, count, from.stride,
                                 static_cast<raylanes_containing_part*>(to), &c),
              RAYLANES_OK);
    std::vector<ContainingPart> expected(count);
    this->cpp_tree.innermost_parts(from, expected, by);
    EXPECT_TRUE(parts.values() == expected);
    const auto lists = made<ListsOfC>([&](raylanes_lists** address) {
      C::containing_parts(scene, from.first, count, from.stride, address, &c);
    });
    const auto all = this->cpp_tree.containing_parts(from, by);
    this->expect_lists(lists, all);
    found += all.items.size();
  });
  EXPECT_GT(found, 0u);
}

}  // namespace
}  // namespace raylanes::testing

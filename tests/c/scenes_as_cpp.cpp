// Scenes of C beside the class: files, normals, reports, spheres and primitives of the caller.
#include "as_cpp.hpp"

namespace raylanes::testing {
namespace {

class CScenes : public CCalls<Scene> {
 public:
  std::string saved_by_c() const {
    std::size_t size = 0;
    EXPECT_EQ(raylanes_scene_save(c_tree.get(), nullptr, 0, &size), RAYLANES_SMALL_BUFFER);
    Apart<char> bytes(size);
    EXPECT_EQ(raylanes_scene_save(c_tree.get(), bytes.data(), size, &size), RAYLANES_OK);
    const std::vector<char> all = bytes.values();
    return std::string(all.begin(), all.end());
  }
  std::string saved() const {
    std::ostringstream file;
    cpp_tree.save(file);
    return file.str();
  }
};

TEST_F(CScenes, are_saved_as_the_class_is) {
  const std::string file = saved();
  EXPECT_EQ(saved_by_c(), file);
  Apart<char> bytes(std::vector<char>(file.begin(), file.end()), 0);
  const auto loaded =
      made<TreeOfC<Scene>>([&](auto** scene) { raylanes_scene_load(scene, bytes.data(), file.size()); });
  ASSERT_NE(loaded, nullptr);
  std::vector<SceneHit> hits(count), expected(count);
  cpp_tree.closest(rays, expected);
  raylanes_scene_closest(loaded.get(), rays.data(), count, 0, hits.data(), 0, nullptr);
  EXPECT_TRUE(same_bytes(hits, expected));
}

TEST_F(CScenes, follow_changes_of_the_class) {
  Mesh moved = ball;
  for (Float3& vertex : moved.vertices) std::swap(vertex[0], vertex[2]);
  cpp_tree.refit(1, moved.vertices, moved.triangles, 2), cpp_tree.move(5, {}), cpp_tree.set_moving(1);
  cpp_tree.set_mask(2, 7), cpp_tree.replace(0, Bvh(moved)), cpp_tree.update();
  Apart<Float3> vertices(moved.vertices, 3);
  const auto tree = c_tree_of<float>(moved);
  raylanes_scene* const scene = c_tree.get();
  EXPECT_EQ(raylanes_scene_refit(scene, 1, vertices.data(), moved.vertices.size(), vertices.stride(),
                                 moved.triangles.data(), moved.triangles.size(), 0, 2),
            RAYLANES_OK);
  EXPECT_EQ(raylanes_scene_move(scene, 5, nullptr), RAYLANES_OK);
  EXPECT_EQ(raylanes_scene_set_moving(scene, 1, 3), RAYLANES_OK);
  EXPECT_EQ(raylanes_scene_set_mask(scene, 2, 7), RAYLANES_OK);
  EXPECT_EQ(raylanes_scene_replace_tree(scene, 0, tree.get()), RAYLANES_OK);
  EXPECT_EQ(raylanes_scene_update(scene, 1), RAYLANES_OK);
  EXPECT_EQ(saved_by_c(), saved());
  const SceneReport expected = cpp_tree.report();
  raylanes_scene_report report;
  EXPECT_EQ(raylanes_scene_describe(scene, &report, sizeof report), RAYLANES_OK);
  EXPECT_EQ(std::memcmp(&report, &expected, sizeof report), 0);
  EXPECT_EQ(raylanes_scene_bytes(scene), cpp_tree.bytes());
  std::vector<SceneHit> hits(count);
  cpp_tree.closest(rays, hits);
  expect_same<Float3>(
      "normals", 0,
      [&](auto& normals) {
        return raylanes_scene_normals(scene, hits.data(), count, 0, static_cast<float*>(normals.data()), 2);
      },
      [&](auto& normals) { cpp_tree.normals(hits, normals); });
  expect_same<Triangle>(
      "corners", 0,
      [&](auto& corners) {
        return raylanes_scene_corners(scene, hits.data(), count, 0, static_cast<float*>(corners.data()), 2);
      },
      [&](auto& corners) { cpp_tree.corners(hits, corners); });
}

TEST_F(CScenes, know_the_parts_that_the_class_knows) {
  std::size_t found = 0;
  each_point_option<LocateOptions>([&](const auto& c, const auto& by) {
    const auto from = points();
    Apart<ContainingPart> parts(count);
    void* const to = parts.data();
    ASSERT_EQ(raylanes_scene_innermost_parts(c_tree.get(), from.first, count, from.stride,
                                             static_cast<raylanes_containing_part*>(to), &c),
              RAYLANES_OK);
    std::vector<ContainingPart> expected(count);
    cpp_tree.innermost_parts(from, expected, by);
    EXPECT_TRUE(parts.values() == expected);
    const auto lists = made<ListsOfC>([&](raylanes_lists** address) {
      raylanes_scene_containing_parts(c_tree.get(), from.first, count, from.stride, address, &c);
    });
    const auto all = cpp_tree.containing_parts(from, by);
    expect_lists(lists, all);
    found += all.items.size();
  });
  EXPECT_GT(found, 0u);
}

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

}  // namespace
}  // namespace raylanes::testing

// Scenes in C: the tests of trees with a scene of one tetrahedron, and what scenes of floats alone have.
#define NUMBER float
#define TREE raylanes_scene
#define CALL(name) raylanes_scene_##name
#define RECORD(name) RECORD_##name
#define RECORD_ray raylanes_ray
#define RECORD_hit raylanes_scene_hit
#define RECORD_crossing raylanes_scene_crossing
#define RECORD_stretch raylanes_scene_stretch
#define RECORD_closest_point raylanes_scene_closest_point
#define KIND "scene"
#define PART_TREE raylanes_bvh
#define PART(name) raylanes_bvh_##name
#define ANOTHER_LOAD raylanes_bvh_load
#define ANOTHER_TREE raylanes_bvh
#include "scene_test.h"
#include "tree_stretches.h"

// A progress that is given with a mesh is not called, not even where the tree is built.
static void test_meshes(void) {
  raylanes_scene* scene = NULL;
  raylanes_build_options options;
  double at_once[2] = {0, 0};
  uint32_t part;
  GOOD(raylanes_init_build_options(&options, sizeof options));
  options.progress = tell_progress, options.progress_context = at_once;
  GOOD(raylanes_scene_create(&scene));
  GOOD(raylanes_scene_add_mesh(scene, corners, 4, 0, faces, 4, 0, &options, &part));
  GOOD(raylanes_scene_place(scene, part, up_by_4, every_bit, &part));
  GOOD(raylanes_scene_update(scene, 1));
  expect_hit(scene, NULL, 4.5f, 0, 0);
  GOOD(raylanes_scene_set_mask(scene, part, 0));  // at once
  expect_hit(scene, NULL, INFINITY, RAYLANES_NO_PART, RAYLANES_NO_PART);
  raylanes_scene_destroy(scene);
}

static int32_t hit_roof(void* context, uint32_t primitive, const raylanes_ray* ray, raylanes_hit* hit) {
  const float* const height = context;
  const float t = (height[primitive] - ray->origin[2]) / ray->direction[2];
  if (!(t >= ray->tmin && t <= ray->tmax)) return 0;
  hit->t = t, hit->u = 0.25f, hit->v = 0.5f;
  return 1;
}

static void test_other_primitives(void) {
  static const float heights[2] = {3, 5};
  static const float boxes[12] = {0, 0, 3, 1, 1, 3, 0, 0, 5, 1, 1, 5};
  static const raylanes_sphere spheres[2] = {{{0.25f, 0.25f, 7}, 1}, {{9, 9, 9}, -1}};
  raylanes_scene *scene = NULL, *copy = NULL;
  raylanes_build_options options;
  raylanes_ray_options trace = ray_options();
  raylanes_lists* lists = NULL;
  raylanes_scene_hit hits[3];
  uint32_t geometry, instance;
  size_t size;
  GOOD(raylanes_init_build_options(&options, sizeof options));
  GOOD(raylanes_scene_create(&scene));
  GOOD(raylanes_scene_add_spheres(scene, spheres, 2, 0, &options, &geometry));
  GOOD(raylanes_scene_place(scene, geometry, NULL, 1, &instance));
  options.max_in_leaf = 2, options.slack = 0;
  GOOD(raylanes_scene_add_primitives(scene, boxes, 2, 0, hit_roof, (void*)(size_t)heights, &options,
                                     &geometry));
  GOOD(raylanes_scene_place(scene, geometry, NULL, 2, &instance));
  GOOD(raylanes_scene_update(scene, 1));
  GOOD(raylanes_scene_copy(&copy, scene));
  raylanes_scene_destroy(scene);
  expect_hit(copy, NULL, 1, 0, 0);
  trace.mask = 2;
  expect_hit(copy, &trace, 4, 1, 1);
  GOOD(raylanes_scene_all_hits(copy, &(raylanes_ray){{0.25f, 0.25f, 9}, 0, {0, 0, -1}, INFINITY}, 1, 0,
                               &lists, NULL));
  EXPECT(raylanes_lists_offsets(lists)[1] == 4);
  memcpy(hits, raylanes_lists_items(lists), 3 * sizeof *hits);
  EXPECT(hits[1].t == 3 && hits[2].t == 4 && hits[2].u == 0.25f && hits[2].v == 0.5f &&
         hits[2].primitive == 1);
  raylanes_lists_destroy(lists);
  REFUSED(raylanes_scene_crossings(copy, rays, 3, 0, &lists, NULL), "triangles");
  REFUSED(raylanes_scene_save(copy, NULL, 0, &size), "primitives");
  GOOD(raylanes_scene_replace_spheres(copy, 1, spheres, 1, 0, NULL));
  GOOD(raylanes_scene_update(copy, 1));
  expect_hit(copy, &trace, 1, 1, 1);
  REFUSED(raylanes_scene_set_triangle_masks(copy, 1, &every_bit, 1), "no triangles");
  raylanes_scene_destroy(copy);
}

static void test_refused_kinds(raylanes_scene* scene) {
  const raylanes_sphere sphere = {{0, 0, 0}, 1};
  raylanes_build_options options;
  uint32_t got = 7;
  GOOD(raylanes_init_build_options(&options, sizeof options));
  REFUSED(raylanes_scene_add_spheres(NULL, &sphere, 1, 0, NULL, &got), "scene");
  REFUSED(raylanes_scene_add_spheres(scene, NULL, 1, 0, NULL, &got), "spheres");
  REFUSED(raylanes_scene_add_spheres(scene, &sphere, 1, 15, NULL, &got), "spheres");
  REFUSED(raylanes_scene_add_primitives(NULL, corners, 2, 0, hit_roof, NULL, NULL, &got), "scene");
  REFUSED(raylanes_scene_add_primitives(scene, NULL, 2, 0, hit_roof, NULL, NULL, &got), "boxes");
  REFUSED(raylanes_scene_add_primitives(scene, corners, 2, 0, NULL, NULL, NULL, &got), "test");
  options.max_in_leaf = 9;
  REFUSED(raylanes_scene_add_primitives(scene, corners, 2, 0, hit_roof, NULL, &options, &got), "leaf");
  options.max_in_leaf = 1, options.slack = -1;
  REFUSED(raylanes_scene_add_primitives(scene, corners, 2, 0, hit_roof, NULL, &options, &got), "slack");
  options.slack = 0, options.builder = 6;
  REFUSED(raylanes_scene_add_spheres(scene, &sphere, 1, 0, &options, &got), "builder");
  REFUSED(raylanes_scene_replace_spheres(scene, 1, &sphere, 1, 0, NULL), "geometry 1");
  EXPECT(got == 7 && raylanes_scene_geometry_count(scene) == 1);
  expect_tetrahedron(scene);  // without another update
}

void test_scenes(void) {
  raylanes_scene* const scene = scene_of_tetrahedron();
  test_scene(scene);
  test_stretches(scene);
  test_refused_kinds(scene);
  raylanes_scene_destroy(scene);
  test_meshes();
  test_other_primitives();
}

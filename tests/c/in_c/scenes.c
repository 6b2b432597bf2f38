// Scenes in C: the tests of trees with a scene of one tetrahedron, and what scenes have besides.
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
#define ANOTHER_LOAD raylanes_bvh_load
#define ANOTHER_TREE raylanes_bvh
#include "tetrahedron.h"
#include "tree_files.h"
#include "tree_points.h"
#include "tree_queries.h"
#include "tree_refused.h"
#include "tree_refused_points.h"

static const float up_by_4[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4};
static const uint32_t every_bit = 0xffffffff;

static raylanes_scene* scene_of_tetrahedron(void) {
  raylanes_scene* scene = NULL;
  uint32_t geometry = 7, instance = 7;
  GOOD(raylanes_scene_create(&scene));
  GOOD(raylanes_scene_add_mesh(scene, corners, 4, 0, faces, 4, 0, NULL, &geometry));
  GOOD(raylanes_scene_place(scene, geometry, NULL, every_bit, &instance));
  GOOD(raylanes_scene_update(scene, 1));
  EXPECT(geometry == 0 && instance == 0);
  return scene;
}

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
  raylanes_scene_destroy(scene);
}

static void expect_hit(const raylanes_scene* scene, const raylanes_ray_options* options, float t,
                       uint32_t geometry, uint32_t instance) {
  static const raylanes_ray down = {{0.25f, 0.25f, 9}, 0, {0, 0, -1}, INFINITY};
  raylanes_scene_hit hit;
  GOOD(raylanes_scene_closest1(scene, &down, &hit, options));
  EXPECT(hit.t == t && hit.geometry == geometry && hit.instance == instance);
}

static void test_places(void) {
  raylanes_scene *scene = scene_of_tetrahedron(), *copy = NULL;
  raylanes_ray_options options = ray_options();
  raylanes_bvh* tree = NULL;
  raylanes_scene_report report;
  uint32_t geometry, instance, mask = 0;
  float transform[12], lo[3], hi[3], raised[12];
  size_t i;
  for (i = 0; i < 12; ++i) raised[i] = corners[i] + (i % 3 == 2 ? 1 : 0);
  expect_hit(scene, NULL, 8.5f, 0, 0);
  GOOD(raylanes_bvh_create(&tree, corners, 4, 0, faces, 4, 0, NULL));
  GOOD(raylanes_scene_add_tree(scene, tree, &geometry));
  GOOD(raylanes_scene_place(scene, geometry, up_by_4, 2, &instance));
  EXPECT(geometry == 1 && instance == 1);
  REFUSED(raylanes_scene_closest1(scene, rays, (raylanes_scene_hit*)(void*)raised, NULL), "update()");
  GOOD(raylanes_scene_update(scene, 0));
  expect_hit(scene, NULL, 4.5f, 1, 1);
  options.mask = 4;
  expect_hit(scene, &options, 8.5f, 0, 0);
  options.mask = 0;
  expect_hit(scene, &options, INFINITY, RAYLANES_NO_PART, RAYLANES_NO_PART);

  // The tree is refitted beside the scene, which keeps it as it was.
  GOOD(raylanes_bvh_refit(tree, raised, 4, 0, faces, 4, 0, 1));
  expect_hit(scene, NULL, 4.5f, 1, 1);
  GOOD(raylanes_scene_copy(&copy, scene));
  GOOD(raylanes_scene_replace_tree(scene, 1, tree));
  GOOD(raylanes_scene_refit(scene, 0, raised, 4, 0, faces, 4, 0, 1));
  GOOD(raylanes_scene_update(scene, 1));
  raylanes_bvh_destroy(tree);
  expect_hit(scene, NULL, 3.5f, 1, 1);
  expect_hit(copy, NULL, 4.5f, 1, 1);
  GOOD(raylanes_scene_set_mask(scene, 1, 0));
  expect_hit(scene, NULL, 7.5f, 0, 0);
  GOOD(raylanes_scene_set_mask(scene, 1, 6));
  GOOD(raylanes_scene_move(scene, 1, NULL));
  GOOD(raylanes_scene_set_moving(scene, 1, 1));
  GOOD(raylanes_scene_update(scene, 1));
  expect_hit(scene, NULL, 7.5f, 0, 0);
  options = ray_options();
  options.mask = 2;
  raylanes_scene_destroy(copy);
  GOOD(raylanes_scene_geometry_of(scene, 1, &geometry));
  GOOD(raylanes_scene_mask_of(scene, 1, &mask));
  GOOD(raylanes_scene_transform_of(scene, 1, transform));
  EXPECT(geometry == 1 && mask == 6 && transform[0] == 1 && transform[11] == 0);
  EXPECT(raylanes_scene_geometry_count(scene) == 2 && raylanes_scene_instance_count(scene) == 2);
  EXPECT(raylanes_scene_bytes(scene) > 0);
  EXPECT(raylanes_scene_geometry_count(NULL) == 0 && raylanes_scene_instance_count(NULL) == 0);
  EXPECT(raylanes_scene_bytes(NULL) == 0);
  memset(&report, 0x5a, sizeof report);
  GOOD(raylanes_scene_describe(scene, &report, sizeof report - 8));
  EXPECT(report.mesh_triangles == 8 && report.meshes_without_tree == (size_t)0x5a5a5a5a5a5a5a5a);
  GOOD(raylanes_scene_bounds(scene, lo, hi));
  EXPECT(lo[2] <= 1 && hi[2] >= 2 && lo[2] > 0.99f && hi[2] < 2.01f);
  raylanes_scene_destroy(scene);
  raylanes_scene_destroy(NULL);
}

static void test_triangle_masks(void) {
  static const uint32_t masks[4] = {2, 2, 6, 2};
  raylanes_scene* scene = scene_of_tetrahedron();
  raylanes_ray_options options = ray_options();
  uint32_t part, instance;
  GOOD(raylanes_scene_set_triangle_masks(scene, 0, masks, 4));
  GOOD(raylanes_scene_update(scene, 1));
  expect_hit(scene, NULL, 8.5f, 0, 0);
  options.mask = 1;
  expect_hit(scene, &options, INFINITY, RAYLANES_NO_PART, RAYLANES_NO_PART);
  GOOD(raylanes_scene_set_triangle_masks(scene, 0, NULL, 0));
  GOOD(raylanes_scene_update(scene, 1));
  expect_hit(scene, &options, 8.5f, 0, 0);
  REFUSED(raylanes_scene_set_triangle_masks(scene, 1, masks, 4), "there is no geometry 1");
  REFUSED(raylanes_scene_set_triangle_masks(scene, 0, NULL, 4), "masks: ");
  REFUSED(raylanes_scene_set_triangle_masks(NULL, 0, masks, 4), "scene: ");
  GOOD(raylanes_scene_add_spheres(scene, corners, 0, 0, NULL, &part));
  GOOD(raylanes_scene_place(scene, part, NULL, 1, &instance));
  REFUSED(raylanes_scene_set_triangle_masks(scene, part, masks, 4), "no triangles");
  raylanes_scene_destroy(scene);
}

// The tetrahedron twice in a scene, which is placed by two more.
static void test_scenes_within(void) {
  raylanes_scene *part = scene_of_tetrahedron(), *whole = NULL;
  raylanes_instance_level levels[3] = {{7, 7}, {7, 7}, {7, 7}};
  uint32_t geometry, instance, mask;
  size_t count = 0;
  GOOD(raylanes_scene_place(part, 0, up_by_4, 6, &instance));
  GOOD(raylanes_scene_create(&whole));
  GOOD(raylanes_scene_add_scene(whole, part, &geometry));
  raylanes_scene_destroy(part);
  GOOD(raylanes_scene_place(whole, geometry, up_by_4, 3, &instance));
  EXPECT(geometry == 0 && instance == 0);
  GOOD(raylanes_scene_update(whole, 1));
  expect_hit(whole, NULL, 0.5f, 1, 2);
  GOOD(raylanes_scene_mask_of(whole, 2, &mask));
  EXPECT(mask == 2);
  GOOD(raylanes_scene_add_scene(whole, whole, &geometry));
  GOOD(raylanes_scene_place(whole, geometry, NULL, every_bit, &instance));
  EXPECT(geometry == 2 && instance == 3 && raylanes_scene_instance_count(whole) == 7);
  EXPECT(raylanes_scene_levels_of(whole, 6, levels, 2, &count) == RAYLANES_SMALL_BUFFER && count == 3);
  EXPECT(levels[0].instance == 7);
  GOOD(raylanes_scene_levels_of(whole, 6, levels, 3, &count));
  EXPECT(levels[0].instance == 3 && levels[0].geometry == 2 && levels[1].instance == 0 &&
         levels[1].geometry == 0 && levels[2].instance == 1 && levels[2].geometry == 0);
  REFUSED(raylanes_scene_levels_of(whole, 7, levels, 3, &count), "there is no instance 7");
  REFUSED(raylanes_scene_levels_of(whole, 6, levels, 3, NULL), "count: ");
  REFUSED(raylanes_scene_levels_of(NULL, 6, levels, 3, &count), "scene: ");
  REFUSED(raylanes_scene_levels_of(whole, 6, NULL, 3, &count), "levels: ");
  REFUSED(raylanes_scene_move(whole, 6, NULL), "instance 3");
  REFUSED(raylanes_scene_set_mask(whole, 2, 1), "instance 0");
  REFUSED(raylanes_scene_add_scene(whole, NULL, &geometry), "is NULL");
  REFUSED(raylanes_scene_add_scene(NULL, whole, &geometry), "scene: ");
  raylanes_scene_destroy(whole);
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
  raylanes_scene_hit hits[3], missed;
  float normals[9];
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
  raylanes_scene_destroy(copy);

  scene = scene_of_tetrahedron();
  GOOD(raylanes_scene_closest(scene, rays, 3, 0, hits, 0, NULL));
  GOOD(raylanes_scene_normals(scene, hits, 3, 0, normals, 1));
  EXPECT(normals[0] > 0.57f && normals[2] < 0.58f && normals[3] != normals[3] && normals[8] == -1);
  GOOD(raylanes_scene_normals(scene, NULL, 0, 0, NULL, 1));
  missed = hits[1];
  EXPECT(missed.geometry == RAYLANES_NO_PART && missed.instance == RAYLANES_NO_PART);
  // The instances of crossings lie elsewhere.
  GOOD(raylanes_scene_crossings(scene, rays, 1, 0, &lists, NULL));
  trace = ray_options();
  trace.skip = &((const raylanes_scene_crossing*)raylanes_lists_items(lists))->primitive;
  trace.skip_stride = sizeof(raylanes_scene_crossing);
  trace.skip_to_instance =
      offsetof(raylanes_scene_crossing, instance) - offsetof(raylanes_scene_crossing, primitive);
  GOOD(raylanes_scene_closest1(scene, rays, hits, &trace));
  EXPECT(hits[0].t == 2);
  raylanes_lists_destroy(lists);
  raylanes_scene_destroy(scene);
}

// A tetrahedron within one of four times its size.
static void test_parts(void) {
  static const float around[12] = {4, 0, 0, -0.75f, 0, 4, 0, -0.75f, 0, 0, 4, -0.75f};
  static const float places[9] = {0.125f, 0.125f, 0.125f, -0.5f, 0, 0, 9, 9, 9};
  raylanes_scene* const scene = scene_of_tetrahedron();
  raylanes_point_options options = point_options();
  raylanes_containing_part parts[3];
  const raylanes_containing_part* items;
  raylanes_lists* lists = NULL;
  raylanes_scene_hit hit;
  float three[9];
  uint32_t instance;
  GOOD(raylanes_scene_place(scene, 0, around, 2, &instance));
  GOOD(raylanes_scene_update(scene, 1));
  GOOD(raylanes_scene_innermost_parts(scene, places, 3, 0, parts, NULL));
  EXPECT(parts[0].instance == 0 && parts[0].location == RAYLANES_INSIDE && parts[1].instance == 1);
  EXPECT(parts[2].instance == RAYLANES_NO_PART && parts[2].location == RAYLANES_OUTSIDE);
  GOOD(raylanes_scene_set_mask(scene, 0, 1));
  options.mask = 2;
  GOOD(raylanes_scene_innermost_parts(scene, places, 1, 0, parts, &options));
  EXPECT(parts[0].instance == 1 && parts[0].geometry == 0);
  GOOD(raylanes_scene_containing_parts(scene, places, 3, 0, &lists, NULL));
  items = raylanes_lists_items(lists);
  EXPECT(raylanes_lists_offsets(lists)[1] == 2 && raylanes_lists_offsets(lists)[3] == 3);
  EXPECT(items[0].instance == 0 && items[1].instance == 1 && items[2].instance == 1);
  raylanes_lists_destroy(lists);
  GOOD(raylanes_scene_closest1(scene, rays, &hit, NULL));
  GOOD(raylanes_scene_corners(scene, &hit, 1, 0, three, 1));
  EXPECT(hit.instance == 1 && three[0] == 3.25f && three[1] == -0.75f && three[4] == 3.25f &&
         three[8] == 3.25f);
  GOOD(raylanes_scene_corners(scene, NULL, 0, 0, NULL, 1));
  REFUSED(raylanes_scene_corners(NULL, &hit, 1, 0, three, 1), "scene");
  REFUSED(raylanes_scene_corners(scene, NULL, 1, 0, three, 1), "hits");
  REFUSED(raylanes_scene_corners(scene, &hit, 1, 0, NULL, 1), "corners");
  REFUSED(raylanes_scene_corners(scene, &hit, 1, 0, three, -1), "threads");
  REFUSED(raylanes_scene_innermost_parts(NULL, places, 3, 0, parts, NULL), "scene");
  REFUSED(raylanes_scene_innermost_parts(scene, NULL, 3, 0, parts, NULL), "points");
  REFUSED(raylanes_scene_innermost_parts(scene, places, 3, 0, NULL, NULL), "parts");
  REFUSED(raylanes_scene_containing_parts(NULL, places, 3, 0, &lists, NULL), "scene");
  REFUSED(raylanes_scene_containing_parts(scene, places, 3, 1, &lists, NULL), "points");
  EXPECT(lists == NULL);
  REFUSED(raylanes_scene_containing_parts(scene, places, 3, 0, NULL, NULL), "lists");
  raylanes_scene_destroy(scene);
}

static void test_refused_places(raylanes_scene* scene) {
  const float broken[9] = {0, 0, 0, 1, 0, 0, 0, NAN, 0};
  const raylanes_sphere sphere = {{0, 0, 0}, 1};
  raylanes_build_options options;
  raylanes_scene_report report;
  raylanes_scene* other = scene;
  raylanes_bvh* tree = NULL;
  uint32_t got = 7;
  float numbers[12];
  GOOD(raylanes_bvh_create(&tree, corners, 4, 0, faces, 4, 0, NULL));
  GOOD(raylanes_init_build_options(&options, sizeof options));
  REFUSED(raylanes_scene_create(NULL), "scene");
  REFUSED(raylanes_scene_copy(NULL, scene), "scene");
  REFUSED(raylanes_scene_copy(&other, NULL), "from");
  EXPECT(other == NULL);
  REFUSED(raylanes_scene_add_mesh(NULL, corners, 4, 0, faces, 4, 0, NULL, &got), "scene");
  REFUSED(raylanes_scene_add_mesh(scene, NULL, 4, 0, faces, 4, 0, NULL, &got), "vertices");
  REFUSED(raylanes_scene_add_mesh(scene, broken, 3, 0, faces, 1, 0, NULL, &got), "vert");
  REFUSED(raylanes_scene_add_mesh(scene, corners, 4, 0, faces, SIZE_MAX, 0, NULL, &got), "triangles");
  REFUSED(raylanes_scene_add_mesh(scene, corners, 4, 0, faces, 4, 0, NULL, NULL), "geometry");
  REFUSED(raylanes_scene_add_tree(NULL, tree, &got), "scene");
  REFUSED(raylanes_scene_add_tree(scene, NULL, &got), "tree");
  REFUSED(raylanes_scene_add_tree(scene, tree, NULL), "geometry");
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
  REFUSED(raylanes_scene_replace_tree(scene, 1, tree), "geometry 1");
  REFUSED(raylanes_scene_replace_tree(scene, 0, NULL), "tree");
  REFUSED(raylanes_scene_replace_spheres(scene, 1, &sphere, 1, 0, NULL), "geometry 1");
  REFUSED(raylanes_scene_refit(scene, 1, corners, 4, 0, faces, 4, 0, 1), "geometry 1");
  REFUSED(raylanes_scene_refit(scene, 0, corners, 4, 0, faces, 3, 0, 1), "triangles");
  REFUSED(raylanes_scene_refit(NULL, 0, corners, 4, 0, faces, 4, 0, 1), "scene");
  REFUSED(raylanes_scene_place(NULL, 0, NULL, 1, &got), "scene");
  REFUSED(raylanes_scene_place(scene, 1, NULL, 1, &got), "geometry 1");
  REFUSED(raylanes_scene_place(scene, 0, NULL, 1, NULL), "instance");
  REFUSED(raylanes_scene_move(scene, 1, NULL), "instance 1");
  REFUSED(raylanes_scene_set_mask(scene, 1, 1), "instance 1");
  REFUSED(raylanes_scene_set_mask(NULL, 0, 1), "scene");
  REFUSED(raylanes_scene_set_moving(scene, 1, 1), "instance 1");
  REFUSED(raylanes_scene_update(scene, -1), "threads");
  REFUSED(raylanes_scene_update(NULL, 1), "scene");
  REFUSED(raylanes_scene_geometry_of(scene, 1, &got), "instance 1");
  REFUSED(raylanes_scene_geometry_of(scene, 0, NULL), "geometry");
  REFUSED(raylanes_scene_transform_of(scene, 1, numbers), "instance 1");
  REFUSED(raylanes_scene_transform_of(scene, 0, NULL), "transform");
  REFUSED(raylanes_scene_mask_of(NULL, 0, &got), "scene");
  REFUSED(raylanes_scene_mask_of(scene, 9, &got), "instance 9");
  REFUSED(raylanes_scene_describe(NULL, &report, sizeof report), "scene");
  REFUSED(raylanes_scene_describe(scene, NULL, sizeof report), "report");
  REFUSED(raylanes_scene_describe(scene, &report, sizeof report + 8), "size");
  REFUSED(raylanes_scene_normals(NULL, numbers, 0, 0, numbers, 1), "scene");
  REFUSED(raylanes_scene_normals(scene, NULL, 1, 0, numbers, 1), "hits");
  REFUSED(raylanes_scene_normals(scene, corners, 1, 23, numbers, 1), "hits");
  REFUSED(raylanes_scene_normals(scene, corners, 1, 0, NULL, 1), "normals");
  EXPECT(got == 7 && raylanes_scene_geometry_count(scene) == 1 && raylanes_scene_instance_count(scene) == 1);
  expect_tetrahedron(scene);  // without another update
  raylanes_bvh_destroy(tree);
}

void test_scenes(void) {
  raylanes_scene* const scene = scene_of_tetrahedron();
  test_hits(scene);
  test_shadows(scene);
  test_options_of_rays(scene);
  test_refused_rays(scene);
  test_refused_shadows(scene);
  test_refused_bounds(scene);
  test_functions_of_rays(scene);
  test_lists(scene);
  test_points(scene);
  test_progress_of_points(scene);
  test_refused_points(scene);
  test_files(scene);
  test_refused_places(scene);
  raylanes_scene_destroy(scene);
  test_meshes();
  test_places();
  test_scenes_within();
  test_triangle_masks();
  test_other_primitives();
  test_parts();
}

// The functions that scenes of floats and of doubles share, for the file that includes this and names the kind.
#include "tetrahedron.h"
#include "tree_files.h"
#include "tree_points.h"
#include "tree_queries.h"
#include "tree_refused.h"
#include "tree_refused_points.h"

static const NUMBER up_by_4[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4};
static const uint32_t every_bit = 0xffffffff;

static TREE* scene_of_tetrahedron(void) {
  TREE* scene = NULL;
  uint32_t geometry = 7, instance = 7;
  GOOD(CALL(create)(&scene));
  GOOD(CALL(add_mesh)(scene, corners, 4, 0, faces, 4, 0, NULL, &geometry));
  GOOD(CALL(place)(scene, geometry, NULL, every_bit, &instance));
  GOOD(CALL(update)(scene, 1));
  EXPECT(geometry == 0 && instance == 0);
  return scene;
}

static void expect_hit(const TREE* scene, const raylanes_ray_options* options, NUMBER t, uint32_t geometry,
                       uint32_t instance) {
  static const RECORD(ray) down = {{0.25, 0.25, 9}, 0, {0, 0, -1}, INFINITY};
  RECORD(hit) hit;
  GOOD(CALL(closest1)(scene, &down, &hit, options));
  EXPECT(hit.t == t && hit.geometry == geometry && hit.instance == instance);
}

// Writes the corners of a tetrahedron that is higher by 1.
static void write_raised(NUMBER raised[12]) {
  size_t i;
  for (i = 0; i < 12; ++i) raised[i] = corners[i] + (i % 3 == 2 ? 1 : 0);
}

static void test_places(void) {
  TREE *scene = scene_of_tetrahedron(), *copy = NULL;
  raylanes_ray_options options = ray_options();
  PART_TREE* tree = NULL;
  RECORD(hit) hit;
  uint32_t geometry, instance, mask = 0;
  NUMBER transform[12], lo[3], hi[3], raised[12];
  write_raised(raised);
  expect_hit(scene, NULL, 8.5, 0, 0);
  GOOD(PART(create)(&tree, corners, 4, 0, faces, 4, 0, NULL));
  GOOD(CALL(add_tree)(scene, tree, &geometry));
  GOOD(CALL(place)(scene, geometry, up_by_4, 2, &instance));
  EXPECT(geometry == 1 && instance == 1);
  REFUSED(CALL(closest1)(scene, rays, &hit, NULL), "update()");
  GOOD(CALL(update)(scene, 0));
  expect_hit(scene, NULL, 4.5, 1, 1);
  options.mask = 4;
  expect_hit(scene, &options, 8.5, 0, 0);
  options.mask = 0;
  expect_hit(scene, &options, INFINITY, RAYLANES_NO_PART, RAYLANES_NO_PART);

  // The tree is refitted beside the scene, which keeps it as it was.
  GOOD(PART(refit)(tree, raised, 4, 0, faces, 4, 0, 1));
  expect_hit(scene, NULL, 4.5, 1, 1);
  GOOD(CALL(copy)(&copy, scene));
  GOOD(CALL(replace_tree)(scene, 1, tree));
  GOOD(CALL(update)(scene, 1));
  PART(destroy)(tree);
  expect_hit(scene, NULL, 3.5, 1, 1);
  expect_hit(copy, NULL, 4.5, 1, 1);
  CALL(destroy)(copy);
  GOOD(CALL(set_mask)(scene, 1, 0));
  GOOD(CALL(update)(scene, 1));
  expect_hit(scene, NULL, 8.5, 0, 0);
  GOOD(CALL(set_mask)(scene, 1, 6));
  GOOD(CALL(move)(scene, 1, NULL));
  GOOD(CALL(update)(scene, 1));
  expect_hit(scene, NULL, 7.5, 1, 1);
  GOOD(CALL(geometry_of)(scene, 1, &geometry));
  GOOD(CALL(mask_of)(scene, 1, &mask));
  GOOD(CALL(transform_of)(scene, 1, transform));
  EXPECT(geometry == 1 && mask == 6 && transform[0] == 1 && transform[11] == 0);
  EXPECT(CALL(geometry_count)(scene) == 2 && CALL(instance_count)(scene) == 2);
  EXPECT(CALL(bytes)(scene) > 0);
  EXPECT(CALL(geometry_count)(NULL) == 0 && CALL(instance_count)(NULL) == 0);
  EXPECT(CALL(bytes)(NULL) == 0);
  GOOD(CALL(bounds)(scene, lo, hi));
  EXPECT(lo[2] <= 0 && hi[2] >= 2 && lo[2] > -0.01 && hi[2] < 2.01);
  CALL(destroy)(scene);
  CALL(destroy)(NULL);
}

static void test_surfaces(void) {
  TREE* const scene = scene_of_tetrahedron();
  raylanes_ray_options trace = ray_options();
  raylanes_lists* lists = NULL;
  RECORD(hit) hits[3], missed;
  NUMBER normals[9];
  GOOD(CALL(closest)(scene, rays, 3, 0, hits, 0, NULL));
  GOOD(CALL(normals)(scene, hits, 3, 0, normals, 1));
  EXPECT(normals[0] > 0.57 && normals[2] < 0.58 && normals[3] != normals[3] && normals[8] == -1);
  GOOD(CALL(normals)(scene, NULL, 0, 0, NULL, 1));
  missed = hits[1];
  EXPECT(missed.geometry == RAYLANES_NO_PART && missed.instance == RAYLANES_NO_PART);
  // The instances of crossings lie elsewhere.
  GOOD(CALL(crossings)(scene, rays, 1, 0, &lists, NULL));
  trace.skip = &((const RECORD(crossing)*)raylanes_lists_items(lists))->primitive;
  trace.skip_stride = sizeof(RECORD(crossing));
  trace.skip_to_instance = offsetof(RECORD(crossing), instance) - offsetof(RECORD(crossing), primitive);
  GOOD(CALL(closest1)(scene, rays, hits, &trace));
  EXPECT(hits[0].t == 2);
  raylanes_lists_destroy(lists);
  CALL(destroy)(scene);
}

// A tetrahedron within one of four times its size.
static void test_parts(void) {
  static const NUMBER around[12] = {4, 0, 0, -0.75, 0, 4, 0, -0.75, 0, 0, 4, -0.75};
  static const NUMBER places[9] = {0.125, 0.125, 0.125, -0.5, 0, 0, 9, 9, 9};
  TREE* const scene = scene_of_tetrahedron();
  raylanes_point_options options = point_options();
  raylanes_containing_part parts[3];
  const raylanes_containing_part* items;
  raylanes_lists* lists = NULL;
  RECORD(hit) hit;
  NUMBER three[9];
  uint32_t instance;
  GOOD(CALL(place)(scene, 0, around, 2, &instance));
  GOOD(CALL(update)(scene, 1));
  GOOD(CALL(innermost_parts)(scene, places, 3, 0, parts, NULL));
  EXPECT(parts[0].instance == 0 && parts[0].location == RAYLANES_INSIDE && parts[1].instance == 1);
  EXPECT(parts[2].instance == RAYLANES_NO_PART && parts[2].location == RAYLANES_OUTSIDE);
  GOOD(CALL(set_mask)(scene, 0, 1));
  GOOD(CALL(update)(scene, 1));
  options.mask = 2;
  GOOD(CALL(innermost_parts)(scene, places, 1, 0, parts, &options));
  EXPECT(parts[0].instance == 1 && parts[0].geometry == 0);
  GOOD(CALL(containing_parts)(scene, places, 3, 0, &lists, NULL));
  items = raylanes_lists_items(lists);
  EXPECT(raylanes_lists_offsets(lists)[1] == 2 && raylanes_lists_offsets(lists)[3] == 3);
  EXPECT(items[0].instance == 0 && items[1].instance == 1 && items[2].instance == 1);
  raylanes_lists_destroy(lists);
  GOOD(CALL(closest1)(scene, rays, &hit, NULL));
  GOOD(CALL(corners)(scene, &hit, 1, 0, three, 1));
  EXPECT(hit.instance == 1 && three[0] == 3.25 && three[1] == -0.75 && three[4] == 3.25 && three[8] == 3.25);
  GOOD(CALL(corners)(scene, NULL, 0, 0, NULL, 1));
  REFUSED(CALL(corners)(NULL, &hit, 1, 0, three, 1), "scene");
  REFUSED(CALL(corners)(scene, NULL, 1, 0, three, 1), "hits");
  REFUSED(CALL(corners)(scene, &hit, 1, 0, NULL, 1), "corners");
  REFUSED(CALL(corners)(scene, &hit, 1, 0, three, -1), "threads");
  REFUSED(CALL(innermost_parts)(NULL, places, 3, 0, parts, NULL), "scene");
  REFUSED(CALL(innermost_parts)(scene, NULL, 3, 0, parts, NULL), "points");
  REFUSED(CALL(innermost_parts)(scene, places, 3, 0, NULL, NULL), "parts");
  REFUSED(CALL(containing_parts)(NULL, places, 3, 0, &lists, NULL), "scene");
  REFUSED(CALL(containing_parts)(scene, places, 3, 1, &lists, NULL), "points");
  EXPECT(lists == NULL);
  REFUSED(CALL(containing_parts)(scene, places, 3, 0, NULL, NULL), "lists");
  CALL(destroy)(scene);
}

static void test_changes(void) {
  TREE* const scene = scene_of_tetrahedron();
  raylanes_scene_report report;
  NUMBER raised[12];
  uint32_t instance;
  write_raised(raised);
  GOOD(CALL(place)(scene, 0, up_by_4, 6, &instance));
  GOOD(CALL(refit)(scene, 0, raised, 4, 0, faces, 4, 0, 1));
  GOOD(CALL(update)(scene, 1));
  expect_hit(scene, NULL, 3.5, 0, 1);
  GOOD(CALL(set_mask)(scene, 1, 0));
  GOOD(CALL(update)(scene, 1));
  expect_hit(scene, NULL, 7.5, 0, 0);
  GOOD(CALL(set_mask)(scene, 1, 6));
  GOOD(CALL(move)(scene, 1, NULL));
  GOOD(CALL(set_moving)(scene, 1, 1));
  GOOD(CALL(update)(scene, 1));
  expect_hit(scene, NULL, 7.5, 0, 0);
  memset(&report, 0x5a, sizeof report);
  GOOD(CALL(describe)(scene, &report, sizeof report - 8));
  EXPECT(report.mesh_triangles == 4 && report.meshes_without_tree == (size_t)0x5a5a5a5a5a5a5a5a);
  CALL(destroy)(scene);
}

static void test_triangle_masks(void) {
  static const uint32_t masks[4] = {2, 2, 6, 2};
  TREE* scene = scene_of_tetrahedron();
  raylanes_ray_options options = ray_options();
  size_t size;
  GOOD(CALL(set_triangle_masks)(scene, 0, masks, 4));
  GOOD(CALL(update)(scene, 1));
  expect_hit(scene, NULL, 8.5, 0, 0);
  options.mask = 1;
  expect_hit(scene, &options, INFINITY, RAYLANES_NO_PART, RAYLANES_NO_PART);
  GOOD(CALL(set_triangle_masks)(scene, 0, NULL, 0));
  GOOD(CALL(update)(scene, 1));
  expect_hit(scene, &options, 8.5, 0, 0);
  REFUSED(CALL(set_triangle_masks)(scene, 1, masks, 4), "there is no geometry 1");
  REFUSED(CALL(set_triangle_masks)(scene, 0, NULL, 4), "masks: ");
  REFUSED(CALL(set_triangle_masks)(NULL, 0, masks, 4), "scene: ");
  GOOD(CALL(set_triangle_masks)(scene, 0, masks, 1));
  REFUSED(CALL(save)(scene, NULL, 0, &size), "masks of triangles");
  CALL(destroy)(scene);
}

// The tetrahedron twice in a scene, which is placed by two more.
static void test_scenes_within(void) {
  TREE *part = scene_of_tetrahedron(), *whole = NULL;
  raylanes_instance_level levels[3] = {{7, 7}, {7, 7}, {7, 7}};
  uint32_t geometry, instance, mask;
  size_t count = 0;
  GOOD(CALL(place)(part, 0, up_by_4, 6, &instance));
  GOOD(CALL(create)(&whole));
  GOOD(CALL(add_scene)(whole, part, &geometry));
  CALL(destroy)(part);
  GOOD(CALL(place)(whole, geometry, up_by_4, 3, &instance));
  EXPECT(geometry == 0 && instance == 0);
  GOOD(CALL(update)(whole, 1));
  expect_hit(whole, NULL, 0.5, 1, 2);
  GOOD(CALL(mask_of)(whole, 2, &mask));
  EXPECT(mask == 2);
  GOOD(CALL(add_scene)(whole, whole, &geometry));
  GOOD(CALL(place)(whole, geometry, NULL, every_bit, &instance));
  EXPECT(geometry == 2 && instance == 3 && CALL(instance_count)(whole) == 7);
  EXPECT(CALL(levels_of)(whole, 6, levels, 2, &count) == RAYLANES_SMALL_BUFFER && count == 3);
  EXPECT(levels[0].instance == 7);
  GOOD(CALL(levels_of)(whole, 6, levels, 3, &count));
  EXPECT(levels[0].instance == 3 && levels[0].geometry == 2 && levels[1].instance == 0 &&
         levels[1].geometry == 0 && levels[2].instance == 1 && levels[2].geometry == 0);
  REFUSED(CALL(levels_of)(whole, 7, levels, 3, &count), "there is no instance 7");
  REFUSED(CALL(levels_of)(whole, 6, levels, 3, NULL), "count: ");
  REFUSED(CALL(levels_of)(NULL, 6, levels, 3, &count), "scene: ");
  REFUSED(CALL(levels_of)(whole, 6, NULL, 3, &count), "levels: ");
  REFUSED(CALL(move)(whole, 6, NULL), "instance 3");
  REFUSED(CALL(set_mask)(whole, 2, 1), "instance 0");
  REFUSED(CALL(add_scene)(whole, NULL, &geometry), "is NULL");
  REFUSED(CALL(add_scene)(NULL, whole, &geometry), "scene: ");
  CALL(destroy)(whole);
}

static void test_refused_places(TREE* scene) {
  const NUMBER broken[9] = {0, 0, 0, 1, 0, 0, 0, NAN, 0};
  raylanes_ray_options masked = ray_options();
  TREE* other = scene;
  PART_TREE* tree = NULL;
  raylanes_lists* lists = NULL;
  raylanes_scene_report report;
  RECORD(hit) hit;
  uint32_t got = 7;
  NUMBER numbers[12];
  GOOD(PART(create)(&tree, corners, 4, 0, faces, 4, 0, NULL));
  REFUSED(CALL(create)(NULL), "scene");
  REFUSED(CALL(copy)(NULL, scene), "scene");
  REFUSED(CALL(copy)(&other, NULL), "from");
  EXPECT(other == NULL);
  REFUSED(CALL(add_mesh)(NULL, corners, 4, 0, faces, 4, 0, NULL, &got), "scene");
  REFUSED(CALL(add_mesh)(scene, NULL, 4, 0, faces, 4, 0, NULL, &got), "vertices");
  REFUSED(CALL(add_mesh)(scene, broken, 3, 0, faces, 1, 0, NULL, &got), "vert");
  REFUSED(CALL(add_mesh)(scene, corners, 4, 0, faces, SIZE_MAX, 0, NULL, &got), "triangles");
  REFUSED(CALL(add_mesh)(scene, corners, 4, 0, faces, 4, 0, NULL, NULL), "geometry");
  REFUSED(CALL(add_tree)(NULL, tree, &got), "scene");
  REFUSED(CALL(add_tree)(scene, NULL, &got), "tree");
  REFUSED(CALL(add_tree)(scene, tree, NULL), "geometry");
  REFUSED(CALL(replace_tree)(scene, 1, tree), "geometry 1");
  REFUSED(CALL(replace_tree)(scene, 0, NULL), "tree");
  REFUSED(CALL(place)(NULL, 0, NULL, 1, &got), "scene");
  REFUSED(CALL(place)(scene, 1, NULL, 1, &got), "geometry 1");
  REFUSED(CALL(place)(scene, 0, NULL, 1, NULL), "instance");
  REFUSED(CALL(move)(scene, 1, NULL), "instance 1");
  REFUSED(CALL(set_mask)(scene, 1, 1), "instance 1");
  REFUSED(CALL(set_mask)(NULL, 0, 1), "scene");
  REFUSED(CALL(update)(scene, -1), "threads");
  REFUSED(CALL(update)(NULL, 1), "scene");
  REFUSED(CALL(geometry_of)(scene, 1, &got), "instance 1");
  REFUSED(CALL(geometry_of)(scene, 0, NULL), "geometry");
  REFUSED(CALL(transform_of)(scene, 1, numbers), "instance 1");
  REFUSED(CALL(transform_of)(scene, 0, NULL), "transform");
  REFUSED(CALL(mask_of)(NULL, 0, &got), "scene");
  REFUSED(CALL(mask_of)(scene, 9, &got), "instance 9");
  REFUSED(CALL(normals)(NULL, numbers, 0, 0, numbers, 1), "scene");
  REFUSED(CALL(normals)(scene, NULL, 1, 0, numbers, 1), "hits");
  REFUSED(CALL(normals)(scene, corners, 1, 23, numbers, 1), "hits");
  REFUSED(CALL(normals)(scene, corners, 1, 0, NULL, 1), "normals");
  REFUSED(CALL(refit)(scene, 1, corners, 4, 0, faces, 4, 0, 1), "geometry 1");
  REFUSED(CALL(refit)(scene, 0, corners, 4, 0, faces, 3, 0, 1), "triangles");
  REFUSED(CALL(refit)(NULL, 0, corners, 4, 0, faces, 4, 0, 1), "scene");
  REFUSED(CALL(set_moving)(scene, 1, 1), "instance 1");
  REFUSED(CALL(describe)(NULL, &report, sizeof report), "scene");
  REFUSED(CALL(describe)(scene, NULL, sizeof report), "report");
  REFUSED(CALL(describe)(scene, &report, sizeof report + 8), "size");
  masked.masks = &every_bit, masked.mask_count = 1;
  REFUSED(CALL(closest)(scene, rays, 1, 0, &hit, 0, &masked), "masks");
  REFUSED(CALL(closest1)(scene, rays, &hit, &masked), "masks");
  REFUSED(CALL(all_hits)(scene, rays, 1, 0, &lists, &masked), "masks");
  EXPECT(got == 7 && CALL(geometry_count)(scene) == 1 && CALL(instance_count)(scene) == 1);
  expect_tetrahedron(scene);  // without another update
  PART(destroy)(tree);
}

// These functions, and the queries of trees.
static void test_scene(TREE* scene) {
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
  test_refused_places(scene);
  test_files(scene);
  test_places();
  test_changes();
  test_triangle_masks();
  test_scenes_within();
  test_surfaces();
  test_parts();
}

// Scenes of doubles in C: the tests of trees with a scene of one tetrahedron, and builds.
#define NUMBER double
#define TREE raylanes_scene_d
#define CALL(name) raylanes_scene_d_##name
#define RECORD(name) RECORD_##name
#define RECORD_ray raylanes_rayd
#define RECORD_hit raylanes_scene_hit_d
#define RECORD_crossing raylanes_scene_crossing_d
#define RECORD_stretch raylanes_scene_stretch_d
#define RECORD_closest_point raylanes_scene_closest_point_d
#define KIND "scene"
#define PART_TREE raylanes_bvhd
#define PART(name) raylanes_bvhd_##name
#define ANOTHER_LOAD raylanes_scene_load
#define ANOTHER_TREE raylanes_scene
#include "scene_test.h"
#include "tree_stretches.h"

// A mesh is built when it is added, and a build that ends early adds none.
static void test_builds(void) {
  raylanes_scene_d* scene = NULL;
  raylanes_build_options options;
  double told[2] = {0, 2}, at_once[2] = {0, 0};
  uint32_t geometry = 7;
  GOOD(raylanes_init_build_options(&options, sizeof options));
  GOOD(raylanes_scene_d_create(&scene));
  options.progress = tell_progress, options.progress_context = told;
  GOOD(raylanes_scene_d_add_mesh(scene, corners, 4, 0, faces, 4, 0, &options, &geometry));
  EXPECT(geometry == 0 && told[0] == 1);
  options.progress_context = at_once;
  FAILS(raylanes_scene_d_add_mesh(scene, corners, 4, 0, faces, 4, 0, &options, &geometry), RAYLANES_CANCELLED,
        "ended the call");
  GOOD(raylanes_init_build_options(&options, sizeof options));
  options.builder = RAYLANES_BUILDER_SPATIAL_SPLITS;
  REFUSED(raylanes_scene_d_add_mesh(scene, corners, 4, 0, faces, 4, 0, &options, &geometry),
          "spatial_splits");
  EXPECT(geometry == 0 && raylanes_scene_d_geometry_count(scene) == 1);
  raylanes_scene_d_destroy(scene);
}

// A part beyond what floats can tell apart.
static void test_far_places(void) {
  static const double far_away[12] = {0, -1, 0, 500123.5, 1, 0, 0, 4649776.0009765625, 0, 0, 1, 1048576};
  static const raylanes_rayd ray = {{500123.25, 4649776.2509765625, 1048578}, 0, {0, 0, -1}, INFINITY};
  raylanes_scene_d* const scene = scene_of_tetrahedron();
  raylanes_scene_hit_d hit;
  double three[9], read[12];
  GOOD(raylanes_scene_d_move(scene, 0, far_away));
  GOOD(raylanes_scene_d_update(scene, 1));
  GOOD(raylanes_scene_d_closest1(scene, &ray, &hit, NULL));
  EXPECT(hit.t == 1.5 && hit.u == 0.25 && hit.v == 0.5 && hit.instance == 0 && hit.unused == 0);
  GOOD(raylanes_scene_d_corners(scene, &hit, 1, 0, three, 1));
  EXPECT(three[0] == 500123.5 && three[1] == 4649777.0009765625 && three[2] == 1048576);
  GOOD(raylanes_scene_d_transform_of(scene, 0, read));
  EXPECT(memcmp(read, far_away, sizeof read) == 0);
  raylanes_scene_d_destroy(scene);
}

void test_scenes_of_doubles(void) {
  raylanes_scene_d* const scene = scene_of_tetrahedron();
  test_scene(scene);
  test_stretches(scene);
  raylanes_scene_d_destroy(scene);
  test_builds();
  test_far_places();
}

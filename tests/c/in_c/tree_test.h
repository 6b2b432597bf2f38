// The functions of one kind of tree, for the file that includes this and names the kind.
#include "tetrahedron.h"
#include "tree_files.h"
#include "tree_points.h"
#include "tree_queries.h"
#include "tree_refused.h"
#include "tree_refused_points.h"
#include "tree_stretches.h"
#include "tree_triangles.h"

static TREE* tetrahedron(void) {
  TREE* tree = NULL;
  GOOD(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, NULL));
  EXPECT(tree != NULL);
  return tree;
}

static void test_builds(void) {
  // With numbers between, and of any alignment.
  unsigned char apart[1 + 4 * 40], triangles[2 + 4 * 17];
  raylanes_build_options options;
  RECORD(hit) hit;
  int32_t builder;
  size_t i;
  for (i = 0; i < 4; ++i) memcpy(apart + 1 + 40 * i, corners + 3 * i, 3 * sizeof *corners);
  for (i = 0; i < 4; ++i) memcpy(triangles + 2 + 17 * i, faces + 3 * i, 3 * sizeof *faces);
  GOOD(raylanes_init_build_options(&options, sizeof options));
  for (builder = 0; builder < 6; ++builder) {
    TREE* tree = NULL;
    options.builder = builder;
    options.optimize = builder % 2;
    if (builder == RAYLANES_BUILDER_SPATIAL_SPLITS && sizeof(NUMBER) == 8) {
      REFUSED(CALL(create)(&tree, apart + 1, 4, 40, triangles + 2, 4, 17, &options), "spatial_splits");
      continue;
    }
    GOOD(CALL(create)(&tree, apart + 1, 4, 40, triangles + 2, 4, 17, &options));
    GOOD(CALL(closest1)(tree, rays, &hit, NULL));
    EXPECT(hit.t == 1.5 && hit.primitive == 3);
    CALL(destroy)(tree);
  }
  CALL(destroy)(NULL);
}

static void test_refused_builds(void) {
  static const uint32_t beyond[3] = {0, 1, 4};
  NUMBER broken[9] = {0, 0, 0, 1, 0, 0, 0, NAN, 0};
  raylanes_build_options options;
  double told[2] = {0, 2};
  TREE* tree = (TREE*)&options;  // anything
  GOOD(raylanes_init_build_options(&options, sizeof options));
  REFUSED(CALL(create)(NULL, corners, 4, 0, faces, 4, 0, NULL), "tree");
  REFUSED(CALL(create)(&tree, NULL, 4, 0, faces, 4, 0, NULL), "vertices");
  EXPECT(tree == NULL);
  REFUSED(CALL(create)(&tree, corners, 4, 0, NULL, 4, 0, NULL), "triangles");
  REFUSED(CALL(create)(&tree, corners, 4, 3 * sizeof(NUMBER) - 1, faces, 4, 0, NULL), "vertices");
  REFUSED(CALL(create)(&tree, corners, 4, 0, faces, 4, 11, NULL), "triangles");
  REFUSED(CALL(create)(&tree, corners, SIZE_MAX, 0, faces, 4, 0, NULL), "vertices");
  REFUSED(CALL(create)(&tree, corners, 4, 0, faces, SIZE_MAX / 12 + 2, 0, NULL), "triangles");
  REFUSED(CALL(create)(&tree, corners, 4, SIZE_MAX / 2, faces, 4, 0, NULL), "address space");
  REFUSED(CALL(create)(&tree, corners, 4, 0, beyond, 1, 0, NULL), "4");
  REFUSED(CALL(create)(&tree, broken, 3, 0, beyond, 1, 0, NULL), "vert");
  options.builder = 6;
  REFUSED(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, &options), "builder");
  options.builder = 256 + RAYLANES_BUILDER_BINNED_SAH;
  REFUSED(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, &options), "builder");
  options.builder = -1;
  REFUSED(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, &options), "builder");
  options.builder = 0, options.threads = -1;
  REFUSED(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, &options), "threads");
  options.size = sizeof options + 8;
  REFUSED(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, &options), "options");
  options.size = sizeof options, options.threads = 1;
  options.progress = tell_progress, options.progress_context = told;
  GOOD(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, &options));
  EXPECT(told[0] == 1);
  CALL(destroy)(tree);
  told[0] = told[1] = 0;
  FAILS(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, &options), RAYLANES_CANCELLED, "ended the call");
  EXPECT(tree == NULL);
  options.size = 8;  // as if it had no member but its size
  GOOD(CALL(create)(&tree, corners, 4, 0, faces, 4, 0, &options));
  CALL(destroy)(tree);
}

static void test_empty_trees(void) {
  TREE* tree = NULL;
  raylanes_lists* lists = NULL;
  RECORD(hit) hit;
  uint8_t occluded = 7;
  GOOD(CALL(create)(&tree, NULL, 0, 0, NULL, 0, 0, NULL));
  GOOD(CALL(closest1)(tree, rays, &hit, NULL));
  EXPECT(isinf(hit.t) && hit.primitive == RAYLANES_NO_PRIMITIVE);
  GOOD(CALL(occluded1)(tree, rays, &occluded, NULL));
  EXPECT(occluded == 0);
  GOOD(CALL(closest)(tree, NULL, 0, 0, NULL, 0, NULL));
  GOOD(CALL(all_hits)(tree, NULL, 0, 0, &lists, NULL));
  EXPECT(raylanes_lists_offsets(lists)[0] == 0 && raylanes_lists_items(lists) == NULL);
  raylanes_lists_destroy(lists);
  CALL(destroy)(tree);
}

static void test_refits(TREE* tree) {
  NUMBER moved[12];
  RECORD(hit) hit;
  size_t i;
  for (i = 0; i < 12; ++i) moved[i] = corners[i] + (i % 3 == 2 ? 1 : 0);
  REFUSED(CALL(refit)(NULL, moved, 4, 0, faces, 4, 0, 1), "tree");
  REFUSED(CALL(refit)(tree, NULL, 4, 0, faces, 4, 0, 1), "vertices");
  REFUSED(CALL(refit)(tree, moved, 4, 1, faces, 4, 0, 1), "vertices");
  REFUSED(CALL(refit)(tree, moved, 4, 0, NULL, 4, 0, 1), "triangles");
  REFUSED(CALL(refit)(tree, moved, 4, 0, faces, SIZE_MAX, 0, 1), "triangles");
  REFUSED(CALL(refit)(tree, moved, 4, 0, faces, 3, 0, 1), "triangles");
  REFUSED(CALL(refit)(tree, moved, 4, 0, faces, 4, 0, -1), "threads");
  expect_tetrahedron(tree);
  GOOD(CALL(refit)(tree, moved, 4, 0, faces, 4, 0, 0));
  GOOD(CALL(closest1)(tree, rays, &hit, NULL));
  EXPECT(hit.t == 0.5);
}

void TEST_TREES(void) {
  TREE* tree;
  test_builds();
  test_refused_builds();
  test_empty_trees();
  tree = tetrahedron();
  test_hits(tree);
  test_shadows(tree);
  test_options_of_rays(tree);
  test_refused_rays(tree);
  test_refused_bounds(tree);
  test_functions_of_rays(tree);
  test_masks(tree);
  test_prepared_calls(tree);
  test_refused_calls(tree);
  test_progress_of_points(tree);
  test_refused_shadows(tree);
  test_lists(tree);
  test_stretches(tree);
  test_triangles(tree);
  test_refused_triangles(tree);
  test_points(tree);
  test_refused_points(tree);
  test_files(tree);
  test_refits(tree);
  CALL(destroy)(tree);
}

// Stretches within one kind of tree or within scenes of floats, for tree_test.h and scenes.c.

static void test_stretches(const TREE* tree) {
  raylanes_ray_options options = ray_options();
  struct reject none = {9, 0, 0};
  raylanes_lists* lists = NULL;
  const size_t* offsets;
  const RECORD(stretch) * stretches;
  GOOD(CALL(stretches)(tree, rays, 3, 0, &lists, NULL));
  offsets = raylanes_lists_offsets(lists);
  stretches = raylanes_lists_items(lists);
  EXPECT(offsets[1] == 1 && offsets[2] == 1 && offsets[3] == 2);
  EXPECT(stretches[0].entry == 1.5 && stretches[0].exit == 2 && stretches[0].winding == 1);
  EXPECT(stretches[0].entered_by == 3 && stretches[0].left_by == 0);
  EXPECT(stretches[1].entry == 0 && stretches[1].entered_by == RAYLANES_NO_PRIMITIVE);
  raylanes_lists_destroy(lists);
  REFUSED(CALL(stretches)(tree, rays, 3, 0, NULL, NULL), "lists");
  REFUSED(CALL(stretches)(NULL, rays, 3, 0, &lists, NULL), KIND);
  EXPECT(lists == NULL);
  REFUSED(CALL(stretches)(tree, NULL, 3, 0, &lists, NULL), "rays");
  options.threads = -1;
  REFUSED(CALL(stretches)(tree, rays, 3, 0, &lists, &options), "threads");
  options = ray_options();
  options.facing = RAYLANES_FACING_FRONT;
  REFUSED(CALL(stretches)(tree, rays, 3, 0, &lists, &options), "facing");
  options = ray_options();
  options.filter = reject_hits, options.filter_context = &none;
  REFUSED(CALL(stretches)(tree, rays, 3, 0, &lists, &options), "filter");
  EXPECT(lists == NULL);
}

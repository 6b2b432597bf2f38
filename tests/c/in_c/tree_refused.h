// Calls of one kind of tree or of scenes that are refused, for tree_test.h and scenes.c.

static void test_wrong_options(const TREE* tree, void (*change)(raylanes_ray_options*), const char* word) {
  raylanes_ray_options options = ray_options();
  RECORD(hit) hits[3] = {{.t = 7}, {.t = 7}, {.t = 7}};
  uint8_t occluded[3] = {7, 7, 7};
  raylanes_lists* lists = NULL;
  change(&options);
  REFUSED(CALL(closest)(tree, rays, 3, 0, hits, 0, &options), word);
  REFUSED(CALL(closest1)(tree, rays, hits, &options), word);
  REFUSED(CALL(closest_crossing)(tree, rays, 3, 0, hits, 0, &options), word);
  REFUSED(CALL(closest_crossing1)(tree, rays, hits, &options), word);
  REFUSED(CALL(occluded)(tree, rays, 3, 0, occluded, &options), word);
  REFUSED(CALL(occluded1)(tree, rays, occluded, &options), word);
  REFUSED(CALL(occluded_from)(tree, points, points, 3, 0, 0, 1, occluded, &options), word);
  REFUSED(CALL(occluded_towards)(tree, points, points, 3, 0, occluded, &options), word);
  REFUSED(CALL(all_hits)(tree, rays, 3, 0, &lists, &options), word);
  REFUSED(CALL(crossings)(tree, rays, 3, 0, &lists, &options), word);
  EXPECT(hits[0].t == 7 && hits[2].t == 7 && occluded[0] == 7 && lists == NULL);
}

static void set_threads(raylanes_ray_options* options) {
  options->threads = -1;
}
static void set_facing(raylanes_ray_options* options) {
  options->facing = 3;
}
static void set_path(raylanes_ray_options* options) {
  options->path = "sse9";
}
static void set_size(raylanes_ray_options* options) {
  options->size = 20;
}
static void set_skip(raylanes_ray_options* options) {
  options->skip = faces, options->skip_stride = 3;
}

static void test_refused_rays(const TREE* tree) {
  raylanes_ray_options options = ray_options();
  raylanes_crossing_count counts[3];
  RECORD(hit) hits[3];
  uint8_t occluded[3];
  raylanes_lists* lists = (raylanes_lists*)hits;  // anything
  const size_t short_ray = sizeof *rays - 1, short_hit = sizeof *hits - 1;
  REFUSED(CALL(closest)(NULL, rays, 3, 0, hits, 0, NULL), KIND);
  REFUSED(CALL(closest)(tree, NULL, 3, 0, hits, 0, NULL), "rays");
  REFUSED(CALL(closest)(tree, rays, 3, 0, NULL, 0, NULL), "hits");
  REFUSED(CALL(closest)(tree, rays, 3, short_ray, hits, 0, NULL), "rays");
  REFUSED(CALL(closest)(tree, rays, 3, 0, hits, short_hit, NULL), "hits");
  REFUSED(CALL(closest)(tree, rays, SIZE_MAX, 0, hits, 0, NULL), "address space");
  REFUSED(CALL(closest)(tree, rays, 3, SIZE_MAX, hits, 0, NULL), "address space");
  REFUSED(CALL(closest_crossing)(NULL, rays, 3, 0, hits, 0, NULL), KIND);
  REFUSED(CALL(closest_crossing)(tree, rays, 3, short_ray, hits, 0, NULL), "rays");
  REFUSED(CALL(closest_crossing)(tree, rays, 3, 0, NULL, 0, NULL), "hits");
  REFUSED(CALL(occluded)(NULL, rays, 3, 0, occluded, NULL), KIND);
  REFUSED(CALL(occluded)(tree, rays, 3, 1, occluded, NULL), "rays");
  REFUSED(CALL(occluded)(tree, rays, 3, 0, NULL, NULL), "occluded");
  REFUSED(CALL(closest1)(NULL, rays, hits, NULL), KIND);
  REFUSED(CALL(closest1)(tree, NULL, hits, NULL), "ray");
  REFUSED(CALL(closest1)(tree, rays, NULL, NULL), "hit");
  REFUSED(CALL(occluded1)(NULL, rays, occluded, NULL), KIND);
  REFUSED(CALL(occluded1)(tree, NULL, occluded, NULL), "ray");
  REFUSED(CALL(occluded1)(tree, rays, NULL, NULL), "occluded");
  REFUSED(CALL(all_hits)(tree, rays, 3, 0, NULL, NULL), "lists");
  REFUSED(CALL(all_hits)(NULL, rays, 3, 0, &lists, NULL), KIND);
  EXPECT(lists == NULL);
  REFUSED(CALL(all_hits)(tree, NULL, 3, 0, &lists, NULL), "rays");
  REFUSED(CALL(all_hits)(tree, rays, SIZE_MAX / sizeof *rays + 2, 0, &lists, NULL), "rays");
  REFUSED(CALL(crossings)(tree, rays, 3, 0, NULL, NULL), "lists");
  REFUSED(CALL(crossings)(NULL, rays, 3, 0, &lists, NULL), KIND);
  REFUSED(CALL(crossings)(tree, rays, 3, 5, &lists, NULL), "rays");
  REFUSED(CALL(count_crossings)(NULL, rays, 3, 0, counts, NULL), KIND);
  REFUSED(CALL(count_crossings)(tree, NULL, 3, 0, counts, NULL), "rays");
  REFUSED(CALL(count_crossings)(tree, rays, 3, 0, NULL, NULL), "counts");
  REFUSED(CALL(closest_crossing1)(NULL, rays, hits, NULL), KIND);
  REFUSED(CALL(closest_crossing1)(tree, NULL, hits, NULL), "ray");
  REFUSED(CALL(closest_crossing1)(tree, rays, NULL, NULL), "hit");
  options.after = hits, options.after_stride = sizeof *hits - 1;
  REFUSED(CALL(closest)(tree, rays, 3, 0, hits, 0, &options), "after");
  options.after_stride = SIZE_MAX;
  REFUSED(CALL(closest)(tree, rays, 3, 0, hits, 0, &options), "after");
  test_wrong_options(tree, set_threads, "threads");
  test_wrong_options(tree, set_facing, "facing");
  test_wrong_options(tree, set_path, "sse9");
  test_wrong_options(tree, set_size, "options");
  test_wrong_options(tree, set_skip, "skip");
}

static void test_refused_shadows(const TREE* tree) {
  NUMBER own[9] = {7, 7, 7, 7, 7, 7, 7, 7, 7};
  uint8_t occluded[3] = {7, 7, 7};
  uint8_t* const within = (uint8_t*)own + sizeof own - 3;
  REFUSED(CALL(occluded_from)(NULL, own, points, 3, 0, 0, 1, occluded, NULL), KIND);
  REFUSED(CALL(occluded_from)(tree, NULL, points, 3, 0, 0, 1, occluded, NULL), "from");
  REFUSED(CALL(occluded_from)(tree, own, NULL, 3, 0, 0, 1, occluded, NULL), "points");
  REFUSED(CALL(occluded_from)(tree, own, points, 3, 3 * sizeof *own - 1, 0, 1, occluded, NULL), "points");
  REFUSED(CALL(occluded_from)(tree, own, points, SIZE_MAX, 0, 0, 1, occluded, NULL), "address space");
  REFUSED(CALL(occluded_from)(tree, own, points, 3, 0, 0, 1, NULL, NULL), "occluded");
  REFUSED(CALL(occluded_from)(tree, own, own, 3, 0, 0, 1, within, NULL), "overlap");
  REFUSED(CALL(occluded_towards)(NULL, own, points, 3, 0, occluded, NULL), KIND);
  REFUSED(CALL(occluded_towards)(tree, NULL, points, 3, 0, occluded, NULL), "direction");
  REFUSED(CALL(occluded_towards)(tree, own, NULL, 3, 0, occluded, NULL), "points");
  REFUSED(CALL(occluded_towards)(tree, own, points, 3, 3 * sizeof *own - 1, occluded, NULL), "points");
  REFUSED(CALL(occluded_towards)(tree, own, points, 3, SIZE_MAX, occluded, NULL), "address space");
  REFUSED(CALL(occluded_towards)(tree, own, points, 3, 0, NULL, NULL), "occluded");
  REFUSED(CALL(occluded_towards)(tree, own, own, 3, 0, within, NULL), "overlap");
  EXPECT(occluded[0] == 7 && occluded[2] == 7 && own[8] == 7);
}

static void test_refused_bounds(const TREE* tree) {
  NUMBER lo[3], hi[3];
  REFUSED(CALL(bounds)(NULL, lo, hi), KIND);
  REFUSED(CALL(bounds)(tree, NULL, hi), "lo");
  REFUSED(CALL(bounds)(tree, lo, NULL), "hi");
}

// Calls of one kind of tree that are refused, for tree_test.h.

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

static void test_refused_triangles(const TREE* tree) {
  const uint32_t named[3] = {0, 1, 2};
  raylanes_ray_options options = ray_options();
  raylanes_crossing_count counts[3];
  RECORD(hit) hits[3];
  NUMBER nines[28], lo[3], hi[3];
  REFUSED(CALL(corners)(NULL, named, 3, 0, nines), "tree");
  REFUSED(CALL(corners)(tree, NULL, 3, 0, nines), "primitives");
  REFUSED(CALL(corners)(tree, named, 3, 3, nines), "primitives");
  REFUSED(CALL(corners)(tree, named, 3, 0, NULL), "corners");
  REFUSED(CALL(corners)(tree, named, 3, 0, (NUMBER*)(void*)((char*)nines + 1)), "corners");
  REFUSED(CALL(bounds)(NULL, lo, hi), "tree");
  REFUSED(CALL(bounds)(tree, NULL, hi), "lo");
  REFUSED(CALL(bounds)(tree, lo, NULL), "hi");
  REFUSED(CALL(count_crossings)(NULL, rays, 3, 0, counts, NULL), "tree");
  REFUSED(CALL(count_crossings)(tree, NULL, 3, 0, counts, NULL), "rays");
  REFUSED(CALL(count_crossings)(tree, rays, 3, 0, NULL, NULL), "counts");
  REFUSED(CALL(closest_crossing1)(NULL, rays, hits, NULL), "tree");
  REFUSED(CALL(closest_crossing1)(tree, NULL, hits, NULL), "ray");
  REFUSED(CALL(closest_crossing1)(tree, rays, NULL, NULL), "hit");
  options.after = hits, options.after_stride = sizeof *hits - 1;
  REFUSED(CALL(closest)(tree, rays, 3, 0, hits, 0, &options), "after");
  options.after_stride = SIZE_MAX;
  REFUSED(CALL(closest)(tree, rays, 3, 0, hits, 0, &options), "after");
}

static void test_refused_rays(const TREE* tree) {
  RECORD(hit) hits[3];
  uint8_t occluded[3];
  raylanes_lists* lists = (raylanes_lists*)hits;  // anything
  CALL(calls)* calls = (CALL(calls)*)hits;
  const size_t short_ray = sizeof *rays - 1, short_hit = sizeof *hits - 1;
  REFUSED(CALL(closest)(NULL, rays, 3, 0, hits, 0, NULL), "tree");
  REFUSED(CALL(closest)(tree, NULL, 3, 0, hits, 0, NULL), "rays");
  REFUSED(CALL(closest)(tree, rays, 3, 0, NULL, 0, NULL), "hits");
  REFUSED(CALL(closest)(tree, rays, 3, short_ray, hits, 0, NULL), "rays");
  REFUSED(CALL(closest)(tree, rays, 3, 0, hits, short_hit, NULL), "hits");
  REFUSED(CALL(closest)(tree, rays, SIZE_MAX, 0, hits, 0, NULL), "address space");
  REFUSED(CALL(closest)(tree, rays, 3, SIZE_MAX, hits, 0, NULL), "address space");
  REFUSED(CALL(closest_crossing)(NULL, rays, 3, 0, hits, 0, NULL), "tree");
  REFUSED(CALL(closest_crossing)(tree, rays, 3, short_ray, hits, 0, NULL), "rays");
  REFUSED(CALL(closest_crossing)(tree, rays, 3, 0, NULL, 0, NULL), "hits");
  REFUSED(CALL(occluded)(NULL, rays, 3, 0, occluded, NULL), "tree");
  REFUSED(CALL(occluded)(tree, rays, 3, 1, occluded, NULL), "rays");
  REFUSED(CALL(occluded)(tree, rays, 3, 0, NULL, NULL), "occluded");
  REFUSED(CALL(closest1)(NULL, rays, hits, NULL), "tree");
  REFUSED(CALL(closest1)(tree, NULL, hits, NULL), "ray");
  REFUSED(CALL(closest1)(tree, rays, NULL, NULL), "hit");
  REFUSED(CALL(calls_create)(NULL, tree, NULL), "calls");
  REFUSED(CALL(calls_create)(&calls, NULL, NULL), "tree");
  EXPECT(calls == NULL);
  REFUSED(CALL(calls_closest)(NULL, rays, hits), "calls");
  REFUSED(CALL(calls_occluded)(NULL, rays, occluded), "calls");
  REFUSED(CALL(occluded1)(NULL, rays, occluded, NULL), "tree");
  REFUSED(CALL(occluded1)(tree, NULL, occluded, NULL), "ray");
  REFUSED(CALL(occluded1)(tree, rays, NULL, NULL), "occluded");
  REFUSED(CALL(all_hits)(tree, rays, 3, 0, NULL, NULL), "lists");
  REFUSED(CALL(all_hits)(NULL, rays, 3, 0, &lists, NULL), "tree");
  EXPECT(lists == NULL);
  REFUSED(CALL(all_hits)(tree, NULL, 3, 0, &lists, NULL), "rays");
  REFUSED(CALL(all_hits)(tree, rays, SIZE_MAX / sizeof *rays + 2, 0, &lists, NULL), "rays");
  REFUSED(CALL(crossings)(tree, rays, 3, 0, NULL, NULL), "lists");
  REFUSED(CALL(crossings)(NULL, rays, 3, 0, &lists, NULL), "tree");
  REFUSED(CALL(crossings)(tree, rays, 3, 5, &lists, NULL), "rays");
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
  REFUSED(CALL(occluded_from)(NULL, own, points, 3, 0, 0, 1, occluded, NULL), "tree");
  REFUSED(CALL(occluded_from)(tree, NULL, points, 3, 0, 0, 1, occluded, NULL), "from");
  REFUSED(CALL(occluded_from)(tree, own, NULL, 3, 0, 0, 1, occluded, NULL), "points");
  REFUSED(CALL(occluded_from)(tree, own, points, 3, 3 * sizeof *own - 1, 0, 1, occluded, NULL), "points");
  REFUSED(CALL(occluded_from)(tree, own, points, SIZE_MAX, 0, 0, 1, occluded, NULL), "address space");
  REFUSED(CALL(occluded_from)(tree, own, points, 3, 0, 0, 1, NULL, NULL), "occluded");
  REFUSED(CALL(occluded_from)(tree, own, own, 3, 0, 0, 1, within, NULL), "overlap");
  REFUSED(CALL(occluded_towards)(NULL, own, points, 3, 0, occluded, NULL), "tree");
  REFUSED(CALL(occluded_towards)(tree, NULL, points, 3, 0, occluded, NULL), "direction");
  REFUSED(CALL(occluded_towards)(tree, own, NULL, 3, 0, occluded, NULL), "points");
  REFUSED(CALL(occluded_towards)(tree, own, points, 3, 3 * sizeof *own - 1, occluded, NULL), "points");
  REFUSED(CALL(occluded_towards)(tree, own, points, 3, SIZE_MAX, occluded, NULL), "address space");
  REFUSED(CALL(occluded_towards)(tree, own, points, 3, 0, NULL, NULL), "occluded");
  REFUSED(CALL(occluded_towards)(tree, own, own, 3, 0, within, NULL), "overlap");
  EXPECT(occluded[0] == 7 && occluded[2] == 7 && own[8] == 7);
}

static void test_refused_points(const TREE* tree) {
  raylanes_point_options options = point_options(), wrong[4];
  const char* const words[4] = {"threads", "sse9", "options", "rule"};
  RECORD(closest_point) closest[4];
  NUMBER numbers[4];
  uint8_t locations[4];
  void* const odd = (char*)numbers + 1;
  size_t i;
  REFUSED(CALL(locate)(NULL, points, 3, 0, locations, NULL), "tree");
  REFUSED(CALL(locate)(tree, NULL, 3, 0, locations, NULL), "points");
  REFUSED(CALL(locate)(tree, points, 3, 0, NULL, NULL), "locations");
  REFUSED(CALL(closest_points)(NULL, points, 3, 0, closest, NULL), "tree");
  REFUSED(CALL(closest_points)(tree, points, 3, 2, closest, NULL), "points");
  REFUSED(CALL(closest_points)(tree, points, 3, 0, NULL, NULL), "closest");
  REFUSED(CALL(signed_distances)(NULL, points, 3, 0, numbers, NULL), "tree");
  REFUSED(CALL(signed_distances)(tree, points, SIZE_MAX, 0, numbers, NULL), "address space");
  REFUSED(CALL(signed_distances)(tree, points, 3, 0, odd, NULL), "distances");
  REFUSED(CALL(signed_distances)(tree, points, 3, 0, NULL, NULL), "distances");
  REFUSED(CALL(winding_numbers)(NULL, points, 3, 0, numbers, NULL), "tree");
  REFUSED(CALL(winding_numbers)(tree, NULL, 3, 0, numbers, NULL), "points");
  REFUSED(CALL(winding_numbers)(tree, points, 3, 0, NULL, NULL), "numbers");
  options.accuracy = -1;
  REFUSED(CALL(winding_numbers)(tree, points, 3, 0, numbers, &options), "accuracy");
  for (i = 0; i < 4; ++i) wrong[i] = point_options();
  wrong[0].threads = -1, wrong[1].path = "sse9", wrong[2].size = 0, wrong[3].rule = 4;
  for (i = 0; i < 4; ++i) {
    REFUSED(CALL(locate)(tree, points, 3, 0, locations, wrong + i), words[i]);
    REFUSED(CALL(signed_distances)(tree, points, 3, 0, numbers, wrong + i), words[i]);
    if (i == 3) continue;
    REFUSED(CALL(closest_points)(tree, points, 3, 0, closest, wrong + i), words[i]);
    REFUSED(CALL(winding_numbers)(tree, points, 3, 0, numbers, wrong + i), words[i]);
  }
}

// Corners and prepared calls, which trees alone have, for tree_test.h.

static void test_triangles(const TREE* tree) {
  const uint32_t named[3] = {0, RAYLANES_NO_PRIMITIVE, 3};
  NUMBER three[3][9], lo[3], hi[3];
  size_t i;
  GOOD(CALL(corners)(tree, named, 3, 0, three[0]));
  for (i = 0; i < 9; ++i) {
    EXPECT(three[0][i] == corners[3 * faces[i / 3] + i % 3]);
    EXPECT(three[1][i] != three[1][i]);
    EXPECT(three[2][i] == corners[3 * faces[9 + i / 3] + i % 3]);
  }
  GOOD(CALL(bounds)(tree, lo, hi));
  EXPECT(lo[0] == 0 && lo[1] == 0 && lo[2] == 0 && hi[0] == 1 && hi[1] == 1 && hi[2] == 1);
}

static void test_prepared_calls(const TREE* tree) {
  raylanes_ray_options options = ray_options();
  CALL(calls) * calls;
  RECORD(hit) hit, again;
  uint8_t occluded, is_occluded;
  size_t i;
  GOOD(CALL(calls_create)(&calls, tree, NULL));
  for (i = 0; i < 3; ++i) {
    GOOD(CALL(closest1)(tree, rays + i, &hit, NULL));
    GOOD(CALL(occluded1)(tree, rays + i, &occluded, NULL));
    GOOD(CALL(calls_closest)(calls, rays + i, &again));
    EXPECT(memcmp(&hit, &again, sizeof hit) == 0);
    GOOD(CALL(calls_occluded)(calls, rays + i, &is_occluded));
    EXPECT(is_occluded == occluded);
  }
  CALL(calls_destroy)(calls);
  CALL(calls_destroy)(NULL);
  options.filter = reject_hits;
  REFUSED(CALL(calls_create)(&calls, tree, &options), "filter");
  EXPECT(calls == NULL);
}

static void test_refused_triangles(const TREE* tree) {
  const uint32_t named[3] = {0, 1, 2};
  NUMBER nines[28];
  REFUSED(CALL(corners)(NULL, named, 3, 0, nines), "tree");
  REFUSED(CALL(corners)(tree, NULL, 3, 0, nines), "primitives");
  REFUSED(CALL(corners)(tree, named, 3, 3, nines), "primitives");
  REFUSED(CALL(corners)(tree, named, 3, 0, NULL), "corners");
  REFUSED(CALL(corners)(tree, named, 3, 0, (NUMBER*)(void*)((char*)nines + 1)), "corners");
}

static void test_refused_calls(const TREE* tree) {
  CALL(calls)* calls = (CALL(calls)*)(void*)faces;  // anything
  RECORD(hit) hit;
  uint8_t occluded;
  REFUSED(CALL(calls_create)(NULL, tree, NULL), "calls");
  REFUSED(CALL(calls_create)(&calls, NULL, NULL), "tree");
  EXPECT(calls == NULL);
  REFUSED(CALL(calls_closest)(NULL, rays, &hit), "calls");
  REFUSED(CALL(calls_occluded)(NULL, rays, &occluded), "calls");
}

static void test_masks(const TREE* tree) {
  // The floor, two walls, and the roof, which has no word.
  static const uint32_t words[3] = {1, 2, 4};
  raylanes_ray_options options = ray_options();
  struct reject floor = {0, 0, 0};
  RECORD(hit) hits[3], hit;
  raylanes_lists* lists = NULL;
  uint8_t occluded = 7;
  options.masks = words, options.mask_count = 3, options.mask = 6;
  GOOD(CALL(closest)(tree, rays, 3, 0, hits, 0, &options));
  EXPECT(hits[0].t == 1.5 && hits[0].primitive == 3 && isinf(hits[1].t) && isinf(hits[2].t));
  GOOD(CALL(occluded1)(tree, rays + 2, &occluded, &options));
  EXPECT(occluded == 0);
  GOOD(CALL(crossings)(tree, rays, 3, 0, &lists, &options));
  EXPECT(raylanes_lists_offsets(lists)[1] == 1);
  raylanes_lists_destroy(lists), lists = NULL;
  options.mask = 7, options.filter_mask = 6, options.filter = reject_hits, options.filter_context = &floor;
  GOOD(CALL(closest1)(tree, rays + 2, &hit, &options));
  EXPECT(hit.primitive == 0 && floor.calls == 0);
  GOOD(CALL(closest)(tree, rays, 3, 0, hits, 0, &options));
  EXPECT(hits[0].primitive == 3 && hits[2].primitive == 0 && floor.calls > 0);
  options.filter_mask = 1;
  GOOD(CALL(closest1)(tree, rays + 2, &hit, &options));
  EXPECT(isinf(hit.t));
  options.masks = NULL;
  REFUSED(CALL(closest)(tree, rays, 3, 0, hits, 0, &options), "masks");
}

// The queries of rays of one kind of tree or of scenes, for tree_test.h and scenes.c.

static void test_hits(const TREE* tree) {
  RECORD(hit) hits[3];
  unsigned char apart[3 * 41];
  uint8_t occluded[3];
  size_t i;
  GOOD(CALL(closest)(tree, rays, 3, 0, hits, 0, NULL));
  EXPECT(hits[0].t == 1.5 && hits[0].primitive == 3 && hits[0].u == 0.25 && hits[0].v == 0.5);
  EXPECT(isinf(hits[1].t) && hits[1].u == 0 && hits[1].v == 0 && hits[1].primitive == RAYLANES_NO_PRIMITIVE);
  EXPECT(hits[2].t == 0.25 && hits[2].primitive == 0);
  memset(apart, 0x5a, sizeof apart);
  GOOD(CALL(closest)(tree, rays, 3, sizeof *rays, apart, 41, NULL));
  for (i = 0; i < 3; ++i) {
    EXPECT(memcmp(apart + 41 * i, hits + i, sizeof *hits) == 0);
    EXPECT(apart[41 * i + 40] == 0x5a);
  }
  GOOD(CALL(occluded)(tree, rays, 3, 0, occluded, NULL));
  EXPECT(occluded[0] == 1 && occluded[1] == 0 && occluded[2] == 1);
  for (i = 0; i < 3; ++i) {
    RECORD(hit) hit;
    uint8_t is_occluded = 7;
    GOOD(CALL(closest1)(tree, rays + i, &hit, NULL));
    EXPECT(memcmp(&hit, hits + i, sizeof hit) == 0);
    GOOD(CALL(occluded1)(tree, rays + i, &is_occluded, NULL));
    EXPECT(is_occluded == occluded[i]);
    GOOD(CALL(closest_crossing1)(tree, rays + i, &hit, NULL));
    EXPECT(memcmp(&hit, hits + i, sizeof hit) == 0);
  }
  GOOD(CALL(closest_crossing)(tree, rays, 3, 0, hits, 0, NULL));
  EXPECT(hits[0].t == 1.5 && hits[1].primitive == RAYLANES_NO_PRIMITIVE && hits[2].t == 0.25);
}

static void expect_three(const uint8_t* bits, uint8_t a, uint8_t b, uint8_t c) {
  EXPECT(bits[0] == a && bits[1] == b && bits[2] == c);
}

static void test_shadows(const TREE* tree) {
  static const NUMBER above[3] = {0.25, 0.25, 2}, below[3] = {0.25, 0.25, -3},
                      within[3] = {0.125, 0.125, 0.25};
  static const NUMBER up[3] = {0, 0, 4}, down[3] = {0, 0, -0.5}, nowhere[3] = {0, 0, 0};
  RECORD(hit) floors[3];
  const uint8_t active = 5;
  raylanes_ray_options options = ray_options();
  unsigned char apart[1 + 3 * 29];
  uint8_t occluded[3];
  size_t i;
  memset(floors, 0, sizeof floors);
  floors[2].primitive = RAYLANES_NO_PRIMITIVE;
  GOOD(CALL(occluded_from)(tree, above, points, 3, 0, 0, 1, occluded, NULL));
  expect_three(occluded, 1, 1, 1);
  GOOD(CALL(occluded_from)(tree, below, points, 3, 0, 0, 1, occluded, NULL));
  expect_three(occluded, 1, 0, 1);
  GOOD(CALL(occluded_from)(tree, below, points, 3, 0, 0, 0.5, occluded, NULL));
  expect_three(occluded, 0, 0, 0);
  GOOD(CALL(occluded_from)(tree, below, points, 3, 0, 0.984375, 1, occluded, NULL));
  expect_three(occluded, 0, 0, 1);
  GOOD(CALL(occluded_from)(tree, points, points, 3, 0, 0, 1, occluded, NULL));
  expect_three(occluded, 0, 1, 1);
  GOOD(CALL(occluded_towards)(tree, up, points, 3, 0, occluded, NULL));
  expect_three(occluded, 1, 1, 1);
  GOOD(CALL(occluded_towards)(tree, down, points, 3, 0, occluded, NULL));
  expect_three(occluded, 1, 0, 1);
  GOOD(CALL(occluded_towards)(tree, nowhere, points, 3, 0, occluded, NULL));
  expect_three(occluded, 0, 0, 0);
  GOOD(CALL(occluded_from)(tree, up, NULL, 0, 0, 0, 1, NULL, NULL));
  GOOD(CALL(occluded_towards)(tree, up, NULL, 0, 0, NULL, NULL));

  // At any alignment.
  for (i = 0; i < 3; ++i) memcpy(apart + 1 + 29 * i, points + 3 * i, 3 * sizeof *points);
  GOOD(CALL(occluded_from)(tree, below, apart + 1, 3, 29, 0, 1, occluded, NULL));
  expect_three(occluded, 1, 0, 1);
  GOOD(CALL(occluded_towards)(tree, down, apart + 1, 3, 29, occluded, NULL));
  expect_three(occluded, 1, 0, 1);

  options.skip = &floors[0].primitive, options.skip_stride = sizeof *floors, options.threads = 2,
  options.path = "scalar";
  GOOD(CALL(occluded_from)(tree, below, points, 3, 0, 0, 1, occluded, &options));
  expect_three(occluded, 0, 0, 1);
  GOOD(CALL(occluded_towards)(tree, down, points, 3, 0, occluded, &options));
  expect_three(occluded, 0, 0, 1);
  // From within, the light sees the back of the floor.
  options = ray_options();
  options.facing = RAYLANES_FACING_BACK;
  GOOD(CALL(occluded_from)(tree, within, points, 2, 0, 0, 1, occluded, &options));
  EXPECT(occluded[1] == 1);
  options.facing = RAYLANES_FACING_FRONT;
  GOOD(CALL(occluded_from)(tree, within, points, 2, 0, 0, 1, occluded, &options));
  EXPECT(occluded[1] == 0);
  GOOD(CALL(occluded_towards)(tree, down, points, 2, 0, occluded, &options));
  EXPECT(occluded[0] == 0);
  options = ray_options();
  options.active = &active;
  memset(occluded, 7, sizeof occluded);
  GOOD(CALL(occluded_from)(tree, below, points, 3, 0, 0, 1, occluded, &options));
  expect_three(occluded, 1, 7, 1);
  GOOD(CALL(occluded_towards)(tree, nowhere, points, 3, 0, occluded, &options));
  expect_three(occluded, 0, 7, 0);
}

static void test_options_of_rays(const TREE* tree) {
  raylanes_ray_options options = ray_options();
  RECORD(hit) hits[3], again[3], hit;
  const uint8_t active = 4;
  uint8_t occluded[3] = {7, 7, 7};
  raylanes_lists* lists = NULL;
  GOOD(CALL(closest)(tree, rays, 3, 0, hits, 0, NULL));

  options.facing = RAYLANES_FACING_BACK;
  GOOD(CALL(closest)(tree, rays, 3, 0, again, 0, &options));
  EXPECT(again[0].t == 2 && again[0].primitive == 0 && again[2].t == 0.25);
  GOOD(CALL(closest1)(tree, rays, &hit, &options));
  EXPECT(hit.t == 2);
  GOOD(CALL(closest_crossing)(tree, rays, 3, 0, again, 0, &options));
  EXPECT(again[0].t == 2);
  options.facing = RAYLANES_FACING_FRONT;
  GOOD(CALL(occluded1)(tree, rays + 2, occluded, &options));
  EXPECT(occluded[0] == 0);

  options = ray_options();
  options.skip = &hits[0].primitive, options.skip_stride = sizeof *hits;
  options.threads = 0, options.path = "scalar";
  GOOD(CALL(closest)(tree, rays, 3, 0, again, 0, &options));
  EXPECT(again[0].t == 2 && again[1].primitive == RAYLANES_NO_PRIMITIVE && isinf(again[2].t));

  // Peeled: behind the first hit the second, and nothing behind a miss.
  options = ray_options();
  options.after = hits;
  GOOD(CALL(closest)(tree, rays, 3, 0, again, 0, &options));
  EXPECT(again[0].t == 2 && again[1].primitive == RAYLANES_NO_PRIMITIVE && isinf(again[2].t));
  GOOD(CALL(closest_crossing)(tree, rays, 3, 0, again, 0, &options));
  EXPECT(again[0].t == 2);
  options.after_stride = sizeof *hits;
  GOOD(CALL(closest_crossing1)(tree, rays, &hit, &options));
  EXPECT(hit.t == 2 && hit.primitive == 0);

  options = ray_options();
  options.active = &active;
  again[0] = again[1] = hits[2];
  occluded[0] = occluded[1] = 7;
  GOOD(CALL(closest)(tree, rays, 3, 0, again, 0, &options));
  EXPECT(again[0].t == 0.25 && again[1].t == 0.25 && again[2].t == 0.25);
  GOOD(CALL(occluded)(tree, rays, 3, 0, occluded, &options));
  EXPECT(occluded[0] == 7 && occluded[1] == 7 && occluded[2] == 1);

  options = ray_options();
  options.max_count = 1;
  GOOD(CALL(all_hits)(tree, rays, 3, 0, &lists, &options));
  EXPECT(raylanes_lists_offsets(lists)[1] == 1 && raylanes_lists_offsets(lists)[3] == 2);
  raylanes_lists_destroy(lists);

  // The members behind the size that is given have their defaults.
  options.size = 16, options.facing = RAYLANES_FACING_BACK, options.path = "unread";
  GOOD(CALL(closest1)(tree, rays, &hit, &options));
  EXPECT(hit.t == 2);
}

static void test_lists(const TREE* tree) {
  raylanes_lists* lists = NULL;
  const size_t* offsets;
  const RECORD(hit) * hits;
  const RECORD(crossing) * crossings;
  raylanes_crossing_count counts[3];
  GOOD(CALL(all_hits)(tree, rays, 3, 0, &lists, NULL));
  offsets = raylanes_lists_offsets(lists);
  hits = raylanes_lists_items(lists);
  EXPECT(offsets[0] == 0 && offsets[1] == 2 && offsets[2] == 2 && offsets[3] == 3);
  EXPECT(hits[0].t == 1.5 && hits[0].primitive == 3 && hits[1].t == 2 && hits[1].primitive == 0);
  EXPECT(hits[2].t == 0.25);
  raylanes_lists_destroy(lists);
  GOOD(CALL(crossings)(tree, rays, 3, 0, &lists, NULL));
  offsets = raylanes_lists_offsets(lists);
  crossings = raylanes_lists_items(lists);
  EXPECT(offsets[1] == 2 && offsets[2] == 2 && offsets[3] == 3);
  EXPECT(crossings[0].t == 1.5 && crossings[0].side == -1 && crossings[0].primitive == 3);
  EXPECT(crossings[1].t == 2 && crossings[1].side == 1 && crossings[2].side == 1);
  raylanes_lists_destroy(lists);
  GOOD(CALL(count_crossings)(tree, rays, 3, 0, counts, NULL));
  EXPECT(counts[0].crossings == 2 && counts[0].winding == 0 && counts[1].crossings == 0);
  EXPECT(counts[2].crossings == 1 && counts[2].winding == 1);
  raylanes_lists_destroy(NULL);
  EXPECT(raylanes_lists_offsets(NULL) == NULL && raylanes_lists_items(NULL) == NULL);
}

static void test_functions_of_rays(const TREE* tree) {
  raylanes_ray_options options = ray_options();
  struct reject roof = {3, 0, 0}, stop = {3, 0, 1};
  double told[2] = {0, 2}, at_once[2] = {0, 0};
  RECORD(hit) hits[3], hit;
  uint8_t occluded[3];
  raylanes_lists* lists = NULL;
  raylanes_crossing_count counts[3];
  options.filter = reject_hits, options.filter_context = &roof;
  GOOD(CALL(closest)(tree, rays, 3, 0, hits, 0, &options));
  EXPECT(hits[0].t == 2 && hits[0].primitive == 0 && isinf(hits[1].t) && hits[2].t == 0.25);
  EXPECT(roof.calls > 0);
  GOOD(CALL(closest1)(tree, rays, &hit, &options));
  EXPECT(memcmp(&hit, hits, sizeof hit) == 0);
  roof.primitive = 0;
  GOOD(CALL(occluded)(tree, rays, 3, 0, occluded, &options));
  expect_three(occluded, 1, 0, 0);
  GOOD(CALL(occluded1)(tree, rays + 2, occluded, &options));
  EXPECT(occluded[0] == 0);
  GOOD(CALL(occluded_from)(tree, points + 3, points, 3, 0, 0, 1, occluded, &options));
  expect_three(occluded, 0, 0, 0);
  GOOD(CALL(occluded_towards)(tree, points + 3, points, 3, 0, occluded, &options));
  EXPECT(occluded[0] == 0);
  options.filter_context = &stop;
  FAILS(CALL(closest)(tree, rays, 3, 0, hits, 0, &options), RAYLANES_CANCELLED, "ended the call");
  stop.calls = 0;
  FAILS(CALL(closest1)(tree, rays, &hit, &options), RAYLANES_CANCELLED, "ended the call");
  stop.calls = 0;
  FAILS(CALL(occluded1)(tree, rays, occluded, &options), RAYLANES_CANCELLED, "ended the call");
  REFUSED(CALL(closest_crossing)(tree, rays, 3, 0, hits, 0, &options), "filter");
  REFUSED(CALL(closest_crossing1)(tree, rays, &hit, &options), "filter");
  REFUSED(CALL(all_hits)(tree, rays, 3, 0, &lists, &options), "filter");
  REFUSED(CALL(crossings)(tree, rays, 3, 0, &lists, &options), "filter");
  REFUSED(CALL(count_crossings)(tree, rays, 3, 0, counts, &options), "filter");

  options = ray_options();
  options.progress = tell_progress, options.progress_context = told;
  GOOD(CALL(closest)(tree, rays, 3, 0, hits, 0, &options));
  EXPECT(told[0] == 1 && hits[0].t == 1.5);
  told[0] = 0;
  GOOD(CALL(crossings)(tree, rays, 3, 0, &lists, &options));
  EXPECT(told[0] == 1);
  raylanes_lists_destroy(lists);
  options.progress_context = at_once;
  FAILS(CALL(occluded)(tree, rays, 3, 0, occluded, &options), RAYLANES_CANCELLED, "ended the call");
  FAILS(CALL(all_hits)(tree, rays, 3, 0, &lists, &options), RAYLANES_CANCELLED, "ended the call");
  EXPECT(lists == NULL);
  GOOD(CALL(closest1)(tree, rays, &hit, &options));  // of batches
}

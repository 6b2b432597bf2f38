// Triangles of one kind of tree, and its queries of points, for tree_test.h.

static raylanes_point_options point_options(void) {
  raylanes_point_options options;
  GOOD(raylanes_init_point_options(&options, sizeof options));
  return options;
}

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

static int is_near(double a, double b) {
  return fabs(a - b) <= 1e-6;
}

static void test_points(const TREE* tree) {
  raylanes_point_options options = point_options();
  RECORD(closest_point) closest[3];
  NUMBER distances[3], numbers[3];
  uint8_t locations[3], active = 2;
  int32_t rule;
  for (rule = 0; rule < 4; ++rule) {
    options.rule = rule;
    memset(locations, 7, sizeof locations);
    GOOD(CALL(locate)(tree, points, 3, 0, locations, &options));
    EXPECT(locations[0] == RAYLANES_INSIDE && locations[1] == RAYLANES_OUTSIDE &&
           locations[2] == RAYLANES_ON);
  }
  GOOD(CALL(closest_points)(tree, points, 3, 0, closest, NULL));
  EXPECT(closest[0].distance_squared == 0.015625 && closest[1].distance_squared == 4);
  EXPECT(closest[1].primitive == 0 && closest[1].point[0] == 0.25 && closest[1].point[2] == 0);
  EXPECT(closest[2].distance_squared == 0);
  GOOD(CALL(signed_distances)(tree, points, 3, 0, distances, NULL));
  EXPECT(distances[0] == -0.125 && distances[1] == 2 && distances[2] == 0);
  GOOD(CALL(winding_numbers)(tree, points, 3, 0, numbers, NULL));
  EXPECT(numbers[0] == 1 && numbers[1] == 0 && is_near(numbers[2], 0.5));

  options = point_options();
  options.max_distance = 1, options.accuracy = 0, options.threads = 2, options.path = "scalar";
  GOOD(CALL(closest_points)(tree, points, 3, 0, closest, &options));
  EXPECT(closest[1].primitive == RAYLANES_NO_PRIMITIVE && isinf(closest[1].distance_squared));
  GOOD(CALL(signed_distances)(tree, points, 3, 0, distances, &options));
  EXPECT(distances[0] == -0.125 && isinf(distances[1]) && distances[1] > 0);
  GOOD(CALL(winding_numbers)(tree, points, 3, 0, numbers, &options));
  EXPECT(numbers[0] == 1);
  // Every second point, and the second of three.
  GOOD(CALL(locate)(tree, points, 2, 2 * 3 * sizeof *points, locations, NULL));
  EXPECT(locations[0] == RAYLANES_INSIDE && locations[1] == RAYLANES_ON);
  options = point_options();
  options.active = &active;
  memset(locations, 7, sizeof locations);
  GOOD(CALL(locate)(tree, points, 3, 0, locations, &options));
  EXPECT(locations[0] == 7 && locations[1] == RAYLANES_OUTSIDE && locations[2] == 7);
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

static void test_progress_of_points(const TREE* tree) {
  raylanes_point_options options = point_options();
  double told[2] = {0, 2}, at_once[2] = {0, 0};
  RECORD(closest_point) closest[3];
  NUMBER numbers[3];
  uint8_t locations[3];
  options.progress = tell_progress, options.progress_context = told;
  GOOD(CALL(locate)(tree, points, 3, 0, locations, &options));
  EXPECT(told[0] == 1);
  told[0] = 0;
  GOOD(CALL(closest_points)(tree, points, 3, 0, closest, &options));
  EXPECT(told[0] == 1);
  options.progress_context = at_once;
  FAILS(CALL(signed_distances)(tree, points, 3, 0, numbers, &options), RAYLANES_CANCELLED, "ended the call");
  FAILS(CALL(winding_numbers)(tree, points, 3, 0, numbers, &options), RAYLANES_CANCELLED, "ended the call");
}

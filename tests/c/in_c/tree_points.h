// The queries of points of one kind of tree or of scenes, for tree_test.h and scenes.c.

static raylanes_point_options point_options(void) {
  raylanes_point_options options;
  GOOD(raylanes_init_point_options(&options, sizeof options));
  return options;
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

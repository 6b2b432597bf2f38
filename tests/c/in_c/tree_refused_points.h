// Calls with points that are refused, of one kind of tree or of scenes, for tree_test.h and scenes.c.

static void test_refused_points(const TREE* tree) {
  raylanes_point_options options = point_options(), wrong[4];
  const char* const words[4] = {"threads", "sse9", "options", "rule"};
  RECORD(closest_point) closest[4];
  NUMBER numbers[4];
  uint8_t locations[4];
  void* const odd = (char*)numbers + 1;
  size_t i;
  REFUSED(CALL(locate)(NULL, points, 3, 0, locations, NULL), KIND);
  REFUSED(CALL(locate)(tree, NULL, 3, 0, locations, NULL), "points");
  REFUSED(CALL(locate)(tree, points, 3, 0, NULL, NULL), "locations");
  REFUSED(CALL(closest_points)(NULL, points, 3, 0, closest, NULL), KIND);
  REFUSED(CALL(closest_points)(tree, points, 3, 2, closest, NULL), "points");
  REFUSED(CALL(closest_points)(tree, points, 3, 0, NULL, NULL), "closest");
  REFUSED(CALL(signed_distances)(NULL, points, 3, 0, numbers, NULL), KIND);
  REFUSED(CALL(signed_distances)(tree, points, SIZE_MAX, 0, numbers, NULL), "address space");
  REFUSED(CALL(signed_distances)(tree, points, 3, 0, odd, NULL), "distances");
  REFUSED(CALL(signed_distances)(tree, points, 3, 0, NULL, NULL), "distances");
  REFUSED(CALL(winding_numbers)(NULL, points, 3, 0, numbers, NULL), KIND);
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

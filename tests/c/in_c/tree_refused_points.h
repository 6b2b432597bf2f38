// Calls of one kind of tree alone that are refused, for tree_test.h.

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

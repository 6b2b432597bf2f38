// ISA paths, options and roots in C.
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "check.h"

void test_paths(void) {
  const char *name = "unchanged", *active;
  int32_t is_supported = -1;
  GOOD(raylanes_path_at(0, &name, &is_supported));
  EXPECT(strcmp(name, "scalar") == 0 && is_supported == 1);
  REFUSED(raylanes_path_at(raylanes_path_count(), &name, &is_supported), "path");
  REFUSED(raylanes_path_at(SIZE_MAX, &name, &is_supported), "path");
  REFUSED(raylanes_path_at(0, NULL, &is_supported), "name");
  REFUSED(raylanes_path_at(0, &name, NULL), "is_supported");
  EXPECT(strcmp(name, "scalar") == 0);

  GOOD(raylanes_active_path(&active));
  REFUSED(raylanes_active_path(NULL), "name");
  GOOD(raylanes_force_path("scalar"));
  GOOD(raylanes_active_path(&name));
  EXPECT(strcmp(name, "scalar") == 0);
  REFUSED(raylanes_force_path("sse9"), "sse9");
  GOOD(raylanes_force_path(NULL));
  GOOD(raylanes_active_path(&name));
  EXPECT(strcmp(name, active) == 0);
}

void test_options(void) {
  raylanes_build_options build;
  raylanes_ray_options rays;
  raylanes_point_options points;
  GOOD(raylanes_init_build_options(&build, sizeof build));
  EXPECT(build.size == sizeof build && build.builder == RAYLANES_BUILDER_BINNED_SAH && build.threads == 1);
  EXPECT(build.optimize == 0 && build.choose == 0 && build.rays == 0);
  GOOD(raylanes_init_ray_options(&rays, sizeof rays));
  EXPECT(rays.size == sizeof rays && rays.threads == 1 && rays.facing == RAYLANES_FACING_ANY);
  EXPECT(rays.path == NULL && rays.active == NULL && rays.skip == NULL && rays.skip_stride == 0);
  EXPECT(rays.max_count == SIZE_MAX);
  GOOD(raylanes_init_point_options(&points, sizeof points));
  EXPECT(points.size == sizeof points && points.threads == 1 && points.rule == RAYLANES_RULE_PARITY);
  EXPECT(points.path == NULL && points.active == NULL && points.accuracy == 1e-6);
  EXPECT(isinf(points.max_distance) && points.max_distance > 0);

  // Programs of an earlier version have smaller structs: nothing is written behind them.
  memset(&rays, 0x5a, sizeof rays);
  GOOD(raylanes_init_ray_options(&rays, 16));
  EXPECT(rays.size == 16 && rays.threads == 1 && rays.facing == 0);
  EXPECT(*(const unsigned char*)&rays.path == 0x5a);

  REFUSED(raylanes_init_build_options(NULL, sizeof build), "options");
  REFUSED(raylanes_init_ray_options(NULL, sizeof rays), "options");
  REFUSED(raylanes_init_point_options(NULL, sizeof points), "options");
  REFUSED(raylanes_init_build_options(&build, sizeof build + 8), "options");
  REFUSED(raylanes_init_ray_options(&rays, sizeof rays + 8), "options");
  REFUSED(raylanes_init_point_options(&points, sizeof points - 4), "options");
  REFUSED(raylanes_init_build_options(&build, 0), "options");
  REFUSED(raylanes_init_ray_options(&rays, 4), "options");
}

static void test_roots_of_floats(void) {
  const float x[4] = {4, 0.25f, 0, -1};
  float y[4];
  const void* const odd = (const char*)x + 1;
  GOOD(raylanes_sqrt(x, y, 4, RAYLANES_CORRECTLY_ROUNDED, NULL));
  EXPECT(y[0] == 2 && y[1] == 0.5f && y[2] == 0 && isnan(y[3]));
  GOOD(raylanes_rsqrt(x, y, 3, RAYLANES_CORRECTLY_ROUNDED, "scalar"));
  EXPECT(y[0] == 0.5f && y[1] == 2 && isinf(y[2]));
  GOOD(raylanes_reciprocal(x, y, 2, RAYLANES_WITHIN_2_TO_MINUS_4, NULL));
  EXPECT(fabsf(y[0] - 0.25f) <= 0.25f / 16 && fabsf(y[1] - 4) <= 4.0f / 16);
  GOOD(raylanes_sqrt(NULL, NULL, 0, RAYLANES_WITHIN_1_ULP, NULL));
  y[0] = 7;
  REFUSED(raylanes_sqrt(NULL, y, 1, 0, NULL), "x");
  REFUSED(raylanes_rsqrt(x, NULL, 1, 0, NULL), "y");
  REFUSED(raylanes_sqrt(odd, y, 1, 0, NULL), "x");
  REFUSED(raylanes_reciprocal(x, y, SIZE_MAX, 0, NULL), "address space");
  REFUSED(raylanes_reciprocal(x, y, (size_t)PTRDIFF_MAX / 4 + 1, 0, NULL), "address space");
  REFUSED(raylanes_sqrt(x, y, 1, 8, NULL), "accuracy");
  REFUSED(raylanes_sqrt(x, y, 1, -1, NULL), "accuracy");
  REFUSED(raylanes_rsqrt(x, y, 1, 256, NULL), "accuracy");
  REFUSED(raylanes_reciprocal(x, y, 1, 0, ""), "path");
  EXPECT(y[0] == 7);
}

static void test_roots_of_doubles(void) {
  const double x[3] = {4, 0.25, 0};
  double y[3];
  GOOD(raylanes_sqrtd(x, y, 3, RAYLANES_CORRECTLY_ROUNDED, NULL));
  EXPECT(y[0] == 2 && y[1] == 0.5 && y[2] == 0);
  GOOD(raylanes_rsqrtd(x, y, 3, RAYLANES_WITHIN_1_ULP, NULL));
  EXPECT(fabs(y[0] - 0.5) <= 0x1p-53 && fabs(y[1] - 2) <= 0x1p-51 && isinf(y[2]));
  GOOD(raylanes_reciprocald(x, y, 3, RAYLANES_CORRECTLY_ROUNDED, "scalar"));
  EXPECT(y[0] == 0.25 && y[1] == 4 && isinf(y[2]));
  REFUSED(raylanes_rsqrtd(x, y, 3, RAYLANES_CORRECTLY_ROUNDED, NULL), "rsqrt");
  REFUSED(raylanes_sqrtd(x, y, (size_t)PTRDIFF_MAX / 8 + 1, 0, NULL), "address space");
  REFUSED(raylanes_rsqrtd(NULL, y, 3, RAYLANES_WITHIN_1_ULP, NULL), "x");
  REFUSED(raylanes_reciprocald(x, NULL, 3, RAYLANES_WITHIN_1_ULP, NULL), "y");
}

static void test_accuracies(void) {
  int32_t accuracy = -1;
  GOOD(raylanes_accuracy_within(1e-7, &accuracy));
  EXPECT(accuracy == RAYLANES_CORRECTLY_ROUNDED);
  GOOD(raylanes_accuracy_withind(1e-7, &accuracy));
  EXPECT(accuracy == RAYLANES_WITHIN_2_TO_MINUS_44);
  REFUSED(raylanes_accuracy_within(1e-8, &accuracy), "5.960464477539063e-08");
  REFUSED(raylanes_accuracy_withind(NAN, &accuracy), "nan");
  REFUSED(raylanes_accuracy_within(1, NULL), "accuracy");
  EXPECT(accuracy == RAYLANES_WITHIN_2_TO_MINUS_44);
}

void test_roots(void) {
  test_roots_of_floats();
  test_roots_of_doubles();
  test_accuracies();
}

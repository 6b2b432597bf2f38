// The mesh, rays and options of the tests in C, for the file that includes this and names a kind.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

// Three corners at distance 1 on the axes, and the origin; normals point out.
static const NUMBER corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
// Down through the tetrahedron, past it, and down again from within, which leaves only.
static const RECORD(ray) rays[3] = {{{0.25, 0.25, 2}, 0, {0, 0, -1}, INFINITY},
                                    {{2, 2, 2}, 0, {0, 0, -1}, INFINITY},
                                    {{0.25, 0.25, 0.25}, 0, {0, 0, -1}, INFINITY}};
// Inside, outside, on the floor.
static const NUMBER points[9] = {0.125, 0.125, 0.125, 0.25, 0.25, -2, 0.25, 0.25, 0};

static raylanes_ray_options ray_options(void) {
  raylanes_ray_options options;
  GOOD(raylanes_init_ray_options(&options, sizeof options));
  return options;
}

// Rejects the hits of one primitive, and counts its calls; ends the call where the count comes to `last`.
struct reject {
  uint32_t primitive;
  int calls, last;
};
static int32_t reject_hits(void* context, size_t n, const size_t* indices, const void* hits,
                           uint8_t* rejected) {
  struct reject* const state = context;
  size_t k;
  for (k = 0; k < n; ++k) {
    EXPECT(indices[k] < 3 && rejected[k] == 0);
    rejected[k] = ((const RECORD(hit)*)hits)[k].primitive == state->primitive;
  }
  return ++state->calls == state->last;
}
static int32_t tell_progress(void* context, double share) {
  double* const state = context;
  EXPECT(share >= state[0]);
  state[0] = share;
  return share >= state[1];
}

static void expect_tetrahedron(const TREE* tree) {
  RECORD(hit) hit;
  GOOD(CALL(closest1)(tree, rays, &hit, NULL));
  EXPECT(hit.t == 1.5 && hit.primitive == 3);
}

// The declarations that the pages' blocks of statements use, in place of a reader's own program.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <vector>

#include <raylanes/raylanes.hpp>

// A tetrahedron, rays down on it, and points around it.
struct Given {
  std::vector<raylanes::Float3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<raylanes::Index3> triangles{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  raylanes::Mesh mesh{vertices, triangles};
  std::vector<raylanes::Ray> rays =
      std::vector<raylanes::Ray>(100, {.origin = {0.25f, 0.25f, 2}, .direction = {0, 0, -1}});
  std::vector<raylanes::Hit> hits = std::vector<raylanes::Hit>(rays.size());
  std::vector<std::uint8_t> dark = std::vector<std::uint8_t>(rays.size());
  std::vector<raylanes::Float3> points{{0.1f, 0.1f, 0.1f}, {2, 2, 2}, {0, 0, 0}};
  raylanes::Bvh bvh{vertices, triangles};
  raylanes::Float3 light{1, 2, 3};
  std::vector<raylanes::Ray> shadow_rays = rays;  // and where each of them begins
  std::vector<raylanes::Hit> from = hits;
  using Hit = raylanes::Hit;
  std::stringstream file;

  static void move(std::vector<raylanes::Float3>& corners) {
    for (raylanes::Float3& corner : corners) corner[0] += 0.125f;
  }
};

struct Row {
  const char* name;
  int (*run)(int, char**);
};

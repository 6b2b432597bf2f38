#include "box_cases.hpp"

#include "../support/random_input.hpp"

namespace raylanes::testing {

namespace {

constexpr float largest = 0x1.fffffep127f;

const BoxCase cases[] = {
    {"through a flat box", make_ray({0, 0, 2}, {0, 0, -1}), {{-1, -1, 0}, {1, 1, 0}}, true},
    {"in the plane of a flat box", make_ray({-2, 0, 0}, {1, 0, 0}), {{-1, -1, 0}, {1, 1, 0}}, true},
    {"beside the plane of a flat box", make_ray({-2, 0, 1}, {1, 0, 0}), {{-1, -1, 0}, {1, 1, 0}}, false},
    {"through a box that is a line", make_ray({0, 1, 2}, {0, 0, -1}), {{-1, 1, 0}, {1, 1, 0}}, true},
    {"along a box that is a line", make_ray({-2, 1, 0}, {1, 0, 0}), {{-1, 1, 0}, {1, 1, 0}}, true},
    {"through a point", make_ray({-1, -2, -3}, {1, 2, 3}), {{1, 2, 3}, {1, 2, 3}}, true},
    {"past a point", make_ray({-1, -2, -3}, {1, 2, 3}), {{1, 2, 4}, {1, 2, 4}}, false},
    {"from a point box", make_ray({1, 2, 3}, {1, 0, 0}), {{1, 2, 3}, {1, 2, 3}}, true},
    {"through a corner", make_ray({-3, 1, 1}, {1, 0, 0}), unit_box, true},
    {"through a corner aslant", make_ray({3, -1, -1}, {-2, 2, 2}), unit_box, true},
    {"past a corner aslant", make_ray({3, -0.5f, -1}, {-2, 2, 2}, 0), {{-1, -1, -1}, {1, 1, 0.5f}}, false},
    {"along an edge", make_ray({1, 1, -5}, {0, -0.0f, 1}), unit_box, true},
    {"the empty box",
     make_ray({0, 0, 0}, {1, 1, 1}),
     {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}},
     false},
    {"a box inverted on x", make_ray({0, 0, 0}, {1, 1, 1}), {{1, -1, -1}, {-1, 1, 1}}, false},
    {"a box inverted on z, ray along x", make_ray({0, 0, 0}, {1, 0, 0}), {{-1, -1, 1}, {1, 1, -1}}, false},
    {"the infinite box",
     make_ray({5, 6, 7}, {1, 0, -1}),
     {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}},
     true},
    {"a half-infinite box, inwards", make_ray({-5, 0, 0}, {1, 0, 0}), {{0, -1, -1}, {infinity, 1, 1}}, true},
    {"a half-infinite box, outwards",
     make_ray({-5, 0, 0}, {-1, 0, 0}),
     {{0, -1, -1}, {infinity, 1, 1}},
     false},
    {"an infinite slab, still in it",
     make_ray({0, 0, 5}, {0, 0, -1}),
     {{-infinity, -infinity, -1}, {infinity, infinity, 1}},
     true},
    {"behind", make_ray({0, 0, 5}, {0, 0, 1}), unit_box, false},
    {"tmin inside", make_ray({0, 0, 5}, {0, 0, -1}, 5), unit_box, true},
    {"tmax before the box", make_ray({0, 0, 5}, {0, 0, -1}, 0, 3.5f), unit_box, false},
    {"tmax at the entry", make_ray({0, 0, 5}, {0, 0, -1}, 0, 4), unit_box, true},
    {"tmin at the entry", make_ray({0, 0, 5}, {0, 0, -1}, 4), unit_box, true},
    {"tmin at the exit", make_ray({0, 0, 5}, {0, 0, -1}, 6), unit_box, true},
    {"tmin behind the box", make_ray({0, 0, 5}, {0, 0, -1}, 6.5f), unit_box, false},
    {"tmin > tmax in the box", make_ray({0, 0, 5}, {0, 0, -1}, 5.5f, 5), unit_box, false},
    {"tmin is NaN", make_ray({0, 0, 5}, {0, 0, -1}, nan), unit_box, false},
    {"tmax is NaN", make_ray({0, 0, 5}, {0, 0, -1}, 0, nan), unit_box, false},
    {"no direction", make_ray({0, 0, 0}, {0, -0.0f, 0}), unit_box, false},
    {"the largest numbers",
     make_ray({-0x1.fffffep127f, 0, 0}, {1, 0, 0}),
     {{0x1.fffffep127f, -1, -1}, {0x1.fffffep127f, 1, 1}},
     true,
     true},
    {"the largest box, from its corner",
     make_ray({-largest, -largest, -largest}, {1, 1, 1}),
     {{-largest, -largest, -largest}, {largest, largest, largest}},
     true,
     true},
    {"the largest box, from the middle",
     make_ray({0, 0, 0}, {1, 0, -0.5f}),
     {{-largest, -largest, -largest}, {largest, largest, largest}},
     true,
     true},
    {"beside, from the largest number", make_ray({largest, 0, 0}, {0, 1, 0}), unit_box, false, true},
    {"behind, from the largest number", make_ray({largest, 0, 0}, {1, 0, 0}), unit_box, false, true},
    {"beside on x", make_ray({3, 0, 5}, {0, 0, -1}), unit_box, false},
    {"beside on y", make_ray({0, 3, 5}, {0, 0, -1}), unit_box, false},
    {"beside, aslant", make_ray({5, 0, 0}, {-1, 1, 0}), unit_box, false},
    {"from inside", make_ray({0, 0, 0}, {0, 0, -1}), unit_box, true},
    {"a flat box, aslant", make_ray({0, 0, 5}, {0.1f, 0, -1}), {{-1, -1, 0}, {1, 1, 0}}, true},
    {"inverted on z, ray along z", make_ray({0, 0, 0}, {0, 0, 1}), {{-1, -1, 1}, {1, 1, -1}}, false},
    {"inverted on x, ray along z", make_ray({0, 0, 0}, {0, 0, 1}), {{1, -1, -1}, {-1, 1, 1}}, false},
    {"still in a box of a small number",
     make_ray({0, 0, 5}, {0, 0, -1}),
     {{-1e-20f, 0, -1}, {1e-20f, 0, 1}},
     true},
    {"both ends in the box", make_ray({0, 0, 5}, {0, 0, -1}, 5, 5), unit_box, true},
    {"both ends NaN", make_ray({0, 0, 5}, {0, 0, -1}, nan, nan), unit_box, false},
};

constexpr float places[] = {-2, -1, 0.5f, 1, 2};
constexpr float speeds[] = {1,      -1,      0.0f,      -0.0f,    0x1p-149f, -0x1p-149f,
                            1e-30f, -1e-30f, 0x1p-126f, infinity, -infinity, nan};

}  // namespace

std::span<const BoxCase> box_cases() {
  return cases;
}

std::vector<Ray> rays_of_one_axis(int axis, const AxisState& next, const AxisState& last) {
  std::vector<Ray> rays;
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  for (const float place : places)
    for (const float speed : speeds) {
      Ray ray = make_ray({0, 0, 0}, {0, 0, 0});
      ray.origin[axis] = place, ray.direction[axis] = speed;
      ray.origin[b] = next.origin, ray.direction[b] = next.direction;
      ray.origin[c] = last.origin, ray.direction[c] = last.direction;
      rays.push_back(ray);
    }
  return rays;
}

}  // namespace raylanes::testing

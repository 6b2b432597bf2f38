// All triangle forms in scenes of any size and place, with directions of any length.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/random_input.hpp"
#include "answers.hpp"
#include "judge.hpp"
#include "scenes.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<TriangleResult>;

// A triangle of about `scale` and unit directions that pass it well inside or well outside.
TriangleScene scene_of_size(double scale, bool inside, Random& random) {
  const auto size = static_cast<float>(scale);
  TriangleScene scene{{},
                      {make_triangle({-size, -size, size / 8}, {size, -size / 2, 0}, {0, size, -size / 4})}};
  for (int i = 0; i < 8; ++i) {
    const Float3 origin{random.number(-size / 2, size / 2), random.number(-size / 2, size / 2), size};
    const double u = inside ? random.real(0.2, 0.4) : random.real(1.2, 1.5);
    const Ray ray = ray_to(origin, scene.triangles[0], u, inside ? 0.3 : -0.3, 1 / scale);
    const double length = std::hypot(ray.direction[0], ray.direction[1], ray.direction[2]);
    Float3 direction;
    for (std::size_t k = 0; k < 3; ++k) direction[k] = static_cast<float>(ray.direction[k] / length);
    scene.rays.push_back(make_ray(origin, direction));
  }
  return scene;
}

// Decides on products of four lengths where the others have three.
bool is_plane_edges(TriangleForm form) {
  return form == TriangleForm::plane_edges_plain || form == TriangleForm::plane_edges;
}

// What flushing adds to the error of t: six products in its numerator, each less than 2^-126, over det.
void allow_flushing(TriangleJudgement& judgement) {
  if (judgement.t) *judgement.t += 6 * 0x1p-126 / std::fabs(judgement.exact.det.get_d());
}

void expect_right(TriangleForm form, const TriangleScene& scene, FloatMode mode,
                  const std::vector<TriangleJudgement>& judgements) {
  for (const FormVariant& variant : all_variants<TriangleForm>()) {
    if (variant.test != form) continue;
    const Results results = answers(variant, scene.rays, scene.triangles, mode);
    for (std::size_t i = 0; i < results.size(); ++i)
      EXPECT_EQ(fault(results[i], scene.ray(i), judgements[i]), "")
          << variant.name() << ' ' << name_of(mode) << " pair " << i << " t " << results[i].t;
  }
}

class TriangleScales : public ::testing::TestWithParam<TriangleForm> {};

TEST_P(TriangleScales, all_usable_ones_are_decided_right) {
  const TriangleForm form = GetParam();
  for (int exponent = -12; exponent <= 12; ++exponent) {
    SCOPED_TRACE("10^" + std::to_string(exponent));
    if (is_plane_edges(form) && std::abs(exponent) > 8) continue;
    Random random(113);
    for (const bool inside : {true, false}) {
      const TriangleScene scene = scene_of_size(std::pow(10.0, exponent), inside, random);
      std::vector<TriangleJudgement> judgements;
      for (std::size_t i = 0; i < scene.size(); ++i) {
        judgements.push_back(judge(form, scene.ray(i), scene.triangle(i)));
        EXPECT_EQ(judgements.back().decision, inside ? oracle::Class::must_hit : oracle::Class::must_miss);
      }
      expect_right(form, scene, FloatMode::ieee, judgements);
      for (TriangleJudgement& judgement : judgements) allow_flushing(judgement);
      expect_right(form, scene, FloatMode::flush, judgements);
    }
  }
}

// Not plane_edges, whose products of four lengths mean nothing there.
class BeyondTriangleScales : public ::testing::TestWithParam<TriangleForm> {};

TEST_P(BeyondTriangleScales, nothing_is_hit_that_is_passed) {
  for (const double scale : {1e-14, 1e14})
    for (const FloatMode mode : float_modes) {
      Random random(114);
      const TriangleScene scene = scene_of_size(scale, false, random);
      // Flushed to 0, its n·s puts the plane at the ray's origin: a hit at t = 0.
      if (GetParam() == TriangleForm::precomputed && scale < 1 && mode == FloatMode::flush) continue;
      for (const FormVariant& variant : all_variants<TriangleForm>())
        if (variant.test == GetParam()) {
          EXPECT_EQ(answers(variant, scene.rays, scene.triangles, mode),
                    Results(scene.size(), triangle_missed))
              << variant.name() << ' ' << name_of(mode) << ' ' << scale;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, BeyondTriangleScales,
                         ::testing::Values(TriangleForm::moller_trumbore, TriangleForm::moller_trumbore_edges,
                                           TriangleForm::watertight, TriangleForm::precomputed,
                                           TriangleForm::directional),
                         [](const auto& form) { return name_of(form.param); });

TEST_P(TriangleScales, directions_of_any_usable_length_are_decided_right) {
  Random random(115);
  for (const double length : {1e-30, 1e-18, 1e18, 1e30}) {
    SCOPED_TRACE(length);
    TriangleScene scene = scene_of_size(1, true, random);
    for (Ray& ray : scene.rays)
      for (float& d : ray.direction) d *= static_cast<float>(length);
    std::vector<TriangleJudgement> judgements;
    for (std::size_t i = 0; i < scene.size(); ++i) {
      judgements.push_back(judge(GetParam(), scene.ray(i), scene.triangle(i)));
      EXPECT_EQ(judgements.back().decision, oracle::Class::must_hit);
    }
    for (const FloatMode mode : float_modes) expect_right(GetParam(), scene, mode, judgements);
  }
}

struct Offset {
  const char* name;
  Float3 centre;
  double least_on_planes;  // the least share that plane_edges decides
};
constexpr Offset offsets[] = {{"1e2", {100, -100, 50}, 0.98},
                              {"1e4", {1e4f, -1e4f, 5e3f}, 0.85},
                              {"1e6", {1e6f, -1e6f, 5e5f}, 0},
                              {"Embree's", {148376, 1234, -223423}, 0.3}};

TEST_P(TriangleScales, far_from_the_origin_what_is_decided_is_right) {
  for (const Offset& offset : offsets) {
    SCOPED_TRACE(offset.name);
    Random random(116);
    std::size_t decided = 0, pairs = 0;
    for (int round = 0; round < (quick() ? 1 : 6); ++round) {
      TriangleScene scene;
      for (int i = 0; i < 3; ++i) scene.triangles.push_back(random.triangle(1, offset.centre));
      for (std::size_t i = 0; i < 9; ++i)
        scene.rays.push_back(ray_to(random.point(2, offset.centre), scene.triangles[i % 3],
                                    random.real(-0.2, 0.8), random.real(-0.2, 0.8)));
      std::vector<TriangleJudgement> judgements;
      for (std::size_t i = 0; i < scene.size(); ++i) {
        judgements.push_back(judge(GetParam(), scene.ray(i), scene.triangle(i)));
        decided += judgements.back().decision != oracle::Class::either;
        ++pairs;
      }
      for (const FloatMode mode : float_modes) expect_right(GetParam(), scene, mode, judgements);
    }
    // The plane's n·p − n·o cancels what the distance put in; all other forms subtract first.
    const double least = is_plane_edges(GetParam()) ? offset.least_on_planes : 0.98;
    if (!quick()) {
      EXPECT_GE(static_cast<double>(decided), least * static_cast<double>(pairs));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, TriangleScales, ::testing::ValuesIn(all_triangle_forms),
                         [](const auto& form) { return name_of(form.param); });

}  // namespace
}  // namespace raylanes::testing

// Built-in scenes, scenes from files, and cameras. The bytes of built-in scenes are recorded, see recorded_scenes.hpp.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <raylanes/closed_mesh.hpp>

#include "../../tests/support/message_of.hpp"
#include "../support/scenes/procedural.hpp"
#include "../support/scenes/shapes.hpp"
#include "../support/scenes/subdivision.hpp"
#include "../support/scenes/vector3.hpp"
#include "scene_samples.hpp"
#include "temporary_folder.hpp"

namespace raylanes::bench {
namespace {

TEST(ProceduralScenes, spheres_are_closed) {
  const Mesh mesh = make_procedural_scene("spheres").mesh;
  const ClosedReport report = closed_report(mesh.vertices, mesh.triangles, mesh.triangles.size());
  EXPECT_GT(report.open, 0u);
  EXPECT_EQ(report.inconsistent, 0u);
  // Only the floor has a rim: it lies at height 0.
  for (const FaultyEdge& edge : report.first)
    EXPECT_TRUE(edge.fault != EdgeFault::open || mesh.vertices[edge.from][1] == 0.0f);
}

TEST(Subdivide, cuts_at_the_midpoints_of_edges) {
  Mesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {2, 4, 6}}, {{0, 1, 2}, {3, 2, 1}}};
  subdivide(mesh, 1);
  const std::vector<Float3> middles{{1, 0, 0}, {1, 2, 0}, {0, 2, 0}, {1, 4, 3}, {2, 2, 3}};
  EXPECT_EQ(std::vector(mesh.vertices.begin() + 4, mesh.vertices.end()), middles);
  const std::vector<Index3> quarters{{0, 4, 6}, {4, 1, 5}, {6, 5, 2}, {4, 5, 6},
                                     {3, 7, 8}, {7, 2, 5}, {8, 5, 1}, {7, 5, 8}};
  EXPECT_EQ(mesh.triangles, quarters);
}

TEST(Subdivide, closed_meshes_stay_closed_and_large_numbers_finite) {
  Mesh mesh;
  append_box(mesh, {-3e38, -3e38, -3e38}, {3e38, 3e38, 3e38});
  subdivide(mesh, 3);
  EXPECT_EQ(mesh.triangles.size(), 12u * 64);
  // Euler: V - E + F = 2, and E = 3F/2.
  EXPECT_EQ(mesh.vertices.size(), 2 + mesh.triangles.size() / 2);
  EXPECT_NO_THROW(validate_mesh(mesh.vertices, mesh.triangles));
  EXPECT_TRUE(is_closed(mesh));
  Mesh large{{{0, 0, 0}}, std::vector<Index3>((1u << 18) + 1)};
  EXPECT_EQ(message_of([&] { subdivide(large, 5); }),
            "--subdivide 5: 262145 triangles would become more than 2^28");
}

TEST(LoadScene, camera_comes_from_the_list_beside_the_file) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string eye : {"1,2", "1,2,x", "1,2,nan", "1,2,3"}) {
    folder.write("scenes.tsv", "other\tb.obj\t1\t0,0,0\t1,1,1\t0,1,0\t50\tkind\n\none\ta.obj\t1\t" + eye +
                                   "\t-4,5.5,6e-1\t0,0,1\t60\tobject\n");
    if (eye != "1,2,3") {
      const std::string message = message_of([&] { load_scene(file); });
      EXPECT_NE(message.find("scenes.tsv line 3: "), std::string::npos) << message;
      continue;
    }
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene.name, "one");
    EXPECT_EQ(scene.camera.eye, (Float3{1, 2, 3}));
    EXPECT_EQ(scene.camera.look_at, (Float3{-4, 5.5f, 0.6f}));
    EXPECT_EQ(scene.camera.up, (Float3{0, 0, 1}));
    EXPECT_EQ(scene.camera.fov_degrees, 60.0f);
  }
}

TEST(LoadScene, automatic_camera_sees_all_of_an_unlisted_mesh) {
  const TemporaryFolder folder;
  const Scene scene = load_scene(folder.write("thing.obj", "v 100 0 0\nv 140 0 0\nv 100 30 7\nf 1 2 3\n"));
  const Double3 eye = to_double(scene.camera.eye);
  const Double3 forward = subtract(to_double(scene.camera.look_at), eye);
  for (const Float3& vertex : scene.mesh.vertices) {
    const Double3 to = subtract(to_double(vertex), eye);
    const double angle = std::acos(dot(to, forward) / (length(to) * length(forward)));
    EXPECT_LT(angle * 180 / std::numbers::pi, scene.camera.fov_degrees / 2 + 1e-3);
  }
}

TEST(ParseCamera, six_numbers_are_eye_and_look_at) {
  const Camera camera = parse_camera("1,-2,3.5,4,5,6e1", front);
  EXPECT_EQ(camera.eye, (Float3{1, -2, 3.5f}));
  EXPECT_EQ(camera.look_at, (Float3{4, 5, 60}));
  EXPECT_EQ(camera.up, front.up);
  EXPECT_THROW(parse_camera("1,2,3,1,2,3", front), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::bench

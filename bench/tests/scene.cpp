// Built-in scenes, whose bytes are recorded, see recorded_scenes.hpp; scenes from files, cameras and pictures.
#include <png.h>

#include <raylanes/closed_mesh.hpp>

#include "../../tests/support/message_of.hpp"
#include "../support/pictures/heatmap.hpp"
#include "../support/pictures/image.hpp"
#include "../support/scenes/parts.hpp"
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

// Two strips, whose triangles take turns, and a triangle that touches none of their corners. One strip has a vertex for
// each corner, one shares them.
TEST(Parts, are_connected_pieces_in_the_order_of_their_first_triangles) {
  const auto at = [](float x, float y) { return Float3{x, y, 0}; };
  Mesh mesh{{at(0, 0), at(1, 0), at(0, 1), at(5, 0), at(6, 0), at(5, 1), at(1, 0), at(1, 1), at(0, 1),
             at(6, 1), at(9, 9), at(9, 8), at(8, 9)},
            {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {4, 9, 5}, {10, 11, 12}}};
  const std::vector<Index3> sorted{{0, 1, 2}, {6, 7, 8}, {3, 4, 5}, {4, 9, 5}, {10, 11, 12}};
  const Parts parts = cut_into_parts(mesh, 100);
  EXPECT_EQ(mesh.triangles, sorted);
  EXPECT_EQ(parts.first, (std::vector<std::uint32_t>{0, 2, 4}));
  for (std::size_t i = 0; i < parts.meshes.size(); ++i)
    for (std::size_t k = 0; k < parts.meshes[i].triangles.size(); ++k)
      for (std::size_t corner = 0; corner < 3; ++corner)
        EXPECT_EQ(parts.meshes[i].vertices[parts.meshes[i].triangles[k][corner]],
                  mesh.vertices[mesh.triangles[parts.first[i] + k][corner]]);
  EXPECT_EQ(parts.meshes[1].vertices.size(), 4u);
  EXPECT_EQ(cut_into_parts(mesh, 2).first, (std::vector<std::uint32_t>{0, 4}));
  EXPECT_EQ(cut_into_parts(mesh, 1).first, (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(parts_of_groups(mesh, {1, 1, 4, 5}).first, (std::vector<std::uint32_t>{0, 1, 4}));
}

TEST(Parts, that_are_nodes_have_meshes_in_common) {
  const Mesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  Mesh two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {{0, 1, 2}, {3, 4, 5}}};
  const Transform moved{{{1, 0, 0, 5}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  const Parts parts = parts_of_nodes(two, {0, 0, 1}, {{Mesh(), one}, {{0, {}}, {1, {}}, {1, moved}}});
  EXPECT_EQ(parts.first, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(parts.shared_meshes().size(), 2u);
  EXPECT_EQ(parts.place(0).mesh, 1u);
  EXPECT_EQ(parts.place(1).mesh, 1u);
  EXPECT_EQ(parts.place(1).transform.row[0][3], 5.0f);
  EXPECT_TRUE(parts.has_transforms());
  EXPECT_FALSE(parts_of_groups(two, {0, 1}).has_transforms());
  EXPECT_EQ(parts_of_groups(two, {0, 1}).shared_meshes().size(), 2u);
  // One part is traced where it stands.
  EXPECT_FALSE(parts_of_nodes(one, {0}, {{one}, {{0, moved}}}).has_transforms());
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

TEST(WritePng, reads_back_the_same) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> rgb(3 * 7 * 5);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(37 * i);
  write_png(folder / "a.png", 7, 5, rgb);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, (folder / "a.png").c_str()));
  EXPECT_TRUE(image.width == 7 && image.height == 5);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(read, rgb);
}

TEST(SliceColours, tell_sides_apart_and_grow_darker) {
  const std::vector<float> distances{-1, -0.05f, 0, 0.05f, 0.15f, 1, infinity, -infinity};
  const std::vector<std::uint8_t> rgb = slice_colours(distances);
  ASSERT_EQ(rgb.size(), 3 * distances.size());
  EXPECT_EQ(largest_size(distances), 1.0f);
  const auto sum = [&](std::size_t i) { return rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2]; };
  for (const std::size_t inside : {0u, 1u, 7u}) EXPECT_GT(rgb[3 * inside + 2], rgb[3 * inside]);
  for (const std::size_t outside : {3u, 4u, 5u, 6u}) EXPECT_GT(rgb[3 * outside], rgb[3 * outside + 2]);
  EXPECT_TRUE(sum(2) == 0 && sum(0) < sum(1) && sum(4) < sum(3) && sum(5) < sum(4) && sum(6) == sum(5));
}

TEST(Shade, sky_surface_shadow_and_darkness) {
  const std::vector<Ray> rays(4, Ray{{0, 0, 5}, 0, {0, 0, -1}, 9});
  const std::vector<Hit> hits{{5, 0.25f, 0.5f, 0}, {5, 0.25f, 0.5f, 0}, {5, 0, 0, 1}, miss};
  const auto rgb = shade({"three", three, front}, rays, hits, std::vector<std::uint8_t>{0, 1}, {0, 0, 9});
  ASSERT_EQ(rgb.size(), 12u);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    EXPECT_GT(rgb[channel], rgb[3 + channel] + 40);  // lit against in shadow
    EXPECT_GT(rgb[3 + channel], 40);                 // which can still be seen
    EXPECT_EQ(rgb[6 + channel], 0);                  // no area, no colour
    EXPECT_GT(rgb[9 + channel], 150);                // sky
  }
}

using Rgb = std::array<std::uint8_t, 3>;

// How many pixels of one row of panels have the colour.
std::ptrdiff_t pixels_of(const Rgb& colour, const HeatRow& row, std::uint32_t width, std::uint32_t height) {
  const HeatPicture picture = heatmap(std::span(&row, 1), width, height);
  EXPECT_EQ(picture.rgb.size(), std::size_t{3} * picture.width * picture.height);
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3)
    count += Rgb{picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]} == colour;
  return count;
}

// The panels, and the legend in the same colours, twelve pixels high. One pixel that costs much leaves the scale.
TEST(Heatmap, from_violet_to_yellow_on_one_scale) {
  const HeatRow row{"tests", {{"a", {0, 50, 100, 100}}, {"b", std::vector<std::uint64_t>(4, 25)}}};
  const Rgb cheapest{68, 1, 84}, middle{33, 145, 140}, dearest{253, 231, 37};
  for (const auto& [colour, panels] : {std::pair{cheapest, 1}, {middle, 1}, {dearest, 2}, {{59, 82, 139}, 4}})
    EXPECT_EQ(pixels_of(colour, row, 2, 2) % 12, panels);
  HeatRow one{"tests", {{"a", std::vector<std::uint64_t>(1000, 10)}}};
  one.panels[0].tests[3] = 1000000;
  EXPECT_GE(pixels_of(dearest, one, 100, 10), 1000);
}

}  // namespace
}  // namespace raylanes::bench

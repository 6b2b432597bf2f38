// Scenes, ray sets and pictures.
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../bench/image.hpp"
#include "../bench/procedural_scenes.hpp"
#include "../bench/ray_sets.hpp"
#include "../bench/scene.hpp"

namespace raylanes::bench {
namespace {

namespace fs = std::filesystem;
using Point = std::array<double, 3>;

class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "raylanes_scene_XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  fs::path path_;
};

template <typename Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "(no error)";
}

double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point direction_of(const Ray& r) {
  return {r.direction[0], r.direction[1], r.direction[2]};
}
Point origin_of(const Ray& r) {
  return {r.origin[0], r.origin[1], r.origin[2]};
}
bool same(const std::vector<Ray>& a, const std::vector<Ray>& b) {
  return std::ranges::equal(a, b, [](const Ray& x, const Ray& y) {
    return origin_of(x) == origin_of(y) && direction_of(x) == direction_of(y) && x.tmin == y.tmin &&
           x.tmax == y.tmax;
  });
}

const Camera front{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90};

// Triangle 0 in the plane z = 0 (normal +z), 1 without area, 2 at x = 1000 (normal +x).
const Mesh three{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {1000, 0, 0}, {1000, 1, 0}, {1000, 0, 1}},
                 {{0, 1, 2}, {0, 1, 0}, {3, 4, 5}}};
const Hit miss{std::numeric_limits<float>::infinity(), 0, 0, no_primitive};

std::string obj_text() {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
}

TEST(ProceduralScenes, SizesNamesAndDeterminism) {
  const std::map<std::string, std::pair<std::size_t, std::size_t>> sizes{
      {"spheres", {95000, 110000}}, {"hall", {45000, 65000}}, {"fractal", {131072, 131072}}};
  for (const auto& [name, range] : sizes) {
    const Scene scene = load_scene(name), again = make_procedural_scene(name);
    EXPECT_EQ(scene.name, name);
    EXPECT_GE(scene.mesh.triangles.size(), range.first) << name;
    EXPECT_LE(scene.mesh.triangles.size(), range.second) << name;
    EXPECT_NO_THROW(validate_mesh(scene.mesh.vertices, scene.mesh.triangles)) << name;
    EXPECT_EQ(scene.mesh.vertices, again.mesh.vertices) << name;
    EXPECT_EQ(scene.mesh.triangles, again.mesh.triangles) << name;
    EXPECT_EQ(primary_rays(scene.camera, 4, 3).size(), 12u) << name;
  }
  for (const std::string& name : procedural_scene_names()) EXPECT_NO_THROW(make_procedural_scene(name));
}

TEST(ProceduralScenes, SpheresAreClosed) {
  const Mesh mesh = make_procedural_scene("spheres").mesh;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& [a, b, c] : mesh.triangles)
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}})
      edges[std::minmax(from, to)] += from < to ? 1 : -1;
  std::set<std::uint32_t> open;
  for (const auto& [edge, balance] : edges)
    if (balance != 0) open.insert(edge.first);
  // Only the floor has a rim: it lies at height 0.
  EXPECT_FALSE(open.empty());
  for (const std::uint32_t vertex : open) EXPECT_EQ(mesh.vertices[vertex][1], 0.0f);
}

TEST(ProceduralScenes, UnknownNameListsTheValidOnes) {
  for (const std::string name : {"sphere", ""}) {
    EXPECT_THROW(make_procedural_scene(name), std::invalid_argument);
    const std::string message = message_of([&] { load_scene(name); });
    EXPECT_NE(message.find("unknown scene '" + name + "', allowed are spheres, hall, fractal"),
              std::string::npos)
        << message;
  }
}

TEST(LoadScene, CameraComesFromTheListBesideTheFile) {
  const Folder folder;
  folder.write("scenes.tsv",
               "# name\tfile\n\nother\tb.obj\t1\t0,0,0\t1,1,1\t0,1,0\t50\tkind\n"
               "one\ta.obj\t1\t1,2,3\t-4,5.5,6e-1\t0,0,1\t60\tobject\n");
  const Scene scene = load_scene(folder.write("a.obj", obj_text()).string());
  EXPECT_EQ(scene.name, "one");
  EXPECT_EQ(scene.camera.eye, (Float3{1, 2, 3}));
  EXPECT_EQ(scene.camera.look_at, (Float3{-4, 5.5f, 0.6f}));
  EXPECT_EQ(scene.camera.up, (Float3{0, 0, 1}));
  EXPECT_EQ(scene.camera.fov_degrees, 60.0f);
}

TEST(LoadScene, MalformedListsAreErrors) {
  for (const std::string line : {"one\ta.obj\t1\t1,2\t0,0,0\t0,1,0\t60\tobject", "one\ta.obj\t1",
                                 "one\ta.obj\t1\t1,2,x\t0,0,0\t0,1,0\t60\tobject",
                                 "one\ta.obj\t1\t1,2,nan\t0,0,0\t0,1,0\t60\tobject"}) {
    const Folder folder;
    folder.write("scenes.tsv", "# head\n" + line + "\n");
    const fs::path file = folder.write("a.obj", obj_text());
    const std::string message = message_of([&] { load_scene(file.string()); });
    EXPECT_NE(message.find("scenes.tsv line 2: "), std::string::npos) << message;
  }
}

TEST(LoadScene, AutomaticCameraSeesAllOfAnUnlistedMesh) {
  const Folder folder;
  const Scene scene =
      load_scene(folder.write("thing.obj", "v 100 0 0\nv 140 0 0\nv 100 30 7\nf 1 2 3\n").string());
  EXPECT_EQ(scene.name, "thing");
  const Camera& c = scene.camera;
  const Point eye{c.eye[0], c.eye[1], c.eye[2]};
  const Point forward{c.look_at[0] - eye[0], c.look_at[1] - eye[1], c.look_at[2] - eye[2]};
  for (const Float3& v : scene.mesh.vertices) {
    const Point to{v[0] - eye[0], v[1] - eye[1], v[2] - eye[2]};
    const double cosine = dot(to, forward) / std::sqrt(dot(to, to) * dot(forward, forward));
    EXPECT_LT(std::acos(cosine) * 180 / std::numbers::pi, c.fov_degrees / 2 + 1e-3);
  }
}

TEST(LoadScene, MissingFile) {
  EXPECT_THROW(load_scene("/nonexistent/a.obj"), std::runtime_error);
}

TEST(ParseCamera, SixNumbersOrAnError) {
  const Camera camera = parse_camera("1,-2,3.5,4,5,6e1", front);
  EXPECT_EQ(camera.eye, (Float3{1, -2, 3.5f}));
  EXPECT_EQ(camera.look_at, (Float3{4, 5, 60}));
  EXPECT_EQ(camera.up, front.up);
  EXPECT_EQ(camera.fov_degrees, front.fov_degrees);
  for (const char* text : {"", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,x", "1,2,3,4,5,6 ", "1,2,3,,5,6",
                           "1,2,3,4,5,nan", "1,2,3,4,5,inf", "1,2,3,1,2,3"})
    EXPECT_THROW(parse_camera(text, front), std::invalid_argument) << text;
}

TEST(PrimaryRays, PinholeGeometryRowByRow) {
  const std::vector<Ray> rays = primary_rays(front, 4, 2);
  ASSERT_EQ(rays.size(), 8u);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // 90 degrees: the picture is 2 high and 4 wide at distance 1; pixel centres lie at halves.
    const double x = static_cast<double>(i % 4) - 1.5, y = i < 4 ? 0.5 : -0.5;
    const Point direction = direction_of(rays[i]);
    EXPECT_NEAR(direction[0], x, 1e-6);
    EXPECT_NEAR(direction[1], y, 1e-6);
    EXPECT_NEAR(direction[2], -1, 1e-6);
    EXPECT_EQ(origin_of(rays[i]), (Point{0, 0, 5}));
    EXPECT_EQ(rays[i].tmin, 0.0f);
    EXPECT_EQ(rays[i].tmax, std::numeric_limits<float>::infinity());
  }
}

TEST(PrimaryRays, UpAlongTheLineOfSightStillGivesAPicture) {
  for (const Float3& up : {Float3{0, 0, 1}, Float3{0, 0, 0}}) {
    const auto rays = primary_rays({{0, 0, 5}, {0, 0, 0}, up, 60}, 3, 3);
    for (const Ray& r : rays) EXPECT_NEAR(r.direction[2], -1, 1e-6);
    EXPECT_NE(direction_of(rays[0]), direction_of(rays[8]));
  }
}

TEST(PrimaryRays, Errors) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(primary_rays(front, 0, 2), std::invalid_argument);
  EXPECT_THROW(primary_rays(front, 2, 0), std::invalid_argument);
  for (const float fov : {0.0f, 180.0f, -1.0f, nan}) {
    Camera camera = front;
    camera.fov_degrees = fov;
    EXPECT_THROW(primary_rays(camera, 2, 2), std::invalid_argument);
  }
  EXPECT_THROW(primary_rays({{1, 1, 1}, {1, 1, 1}, {0, 1, 0}, 60}, 2, 2), std::invalid_argument);
  EXPECT_THROW(primary_rays({{nan, 1, 1}, {1, 1, 0}, {0, 1, 0}, 60}, 2, 2), std::invalid_argument);
}

TEST(SecondaryRays, SkipMissesAndTrianglesWithoutArea) {
  const std::vector<Hit> hits{miss, {1, 0.2f, 0.2f, 0}, {1, 0, 0, 1}, {1, 0, 0, 2}};
  const std::vector<Ray> primary(4, Ray{{0, 0, 5}, 0, {0, 0, -1}, 10});
  EXPECT_EQ(secondary_origins(hits, three), (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(shadow_rays(hits, three, {0, 0, 9}).size(), 2u);
  EXPECT_EQ(diffuse_rays(primary, hits, three, 1).size(), 2u);
  EXPECT_EQ(ambient_occlusion_rays(primary, hits, three, 1).size(), 2u);
}

TEST(SecondaryRays, Errors) {
  const std::vector<Hit> hits{{1, 0, 0, 3}};
  EXPECT_THROW(secondary_origins(hits, three), std::invalid_argument);
  EXPECT_THROW(diffuse_rays({}, std::vector<Hit>{miss}, three, 1), std::invalid_argument);
}

TEST(ShadowRays, EndAtTheLightAndStartOffTheSurfaceOnItsSide) {
  const std::vector<Hit> hits{{1, 0.25f, 0.5f, 0}, {1, 0.25f, 0.5f, 2}};
  // Barycentric by hand: 1/4 (-1,-1,0) + 1/4 (1,-1,0) + 1/2 (0,1,0) = 0 and (1000, 1/4, 1/2).
  const Point at[] = {{0, 0, 0}, {1000, 0.25, 0.5}};
  for (const Float3& light : {Float3{3, 4, 10}, Float3{3000, 4, -10}}) {
    const std::vector<Ray> rays = shadow_rays(hits, three, light);
    ASSERT_EQ(rays.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t normal_axis = i == 0 ? 2 : 0;
      const double side = light[normal_axis] > at[i][normal_axis] ? 1 : -1;
      const double lifted = side * (rays[i].origin[normal_axis] - at[i][normal_axis]);
      // The lift of 8u of the diagonal, and 256 ULP or 2^-16 with its own rounding.
      const double lift = 0x1p-21 * diagonal_of(three);
      const double steps = std::max(0x1p-16, 0x1p-15 * std::abs(at[i][normal_axis]));
      EXPECT_GE(lifted, lift);
      EXPECT_LE(lifted, lift + 1.01 * steps);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(rays[i].origin[axis] + rays[i].direction[axis], light[axis], 1e-3);
        if (axis != normal_axis) {
          EXPECT_EQ(rays[i].origin[axis], static_cast<float>(at[i][axis]));
        }
      }
      EXPECT_EQ(rays[i].tmin, 0.0f);
      EXPECT_LT(rays[i].tmax, 1.0f);
      EXPECT_GT(rays[i].tmax, 0.99f);
    }
  }
}

TEST(ShadowRays, LeaveTheSurfaceAtNegativeCoordinatesToo) {
  const Mesh wall{{{-1000, 0, 0}, {-1000, 1, 0}, {-1000, 0, 1}}, {{0, 1, 2}}};
  const std::vector<Hit> hits{{1, 0.25f, 0.5f, 0}};
  EXPECT_GT(shadow_rays(hits, wall, {0, 0, 0}).at(0).origin[0], -1000.0f);
  EXPECT_LT(shadow_rays(hits, wall, {-2000, 0, 0}).at(0).origin[0], -1000.0f);
}

class BouncedRays : public testing::TestWithParam<double> {};

TEST_P(BouncedRays, AreCosineDistributedOnTheSideOfTheRay) {
  const double side = GetParam();
  constexpr std::size_t count = 20000;
  const std::vector<Hit> hits(count, Hit{1, 0.25f, 0.5f, 0});
  const std::vector<Ray> primary(
      count, Ray{{0, 0, static_cast<float>(5 * side)}, 0, {0, 0, static_cast<float>(-side)}, 9});
  const std::vector<Ray> rays = diffuse_rays(primary, hits, three, 7);
  ASSERT_EQ(rays.size(), count);
  double sum = 0, sum_of_squares = 0, sum_x = 0, sum_y = 0;
  for (const Ray& r : rays) {
    const double cosine = side * r.direction[2];
    EXPECT_GT(cosine, 0);
    EXPECT_GT(side * r.origin[2], 0);
    EXPECT_NEAR(dot(direction_of(r), direction_of(r)), 1, 1e-5);
    EXPECT_EQ(r.tmax, std::numeric_limits<float>::infinity());
    sum += cosine;
    sum_of_squares += cosine * cosine;
    sum_x += r.direction[0];
    sum_y += r.direction[1];
  }
  // A density of cos/pi has the moments 2/3, 1/2, 0, 0; a uniform one 1/2, 1/3. Bounds are five sigma.
  EXPECT_NEAR(sum / count, 2.0 / 3, 0.009);
  EXPECT_NEAR(sum_of_squares / count, 0.5, 0.011);
  EXPECT_NEAR(sum_x / count, 0, 0.018);
  EXPECT_NEAR(sum_y / count, 0, 0.018);
}
INSTANTIATE_TEST_SUITE_P(BothSides, BouncedRays, testing::Values(1.0, -1.0));

TEST(DiffuseRays, DependOnSeedAndPixelOnly) {
  const std::vector<Hit> hits(3, Hit{1, 0.25f, 0.5f, 0});
  const std::vector<Ray> primary(3, Ray{{0, 0, 5}, 0, {0, 0, -1}, 9});
  const auto rays = diffuse_rays(primary, hits, three, 7);
  EXPECT_TRUE(same(rays, diffuse_rays(primary, hits, three, 7)));
  const auto other = diffuse_rays(primary, hits, three, 8);
  std::set<Point> directions;
  for (const auto& set : {rays, other})
    for (const Ray& r : set) directions.insert(direction_of(r));
  EXPECT_EQ(directions.size(), 6u);
  // Pixels before it do not change a pixel.
  std::vector<Hit> first_missed = hits;
  first_missed[0] = miss;
  const auto fewer = diffuse_rays(primary, first_missed, three, 7);
  EXPECT_TRUE(same(fewer, {rays[1], rays[2]}));
}

TEST(AmbientOcclusionRays, ReachATenthOfTheDiagonal) {
  const std::vector<Hit> hits(1, Hit{1, 0.25f, 0.5f, 0});
  const std::vector<Ray> primary(1, Ray{{0, 0, 5}, 0, {0, 0, -1}, 9});
  const auto rays = ambient_occlusion_rays(primary, hits, three, 7);
  EXPECT_NEAR(rays.at(0).tmax, 0.1 * std::sqrt(1001.0 * 1001 + 2 * 2 + 1), 1e-3);
}

TEST(DefaultLight, AboveTheEyeIndoorsAndApartFromTheMeshOutdoors) {
  const Scene hall = make_procedural_scene("hall");
  const Float3 lamp = default_light(hall);
  EXPECT_GT(lamp[1], hall.camera.eye[1]);
  EXPECT_LT(
      std::hypot(lamp[0] - hall.camera.eye[0], lamp[1] - hall.camera.eye[1], lamp[2] - hall.camera.eye[2]),
      3);
  const Scene object{"three", three, automatic_camera(three)};
  const Bounds bounds = bounds_of(three);
  const Float3 sun = default_light(object);
  EXPECT_GT(sun[1], bounds.hi[1]);
}

// Reads a picture back through libpng.
std::vector<std::uint8_t> read_png(const fs::path& file, std::uint32_t width, std::uint32_t height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_file(&image, file.c_str()));
  EXPECT_EQ(image.width, width);
  EXPECT_EQ(image.height, height);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr));
  return rgb;
}

TEST(WritePng, ReadsBackTheSame) {
  const Folder folder;
  std::vector<std::uint8_t> rgb(3 * 7 * 5);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(37 * i);
  for (int again = 0; again < 2; ++again) {
    write_png(folder / "a.png", 7, 5, rgb);
    EXPECT_EQ(read_png(folder / "a.png", 7, 5), rgb);
    std::ranges::reverse(rgb);
  }
}

TEST(WritePng, Errors) {
  const Folder folder;
  const std::vector<std::uint8_t> rgb(12);
  EXPECT_THROW(write_png(folder / "a.png", 2, 3, rgb), std::invalid_argument);
  EXPECT_THROW(write_png(folder / "a.png", 0, 3, {}), std::invalid_argument);
  const fs::path nowhere = folder / "missing" / "a.png";
  const std::string message = message_of([&] { write_png(nowhere, 2, 2, rgb); });
  EXPECT_TRUE(message.starts_with(nowhere.string() + ": ")) << message;
}

TEST(Shade, SkySurfaceShadowAndDarkness) {
  const Scene scene{"three", three, front};
  const std::vector<Ray> rays(4, Ray{{0, 0, 5}, 0, {0, 0, -1}, 9});
  const std::vector<Hit> hits{{5, 0.25f, 0.5f, 0}, {5, 0.25f, 0.5f, 0}, {5, 0, 0, 1}, miss};
  const std::vector<std::uint8_t> occluded{0, 1};
  const auto rgb = shade(scene, rays, hits, occluded, {0, 0, 9});
  ASSERT_EQ(rgb.size(), 12u);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    EXPECT_GT(rgb[channel], rgb[3 + channel] + 40);  // lit against in shadow
    EXPECT_GT(rgb[3 + channel], 40);                 // which can still be seen
    EXPECT_EQ(rgb[6 + channel], 0);                  // no area, no colour
    EXPECT_GT(rgb[9 + channel], 150);                // sky
  }
  EXPECT_THROW(shade(scene, rays, hits, {}, {0, 0, 9}), std::invalid_argument);
  EXPECT_THROW(shade(scene, {}, hits, occluded, {0, 0, 9}), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::bench

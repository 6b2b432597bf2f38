#include "procedural.hpp"

#include "../readers/printable.hpp"
#include "shapes.hpp"
#include "splitmix.hpp"

namespace raylanes::bench {
namespace {

// Spheres that do not touch, thrown like darts on a disk, the large ones first.
Scene make_spheres() {
  constexpr std::size_t count = 80;
  constexpr double disk_radius = 9;
  Scene scene{"spheres", {}, {{0, 5.2f, 15.5f}, {0, 0.5f, 0}, {0, 1, 0}, 50}};
  append_grid(scene.mesh, 24, 24, [](double u, double v) { return Double3{40 * u - 20, 0, 20 - 40 * v}; });
  struct Disk {
    double x, z, radius;
  };
  std::vector<Disk> placed;
  SplitMix random(2024);
  while (placed.size() < count) {
    const double radius = 0.3 + 1.3 * std::pow(1 - double(placed.size()) / count, 3);
    const double angle = 2 * std::numbers::pi * random.uniform();
    const double distance = disk_radius * std::sqrt(random.uniform());
    const Disk disk{distance * std::cos(angle), distance * std::sin(angle), radius};
    const bool is_free = std::ranges::none_of(placed, [&](const Disk& other) {
      return std::hypot(disk.x - other.x, disk.z - other.z) < 0.95 * (disk.radius + other.radius);
    });
    if (!is_free) continue;
    placed.push_back(disk);
    append_icosphere(scene.mesh, {disk.x, radius, disk.z}, radius, 3);
  }
  return scene;
}

// A number in [0, 1) for a point of the lattice.
double lattice_value(std::int64_t x, std::int64_t z, int octave) {
  const auto seed = static_cast<std::uint64_t>(x * 73856093 ^ z * 19349663 ^ octave * 83492791);
  return SplitMix(seed).uniform();
}

double smooth_noise(double x, double z, int octave) {
  const auto ease = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const auto xi = static_cast<std::int64_t>(std::floor(x)), zi = static_cast<std::int64_t>(std::floor(z));
  const double u = ease(x - std::floor(x)), v = ease(z - std::floor(z));
  const double near = std::lerp(lattice_value(xi, zi, octave), lattice_value(xi + 1, zi, octave), u);
  const double far = std::lerp(lattice_value(xi, zi + 1, octave), lattice_value(xi + 1, zi + 1, octave), u);
  return std::lerp(near, far, v);
}

// Ridged multifractal (F. K. Musgrave, 1994): folded noise makes ridges, and each octave is weighted by the
// one before, so that valleys stay smooth.
double terrain_height(double x, double z) {
  double height = 0, weight = 1, amplitude = 1;
  for (int octave = 0; octave < 8; ++octave) {
    const double fold = 1 - std::abs(2 * smooth_noise(x, z, octave) - 1);
    const double ridge = fold * fold * weight;
    height += amplitude * ridge;
    weight = std::clamp(1.6 * ridge, 0.0, 1.0);
    amplitude *= 0.5;
    // Turned as well as scaled, or the lattices of all octaves would lie on each other.
    const double turned_x = 1.6 * x - 1.2 * z;
    z = 1.2 * x + 1.6 * z;
    x = turned_x;
  }
  return height;
}

Scene make_fractal() {
  Scene scene{"fractal", {}, {{0, 9.5f, 21}, {0, 1, -1}, {0, 1, 0}, 40}};
  append_grid(scene.mesh, 256, 256, [](double u, double v) {
    return Double3{24 * u - 12, 2.4 * terrain_height(4 * u + 7, 4 * v + 3), 12 - 24 * v};
  });
  return scene;
}

// The crown of a tree: leaves around boughs, each a square of two triangles, of which a filter may cut a leaf.
Scene make_foliage() {
  constexpr std::size_t leaves = 50000, of_bough = 500;
  Scene scene{"foliage", {}, {{0, 0.3f, 4}, {0, 0, 0}, {0, 1, 0}, 45}};
  SplitMix random(7);
  const auto in_ball = [&](double least) {
    for (;;) {
      const Double3 p{2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1};
      if (const double squared = dot(p, p); squared <= 1 && squared >= least * least) return p;
    }
  };
  Double3 bough{};
  for (std::size_t i = 0; i < leaves; ++i) {
    if (i % of_bough == 0) bough = in_ball(0.5);
    const Double3 at = add(bough, scale(in_ball(0), 0.3)), along = scale(normalized(in_ball(0.1)), 0.05),
                  beside = scale(normalized(cross(along, in_ball(0.1))), 0.03), end = add(at, along);
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const Double3& p : {at, add(at, beside), add(end, beside), end})
      scene.mesh.vertices.push_back(to_float(p));
    scene.mesh.triangles.insert(scene.mesh.triangles.end(),
                                {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  }
  return scene;
}

struct Entry {
  std::string_view name;
  Scene (*make)();
};
constexpr std::array entries{Entry{"spheres", make_spheres}, Entry{"hall", make_hall_scene},
                             Entry{"fractal", make_fractal}, Entry{"foliage", make_foliage}};

}  // namespace

std::vector<std::string> procedural_scene_names() {
  std::vector<std::string> names;
  for (const Entry& entry : entries) names.emplace_back(entry.name);
  return names;
}

Scene make_procedural_scene(std::string_view name) {
  std::string allowed;
  for (const Entry& entry : entries) {
    if (entry.name == name) return entry.make();
    allowed += (allowed.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw std::invalid_argument("unknown scene '" + printable(name) + "', allowed are " + allowed +
                              " and mesh files");
}

}  // namespace raylanes::bench

#include "ray_sets.hpp"

#include <raylanes/rays.hpp>

#include "../../../dispatch/checked.hpp"
#include "../scenes/camera.hpp"
#include "../scenes/splitmix.hpp"
#include "aim.hpp"
#include "surface.hpp"

namespace raylanes::bench {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
// Short of the light by more than the rounding of origin and direction.
constexpr float shadow_tmax = 0.999f;

Ray make_ray(const Float3& origin, const Float3& direction, float tmax) {
  return {{origin[0], origin[1], origin[2]}, 0, {direction[0], direction[1], direction[2]}, tmax};
}

// Moves a point off its surface along the unit normal: by a number of float steps that grows with the
// coordinate, or by a fixed length near 0, where float steps are too small (constants of the paper).
Float3 offset_along(const Float3& point, const Double3& normal) {
  constexpr double near_zero = 1.0 / 32, fixed_length = 1.0 / 65536, steps = 256;
  Float3 moved;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float p = point[axis];
    const auto count = static_cast<std::int32_t>(steps * normal[axis]);
    const float stepped = std::bit_cast<float>(std::bit_cast<std::int32_t>(p) + (p < 0 ? -count : count));
    moved[axis] = std::abs(p) < near_zero ? static_cast<float>(p + fixed_length * normal[axis]) : stepped;
  }
  return moved;
}

// How far secondary rays start above their surface, besides the offset in ULP of the point: 8u of the
// diagonal (u = 2^-24). The depth of a triangle as large as the scene rounds by up to about 6u of that, and a
// ray that starts closer may meet its own floor.
double lift_of(const Mesh& mesh) {
  return 8 * 0x1p-24 * diagonal_of(mesh);
}

// A direction on the hemisphere about `normal`, cosine-distributed: a uniform point of the disk, raised.
Double3 cosine_direction(const Double3& normal, SplitMix& random) {
  const double u = random.uniform();
  const double angle = 2 * std::numbers::pi * random.uniform();
  const auto [x_axis, y_axis] = tangents_of(normal);
  const double radius = std::sqrt(u);
  const Double3 in_plane =
      add(scale(x_axis, radius * std::cos(angle)), scale(y_axis, radius * std::sin(angle)));
  return add(in_plane, scale(normal, std::sqrt(1 - u)));
}

std::vector<Ray> bounced_rays(std::span<const Ray> primary, std::span<const Hit> hits, const Mesh& mesh,
                              std::uint64_t seed, float tmax) {
  if (primary.size() != hits.size())
    throw std::invalid_argument("bounced rays: " + std::to_string(hits.size()) + " hits for " +
                                std::to_string(primary.size()) + " primary rays, they must be as many");
  std::vector<Ray> rays;
  const double lift = lift_of(mesh);
  for (const std::size_t i : secondary_origins(hits, mesh)) {
    const Double3 normal =
        normal_against(to_double(primary[i].direction), surface_normal(mesh, hits[i].primitive));
    // Mixed once, or seeds s and s + 1 would share the numbers of neighbouring pixels.
    SplitMix random(SplitMix(seed).next() + i * 0x9e3779b97f4a7c15u);
    SplitMix own(random.next());
    const Double3 lifted = add(hit_point(mesh, hits[i]), scale(normal, lift));
    rays.push_back(
        make_ray(offset_along(to_float(lifted), normal), to_float(cosine_direction(normal, own)), tmax));
  }
  return rays;
}

}  // namespace

std::vector<Ray> primary_rays(const Camera& camera, std::uint32_t width, std::uint32_t height,
                              std::uint32_t samples) {
  if (width == 0 || height == 0)
    throw std::invalid_argument("picture of " + std::to_string(width) + " x " + std::to_string(height) +
                                " pixels, allowed are 1 x 1 and more");
  if (!(camera.fov_degrees > 0 && camera.fov_degrees < 180))
    throw std::invalid_argument("camera: opening angle of " + text_of(camera.fov_degrees) +
                                " degrees, allowed are those between 0 and 180");
  const auto cells = static_cast<std::uint32_t>(std::lround(std::sqrt(samples)));
  if (samples == 0 || cells * cells != samples)
    throw std::invalid_argument("picture of " + std::to_string(samples) +
                                " samples a pixel, allowed are 1, 4, 9, 16, 25 and other squares");
  const CameraFrame frame = camera_frame(camera);
  const double half_height = std::tan(camera.fov_degrees * std::numbers::pi / 360);
  const double pixel = 2 * half_height / height;
  std::vector<Ray> rays;
  rays.reserve(std::size_t{width} * height * samples);
  constexpr std::uint64_t sample_seed = 7;
  SplitMix random(sample_seed);
  for (std::uint32_t row = 0; row < height; ++row)
    for (std::uint32_t column = 0; column < width; ++column)
      for (std::uint32_t sample = 0; sample < samples; ++sample) {
        const double in_x = samples == 1 ? 0.5 : (sample % cells + random.uniform()) / cells;
        const double in_y = samples == 1 ? 0.5 : (sample / cells + random.uniform()) / cells;
        const double x = pixel * (column + in_x - 0.5 * width), y = pixel * (0.5 * height - row - in_y);
        const Double3 direction = add(frame.forward, add(scale(frame.right, x), scale(frame.up, y)));
        rays.push_back(make_ray(camera.eye, to_float(direction), infinity));
      }
  return rays;
}

std::vector<std::size_t> secondary_origins(std::span<const Hit> hits, const Mesh& mesh) {
  std::vector<std::size_t> origins;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::uint32_t primitive = hits[i].primitive;
    if (primitive == no_primitive) continue;
    if (primitive >= mesh.triangles.size())
      throw std::invalid_argument("hit " + std::to_string(i) + ": triangle " + std::to_string(primitive) +
                                  " is out of range, the mesh has " + std::to_string(mesh.triangles.size()));
    if (has_area(mesh, primitive)) origins.push_back(i);
  }
  return origins;
}

std::vector<Ray> shadow_rays(std::span<const Hit> hits, const Mesh& mesh, const Float3& light) {
  std::vector<Ray> rays;
  const double lift = lift_of(mesh);
  for (const std::size_t i : secondary_origins(hits, mesh)) {
    const Double3 point = hit_point(mesh, hits[i]);
    const Double3 from_light = subtract(point, to_double(light));
    const Double3 normal = normal_against(from_light, surface_normal(mesh, hits[i].primitive));
    const Float3 origin = offset_along(to_float(add(point, scale(normal, lift))), normal);
    rays.push_back(make_ray(origin, to_float(subtract(to_double(light), to_double(origin))), shadow_tmax));
  }
  return rays;
}

std::vector<Ray> rays_from_light(std::span<const Ray> shadow, const Float3& light) {
  std::vector<Ray> rays;
  rays.reserve(shadow.size());
  for (const Ray& ray : shadow)
    rays.push_back(
        make_ray(light, to_float(subtract(to_double(ray.origin), to_double(light))), 1 - 0x1p-12f));
  return rays;
}

std::vector<Ray> diffuse_rays(std::span<const Ray> primary, std::span<const Hit> hits, const Mesh& mesh,
                              std::uint64_t seed) {
  return bounced_rays(primary, hits, mesh, seed, infinity);
}

std::vector<Ray> ambient_occlusion_rays(std::span<const Ray> primary, std::span<const Hit> hits,
                                        const Mesh& mesh, std::uint64_t seed) {
  return bounced_rays(primary, hits, mesh, seed, static_cast<float>(0.1 * diagonal_of(mesh)));
}

std::vector<Ray> random_rays(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<Ray> rays;
  if (mesh.triangles.empty()) return rays;
  const Box bounds = bounds_of(mesh);
  const Double3 middle = scale(add(to_double(bounds.lo), to_double(bounds.hi)), 0.5);
  const double radius = diagonal_of(mesh);
  SplitMix random(seed);
  rays.reserve(count);
  while (rays.size() < count) {
    const double height = between(random, -1, 1), turn = between(random, 0, 2 * std::numbers::pi),
                 across = std::sqrt(1 - height * height);
    const Double3 from{across * std::cos(turn), across * std::sin(turn), height};
    Double3 to;
    for (std::size_t axis = 0; axis < 3; ++axis) to[axis] = between(random, bounds.lo[axis], bounds.hi[axis]);
    rays.push_back(ray_towards(add(middle, scale(from, radius)), to));
  }
  return rays;
}

Float3 default_light(const Scene& scene) {
  const Box bounds = bounds_of(scene.mesh);
  const double diagonal = diagonal_of(scene.mesh);
  const CameraFrame frame = camera_frame(scene.camera);
  const Double3 eye = to_double(scene.camera.eye);
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    inside = inside && scene.camera.eye[axis] > bounds.lo[axis] && scene.camera.eye[axis] < bounds.hi[axis];
  if (inside) {
    const double view = length(subtract(to_double(scene.camera.look_at), eye));
    const double shift = std::min(0.08 * view, 0.05 * diagonal);
    return to_float(add(eye, scale(subtract(frame.up, frame.right), shift)));
  }
  if (scene.mesh.triangles.empty()) return scene.camera.eye;
  const Double3 middle = scale(add(to_double(bounds.lo), to_double(bounds.hi)), 0.5);
  const double distance = std::max(length(subtract(eye, middle)), diagonal);
  const Double3 towards =
      normalized(add(scale(frame.up, 1.0), subtract(scale(frame.right, -0.8), frame.forward)));
  return to_float(add(middle, scale(towards, distance)));
}

std::vector<std::size_t> pixels_in(PixelOrder order, std::uint32_t width, std::uint32_t height) {
  constexpr std::size_t block_side = 32, tile_side = 4;
  constexpr std::uint64_t shuffle_seed = 1;
  std::vector<std::size_t> pixels(std::size_t{width} * height);
  std::iota(pixels.begin(), pixels.end(), std::size_t{0});
  switch (order) {
    case PixelOrder::rows:
      return pixels;
    case PixelOrder::tiles: {
      const auto place = [&](std::size_t pixel) {
        const std::size_t x = pixel % width, y = pixel / width;
        return std::tuple(y / block_side, x / block_side, y / tile_side, x / tile_side, pixel);
      };
      std::sort(pixels.begin(), pixels.end(),
                [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
      return pixels;
    }
    case PixelOrder::shuffled: {
      // Fisher and Yates 1938.
      SplitMix random(shuffle_seed);
      for (std::size_t left = pixels.size(); left > 1; --left)
        std::swap(pixels[left - 1], pixels[random.next() % left]);
      return pixels;
    }
  }
  throw std::invalid_argument("rays: unknown order " + std::to_string(static_cast<int>(order)));
}

}  // namespace raylanes::bench

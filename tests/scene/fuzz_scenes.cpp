// Rays of any bits through scenes of any parts in places of any bits, on any path and in any mode: the hits are as if
// all instances were asked one after the other, nothing is written elsewhere.
#include <raylanes/paths.hpp>
#include <raylanes/stretches.hpp>

#include "../fuzz/any_mesh.hpp"
#include "../fuzz/fence.hpp"
#include "../support/same_bytes.hpp"
#include "any_nesting.hpp"
#include "fuzz_primitives.hpp"
#include "points/placed_triangles.hpp"
#include "scene_oracle.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t max_rays = 40;

// Often one that shows something.
Transform any_transform(Bytes& bytes, Coordinates& coordinates) {
  Transform transform;
  const std::size_t kind = bytes.below(4);
  for (std::size_t i = 0; i < 3 && kind > 0; ++i) {
    transform.row[i][3] = coordinates();
    for (std::size_t j = 0; j < 3 && kind > 1; ++j) transform.row[i][j] = coordinates();
  }
  return transform;
}

void expect_same(const Scene& scene, std::span<const Ray> rays, const std::vector<SceneHit>& expected,
                 const TraceOptions& options) {
  static Fence fence(max_rays * sizeof(SceneHit)), byte_fence(max_rays);
  const std::span<SceneHit> hits(fence.last<SceneHit>(rays.size()), rays.size());
  const std::span<std::uint8_t> occluded(byte_fence.last<std::uint8_t>(rays.size()), rays.size());
  scene.closest(rays, hits, options);
  scene.occluded(rays, occluded, options);
  fence.expect_intact("hits"), byte_fence.expect_intact("occluded");
  const TraceOptions of_one{.path = options.path, .facing = options.facing, .mask = options.mask};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool is_hit = static_cast<bool>(expected[i]);
    if (!same_bytes(hits[i], expected[i]) || occluded[i] != (is_hit ? 1 : 0))
      fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": " + text(hits[i]) + ", not " +
           text(expected[i]) + "; occluded " + std::to_string(occluded[i]));
    const SceneHit alone = scene.closest(rays[i], of_one);
    if (!same_bytes(alone, expected[i]) || scene.occluded(rays[i], of_one) != is_hit)
      fail(std::string(options.path->name) + ": ray " + std::to_string(i) + " alone: " + text(alone) +
           ", not " + text(expected[i]));
  }
}

// So many as packets want, from the origin of one.
std::vector<Ray> from_one_origin(Bytes& bytes, const std::vector<Ray>& rays) {
  std::vector<Ray> shared;
  for (std::size_t i = 0; i < 80; ++i) {
    shared.push_back(rays[i % rays.size()]);
    if (!bytes.chance(16)) shared.back().origin = rays[0].origin;
  }
  return shared;
}

// Behind the nearest hit there is the second one of all, on any path.
void expect_after(const Scene& scene, const std::vector<Ray>& rays, const std::vector<SceneHit>& nearest,
                  const TraceOptions& options) {
  std::vector<SceneHit> hits = nearest;
  scene.closest(rays, hits, behind(options, hits));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::vector<SceneHit> all = all_scene_hits(scene, rays[i], options.mask, options.facing);
    if (!same_bytes(hits[i], all.size() > 1 ? all[1] : SceneHit()))
      fail("next: ray " + std::to_string(i) + " on " + options.path->name + ": " + text(hits[i]));
  }
}

// Skips are read as they were, wherever results are written over them.
void expect_skips_apart(Bytes& bytes, const Scene& scene, const std::vector<Ray>& rays,
                        const std::vector<SceneHit>& nearest, TraceOptions options) {
  const std::size_t n = rays.size(), at = bytes.below(3);
  std::vector<SceneHit> expected(n), room(n + 2);
  const SceneHitView to(room.data() + 1, n);
  options.skip = nearest;
  scene.closest(rays, expected, options);
  std::ranges::copy(nearest, room.data() + at);
  options.skip = SceneHitView(room.data() + at, n);
  if (bytes.chance(128))
    scene.closest(rays, to, options);
  else
    scene.closest(
        rays, to, [](auto, auto, auto) {}, options);
  if (!same_bytes(std::span<SceneHit>(room).subspan(1, n), std::span<SceneHit>(expected)))
    fail(std::string("skips among the results on ") + options.path->name);
  std::vector<Float3> normals(n);
  for (SceneHit& hit : expected) hit.instance ^= static_cast<std::uint32_t>(bytes.below(3));
  scene.normals(expected, normals);
}

// The closest crossing of a scene is that of one of its instances, by their own trees.
void expect_closest_crossings(const Scene& scene, const std::vector<Ray>& rays, const TraceOptions& options) {
  std::vector<SceneHit> hits(rays.size());
  scene.closest_crossing(rays, hits, options);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SceneHit expected =
        expected_hit(scene, rays[i], options.mask, [&](std::uint32_t geometry, const Ray& ray) {
          return scene.tree(geometry)->closest_crossing(ray,
                                                        {.path = &paths().front(), .facing = options.facing});
        });
    if (!same_bytes(hits[i], expected))
      fail("closest crossing: ray " + std::to_string(i) + " on " + options.path->name + ": " + text(hits[i]));
  }
}

// A scene has the stretches of its instances, by their own trees.
void expect_stretches(const Scene& scene, const std::vector<Ray>& rays, const TraceOptions& options) {
  const auto lists =
      stretches(scene, rays, {.path = options.path, .threads = options.threads, .mask = options.mask});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::vector<Stretch> expected;
    expected_hit(scene, rays[i], options.mask, [&](std::uint32_t geometry, const Ray& ray) {
      const auto of_instance = stretches(*scene.tree(geometry), std::vector{ray}, {.path = &paths().front()});
      expected.insert(expected.end(), of_instance.items.begin(), of_instance.items.end());
      return Hit();
    });
    std::ranges::stable_sort(expected, {}, &Stretch::entry);
    if (!std::ranges::equal(lists[i], expected, [](const Stretch& a, const Stretch& b) { return a == b; }))
      fail("stretches: ray " + std::to_string(i) + " on " + options.path->name);
  }
}

// A scene has the hits of its instances.
void expect_lists(const Scene& scene, const std::vector<Ray>& rays, const TraceOptions& options) {
  const auto lists = scene.all_hits(
      rays,
      {.facing = options.facing, .path = options.path, .threads = options.threads, .mask = options.mask});
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!same_bytes(lists[i],
                    std::span<const SceneHit>(all_scene_hits(scene, rays[i], options.mask, options.facing))))
      fail("all hits: ray " + std::to_string(i) + " on " + options.path->name);
}

// Points have the closest point of all triangles, one after the other, and the parts whose trees say so.
void expect_points(Bytes& bytes, const Scene& scene, const std::vector<Ray>& rays,
                   const TraceOptions& options) {
  static Fence fence(max_rays * sizeof(SceneClosestPoint)), part_fence(max_rays * sizeof(ContainingPart));
  const std::size_t n = rays.size();
  std::vector<Float3> points;
  for (const Ray& ray : rays) points.push_back(ray.origin);
  const float most = bytes.chance(128) ? infinity : std::abs(rays[0].tmin);
  const std::span<SceneClosestPoint> closest(fence.last<SceneClosestPoint>(n), n);
  const std::span<ContainingPart> inner(part_fence.last<ContainingPart>(n), n);
  const LocateOptions by{.rule = static_cast<InsideRule>(bytes.below(inside_rule_names.size())),
                         .path = options.path,
                         .threads = options.threads,
                         .mask = options.mask};
  scene.closest_points(
      points, closest,
      {.max_distance = most, .path = options.path, .threads = options.threads, .mask = options.mask});
  scene.innermost_parts(points, inner, by);
  fence.expect_intact("closest"), part_fence.expect_intact("parts");
  const PlacedTriangles triangles(scene, options.mask);
  const auto lists = scene.containing_parts(points, by);
  for (std::size_t i = 0; i < n; ++i) {
    if (!same_bytes(closest[i], triangles.one_by_one(points[i], most)))
      fail("closest point " + std::to_string(i) + " on " + options.path->name);
    if (inner[i] != (lists[i].empty() ? ContainingPart() : lists[i][0]))
      fail("innermost part of point " + std::to_string(i) + " on " + options.path->name);
    std::map<std::uint32_t, Location> found;
    for (const ContainingPart& part : lists[i]) found[part.instance] = part.location;
    for (std::uint32_t instance = 0; instance < scene.instance_count(); ++instance) {
      if (!is_there(scene, instance, options.mask)) continue;
      const Float3 mapped =
          mapped_ray(make_ray(points[i], {1, 0, 0}),
                     Instance(scene.geometry_of(instance), scene.transform_of(instance), ~0u))
              .origin;
      Location location;
      scene.tree(scene.geometry_of(instance))
          ->locate(std::span(&mapped, 1), std::span(&location, 1),
                   {.rule = by.rule, .path = &paths().front()});
      const Location here = found.contains(instance) ? found[instance] : Location::outside;
      const bool is_certain =  // in open meshes other rules ask neighbours
          location == Location::on || here == Location::on || by.rule == InsideRule::vote;
      if (is_certain && here != location)
        fail("part " + std::to_string(instance) + " of point " + std::to_string(i) + " on " +
             options.path->name);
    }
  }
  std::vector<float> numbers(n);
  scene.signed_distances(points, numbers, {.rule = by.rule, .path = by.path, .mask = by.mask});
  scene.winding_numbers(points, numbers, {.path = by.path, .threads = by.threads, .mask = by.mask});
  std::vector<Triangle> corners(n);
  scene.corners(PrimitiveView(closest), corners);
}

// Through a file, once with a damage that must be found.
Scene loaded_again(Bytes& bytes, Scene scene) {
  std::stringstream file, damaged;
  scene.save(file);
  std::string text_of_file = file.str();
  text_of_file[bytes.below(std::min<std::size_t>(text_of_file.size(), 65536))] ^=
      static_cast<char>(1 << bytes.below(8));
  damaged << text_of_file;
  try {
    Scene::load(damaged);
    fail("a damaged scene was taken for a good one");
  } catch (const std::runtime_error&) {
  }
  return Scene::load(file);
}

// A copy, of which no change of the original is seen.
Scene copied(Scene& scene, const Mesh& mesh) {
  const Scene copy = scene;
  std::vector<Float3> turned(mesh.vertices);
  for (Float3& vertex : turned) std::swap(vertex[0], vertex[2]);
  scene.refit(0, turned, mesh.triangles);
  scene.replace(1, Bvh());
  scene.update();
  return copy;
}

// Spheres and primitives of the caller's, which hit nothing, beside the triangles of a scene.
void expect_others(Bytes& bytes, Scene scene, const std::vector<Ray>& rays, const TraceOptions& options) {
  Coordinates coordinates(bytes);
  const auto nothing = [](std::uint32_t, const Ray&, Hit&) { return false; };
  std::vector<Sphere> spheres(bytes.below(20));
  for (Sphere& sphere : spheres) sphere = {{coordinates(), coordinates(), coordinates()}, coordinates()};
  const SphereTree tree(spheres);
  const std::uint32_t balls = scene.add(SphereTree(spheres)),
                      own = scene.add(BoundedTree(std::vector<Box>{{{-1, -1, -1}, {1, 1, 1}}}), nothing);
  for (std::size_t places = 1 + bytes.below(4); places > 0; --places)
    scene.place(bytes.chance(64) ? own : balls, bytes.chance(128) ? Transform() : moved_by(1, 0, 0, 0.5f),
                bytes.chance(128) ? ~0u : bytes.byte());
  scene.update();
  std::vector<SceneHit> expected;
  for (const Ray& ray : rays)
    expected.push_back(expected_hit(scene, ray, options.mask, [&](std::uint32_t geometry, const Ray& mapped) {
      return geometry == own     ? Hit()
             : geometry == balls ? tree.closest(mapped, {.path = &paths().front()})
                                 : scene.tree(geometry)->closest(mapped, {.path = &paths().front()});
    }));
  expect_same(scene, rays, expected, options);
}

// Makes instances leave the common tree and join it. Masks may change at last, without an update.
void change_some(Bytes& bytes, Coordinates& coordinates, Scene& scene, const Mesh (&meshes)[2]) {
  for (std::size_t steps = 1 + bytes.below(8); steps > 0; --steps) {
    const auto instance = static_cast<std::uint32_t>(bytes.below(scene.instance_count()));
    const auto geometry = static_cast<std::uint32_t>(bytes.below(2));
    const std::size_t kind = bytes.below(6);
    if (kind == 0) scene.move(instance, any_transform(bytes, coordinates));
    if (kind == 1) scene.set_moving(instance, bytes.chance(128));
    if (kind == 2) scene.replace(geometry, Bvh(meshes[geometry]));
    if (kind == 3) scene.place(geometry);
    if (kind == 4) scene.refit(geometry, meshes[geometry].vertices, meshes[geometry].triangles);
    if (kind < 4 || bytes.chance(128)) scene.update();
    if (kind == 5) scene.set_mask(instance, any_mask(bytes));
  }
  const Scene copy = scene;
  if (bytes.chance(128)) scene.update();
  if (bytes.chance(64)) scene = copy;
  try {
    scene.closest(Ray());
  } catch (const std::logic_error&) {
    scene.update();
  }
}

// The triangles of a geometry have masks, and are there for calls that share a bit.
void expect_triangle_masks(Bytes& bytes, Scene scene, const std::vector<Ray>& rays,
                           const TraceOptions& options) {
  if (scene.geometry_count() == 0) return;
  const auto masked = static_cast<std::uint32_t>(bytes.below(scene.geometry_count()));
  if (scene.tree(masked) == nullptr) return;
  std::vector<std::uint32_t> words(bytes.below(20));
  for (std::uint32_t& word : words) word = any_mask(bytes);
  scene.set_triangle_masks(masked, words);
  scene.update();
  std::vector<SceneHit> expected;
  for (const Ray& ray : rays)
    expected.push_back(expected_hit(scene, ray, options.mask, [&](std::uint32_t geometry, const Ray& mapped) {
      TraceOptions by{.path = &paths().front(), .facing = options.facing, .mask = options.mask};
      if (geometry == masked) by.masks = words;
      return scene.tree(geometry)->closest(mapped, by);
    }));
  expect_same(scene, rays, expected, options);
  std::vector<SceneHit> hits(rays.size());
  scene.closest_crossing(rays, hits, options);
  const auto lists =
      scene.all_hits(rays, {.facing = options.facing, .path = options.path, .mask = options.mask});
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!same_bytes(expected[i], lists[i].empty() ? SceneHit() : lists[i][0]))
      fail("all hits of masked triangles: ray " + std::to_string(i) + " on " + options.path->name);
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_scenes(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  const Mesh meshes[] = {any_mesh(bytes), any_mesh(bytes)};
  Scene scene;
  for (const Mesh& mesh : meshes)
    bytes.chance(100)   ? scene.add(mesh)
    : bytes.chance(128) ? scene.add(Bvh(mesh))
                        : scene.add(std::make_shared<const Bvh>(mesh));
  Coordinates coordinates(bytes);
  const std::size_t instances = bytes.below(bytes.chance(64) ? 60 : 4);
  for (std::size_t i = 0; i < instances; ++i)
    scene.place(static_cast<std::uint32_t>(bytes.below(2)), any_transform(bytes, coordinates),
                any_mask(bytes));
  scene.update();
  if (instances > 0 && bytes.chance(128)) change_some(bytes, coordinates, scene, meshes);
  if (bytes.chance(64)) scene = copied(scene, meshes[0]);
  for (std::size_t levels = bytes.below(8); levels > 5; --levels)
    scene = within_another(bytes, scene, [&] { return any_transform(bytes, coordinates); });
  if (bytes.chance(64)) scene = loaded_again(bytes, std::move(scene));
  const TraceOptions options{.mode = static_cast<TraversalMode>(bytes.below(traversal_mode_names.size())),
                             .path = bytes.pick(fuzzed_paths()),
                             .threads = bytes.chance(32) ? 2 : 1,
                             .facing = bytes.chance(64)   ? Facing::front
                                       : bytes.chance(64) ? Facing::back
                                                          : Facing::any,
                             .mask = bytes.byte()};
  std::vector<Ray> rays;
  std::vector<SceneHit> expected;
  const std::size_t n = bytes.below(max_rays + 1);
  for (std::size_t i = 0; i < n; ++i) {
    rays.push_back(any_ray(bytes, coordinates, meshes[i % 2]));
    expected.push_back(
        expected_hit(scene, rays[i], options.mask, [&](std::uint32_t geometry, const Ray& ray) {
          return scene.tree(geometry)->closest(ray, {.path = &paths().front(), .facing = options.facing});
        }));
  }
  expect_same(scene, rays, expected, options);
  if (bytes.chance(64)) expect_after(scene, rays, expected, options);
  if (bytes.chance(64)) expect_skips_apart(bytes, scene, rays, expected, options);
  if (bytes.chance(64)) expect_closest_crossings(scene, rays, options);
  if (bytes.chance(32)) expect_lists(scene, rays, options);
  if (bytes.chance(16)) expect_stretches(scene, rays, options);
  if (bytes.chance(48)) expect_triangle_masks(bytes, scene, rays, options);
  if (!rays.empty() && bytes.chance(64)) expect_points(bytes, scene, rays, options);
  if (bytes.chance(64))
    expect_others(bytes, scene, rays, {.mode = options.mode, .path = options.path, .mask = options.mask});
  if (!rays.empty() && bytes.chance(64)) rays = from_one_origin(bytes, rays);
  if (bytes.chance(64))
    expect_hits_of_boxes(bytes, meshes[0], rays, {.path = options.path, .threads = options.threads});
  if (bytes.chance(64)) expect_hits_of_spheres(bytes, rays, {.path = options.path});
  return 0;
}

// Rays and points of any bits through scenes of doubles in places of any bits, on any path: the hits are as if all
// instances were asked one after the other, nothing is written elsewhere.
#include <map>
#include <sstream>

#include <raylanes/stretches.hpp>

#include "../../../accel/scene/doubles/instance_d.hpp"
#include "../../fuzz/any_doubles.hpp"
#include "../../fuzz/fence.hpp"
#include "../../support/same_bytes.hpp"
#include "../any_nesting.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t max_rays = 20;

TransformD any_transform_d(Bytes& bytes, DoubleCoordinates& coordinates) {
  TransformD transform;
  const std::size_t kind = bytes.below(4);
  for (std::size_t i = 0; i < 3 && kind > 0; ++i) {
    transform.row[i][3] = coordinates();
    for (std::size_t j = 0; j < 3 && kind > 1; ++j)
      transform.row[i][j] = kind == 2 ? coordinates.difference() : bytes.number<double>();
  }
  return transform;
}

// The masks of the triangles of geometries.
using MasksOfParts = std::map<std::uint32_t, std::vector<std::uint32_t>>;

// visit(instance, tree, ray, options) for each instance that may be hit, with the ray in its space.
template <class Visit>
void each_instance(const SceneD& scene, const MasksOfParts& masks, const RayD& ray, std::uint32_t mask,
                   const Visit& visit) {
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const InstanceD instance(scene.geometry_of(i), scene.transform_of(i), scene.mask_of(i));
    const BvhD& tree = scene.tree(instance.geometry);
    if ((instance.mask & mask) == 0 || !(bounds_of(instance, tree.bounds()).box.lo[0] < HUGE_VAL)) continue;
    ListOptions options{.mask = mask};
    if (const auto found = masks.find(instance.geometry); found != masks.end()) options.masks = found->second;
    visit(i, tree, std::vector{in_part(instance, ray)}, options);
  }
}

// All hits of a ray, in order, by the tree of each instance.
std::vector<SceneHitD> hits_of(const SceneD& scene, const MasksOfParts& masks, const RayD& ray,
                               std::uint32_t mask, Facing facing) {
  std::vector<SceneHitD> all;
  each_instance(scene, masks, ray, mask, [&](auto i, const BvhD& tree, const auto& mapped, auto options) {
    options.facing = facing;
    const auto lists = tree.all_hits(mapped, options);
    for (const HitD& hit : lists.items)
      all.push_back({hit.t, hit.u, hit.v, hit.primitive, scene.geometry_of(i), i});
  });
  std::ranges::sort(all, {},
                    [](const SceneHitD& hit) { return std::tuple(hit.t, hit.instance, hit.primitive); });
  return all;
}

void expect_hits(const SceneD& scene, const MasksOfParts& masks, const std::vector<RayD>& rays,
                 const TraceOptionsD& options) {
  static Fence fence(max_rays * sizeof(SceneHitD)), byte_fence(max_rays);
  const std::span<SceneHitD> hits(fence.last<SceneHitD>(rays.size()), rays.size());
  const std::span<std::uint8_t> occluded(byte_fence.last<std::uint8_t>(rays.size()), rays.size());
  scene.closest(rays, hits, options), scene.occluded(rays, occluded, options);
  fence.expect_intact("hits"), byte_fence.expect_intact("occluded");
  const std::vector<SceneHitD> nearest(hits.begin(), hits.end());
  TraceOptionsD behind = options;
  behind.after = nearest;
  scene.closest(rays, hits, behind);
  const auto lists =
      scene.all_hits(rays, {.facing = options.facing, .path = options.path, .mask = options.mask});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::string ray = std::string(options.path->name) + ": ray " + std::to_string(i) + ": ";
    const std::vector<SceneHitD> all = hits_of(scene, masks, rays[i], options.mask, options.facing);
    const auto at = [&](std::size_t k) { return k < all.size() ? all[k] : SceneHitD(); };
    if (!same_bytes(nearest[i], at(0)) || (occluded[i] != 0) == all.empty())
      fail(ray + "another nearest hit");
    if (!same_bytes(scene.closest(rays[i], {.facing = options.facing, .mask = options.mask}), at(0)))
      fail(ray + "another one alone");
    if (!same_bytes(hits[i], at(1))) fail(ray + "another next hit");
    if (!same_bytes(lists[i], std::span<const SceneHitD>(all))) fail(ray + "another list");
  }
  std::vector<SceneHitD> crossings(rays.size());
  scene.closest_crossing(rays, crossings, options);
  const auto within = stretches(scene, rays, {.path = options.path, .mask = options.mask});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::vector<SceneStretchD> all;
    each_instance(scene, masks, rays[i], options.mask,
                  [&](auto number, const BvhD& tree, const auto& mapped, const auto& seen) {
                    for (const StretchD& stretch : stretches(tree, mapped, seen).items)
                      all.push_back({stretch, scene.geometry_of(number), number});
                  });
    std::ranges::stable_sort(all, {}, &SceneStretchD::entry);
    if (!std::ranges::equal(within[i], all)) fail("ray " + std::to_string(i) + ": other stretches");
  }
}

void expect_points(const SceneD& scene, const std::vector<RayD>& rays, const TraceOptionsD& options) {
  const VertexViewD points(rays.data(), rays.size(), sizeof(RayD));
  std::vector<SceneClosestPointD> closest(rays.size());
  std::vector<TriangleD> corners(rays.size());
  std::vector<Double3> normals(rays.size());
  std::vector<Location> locations(rays.size());
  std::vector<double> numbers(rays.size());
  scene.closest_points(points, closest, {.path = options.path, .mask = options.mask});
  scene.corners(PrimitiveView(closest), corners), scene.normals(PrimitiveView(closest), normals);
  const LocateOptions places{.path = options.path, .mask = options.mask};
  scene.locate(points, locations, places);
  const auto lists = scene.containing_parts(points, places);
  scene.winding_numbers(points, numbers, {.path = options.path, .mask = options.mask});
  scene.signed_distances(points, numbers, {.path = options.path, .mask = options.mask});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if ((locations[i] == Location::outside) != lists[i].empty()) fail("a point is in no part, or in one");
    if (closest[i] && (std::isnan(closest[i].distance) || std::isnan(corners[i].corner[0][0])))
      fail("a closest point is no number");
    if (!same_bytes(scene.closest_point(points[i], {.mask = options.mask}), closest[i]))
      fail("a closest point alone is another");
  }
}

SceneD loaded_again(const SceneD& scene) {
  std::stringstream file, again;
  scene.save(file);
  SceneD loaded = SceneD::load(file);
  loaded.save(again);
  if (again.str() != file.str()) fail("a loaded scene is saved as another one");
  return loaded;
}

// Masks for the triangles of a geometry, which is no scene.
MasksOfParts some_masks(Bytes& bytes, SceneD& scene) {
  const auto geometry = static_cast<std::uint32_t>(bytes.below(scene.geometry_count()));
  std::vector<std::uint32_t> masks(1 + bytes.below(20));
  for (std::uint32_t& mask : masks) mask = bytes.byte();
  try {
    scene.set_triangle_masks(geometry, masks);
  } catch (const std::invalid_argument&) {
    return {};
  }
  scene.update();
  return {{geometry, masks}};
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_scenes_of_doubles(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  DoubleCoordinates coordinates(bytes);
  const DoubleMesh meshes[] = {any_double_mesh(bytes, coordinates), any_double_mesh(bytes, coordinates)};
  SceneD scene;
  for (const DoubleMesh& mesh : meshes)
    bytes.chance(128) ? scene.add(mesh.vertices, mesh.triangles)
                      : scene.add(std::make_shared<const BvhD>(mesh.vertices, mesh.triangles));
  for (std::size_t i = bytes.below(bytes.chance(64) ? 40 : 5); i > 0; --i)
    scene.place(static_cast<std::uint32_t>(bytes.below(2)), any_transform_d(bytes, coordinates),
                bytes.chance(128) ? ~0u : static_cast<std::uint32_t>(bytes.below(7)));
  scene.update();
  if (scene.instance_count() > 0 && bytes.chance(64)) {
    const SceneD copy = scene;
    scene.move(0, any_transform_d(bytes, coordinates)), scene.set_mask(0, bytes.byte());
    scene.replace(1, BvhD(meshes[0].vertices, meshes[0].triangles));
    if (bytes.chance(64)) scene = copy;
    if (bytes.chance(64)) scene.refit(0, meshes[0].vertices, meshes[0].triangles);
    scene.update();
  }
  for (std::size_t levels = bytes.below(8); levels > 5; --levels)
    scene = within_another(bytes, scene, [&] { return any_transform_d(bytes, coordinates); });
  if (bytes.chance(64)) scene = loaded_again(scene);
  MasksOfParts masks;
  if (bytes.chance(64)) masks = some_masks(bytes, scene);
  std::vector<RayD> rays;
  for (std::size_t n = bytes.below(max_rays); rays.size() < n;)
    rays.push_back(any_double_ray(bytes, coordinates, meshes[rays.size() % 2]));
  const TraceOptionsD options{.path = bytes.pick(fuzzed_paths()),
                              .threads = bytes.chance(32) ? 2 : 1,
                              .facing = bytes.chance(64) ? Facing::back : Facing::any,
                              .mask = bytes.chance(128) ? ~0u : bytes.byte()};
  expect_hits(scene, masks, rays, options);
  if (bytes.chance(64)) expect_points(scene, rays, options);
  return 0;
}

// The build of a scene by a commit.
#include <algorithm>
#include <limits>
#include <span>

#include "meshes.hpp"

namespace embree {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr raylanes::Box empty_box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

void include(raylanes::Box& all, const raylanes::Box& box) {
  for (std::size_t k = 0; k < 3; ++k)
    all.lo[k] = std::min(all.lo[k], box.lo[k]), all.hi[k] = std::max(all.hi[k], box.hi[k]);
}

raylanes::Box box_of_user(const Geometry& geometry, std::uint32_t primitive) {
  require_allowed(geometry.bounds != nullptr, "bounds function not set");
  RTCBounds b{};
  const RTCBoundsFunctionArguments arguments{geometry.user, primitive, 0, &b};
  geometry.bounds(&arguments);
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

raylanes::Box box_of_point(const Geometry& geometry, std::uint32_t primitive) {
  const auto* ball = geometry.find(RTC_BUFFER_TYPE_VERTEX)->at<float>(primitive);
  const float radius = ball[3];
  if (!is_fit(ball) || !(radius >= 0 && radius < 1.844e18f)) return empty_box;
  return {{ball[0] - radius, ball[1] - radius, ball[2] - radius},
          {ball[0] + radius, ball[1] + radius, ball[2] + radius}};
}

raylanes::Box box_of_instance(const Matrix& to_scene, const raylanes::Box& inner) {
  raylanes::Box box = empty_box;
  if (is_empty(inner)) return box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double at[3], moved[3];
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = static_cast<double>((corner >> k & 1 ? inner.hi : inner.lo)[k]);
    to_scene.move_point(at, moved);
    const raylanes::Float3 point{static_cast<float>(moved[0]), static_cast<float>(moved[1]),
                                 static_cast<float>(moved[2])};
    include(box, {point, point});
  }
  return box;
}

raylanes::Transform transform_of(const Matrix& matrix) {
  raylanes::Transform transform;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) transform.row[i][j] = static_cast<float>(matrix.row[i][j]);
  return transform;
}

// Whether raylanes::Scene may have an instance: it knows one mask for both, and no callbacks.
bool is_placeable(const Geometry& instance, const Built& of) {
  return of.is_plain_mesh && of.things.empty() && (instance.mask == ~0u || of.mesh_mask == ~0u);
}

void find_masks(Built& built) {
  bool is_first = true;
  for (const Part& part : built.parts) {
    const Geometry& geometry = *part.geometry;
    if (!geometry.is_mesh()) continue;
    const bool is_plain = !geometry.has_filter() && (is_first || geometry.mask == built.mesh_mask);
    built.is_plain_mesh = built.is_plain_mesh && is_plain;
    built.mesh_mask = geometry.mask, is_first = false;
  }
}

void collect_things(Built& built, bool placed) {
  for (std::uint32_t part = 0; part < built.parts.size(); ++part) {
    const Geometry& geometry = *built.parts[part].geometry;
    const Built* of = nullptr;
    if (geometry.is_instance()) {
      if (geometry.instanced.get() == nullptr) continue;
      of = geometry.instanced->built.get();
    }
    const bool is_placed = of != nullptr && built.is_plain_mesh && is_placeable(geometry, *of);
    if (geometry.is_mesh() || is_placed != placed) continue;
    if (of != nullptr) built.instanced.push_back(geometry.instanced->built);
    for (std::uint32_t i = 0; i < geometry.primitive_count(); ++i) {
      built.things.push_back({part, i, of});
      built.boxes.push_back(of != nullptr        ? box_of_instance(geometry.to_scene, of->bounds)
                            : geometry.is_user() ? box_of_user(geometry, i)
                                                 : box_of_point(geometry, i));
    }
  }
}

void place(Built& built, unsigned mask, const Placement& placement, std::uint32_t geometry,
           const raylanes::Transform& transform) {
  built.placed.place(geometry, transform, mask);
  built.placements.push_back(placement);
  built.is_unmasked = built.is_unmasked && mask == ~0u;
}

// The meshes, and each instance that `placed` takes; scenes that are instanced often are added once.
void place_all(Built& built, int threads) {
  if (!built.faces.empty())
    place(built, built.mesh_mask, {&built, RTC_INVALID_GEOMETRY_ID}, built.placed.add(built.mesh), {});
  std::map<const Built*, std::uint32_t> added;
  for (std::size_t i = built.other_count; i < built.things.size(); ++i) {
    const Thing& thing = built.things[i];
    const Part& part = built.parts[thing.part];
    auto [found, is_new] = added.try_emplace(thing.instanced, 0u);
    if (is_new) found->second = built.placed.add(thing.instanced->mesh);
    place(built, part.geometry->mask & thing.instanced->mesh_mask, {thing.instanced, part.id}, found->second,
          transform_of(part.geometry->to_scene));
    built.may_ask_context = built.may_ask_context || thing.instanced->asks_context;
    built.has_placed_instances = true;
  }
  built.placed.update(threads);
}

raylanes::BuildOptions options_of(RTCBuildQuality quality, int threads, const raylanes::Progress& progress) {
  raylanes::BuildOptions options;
  options.threads = threads, options.progress = progress;
  if (quality == RTC_BUILD_QUALITY_LOW) options.builder = raylanes::TreeBuilder::morton;
  if (quality == RTC_BUILD_QUALITY_HIGH) options.builder = raylanes::TreeBuilder::spatial_splits;
  return options;
}

}  // namespace

Built::Built() : calls(std::as_const(*mesh).calls()), bounds(empty_box) {}
Built::~Built() {
  if (device.get() != nullptr) device->memory(-bytes, true);
}

Scene::Change Scene::change() const {
  Change result = is_modified ? Change::more : Change::none;
  for (const auto& [id, geometry] : geometries) {
    require_allowed(!geometry->is_enabled || !geometry->is_dirty || geometry->version > 0,
                    "geometry got not committed");
    const Built* of = geometry->instanced.get() != nullptr ? geometry->instanced->built.get() : nullptr;
    const auto found = built_versions.find(id);
    if (found != built_versions.end() && found->second == std::pair(geometry->version, of)) continue;
    const bool is_refit = geometry->is_mesh() && geometry->quality == RTC_BUILD_QUALITY_REFIT;
    result = std::max(result, is_refit && found != built_versions.end() ? Change::refit : Change::more);
  }
  return result;
}

void Scene::commit() {
  const std::lock_guard guard(lock);
  const Change changed = change();
  if (changed == Change::none) return;
  raylanes::Progress monitor;
  if (progress != nullptr)
    monitor = [this](double share) {
      if (!progress(progress_user, share)) refuse(RTC_ERROR_CANCELLED, "progress monitor forced termination");
    };
  const auto fresh = std::make_shared<Built>();
  fresh->is_robust = (flags & RTC_SCENE_FLAG_ROBUST) != 0;
  fresh->asks_context = fresh->may_ask_context = (flags & RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION) != 0;
  for (const auto& [id, geometry] : geometries)
    if (geometry->is_enabled) fresh->parts.push_back({geometry, id});
  find_masks(*fresh);

  Meshes meshes(fresh->parts);
  if (changed == Change::refit && meshes.faces.size() == built->faces.size())
    *fresh->mesh = built->mesh->refitted(meshes.vertices, meshes.indices, device->threads);
  else
    *fresh->mesh =
        raylanes::Bvh(meshes.vertices, meshes.indices, options_of(quality, device->threads, monitor));
  fresh->faces = std::move(meshes.faces);
  fresh->calls = std::as_const(*fresh->mesh).calls();

  collect_things(*fresh, false);
  fresh->other_count = fresh->things.size();
  collect_things(*fresh, true);
  fresh->has_mesh_alone = fresh->is_plain_mesh && fresh->things.empty();
  if (fresh->is_plain_mesh) place_all(*fresh, device->threads);
  raylanes::BoundedBuildOptions options;
  options.threads = device->threads;
  fresh->others = raylanes::BoundedTree(std::span(fresh->boxes).first(fresh->other_count), options);
  if (fresh->has_placed_instances) fresh->others_and_placed = raylanes::BoundedTree(fresh->boxes, options);

  fresh->bounds = fresh->mesh->bounds();
  for (const raylanes::Box& box : fresh->boxes)
    if (!is_empty(box)) include(fresh->bounds, box);
  const auto bytes =
      static_cast<std::ptrdiff_t>(fresh->mesh->bytes() + fresh->placed.bytes() + fresh->others.bytes() +
                                  fresh->others_and_placed.bytes() + fresh->faces.size() * sizeof(Face));
  device->memory(bytes, true);
  fresh->device = device, fresh->bytes = bytes;
  if (monitor) monitor(1);

  built = fresh;
  built_versions.clear();
  for (const auto& [id, geometry] : geometries)
    built_versions[id] = {geometry->version,
                          geometry->instanced.get() != nullptr ? geometry->instanced->built.get() : nullptr};
  is_modified = false;
}

}  // namespace embree

// The functions that scenes of floats and of doubles share: behind object_calls.hpp, by its macros and:
//   RAYLANES_PART          the trees that are placed: raylanes_bvh
//   RAYLANES_CROSSING      a crossing of C: raylanes_scene_crossing
//   RAYLANES_SCENE_CALL(of_floats, of_doubles)  a function, one of these
// The namespace also has the types PartTree, AnyTransform and CornersOfTriangle.

namespace raylanes::c::RAYLANES_NUMBERS {
namespace {

static_assert(sizeof(AnyTransform) == 12 * sizeof(Number) && sizeof(CornersOfTriangle) == 9 * sizeof(Number));
static_assert(sizeof(typename Tree::Crossing) == sizeof(RAYLANES_CROSSING));
static_assert(offsetof(RAYLANES_HIT, instance) - offsetof(RAYLANES_HIT, primitive) == to_instance_of_hits);
static_assert(offsetof(RAYLANES_HIT, instance) == offsetof(AnyHit, instance));
static_assert(offsetof(RAYLANES_CLOSEST, instance) == offsetof(AnyClosestPoint, instance));
static_assert(sizeof(SceneReport) == sizeof(raylanes_scene_report));

Tree& changed(RAYLANES_HANDLE* handle) {
  require_pointer("scene", handle);
  return *handle->object;
}

std::shared_ptr<const PartTree> shared_tree(const RAYLANES_PART* tree) {
  require_pointer("tree", tree);
  return tree->object;
}

AnyTransform transform_of(const Number* numbers) {
  AnyTransform transform;
  if (numbers != nullptr) std::memcpy(transform.row, numbers, sizeof transform.row);
  return transform;
}

// Adds a scene, with the caller's tests that its primitives may have.
template <class Handle>
std::uint32_t add_whole(Handle* scene, const Handle* added) {
  Tree& to = changed(scene);
  const Tree& from = object_of(added);
  if constexpr (requires { scene->tests; }) {
    auto tests = scene->tests;
    if (added != scene) tests.insert(tests.end(), added->tests.begin(), added->tests.end());
    const std::uint32_t number = to.add(from);
    scene->tests = std::move(tests);
    return number;
  } else {
    return to.add(from);
  }
}

// Writes what find() returns.
template <class T, class Find>
raylanes_status tell(const char* what, T* to, const Find& find) {
  return status_of([&] {
    require_pointer(what, to);
    *to = find();
  });
}

// The primitives and instances of hits in scenes. No hits may be NULL.
PrimitiveView named_by(const void* hits, std::size_t count, std::size_t stride) {
  const std::size_t apart = checked_stride("hits", hits, count, stride, sizeof(AnyHit));
  return Hits(const_cast<void*>(hits), count, apart);
}

// Numbers of records, side by side.
template <class Record>
std::span<Record> records_of(const char* what, Number* first, std::size_t count) {
  checked_stride(what, first, count, 0, sizeof(Record));
  require_alignment(what, first, alignof(Record));
  return {reinterpret_cast<Record*>(first), count};
}

}  // namespace

extern "C" {

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_create, raylanes_scene_d_create)(RAYLANES_HANDLE** scene) {
  return status_of([&] { make("scene", scene, [] { return handle_of(Tree()); }); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_copy, raylanes_scene_d_copy)(RAYLANES_HANDLE** scene,
                                                                                const RAYLANES_HANDLE* from) {
  return status_of([&] {
    make("scene", scene, [&] {
      require_pointer("from", from);
      auto copy = std::make_unique<RAYLANES_HANDLE>(*from);
      copy->object = std::make_shared<Tree>(*from->object);
      return copy.release();
    });
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_add_mesh, raylanes_scene_d_add_mesh)(
    RAYLANES_HANDLE* scene, const void* vertices, std::size_t vertex_count, std::size_t vertex_stride,
    const void* triangles, std::size_t triangle_count, std::size_t triangle_stride,
    const raylanes_build_options* options, std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] {
    return changed(scene).add(vertices_of("vertices", vertices, vertex_count, vertex_stride),
                              triangles_of(triangles, triangle_count, triangle_stride),
                              build_options(options));
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_add_tree,
                                    raylanes_scene_d_add_tree)(RAYLANES_HANDLE* scene,
                                                               const RAYLANES_PART* tree,
                                                               std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] { return changed(scene).add(shared_tree(tree)); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_add_scene,
                                    raylanes_scene_d_add_scene)(RAYLANES_HANDLE* scene,
                                                                const RAYLANES_HANDLE* added,
                                                                std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] { return add_whole(scene, added); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_refit, raylanes_scene_d_refit)(
    RAYLANES_HANDLE* scene, std::uint32_t geometry, const void* vertices, std::size_t vertex_count,
    std::size_t vertex_stride, const void* triangles, std::size_t triangle_count, std::size_t triangle_stride,
    std::int32_t threads) {
  return status_of([&] {
    changed(scene).refit(geometry, vertices_of("vertices", vertices, vertex_count, vertex_stride),
                         triangles_of(triangles, triangle_count, triangle_stride), threads);
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_set_triangle_masks, raylanes_scene_d_set_triangle_masks)(
    RAYLANES_HANDLE* scene, std::uint32_t geometry, const std::uint32_t* masks, std::size_t n) {
  return status_of(
      [&] { changed(scene).set_triangle_masks(geometry, span_of<const std::uint32_t>("masks", masks, n)); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_replace_tree,
                                    raylanes_scene_d_replace_tree)(RAYLANES_HANDLE* scene,
                                                                   std::uint32_t geometry,
                                                                   const RAYLANES_PART* tree) {
  return status_of([&] { changed(scene).replace(geometry, shared_tree(tree)); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_place,
                                    raylanes_scene_d_place)(RAYLANES_HANDLE* scene, std::uint32_t geometry,
                                                            const Number* transform, std::uint32_t mask,
                                                            std::uint32_t* instance) {
  return tell("instance", instance,
              [&] { return changed(scene).place(geometry, transform_of(transform), mask); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_move, raylanes_scene_d_move)(RAYLANES_HANDLE* scene,
                                                                                std::uint32_t instance,
                                                                                const Number* transform) {
  return status_of([&] { changed(scene).move(instance, transform_of(transform)); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_set_mask,
                                    raylanes_scene_d_set_mask)(RAYLANES_HANDLE* scene, std::uint32_t instance,
                                                               std::uint32_t mask) {
  return status_of([&] { changed(scene).set_mask(instance, mask); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_set_moving,
                                    raylanes_scene_d_set_moving)(RAYLANES_HANDLE* scene,
                                                                 std::uint32_t instance,
                                                                 std::int32_t moving) {
  return status_of([&] { changed(scene).set_moving(instance, moving != 0); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_update, raylanes_scene_d_update)(RAYLANES_HANDLE* scene,
                                                                                    std::int32_t threads) {
  return status_of([&] { changed(scene).update(threads); });
}

std::size_t RAYLANES_SCENE_CALL(raylanes_scene_geometry_count,
                                raylanes_scene_d_geometry_count)(const RAYLANES_HANDLE* scene) {
  return scene == nullptr ? 0 : scene->object->geometry_count();
}

std::size_t RAYLANES_SCENE_CALL(raylanes_scene_instance_count,
                                raylanes_scene_d_instance_count)(const RAYLANES_HANDLE* scene) {
  return scene == nullptr ? 0 : scene->object->instance_count();
}

std::size_t RAYLANES_SCENE_CALL(raylanes_scene_bytes, raylanes_scene_d_bytes)(const RAYLANES_HANDLE* scene) {
  return scene == nullptr ? 0 : scene->object->bytes();
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_geometry_of,
                                    raylanes_scene_d_geometry_of)(const RAYLANES_HANDLE* scene,
                                                                  std::uint32_t instance,
                                                                  std::uint32_t* geometry) {
  return tell("geometry", geometry, [&] { return object_of(scene).geometry_of(instance); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_transform_of,
                                    raylanes_scene_d_transform_of)(const RAYLANES_HANDLE* scene,
                                                                   std::uint32_t instance,
                                                                   Number* transform) {
  return status_of([&] {
    const AnyTransform of_instance = object_of(scene).transform_of(instance);
    require_pointer("transform", transform);
    std::memcpy(transform, &of_instance, sizeof of_instance);
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_mask_of,
                                    raylanes_scene_d_mask_of)(const RAYLANES_HANDLE* scene,
                                                              std::uint32_t instance, std::uint32_t* mask) {
  return tell("mask", mask, [&] { return object_of(scene).mask_of(instance); });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_levels_of,
                                    raylanes_scene_d_levels_of)(const RAYLANES_HANDLE* scene,
                                                                std::uint32_t instance,
                                                                raylanes_instance_level* levels,
                                                                std::size_t capacity, std::size_t* count) {
  return status_of([&] {
    require_pointer("count", count);
    const auto to = span_of<InstanceLevel>("levels", levels, capacity);
    const std::vector<InstanceLevel> all = object_of(scene).levels_of(instance);
    *count = all.size();
    if (all.size() > capacity)
      throw SmallBuffer{capacity * sizeof(InstanceLevel), all.size() * sizeof(InstanceLevel)};
    std::ranges::copy(all, to.begin());
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_describe,
                                    raylanes_scene_d_describe)(const RAYLANES_HANDLE* scene,
                                                               raylanes_scene_report* report,
                                                               std::size_t size) {
  return status_of([&] {
    const SceneReport of_scene = object_of(scene).report();
    require_pointer("report", report);
    require_options_size(size, sizeof of_scene);
    std::memcpy(report, &of_scene, size);
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_normals,
                                    raylanes_scene_d_normals)(const RAYLANES_HANDLE* scene, const void* hits,
                                                              std::size_t n, std::size_t hit_stride,
                                                              Number* normals, std::int32_t threads) {
  return status_of([&] {
    object_of(scene).normals(named_by(hits, n, hit_stride),
                             records_of<PointOf<Number>>("normals", normals, n), threads);
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_corners,
                                    raylanes_scene_d_corners)(const RAYLANES_HANDLE* scene, const void* hits,
                                                              std::size_t n, std::size_t hit_stride,
                                                              Number* corners, std::int32_t threads) {
  return status_of([&] {
    object_of(scene).corners(named_by(hits, n, hit_stride),
                             records_of<CornersOfTriangle>("corners", corners, n), threads);
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_innermost_parts, raylanes_scene_d_innermost_parts)(
    const RAYLANES_HANDLE* scene, const void* points, std::size_t n, std::size_t stride,
    raylanes_containing_part* parts, const raylanes_point_options* options) {
  return status_of([&] {
    object_of(scene).innermost_parts(vertices_of("points", points, n, stride),
                                     span_of<ContainingPart>("parts", parts, n),
                                     *PointOptions<LocateOptions>(options));
  });
}

raylanes_status RAYLANES_SCENE_CALL(raylanes_scene_containing_parts, raylanes_scene_d_containing_parts)(
    const RAYLANES_HANDLE* scene, const void* points, std::size_t n, std::size_t stride,
    raylanes_lists** lists, const raylanes_point_options* options) {
  return status_of([&] {
    make("lists", lists, [&] {
      return lists_of(object_of(scene).containing_parts(vertices_of("points", points, n, stride),
                                                        *PointOptions<LocateOptions>(options)));
    });
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS

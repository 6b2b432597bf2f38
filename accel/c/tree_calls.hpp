// The functions of one kind of tree alone: builds, prepared calls, corners. Behind object_calls.hpp, by its macros and:
//   RAYLANES_CALLS         the handle of prepared calls: raylanes_bvh_calls
//   RAYLANES_TREE_CALL(of_floats, of_doubles)  a function, one of these
// The namespace also has the type CornersOfTriangle: Triangle.

struct RAYLANES_CALLS {
  decltype(std::declval<raylanes::c::RAYLANES_NUMBERS::Tree&>().calls()) calls;
};

namespace raylanes::c::RAYLANES_NUMBERS {
namespace {

static_assert(sizeof(CornersOfTriangle) == 9 * sizeof(Number));

const auto& calls_of(const RAYLANES_CALLS* handle) {
  require_pointer("calls", handle);
  return handle->calls;
}

}  // namespace

extern "C" {

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_create,
                                   raylanes_bvhd_create)(RAYLANES_HANDLE** tree, const void* vertices,
                                                         std::size_t vertex_count, std::size_t vertex_stride,
                                                         const void* triangles, std::size_t triangle_count,
                                                         std::size_t triangle_stride,
                                                         const raylanes_build_options* options) {
  return status_of([&] {
    make(kind, tree, [&] {
      return handle_of(Tree(vertices_of("vertices", vertices, vertex_count, vertex_stride),
                            triangles_of(triangles, triangle_count, triangle_stride),
                            build_options(options)));
    });
  });
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_refit,
                                   raylanes_bvhd_refit)(RAYLANES_HANDLE* tree, const void* vertices,
                                                        std::size_t vertex_count, std::size_t vertex_stride,
                                                        const void* triangles, std::size_t triangle_count,
                                                        std::size_t triangle_stride, std::int32_t threads) {
  return status_of([&] {
    object_of(tree);
    const Vertices to = vertices_of("vertices", vertices, vertex_count, vertex_stride);
    const IndexView indices = triangles_of(triangles, triangle_count, triangle_stride);
    if (tree->object.use_count() > 1) {
      tree->object = std::make_shared<Tree>(tree->object->refitted(to, indices, threads));
    } else {
      std::atomic_thread_fence(std::memory_order_acquire);  // behind the scenes of other threads that had it
      tree->object->refit(to, indices, threads);
    }
  });
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_calls_create,
                                   raylanes_bvhd_calls_create)(RAYLANES_CALLS** calls,
                                                               const RAYLANES_HANDLE* tree,
                                                               const raylanes_ray_options* options) {
  return status_of([&] {
    make("calls", calls,
         [&] { return new RAYLANES_CALLS{object_of(tree).calls(TraceBy(options, 1).unfiltered())}; });
  });
}

void RAYLANES_TREE_CALL(raylanes_bvh_calls_destroy, raylanes_bvhd_calls_destroy)(RAYLANES_CALLS* calls) {
  delete calls;
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_calls_closest,
                                   raylanes_bvhd_calls_closest)(const RAYLANES_CALLS* calls,
                                                                const RAYLANES_RAY* ray, RAYLANES_HIT* hit) {
  return status_of([&] {
    const auto one = ray_of(ray);
    require_pointer("hit", hit);
    Hits(hit, 1).set(0, calls_of(calls).closest(one));
  });
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_calls_occluded,
                                   raylanes_bvhd_calls_occluded)(const RAYLANES_CALLS* calls,
                                                                 const RAYLANES_RAY* ray,
                                                                 std::uint8_t* occluded) {
  return status_of([&] {
    const auto one = ray_of(ray);
    require_pointer("occluded", occluded);
    *occluded = calls_of(calls).occluded(one);
  });
}

raylanes_status RAYLANES_TREE_CALL(raylanes_bvh_corners,
                                   raylanes_bvhd_corners)(const RAYLANES_HANDLE* tree, const void* primitives,
                                                          std::size_t n, std::size_t stride,
                                                          Number* corners) {
  return status_of([&] {
    const Tree& asked = object_of(tree);
    const std::size_t apart = checked_stride("primitives", primitives, n, stride, sizeof(std::uint32_t));
    checked_stride("corners", corners, n, 0, sizeof(CornersOfTriangle));
    require_alignment("corners", corners, alignof(CornersOfTriangle));
    asked.corners({primitives, n, apart}, {reinterpret_cast<CornersOfTriangle*>(corners), n});
  });
}

}  // extern "C"
}  // namespace raylanes::c::RAYLANES_NUMBERS

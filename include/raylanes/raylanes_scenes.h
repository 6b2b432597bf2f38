// Scenes in C: trees of triangles of floats, spheres and primitives of your own, each placed any number of times.
// docs/scenes.md has examples in C++; <raylanes/scene.hpp> has the contracts in full. <raylanes/raylanes.h> includes
// this header and says what holds for all functions.
#ifndef RAYLANES_RAYLANES_SCENES_H
#define RAYLANES_RAYLANES_SCENES_H

#include <raylanes/raylanes.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Geometries, and instances that place them. Both are numbered from 0, in the order in which they are added.
/// After any change, call raylanes_scene_update() before the next query: queries of a changed scene are invalid. Many
/// threads may query one scene at the same time, but not while it is changed or destroyed.
/// Rays are moved to the space of an instance: origin and direction are computed in doubles and rounded once to floats.
/// Exact arithmetic on these floats decides; t is the same in both spaces. Hits are ordered by t, then instance, then
/// primitive. <raylanes/scene.hpp> says which instances are never hit.
typedef struct raylanes_scene raylanes_scene;

// A geometry or an instance that does not exist is an invalid argument. The calls of this part set *geometry and
// *instance to the new index. If a call fails, the scene is unchanged.

/// Makes an empty scene.
RAYLANES_STATUS raylanes_scene_create(raylanes_scene** scene);
/// Makes a copy of a scene, which shares its geometries. A change in one of them changes nothing in the other.
RAYLANES_STATUS raylanes_scene_copy(raylanes_scene** scene, const raylanes_scene* from);
/// Destroys a scene; NULL is allowed.
RAYLANES_API void raylanes_scene_destroy(raylanes_scene* scene);

/// Adds a mesh of floats, which the scene copies. Its tree is built when it is first needed. Vertices and triangles are
/// as in raylanes_bvh_create(). `progress` is ignored.
RAYLANES_STATUS raylanes_scene_add_mesh(raylanes_scene* scene, const void* vertices, size_t vertex_count,
                                        size_t vertex_stride, const void* triangles, size_t triangle_count,
                                        size_t triangle_stride, const raylanes_build_options* options,
                                        uint32_t* geometry);
/// Adds a tree, whose memory the scene shares. The tree may be destroyed; a refit of it changes no scene.
RAYLANES_STATUS raylanes_scene_add_tree(raylanes_scene* scene, const raylanes_bvh* tree, uint32_t* geometry);
/// Adds spheres: a raylanes_sphere each. A ray hits a sphere twice, where it enters and leaves it.
RAYLANES_STATUS raylanes_scene_add_spheres(raylanes_scene* scene, const void* spheres, size_t n,
                                           size_t stride, const raylanes_build_options* options,
                                           uint32_t* geometry);
/// Adds primitives of your own: six floats each, lo and hi of its box, and a function that tests them. `context` must
/// outlive the scene and its copies. Such a scene cannot be saved.
RAYLANES_STATUS raylanes_scene_add_primitives(raylanes_scene* scene, const void* boxes, size_t n,
                                              size_t stride, raylanes_primitive_test test, void* context,
                                              const raylanes_build_options* options, uint32_t* geometry);
/// Adds a scene as it is, to be placed as a whole. Later changes of it do not change this scene, and it may be
/// destroyed. Its geometries are shared, and follow: its geometry i is geometry *geometry + 1 + i of this scene. It may
/// place scenes itself, to any depth. `context` of its own primitives must outlive this scene, too.
RAYLANES_STATUS raylanes_scene_add_scene(raylanes_scene* scene, const raylanes_scene* added,
                                         uint32_t* geometry);
/// Replaces a geometry by a tree, whose memory the scene shares; its instances stay where they are.
RAYLANES_STATUS raylanes_scene_replace_tree(raylanes_scene* scene, uint32_t geometry,
                                            const raylanes_bvh* tree);
/// Replaces a geometry by spheres; its instances stay where they are.
RAYLANES_STATUS raylanes_scene_replace_spheres(raylanes_scene* scene, uint32_t geometry, const void* spheres,
                                               size_t n, size_t stride,
                                               const raylanes_build_options* options);
/// Refits a geometry of triangles to another mesh with as many triangles, as raylanes_bvh_refit() does.
RAYLANES_STATUS raylanes_scene_refit(raylanes_scene* scene, uint32_t geometry, const void* vertices,
                                     size_t vertex_count, size_t vertex_stride, const void* triangles,
                                     size_t triangle_count, size_t triangle_stride, int32_t threads);

/// Gives the triangles of a geometry masks: calls with rays see triangle i only if masks[i] and the mask of the call
/// have a bit in common. Triangles from n on are always there, and n = 0 takes all masks away. The scene copies them. A
/// refit keeps them, a replacement takes them away, and a scene that has some cannot be saved.
RAYLANES_STATUS raylanes_scene_set_triangle_masks(raylanes_scene* scene, uint32_t geometry,
                                                  const uint32_t* masks, size_t n);

/// Places a geometry. The transform, row by row, maps a point (x, y, z) of the geometry to the scene: x' = t[0] x +
/// t[1] y + t[2] z + t[3], and y' and z' by the next four numbers each; NULL is the identity. An instance with mask 0
/// is never hit. The usual mask is 0xffffffff.
/// If the geometry is a scene, its instance j becomes instance *instance + 1 + j of this scene. That has the product of
/// both transforms, rounded to floats, and the bits that are in both masks. Hits name it.
RAYLANES_STATUS raylanes_scene_place(raylanes_scene* scene, uint32_t geometry, const float transform[12],
                                     uint32_t mask, uint32_t* instance);
/// Gives an instance another transform; NULL is the identity. If it places a scene, all instances of that move. An
/// instance that belongs to a placed scene is an invalid argument, here and in the next two functions.
RAYLANES_STATUS raylanes_scene_move(raylanes_scene* scene, uint32_t instance, const float transform[12]);
/// Gives an instance another mask, at once: raylanes_scene_update() is not needed.
RAYLANES_STATUS raylanes_scene_set_mask(raylanes_scene* scene, uint32_t instance, uint32_t mask);
/// Says that an instance will move or change otherwise, so that it is in no common tree; or, with 0, that it will not.
RAYLANES_STATUS raylanes_scene_set_moving(raylanes_scene* scene, uint32_t instance, int32_t moving);
/// Makes the scene ready for queries, and builds the trees that it needs. `threads` is as in raylanes_build_options.
RAYLANES_STATUS raylanes_scene_update(raylanes_scene* scene, int32_t threads);

/// Returns the number of geometries; 0 if the scene is NULL.
RAYLANES_API size_t raylanes_scene_geometry_count(const raylanes_scene* scene);
/// Returns the number of instances; 0 if the scene is NULL.
RAYLANES_API size_t raylanes_scene_instance_count(const raylanes_scene* scene);
/// Returns the bytes of the instances, the tree over them and the common trees, without geometries; 0 if scene is NULL.
RAYLANES_API size_t raylanes_scene_bytes(const raylanes_scene* scene);
/// Finds the geometry of an instance.
RAYLANES_STATUS raylanes_scene_geometry_of(const raylanes_scene* scene, uint32_t instance,
                                           uint32_t* geometry);
/// Finds the transform of an instance, twelve numbers row by row.
RAYLANES_STATUS raylanes_scene_transform_of(const raylanes_scene* scene, uint32_t instance,
                                            float transform[12]);
/// Finds the mask of an instance.
RAYLANES_STATUS raylanes_scene_mask_of(const raylanes_scene* scene, uint32_t instance, uint32_t* mask);
/// Writes the way to an instance from the outermost level in: the instance of this scene, then that of the scene which
/// this one places, and so on. *count is set to the number of levels, 1 if the instance belongs to no placed scene. If
/// that is more than `capacity`, nothing is written, and the status is RAYLANES_SMALL_BUFFER.
RAYLANES_STATUS raylanes_scene_levels_of(const raylanes_scene* scene, uint32_t instance,
                                         raylanes_instance_level* levels, size_t capacity, size_t* count);
/// Writes how the scene is traced to the first `size` bytes of report: sizeof(raylanes_scene_report).
RAYLANES_STATUS raylanes_scene_describe(const raylanes_scene* scene, raylanes_scene_report* report,
                                        size_t size);
/// Writes a box around all that can be hit, slightly enlarged, at the last update. A scene in which nothing can be hit
/// has lo = infinity and hi = -infinity.
RAYLANES_STATUS raylanes_scene_bounds(const raylanes_scene* scene, float lo[3], float hi[3]);

/// Writes the scene into a buffer, as raylanes_bvh_save() does. Invalid is a scene with primitives of your own.
RAYLANES_STATUS raylanes_scene_save(const raylanes_scene* scene, void* buffer, size_t capacity, size_t* size);
/// Writes the scene to a file, whose name is UTF-8. If this fails, a part may be there.
RAYLANES_STATUS raylanes_scene_save_file(const raylanes_scene* scene, const char* file);
/// Makes the scene that was saved as these bytes, ready for queries; bytes behind it are ignored. No bytes make a scene
/// that faults.
RAYLANES_STATUS raylanes_scene_load(raylanes_scene** scene, const void* bytes, size_t size);
/// Makes the scene that was saved to a file.
RAYLANES_STATUS raylanes_scene_load_file(raylanes_scene** scene, const char* file);

// Queries of rays, with the options of trees: `mask`, `skip` and `after` are meant for scenes.

/// Finds the nearest hit of each ray: a raylanes_scene_hit. Ties in t go to the lowest instance, then primitive.
RAYLANES_STATUS raylanes_scene_closest(const raylanes_scene* scene, const void* rays, size_t n, size_t stride,
                                       void* hits, size_t hit_stride, const raylanes_ray_options* options);
/// Finds the nearest hit of one ray. `active` is ignored.
RAYLANES_STATUS raylanes_scene_closest1(const raylanes_scene* scene, const raylanes_ray* ray,
                                        raylanes_scene_hit* hit, const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if ray i hits anything, else to 0.
RAYLANES_STATUS raylanes_scene_occluded(const raylanes_scene* scene, const void* rays, size_t n,
                                        size_t stride, uint8_t* occluded,
                                        const raylanes_ray_options* options);
/// Sets *occluded to 1 if the ray hits anything, else to 0. `active` is ignored.
RAYLANES_STATUS raylanes_scene_occluded1(const raylanes_scene* scene, const raylanes_ray* ray,
                                         uint8_t* occluded, const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if anything lies between `from` and points[i], as raylanes_bvh_occluded_from() does.
RAYLANES_STATUS raylanes_scene_occluded_from(const raylanes_scene* scene, const float from[3],
                                             const void* points, size_t n, size_t stride, float start,
                                             float end, uint8_t* occluded,
                                             const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if the ray from points[i] in that direction hits anything.
RAYLANES_STATUS raylanes_scene_occluded_towards(const raylanes_scene* scene, const float direction[3],
                                                const void* points, size_t n, size_t stride,
                                                uint8_t* occluded, const raylanes_ray_options* options);
/// Finds the nearest hit at which each ray passes through the surface of an instance. All geometries must consist of
/// triangles, as in the functions below.
RAYLANES_STATUS raylanes_scene_closest_crossing(const raylanes_scene* scene, const void* rays, size_t n,
                                                size_t stride, void* hits, size_t hit_stride,
                                                const raylanes_ray_options* options);
/// Finds the nearest hit at which one ray passes through the surface of an instance. `active` is ignored.
RAYLANES_STATUS raylanes_scene_closest_crossing1(const raylanes_scene* scene, const raylanes_ray* ray,
                                                 raylanes_scene_hit* hit,
                                                 const raylanes_ray_options* options);
/// Finds every hit of each ray once, in the order of t, then instance, then primitive: lists of raylanes_scene_hit.
/// Spheres and primitives of your own are allowed.
RAYLANES_STATUS raylanes_scene_all_hits(const raylanes_scene* scene, const void* rays, size_t n,
                                        size_t stride, raylanes_lists** lists,
                                        const raylanes_ray_options* options);
/// Finds each crossing of a ray and the surface of an instance once: lists of raylanes_scene_crossing.
RAYLANES_STATUS raylanes_scene_crossings(const raylanes_scene* scene, const void* rays, size_t n,
                                         size_t stride, raylanes_lists** lists,
                                         const raylanes_ray_options* options);
/// Counts the crossings of each ray over all instances, and sums up their sides.
RAYLANES_STATUS raylanes_scene_count_crossings(const raylanes_scene* scene, const void* rays, size_t n,
                                               size_t stride, raylanes_crossing_count* counts,
                                               const raylanes_ray_options* options);
/// Finds where each ray runs within each instance: lists of raylanes_scene_stretch, in the order of entries, then of
/// instances.
RAYLANES_STATUS raylanes_scene_stretches(const raylanes_scene* scene, const void* rays, size_t n,
                                         size_t stride, raylanes_lists** lists,
                                         const raylanes_ray_options* options);
/// Computes the unit normal in the scene of each raylanes_scene_hit: three floats, NaN for misses and for hits of other
/// primitives than triangles. Visits all leaves of the geometries that are hit.
RAYLANES_STATUS raylanes_scene_normals(const raylanes_scene* scene, const void* hits, size_t n,
                                       size_t hit_stride, float* normals, int32_t threads);
/// Writes the corners in the scene of the triangle of each raylanes_scene_hit: nine floats, NaN for misses and for hits
/// of other primitives than triangles.
RAYLANES_STATUS raylanes_scene_corners(const raylanes_scene* scene, const void* hits, size_t n,
                                       size_t hit_stride, float* corners, int32_t threads);

// Queries of points, three floats each, with the options of trees and `mask`. All instances that the mask sees must
// consist of triangles. Each instance decides in its own space, where points go as rays do.

/// Finds the closest point of the instances for each point. <raylanes/scene_hit.hpp> has the error bound.
RAYLANES_STATUS raylanes_scene_closest_points(const raylanes_scene* scene, const void* points, size_t n,
                                              size_t stride, raylanes_scene_closest_point* closest,
                                              const raylanes_point_options* options);
/// Finds out whether each point is inside an instance, on the surface of one and inside none, or outside all.
RAYLANES_STATUS raylanes_scene_locate(const raylanes_scene* scene, const void* points, size_t n,
                                      size_t stride, uint8_t* locations,
                                      const raylanes_point_options* options);
/// Computes how far each point is from the nearest surface of an instance, negative inside an instance.
RAYLANES_STATUS raylanes_scene_signed_distances(const raylanes_scene* scene, const void* points, size_t n,
                                                size_t stride, float* distances,
                                                const raylanes_point_options* options);
/// Computes the sum of the winding numbers of all instances at each point.
RAYLANES_STATUS raylanes_scene_winding_numbers(const raylanes_scene* scene, const void* points, size_t n,
                                               size_t stride, float* numbers,
                                               const raylanes_point_options* options);
/// Finds the innermost instance that contains each point: the one of the least volume.
RAYLANES_STATUS raylanes_scene_innermost_parts(const raylanes_scene* scene, const void* points, size_t n,
                                               size_t stride, raylanes_containing_part* parts,
                                               const raylanes_point_options* options);
/// Finds all instances that contain each point, innermost first: lists of raylanes_containing_part.
RAYLANES_STATUS raylanes_scene_containing_parts(const raylanes_scene* scene, const void* points, size_t n,
                                                size_t stride, raylanes_lists** lists,
                                                const raylanes_point_options* options);

#ifdef __cplusplus
}
#endif
#endif

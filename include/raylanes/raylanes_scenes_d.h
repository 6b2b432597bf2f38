// Scenes of doubles in C: trees of triangles whose corners are doubles, each placed any number of times.
// docs/doubles.md has an example in C++; <raylanes/scene_d.hpp> has the contracts in full. <raylanes/raylanes.h>
// includes this header and says what holds for all functions.
#ifndef RAYLANES_RAYLANES_SCENES_D_H
#define RAYLANES_RAYLANES_SCENES_D_H

#include <raylanes/raylanes.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Geometries of triangles of doubles, and instances that place them. Both are numbered from 0, in the order in which
/// they are added.
/// After any change, call raylanes_scene_d_update() before the next query: queries of a changed scene are invalid. Many
/// threads may query one scene at the same time, but not while it is changed or destroyed.
/// Rays are moved to the space of an instance: origin and direction are computed in pairs of doubles and rounded once.
/// Exact arithmetic on these doubles decides; t is the same in both spaces. Hits are ordered by t, then instance, then
/// primitive. <raylanes/scene_d.hpp> says which instances are never hit.
typedef struct raylanes_scene_d raylanes_scene_d;

// A geometry or an instance that does not exist is an invalid argument. The calls of this part set *geometry and
// *instance to the new index. If a call fails, the scene is unchanged.

/// Makes an empty scene of doubles.
RAYLANES_STATUS raylanes_scene_d_create(raylanes_scene_d** scene);
/// Makes a copy of a scene, which shares its geometries. A change in one of them changes nothing in the other.
RAYLANES_STATUS raylanes_scene_d_copy(raylanes_scene_d** scene, const raylanes_scene_d* from);
/// Destroys a scene of doubles; NULL is allowed.
RAYLANES_API void raylanes_scene_d_destroy(raylanes_scene_d* scene);

/// Adds a mesh of doubles. Its tree is built at once, with all options. Vertices and triangles are as in
/// raylanes_bvhd_create().
RAYLANES_STATUS raylanes_scene_d_add_mesh(raylanes_scene_d* scene, const void* vertices, size_t vertex_count,
                                          size_t vertex_stride, const void* triangles, size_t triangle_count,
                                          size_t triangle_stride, const raylanes_build_options* options,
                                          uint32_t* geometry);
/// Adds a tree of doubles, whose memory the scene shares. The tree may be destroyed; a refit of it changes no scene.
RAYLANES_STATUS raylanes_scene_d_add_tree(raylanes_scene_d* scene, const raylanes_bvhd* tree,
                                          uint32_t* geometry);
/// Adds a scene as it is, to be placed as a whole, as raylanes_scene_add_scene() does.
RAYLANES_STATUS raylanes_scene_d_add_scene(raylanes_scene_d* scene, const raylanes_scene_d* added,
                                           uint32_t* geometry);
/// Replaces a geometry by a tree, whose memory the scene shares; its instances stay where they are.
RAYLANES_STATUS raylanes_scene_d_replace_tree(raylanes_scene_d* scene, uint32_t geometry,
                                              const raylanes_bvhd* tree);
/// Refits a geometry to another mesh with as many triangles, as raylanes_bvhd_refit() does.
RAYLANES_STATUS raylanes_scene_d_refit(raylanes_scene_d* scene, uint32_t geometry, const void* vertices,
                                       size_t vertex_count, size_t vertex_stride, const void* triangles,
                                       size_t triangle_count, size_t triangle_stride, int32_t threads);
/// Gives the triangles of a geometry masks, as raylanes_scene_set_triangle_masks() does.
RAYLANES_STATUS raylanes_scene_d_set_triangle_masks(raylanes_scene_d* scene, uint32_t geometry,
                                                    const uint32_t* masks, size_t n);

/// Places a geometry. The transform, row by row, maps a point (x, y, z) of the geometry to the scene: x' = t[0] x +
/// t[1] y + t[2] z + t[3], and y' and z' by the next four numbers each; NULL is the identity. An instance with mask 0
/// is never hit. The usual mask is 0xffffffff.
/// If the geometry is a scene, its instance j becomes instance *instance + 1 + j of this scene, as in
/// raylanes_scene_place(). The product of both transforms is computed in pairs of doubles and rounded once.
RAYLANES_STATUS raylanes_scene_d_place(raylanes_scene_d* scene, uint32_t geometry, const double transform[12],
                                       uint32_t mask, uint32_t* instance);
/// Gives an instance another transform; NULL is the identity. If it places a scene, all instances of that move. An
/// instance that belongs to a placed scene is an invalid argument, here and in the next two functions.
RAYLANES_STATUS raylanes_scene_d_move(raylanes_scene_d* scene, uint32_t instance, const double transform[12]);
/// Gives an instance another mask, from the next raylanes_scene_d_update() on.
RAYLANES_STATUS raylanes_scene_d_set_mask(raylanes_scene_d* scene, uint32_t instance, uint32_t mask);
/// Says that an instance will move or change otherwise, so that it is in no common tree; or, with 0, that it will not.
RAYLANES_STATUS raylanes_scene_d_set_moving(raylanes_scene_d* scene, uint32_t instance, int32_t moving);
/// Makes the scene ready for queries, and builds the common trees that it needs. `threads` is as in
/// raylanes_build_options.
RAYLANES_STATUS raylanes_scene_d_update(raylanes_scene_d* scene, int32_t threads);

/// Returns the number of geometries; 0 if the scene is NULL.
RAYLANES_API size_t raylanes_scene_d_geometry_count(const raylanes_scene_d* scene);
/// Returns the number of instances; 0 if the scene is NULL.
RAYLANES_API size_t raylanes_scene_d_instance_count(const raylanes_scene_d* scene);
/// Returns the bytes of the instances, the tree over them and the common trees, without geometries; 0 if scene is NULL.
RAYLANES_API size_t raylanes_scene_d_bytes(const raylanes_scene_d* scene);
/// Finds the geometry of an instance.
RAYLANES_STATUS raylanes_scene_d_geometry_of(const raylanes_scene_d* scene, uint32_t instance,
                                             uint32_t* geometry);
/// Finds the transform of an instance, twelve numbers row by row.
RAYLANES_STATUS raylanes_scene_d_transform_of(const raylanes_scene_d* scene, uint32_t instance,
                                              double transform[12]);
/// Finds the mask of an instance.
RAYLANES_STATUS raylanes_scene_d_mask_of(const raylanes_scene_d* scene, uint32_t instance, uint32_t* mask);
/// Writes the way to an instance from the outermost level in, as raylanes_scene_levels_of() does.
RAYLANES_STATUS raylanes_scene_d_levels_of(const raylanes_scene_d* scene, uint32_t instance,
                                           raylanes_instance_level* levels, size_t capacity, size_t* count);
/// Writes how the scene is traced to the first `size` bytes of report: sizeof(raylanes_scene_report).
RAYLANES_STATUS raylanes_scene_d_describe(const raylanes_scene_d* scene, raylanes_scene_report* report,
                                          size_t size);
/// Writes a box around all that can be hit, slightly enlarged, at the last update. A scene in which nothing can be hit
/// has lo = infinity and hi = -infinity.
RAYLANES_STATUS raylanes_scene_d_bounds(const raylanes_scene_d* scene, double lo[3], double hi[3]);

/// Writes the scene into a buffer, as raylanes_bvhd_save() does. A scene whose triangles have masks is an invalid
/// argument.
RAYLANES_STATUS raylanes_scene_d_save(const raylanes_scene_d* scene, void* buffer, size_t capacity,
                                      size_t* size);
/// Writes the scene to a file, whose name is UTF-8. If this fails, a part may be there.
RAYLANES_STATUS raylanes_scene_d_save_file(const raylanes_scene_d* scene, const char* file);
/// Makes the scene that was saved as these bytes, ready for queries; bytes behind it are ignored. No bytes make a scene
/// that faults.
RAYLANES_STATUS raylanes_scene_d_load(raylanes_scene_d** scene, const void* bytes, size_t size);
/// Makes the scene that was saved to a file.
RAYLANES_STATUS raylanes_scene_d_load_file(raylanes_scene_d** scene, const char* file);

// Queries of rays, with the options of trees of doubles but for `masks`. `mask` is of instances, and `skip` and `after`
// name them.

/// Finds the nearest hit of each ray: a raylanes_scene_hit_d. Ties in t go to the lowest instance, then primitive.
RAYLANES_STATUS raylanes_scene_d_closest(const raylanes_scene_d* scene, const void* rays, size_t n,
                                         size_t stride, void* hits, size_t hit_stride,
                                         const raylanes_ray_options* options);
/// Finds the nearest hit of one ray. `active` is ignored.
RAYLANES_STATUS raylanes_scene_d_closest1(const raylanes_scene_d* scene, const raylanes_rayd* ray,
                                          raylanes_scene_hit_d* hit, const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if ray i hits anything, else to 0.
RAYLANES_STATUS raylanes_scene_d_occluded(const raylanes_scene_d* scene, const void* rays, size_t n,
                                          size_t stride, uint8_t* occluded,
                                          const raylanes_ray_options* options);
/// Sets *occluded to 1 if the ray hits anything, else to 0. `active` is ignored.
RAYLANES_STATUS raylanes_scene_d_occluded1(const raylanes_scene_d* scene, const raylanes_rayd* ray,
                                           uint8_t* occluded, const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if anything lies between `from` and points[i], as raylanes_bvhd_occluded_from() does.
RAYLANES_STATUS raylanes_scene_d_occluded_from(const raylanes_scene_d* scene, const double from[3],
                                               const void* points, size_t n, size_t stride, double start,
                                               double end, uint8_t* occluded,
                                               const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if the ray from points[i] in that direction hits anything.
RAYLANES_STATUS raylanes_scene_d_occluded_towards(const raylanes_scene_d* scene, const double direction[3],
                                                  const void* points, size_t n, size_t stride,
                                                  uint8_t* occluded, const raylanes_ray_options* options);
/// Finds the nearest hit at which each ray passes through the surface of an instance: a raylanes_scene_hit_d.
RAYLANES_STATUS raylanes_scene_d_closest_crossing(const raylanes_scene_d* scene, const void* rays, size_t n,
                                                  size_t stride, void* hits, size_t hit_stride,
                                                  const raylanes_ray_options* options);
/// Finds the nearest hit at which one ray passes through the surface of an instance. `active` is ignored.
RAYLANES_STATUS raylanes_scene_d_closest_crossing1(const raylanes_scene_d* scene, const raylanes_rayd* ray,
                                                   raylanes_scene_hit_d* hit,
                                                   const raylanes_ray_options* options);
/// Finds every hit of each ray once, in the order of t, then instance, then primitive: lists of raylanes_scene_hit_d.
RAYLANES_STATUS raylanes_scene_d_all_hits(const raylanes_scene_d* scene, const void* rays, size_t n,
                                          size_t stride, raylanes_lists** lists,
                                          const raylanes_ray_options* options);
/// Finds each crossing of a ray and the surface of an instance once: lists of raylanes_scene_crossing_d.
RAYLANES_STATUS raylanes_scene_d_crossings(const raylanes_scene_d* scene, const void* rays, size_t n,
                                           size_t stride, raylanes_lists** lists,
                                           const raylanes_ray_options* options);
/// Counts the crossings of each ray over all instances, and sums up their sides.
RAYLANES_STATUS raylanes_scene_d_count_crossings(const raylanes_scene_d* scene, const void* rays, size_t n,
                                                 size_t stride, raylanes_crossing_count* counts,
                                                 const raylanes_ray_options* options);
/// Finds where each ray runs within each instance: lists of raylanes_scene_stretch_d, in the order of entries, then of
/// instances.
RAYLANES_STATUS raylanes_scene_d_stretches(const raylanes_scene_d* scene, const void* rays, size_t n,
                                           size_t stride, raylanes_lists** lists,
                                           const raylanes_ray_options* options);
/// Computes the unit normal in the scene of each raylanes_scene_hit_d: three doubles, NaN for misses. Visits all leaves
/// of the geometries that are hit.
RAYLANES_STATUS raylanes_scene_d_normals(const raylanes_scene_d* scene, const void* hits, size_t n,
                                         size_t hit_stride, double* normals, int32_t threads);
/// Writes the corners in the scene of the triangle of each raylanes_scene_hit_d: nine doubles, NaN for misses.
RAYLANES_STATUS raylanes_scene_d_corners(const raylanes_scene_d* scene, const void* hits, size_t n,
                                         size_t hit_stride, double* corners, int32_t threads);

// Queries of points, three doubles each, with the options of trees and `mask`. Each instance decides in its own space,
// where points go as rays do.

/// Finds the closest point of the instances for each point. <raylanes/scene_d.hpp> has the error bound.
RAYLANES_STATUS raylanes_scene_d_closest_points(const raylanes_scene_d* scene, const void* points, size_t n,
                                                size_t stride, raylanes_scene_closest_point_d* closest,
                                                const raylanes_point_options* options);
/// Finds out whether each point is inside an instance, on the surface of one and inside none, or outside all.
RAYLANES_STATUS raylanes_scene_d_locate(const raylanes_scene_d* scene, const void* points, size_t n,
                                        size_t stride, uint8_t* locations,
                                        const raylanes_point_options* options);
/// Computes how far each point is from the nearest surface of an instance, negative inside an instance.
RAYLANES_STATUS raylanes_scene_d_signed_distances(const raylanes_scene_d* scene, const void* points, size_t n,
                                                  size_t stride, double* distances,
                                                  const raylanes_point_options* options);
/// Computes the sum of the winding numbers of all instances at each point.
RAYLANES_STATUS raylanes_scene_d_winding_numbers(const raylanes_scene_d* scene, const void* points, size_t n,
                                                 size_t stride, double* numbers,
                                                 const raylanes_point_options* options);
/// Finds the innermost instance that contains each point: the one of the least volume.
RAYLANES_STATUS raylanes_scene_d_innermost_parts(const raylanes_scene_d* scene, const void* points, size_t n,
                                                 size_t stride, raylanes_containing_part* parts,
                                                 const raylanes_point_options* options);
/// Finds all instances that contain each point, innermost first: lists of raylanes_containing_part.
RAYLANES_STATUS raylanes_scene_d_containing_parts(const raylanes_scene_d* scene, const void* points, size_t n,
                                                  size_t stride, raylanes_lists** lists,
                                                  const raylanes_point_options* options);

#ifdef __cplusplus
}
#endif
#endif

// The C interface: trees over triangles of floats and doubles, scenes, their queries, and roots of arrays, for C99 and
// all that can call C. docs/guide/from_c.md has examples.
//
// All functions:
// - Nothing is thrown. A function that can fail returns a status, and raylanes_last_message() has one line about it.
//   If the status is RAYLANES_INVALID_ARGUMENT, results are unchanged.
// - Many threads may use one tree at the same time, but not while it is refitted or destroyed.
// - A function of yours that a call calls may call the library, but change nothing that the call uses. If it is C++, it
//   may throw: the status is RAYLANES_FAILED.
// - `options` may be NULL: each member then has its default.
// - An array may be NULL if it has no elements. Elements lie `stride` bytes apart, at any alignment; 0: side by side.
//   Arrays without a stride need the alignment of their elements. Arrays of results overlap no other array, but for
//   `skip` and `active`; trees refuse rays and points that do.
// - A stride less than an element, and a size beyond the address space, are invalid arguments.
#ifndef RAYLANES_RAYLANES_H
#define RAYLANES_RAYLANES_H

#include <raylanes/raylanes_types.h>
#include <stddef.h>
#include <stdint.h>

/// Stands before each function. Define RAYLANES_DLL in programs for Windows that link the DLL.
#if defined(_WIN32) && defined(RAYLANES_DLL)
#define RAYLANES_API __declspec(dllimport)
#else
#define RAYLANES_API
#endif
/// Stands before each function that can fail, which returns a status.
#define RAYLANES_STATUS RAYLANES_API raylanes_status

#ifdef __cplusplus
extern "C" {
#endif

/// Returns the message of the last call of this thread that failed, or "". It is valid until the next one that fails.
RAYLANES_API const char* raylanes_last_message(void);
/// Returns the version of the library, "major.minor.patch", with "-dev" between releases.
RAYLANES_API const char* raylanes_version(void);

// ISA paths. Functions that take a `path` take the name of one that this machine supports. NULL is the active one: the
// forced one, else that of the environment variable RAYLANES_PATH, else the best one.

/// Returns the number of ISA paths of this build.
RAYLANES_API size_t raylanes_path_count(void);
/// Finds the name of an ISA path, slowest first, and whether this machine supports it. The name is never freed.
RAYLANES_STATUS raylanes_path_at(size_t index, const char** name, int32_t* is_supported);
/// Finds the name of the active ISA path. Invalid is a RAYLANES_PATH that this machine does not support.
RAYLANES_STATUS raylanes_active_path(const char** name);
/// Makes an ISA path the active one for all threads; NULL undoes this.
RAYLANES_STATUS raylanes_force_path(const char* name);

/// Writes the defaults to the first `size` bytes of options, and the size.
RAYLANES_STATUS raylanes_init_build_options(raylanes_build_options* options, size_t size);
/// Writes the defaults of rays to the first `size` bytes of options, and the size.
RAYLANES_STATUS raylanes_init_ray_options(raylanes_ray_options* options, size_t size);
/// Writes the defaults of points to the first `size` bytes of options, and the size.
RAYLANES_STATUS raylanes_init_point_options(raylanes_point_options* options, size_t size);

/// A tree over triangles of floats. Exact arithmetic on these floats decides, and t, u and v are rounded once.
typedef struct raylanes_bvh raylanes_bvh;
/// A tree over triangles of doubles, exact on these doubles.
typedef struct raylanes_bvhd raylanes_bvhd;

// Trees. Vertices are three floats or doubles, triangles three uint32_t, or three int32_t that are not negative. A call
// that makes a tree sets *tree to NULL if it fails.

/// Builds a tree over a mesh, which it copies. Triangles with two equal corners are left out.
/// Invalid are indices that are not below vertex_count, corners that are not finite, and more than 2^28 triangles.
RAYLANES_STATUS raylanes_bvh_create(raylanes_bvh** tree, const void* vertices, size_t vertex_count,
                                    size_t vertex_stride, const void* triangles, size_t triangle_count,
                                    size_t triangle_stride, const raylanes_build_options* options);
/// Builds a tree over a mesh of doubles.
RAYLANES_STATUS raylanes_bvhd_create(raylanes_bvhd** tree, const void* vertices, size_t vertex_count,
                                     size_t vertex_stride, const void* triangles, size_t triangle_count,
                                     size_t triangle_stride, const raylanes_build_options* options);
/// Makes this the tree of another mesh with as many triangles, such as the same one in motion, faster than a build. If
/// this fails, the tree is unchanged. Scenes that have the tree keep it as it was: a copy is refitted then. `threads`
/// is as in raylanes_build_options.
RAYLANES_STATUS raylanes_bvh_refit(raylanes_bvh* tree, const void* vertices, size_t vertex_count,
                                   size_t vertex_stride, const void* triangles, size_t triangle_count,
                                   size_t triangle_stride, int32_t threads);
/// Makes this the tree of another mesh of doubles with as many triangles.
RAYLANES_STATUS raylanes_bvhd_refit(raylanes_bvhd* tree, const void* vertices, size_t vertex_count,
                                    size_t vertex_stride, const void* triangles, size_t triangle_count,
                                    size_t triangle_stride, int32_t threads);
/// Destroys a tree; NULL is allowed.
RAYLANES_API void raylanes_bvh_destroy(raylanes_bvh* tree);
/// Destroys a tree of doubles; NULL is allowed.
RAYLANES_API void raylanes_bvhd_destroy(raylanes_bvhd* tree);

/// Writes the tree into a buffer of `capacity` bytes, and the bytes that it takes to *size. If these are more, the
/// status is RAYLANES_SMALL_BUFFER. So a call with NULL and 0 asks for the size.
RAYLANES_STATUS raylanes_bvh_save(const raylanes_bvh* tree, void* buffer, size_t capacity, size_t* size);
/// Writes the tree of doubles into a buffer.
RAYLANES_STATUS raylanes_bvhd_save(const raylanes_bvhd* tree, void* buffer, size_t capacity, size_t* size);
/// Writes the tree to a file, whose name is UTF-8. If this fails, a part may be there.
RAYLANES_STATUS raylanes_bvh_save_file(const raylanes_bvh* tree, const char* file);
/// Writes the tree of doubles to a file.
RAYLANES_STATUS raylanes_bvhd_save_file(const raylanes_bvhd* tree, const char* file);
/// Makes the tree that was saved as these bytes; bytes behind it are ignored. No bytes make a tree that faults.
RAYLANES_STATUS raylanes_bvh_load(raylanes_bvh** tree, const void* bytes, size_t size);
/// Makes the tree of doubles that was saved as these bytes.
RAYLANES_STATUS raylanes_bvhd_load(raylanes_bvhd** tree, const void* bytes, size_t size);
/// Makes the tree that was saved to a file, whose name is UTF-8. If this returns RAYLANES_BAD_FILE,
/// raylanes_last_message() has the name and the cause, also if the name is not UTF-8.
RAYLANES_STATUS raylanes_bvh_load_file(raylanes_bvh** tree, const char* file);
/// Makes the tree of doubles that was saved to a file.
RAYLANES_STATUS raylanes_bvhd_load_file(raylanes_bvhd** tree, const char* file);

// Queries of rays: raylanes_ray, or raylanes_rayd in trees of doubles. Results of inactive rays are unchanged.

/// Finds the nearest hit of each ray: a raylanes_hit. Ties in t go to the lowest primitive.
RAYLANES_STATUS raylanes_bvh_closest(const raylanes_bvh* tree, const void* rays, size_t n, size_t stride,
                                     void* hits, size_t hit_stride, const raylanes_ray_options* options);
/// Finds the nearest hit of each ray of doubles: a raylanes_hitd.
RAYLANES_STATUS raylanes_bvhd_closest(const raylanes_bvhd* tree, const void* rays, size_t n, size_t stride,
                                      void* hits, size_t hit_stride, const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if ray i hits any triangle, else to 0.
RAYLANES_STATUS raylanes_bvh_occluded(const raylanes_bvh* tree, const void* rays, size_t n, size_t stride,
                                      uint8_t* occluded, const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if ray i of doubles hits any triangle, else to 0.
RAYLANES_STATUS raylanes_bvhd_occluded(const raylanes_bvhd* tree, const void* rays, size_t n, size_t stride,
                                       uint8_t* occluded, const raylanes_ray_options* options);
/// Finds the nearest hit of one ray, with less overhead than a batch has. `active` is ignored.
RAYLANES_STATUS raylanes_bvh_closest1(const raylanes_bvh* tree, const raylanes_ray* ray, raylanes_hit* hit,
                                      const raylanes_ray_options* options);
/// Finds the nearest hit of one ray of doubles.
RAYLANES_STATUS raylanes_bvhd_closest1(const raylanes_bvhd* tree, const raylanes_rayd* ray,
                                       raylanes_hitd* hit, const raylanes_ray_options* options);
/// Sets *occluded to 1 if the ray hits any triangle, else to 0. `active` is ignored.
RAYLANES_STATUS raylanes_bvh_occluded1(const raylanes_bvh* tree, const raylanes_ray* ray, uint8_t* occluded,
                                       const raylanes_ray_options* options);
/// Sets *occluded to 1 if the ray of doubles hits any triangle, else to 0.
RAYLANES_STATUS raylanes_bvhd_occluded1(const raylanes_bvhd* tree, const raylanes_rayd* ray,
                                        uint8_t* occluded, const raylanes_ray_options* options);
/// Calls with one ray, prepared once: for loops that trace ray by ray.
typedef struct raylanes_bvh_calls raylanes_bvh_calls;
/// Calls with one ray of doubles.
typedef struct raylanes_bvhd_calls raylanes_bvhd_calls;
/// Prepares raylanes_bvh_calls_closest() and raylanes_bvh_calls_occluded(): they find what closest1 and occluded1 find
/// by these options, in less time. They are valid until the tree is refitted or destroyed, and read `skip` and `after`
/// in each call. Make them in the thread that uses them, and again if floating-point exceptions shall trap.
RAYLANES_STATUS raylanes_bvh_calls_create(raylanes_bvh_calls** calls, const raylanes_bvh* tree,
                                          const raylanes_ray_options* options);
/// Prepares calls with one ray of doubles.
RAYLANES_STATUS raylanes_bvhd_calls_create(raylanes_bvhd_calls** calls, const raylanes_bvhd* tree,
                                           const raylanes_ray_options* options);
/// Destroys calls, before or after their tree; NULL is allowed.
RAYLANES_API void raylanes_bvh_calls_destroy(raylanes_bvh_calls* calls);
/// Destroys calls with rays of doubles; NULL is allowed.
RAYLANES_API void raylanes_bvhd_calls_destroy(raylanes_bvhd_calls* calls);
/// Finds the nearest hit of one ray.
RAYLANES_STATUS raylanes_bvh_calls_closest(const raylanes_bvh_calls* calls, const raylanes_ray* ray,
                                           raylanes_hit* hit);
/// Finds the nearest hit of one ray of doubles.
RAYLANES_STATUS raylanes_bvhd_calls_closest(const raylanes_bvhd_calls* calls, const raylanes_rayd* ray,
                                            raylanes_hitd* hit);
/// Sets *occluded to 1 if the ray hits any triangle, else to 0.
RAYLANES_STATUS raylanes_bvh_calls_occluded(const raylanes_bvh_calls* calls, const raylanes_ray* ray,
                                            uint8_t* occluded);
/// Sets *occluded to 1 if the ray of doubles hits any triangle, else to 0.
RAYLANES_STATUS raylanes_bvhd_calls_occluded(const raylanes_bvhd_calls* calls, const raylanes_rayd* ray,
                                             uint8_t* occluded);
/// Sets occluded[i] to 1 if a triangle lies between `from` and points[i], three floats each, else to 0: shadows of one
/// light. Tests the part of each segment between the shares `start` and `end` of its length, counted from `from`: 0 and
/// 1 are all of it, both points included. `facing` is as `from` sees it. Item i of `skip` and `active` is that of
/// points[i]. TriangleTree::occluded_from() in <raylanes/triangle_tree.hpp> has the error bound.
RAYLANES_STATUS raylanes_bvh_occluded_from(const raylanes_bvh* tree, const float from[3], const void* points,
                                           size_t n, size_t stride, float start, float end, uint8_t* occluded,
                                           const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if a triangle lies between `from` and points[i], three doubles each, else to 0.
RAYLANES_STATUS raylanes_bvhd_occluded_from(const raylanes_bvhd* tree, const double from[3],
                                            const void* points, size_t n, size_t stride, double start,
                                            double end, uint8_t* occluded,
                                            const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if the ray from points[i], three floats, in that direction of any length hits any triangle,
/// else to 0: shadows of a sun. The ray begins at its point and has no end. Item i of `skip` and `active` is that of
/// points[i].
RAYLANES_STATUS raylanes_bvh_occluded_towards(const raylanes_bvh* tree, const float direction[3],
                                              const void* points, size_t n, size_t stride, uint8_t* occluded,
                                              const raylanes_ray_options* options);
/// Sets occluded[i] to 1 if the ray from points[i], three doubles, in that direction hits any triangle, else to 0.
RAYLANES_STATUS raylanes_bvhd_occluded_towards(const raylanes_bvhd* tree, const double direction[3],
                                               const void* points, size_t n, size_t stride, uint8_t* occluded,
                                               const raylanes_ray_options* options);
/// Finds the nearest hit at which each ray passes through the surface, such as the exit of a solid with
/// RAYLANES_FACING_BACK. An edge counts once, or not at all if the ray only touches it.
RAYLANES_STATUS raylanes_bvh_closest_crossing(const raylanes_bvh* tree, const void* rays, size_t n,
                                              size_t stride, void* hits, size_t hit_stride,
                                              const raylanes_ray_options* options);
/// Finds the nearest hit at which each ray of doubles passes through the surface.
RAYLANES_STATUS raylanes_bvhd_closest_crossing(const raylanes_bvhd* tree, const void* rays, size_t n,
                                               size_t stride, void* hits, size_t hit_stride,
                                               const raylanes_ray_options* options);

/// Finds the nearest hit at which one ray passes through the surface. `active` is ignored.
RAYLANES_STATUS raylanes_bvh_closest_crossing1(const raylanes_bvh* tree, const raylanes_ray* ray,
                                               raylanes_hit* hit, const raylanes_ray_options* options);
/// Finds the nearest hit at which one ray of doubles passes through the surface.
RAYLANES_STATUS raylanes_bvhd_closest_crossing1(const raylanes_bvhd* tree, const raylanes_rayd* ray,
                                                raylanes_hitd* hit, const raylanes_ray_options* options);

/// A list of items for each ray. Calls that make lists set *lists to NULL if they fail.
typedef struct raylanes_lists raylanes_lists;
/// Returns where the items of each ray begin, and the end of the last: one number more than rays. NULL if lists is.
RAYLANES_API const size_t* raylanes_lists_offsets(const raylanes_lists* lists);
/// Returns the items of all rays, of the type that the call names. NULL if lists is, or there are none.
RAYLANES_API const void* raylanes_lists_items(const raylanes_lists* lists);
/// Destroys lists; NULL is allowed.
RAYLANES_API void raylanes_lists_destroy(raylanes_lists* lists);

/// Finds every hit of each ray once, in the order of t, then of primitives: lists of raylanes_hit.
RAYLANES_STATUS raylanes_bvh_all_hits(const raylanes_bvh* tree, const void* rays, size_t n, size_t stride,
                                      raylanes_lists** lists, const raylanes_ray_options* options);
/// Finds every hit of each ray of doubles once: lists of raylanes_hitd.
RAYLANES_STATUS raylanes_bvhd_all_hits(const raylanes_bvhd* tree, const void* rays, size_t n, size_t stride,
                                       raylanes_lists** lists, const raylanes_ray_options* options);
/// Finds each crossing of a ray and the surface once: lists of raylanes_crossing. A ray leaves a closed mesh as often
/// as it enters it, also through edges and corners.
RAYLANES_STATUS raylanes_bvh_crossings(const raylanes_bvh* tree, const void* rays, size_t n, size_t stride,
                                       raylanes_lists** lists, const raylanes_ray_options* options);
/// Finds each crossing of a ray of doubles and the surface once: lists of raylanes_crossingd.
RAYLANES_STATUS raylanes_bvhd_crossings(const raylanes_bvhd* tree, const void* rays, size_t n, size_t stride,
                                        raylanes_lists** lists, const raylanes_ray_options* options);
/// Counts the crossings of each ray, and sums up their sides, without lists.
RAYLANES_STATUS raylanes_bvh_count_crossings(const raylanes_bvh* tree, const void* rays, size_t n,
                                             size_t stride, raylanes_crossing_count* counts,
                                             const raylanes_ray_options* options);
/// Counts the crossings of each ray of doubles, and sums up their sides.
RAYLANES_STATUS raylanes_bvhd_count_crossings(const raylanes_bvhd* tree, const void* rays, size_t n,
                                              size_t stride, raylanes_crossing_count* counts,
                                              const raylanes_ray_options* options);

/// Finds where each ray runs within the solids of the tree, each entry with its exit: lists of raylanes_stretch.
/// `facing` must be RAYLANES_FACING_ANY. <raylanes/stretches.hpp> has the definition.
RAYLANES_STATUS raylanes_bvh_stretches(const raylanes_bvh* tree, const void* rays, size_t n, size_t stride,
                                       raylanes_lists** lists, const raylanes_ray_options* options);
/// Finds where each ray of doubles runs within the solids of the tree: lists of raylanes_stretchd.
RAYLANES_STATUS raylanes_bvhd_stretches(const raylanes_bvhd* tree, const void* rays, size_t n, size_t stride,
                                        raylanes_lists** lists, const raylanes_ray_options* options);

// The triangles of a tree, as the mesh had them at the last build or refit.

/// Writes v0, v1 and v2 of the triangle of each uint32_t: nine floats. A triangle that the tree does not have, such as
/// that of a miss, has nine NaN. Primitives may lie in hits, sizeof(raylanes_hit) bytes apart.
RAYLANES_STATUS raylanes_bvh_corners(const raylanes_bvh* tree, const void* primitives, size_t n,
                                     size_t stride, float* corners);
/// Writes v0, v1 and v2 of the triangle of each uint32_t: nine doubles.
RAYLANES_STATUS raylanes_bvhd_corners(const raylanes_bvhd* tree, const void* primitives, size_t n,
                                      size_t stride, double* corners);
/// Writes the box around all triangles. An empty tree has lo = infinity and hi = -infinity.
RAYLANES_STATUS raylanes_bvh_bounds(const raylanes_bvh* tree, float lo[3], float hi[3]);
/// Writes the box around all triangles of doubles.
RAYLANES_STATUS raylanes_bvhd_bounds(const raylanes_bvhd* tree, double lo[3], double hi[3]);

// Queries of points: three floats, or three doubles in trees of doubles. Results of inactive points are unchanged.

/// Finds out exactly whether each point is inside, outside or on the surface: a raylanes_location. The mesh should be
/// closed, but for RAYLANES_RULE_VOTE and RAYLANES_RULE_WINDING. Points that are not finite are outside.
RAYLANES_STATUS raylanes_bvh_locate(const raylanes_bvh* tree, const void* points, size_t n, size_t stride,
                                    uint8_t* locations, const raylanes_point_options* options);
/// Finds out exactly whether each point of doubles is inside, outside or on the surface.
RAYLANES_STATUS raylanes_bvhd_locate(const raylanes_bvhd* tree, const void* points, size_t n, size_t stride,
                                     uint8_t* locations, const raylanes_point_options* options);
/// Finds the closest point of the mesh for each point. <raylanes/points.hpp> has the error bound.
RAYLANES_STATUS raylanes_bvh_closest_points(const raylanes_bvh* tree, const void* points, size_t n,
                                            size_t stride, raylanes_closest_point* closest,
                                            const raylanes_point_options* options);
/// Finds the closest point of the mesh for each point of doubles. <raylanes/points.hpp> has the error bound.
RAYLANES_STATUS raylanes_bvhd_closest_points(const raylanes_bvhd* tree, const void* points, size_t n,
                                             size_t stride, raylanes_closest_pointd* closest,
                                             const raylanes_point_options* options);
/// Computes how far each point is from the surface, negative inside; 0 if and only if it is on a triangle, infinite if
/// nothing is within max_distance.
RAYLANES_STATUS raylanes_bvh_signed_distances(const raylanes_bvh* tree, const void* points, size_t n,
                                              size_t stride, float* distances,
                                              const raylanes_point_options* options);
/// Computes how far each point of doubles is from the surface, negative inside.
RAYLANES_STATUS raylanes_bvhd_signed_distances(const raylanes_bvhd* tree, const void* points, size_t n,
                                               size_t stride, double* distances,
                                               const raylanes_point_options* options);
/// Computes the generalised winding number of each point: 1 inside a closed mesh whose normals point out. The error is
/// at most accuracy + 2^-24·|w| + 2^-40·n, with n edges of the boundary. The first call finds the boundary.
RAYLANES_STATUS raylanes_bvh_winding_numbers(const raylanes_bvh* tree, const void* points, size_t n,
                                             size_t stride, float* numbers,
                                             const raylanes_point_options* options);
/// Computes the generalised winding number of each point of doubles, with 2^-53·|w| in place of 2^-24·|w|.
RAYLANES_STATUS raylanes_bvhd_winding_numbers(const raylanes_bvhd* tree, const void* points, size_t n,
                                              size_t stride, double* numbers,
                                              const raylanes_point_options* options);

// Roots of arrays: x and y are the same array or do not overlap. NaN, infinities, zeros and negative numbers give what
// IEEE 754 says. `accuracy` is a raylanes_accuracy, `path` the name of an ISA path or NULL.

/// Writes the loosest raylanes_accuracy that keeps floats within a relative error. An error below 2^-24, which rounding
/// has, is an invalid argument.
RAYLANES_STATUS raylanes_accuracy_within(double relative_error, int32_t* accuracy);
/// Writes the loosest raylanes_accuracy that keeps doubles within a relative error, of 2^-53 or more.
RAYLANES_STATUS raylanes_accuracy_withind(double relative_error, int32_t* accuracy);

/// Computes y[i] = √x[i].
RAYLANES_STATUS raylanes_sqrt(const float* x, float* y, size_t n, int32_t accuracy, const char* path);
/// Computes y[i] = √x[i] of doubles.
RAYLANES_STATUS raylanes_sqrtd(const double* x, double* y, size_t n, int32_t accuracy, const char* path);
/// Computes y[i] = 1/√x[i].
RAYLANES_STATUS raylanes_rsqrt(const float* x, float* y, size_t n, int32_t accuracy, const char* path);
/// Computes y[i] = 1/√x[i] of doubles; RAYLANES_CORRECTLY_ROUNDED is an invalid argument.
RAYLANES_STATUS raylanes_rsqrtd(const double* x, double* y, size_t n, int32_t accuracy, const char* path);
/// Computes y[i] = 1/x[i].
RAYLANES_STATUS raylanes_reciprocal(const float* x, float* y, size_t n, int32_t accuracy, const char* path);
/// Computes y[i] = 1/x[i] of doubles.
RAYLANES_STATUS raylanes_reciprocald(const double* x, double* y, size_t n, int32_t accuracy,
                                     const char* path);

#ifdef __cplusplus
}
#endif

#include <raylanes/raylanes_scenes.h>
#include <raylanes/raylanes_scenes_d.h>
#endif

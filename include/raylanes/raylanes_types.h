// The types of the C interface: statuses, rays and results, enumerations, and options. <raylanes/raylanes.h> has
// the functions and includes this header.
#ifndef RAYLANES_RAYLANES_TYPES_H
#define RAYLANES_RAYLANES_TYPES_H

#include <stddef.h>
#include <stdint.h>

/// The outcome of a call.
typedef enum raylanes_status {
  RAYLANES_OK = 0,
  RAYLANES_INVALID_ARGUMENT = 1,  ///< The message says which one, and what is allowed.
  RAYLANES_OUT_OF_MEMORY = 2,     ///< On several threads some results may be written.
  RAYLANES_TOO_LARGE = 3,         ///< A tree would have more nodes or leaves than can be numbered.
  RAYLANES_BAD_FILE = 4,      ///< Bytes are no tree or scene, or a file cannot be opened, read or written.
  RAYLANES_SMALL_BUFFER = 5,  ///< The caller's buffer is too small.
  RAYLANES_FAILED = 6,        ///< Anything else, such as a thread that cannot be started.
  RAYLANES_CANCELLED = 7      ///< A function of the caller ended the call. Some results may be written.
} raylanes_status;

/// The primitive of a miss.
#define RAYLANES_NO_PRIMITIVE 0xffffffffu
/// The geometry and the instance of a miss in a scene.
#define RAYLANES_NO_PART 0xffffffffu

/// The points origin + t·direction with tmin <= t <= tmax. The direction may have any length. A ray hits nothing if a
/// coordinate is not finite, the direction is zero, tmin or tmax is NaN, or tmin > tmax.
typedef struct raylanes_ray {
  float origin[3], tmin, direction[3], tmax;
} raylanes_ray;
/// A ray of doubles.
typedef struct raylanes_rayd {
  double origin[3], tmin, direction[3], tmax;
} raylanes_rayd;

/// A hit at the point (1-u-v)·v0 + u·v1 + v·v2 of a triangle. A miss has t = infinity and u = v = 0.
typedef struct raylanes_hit {
  float t, u, v;
  uint32_t primitive;  ///< the index of the triangle, or RAYLANES_NO_PRIMITIVE
} raylanes_hit;
/// A hit of doubles.
typedef struct raylanes_hitd {
  double t, u, v;
  uint32_t primitive, unused;
} raylanes_hitd;

/// A hit in a scene, and what was hit. A miss has RAYLANES_NO_PRIMITIVE and RAYLANES_NO_PART.
typedef struct raylanes_scene_hit {
  float t, u, v;
  uint32_t primitive;           ///< the index within the geometry
  uint32_t geometry, instance;  ///< of the scene
} raylanes_scene_hit;
/// A hit in a scene of doubles.
typedef struct raylanes_scene_hit_d {
  double t, u, v;
  uint32_t primitive, geometry, instance, unused;
} raylanes_scene_hit_d;

/// A crossing of a ray and the surface.
typedef struct raylanes_crossing {
  float t;
  uint32_t primitive;
  int32_t side;  ///< 1: along the normal (v1 - v0) x (v2 - v0), out of a solid; -1: against it
} raylanes_crossing;
/// A crossing of doubles.
typedef struct raylanes_crossingd {
  double t;
  uint32_t primitive;
  int32_t side;
} raylanes_crossingd;

/// A crossing of a ray and the surface of an instance. The side is that in the space of the instance.
typedef struct raylanes_scene_crossing {
  float t;
  uint32_t primitive;
  int32_t side;
  uint32_t geometry, instance;
} raylanes_scene_crossing;
/// A crossing of a ray of doubles and the surface of an instance.
typedef struct raylanes_scene_crossing_d {
  double t;
  uint32_t primitive;
  int32_t side;
  uint32_t geometry, instance;
} raylanes_scene_crossing_d;

/// A stretch of a ray within solids, along which the winding number is one number other than 0.
typedef struct raylanes_stretch {
  float entry, exit;             ///< entry < exit
  uint32_t entered_by, left_by;  ///< the triangles there; RAYLANES_NO_PRIMITIVE where the ray begins or ends
  int32_t winding;               ///< 1 in a closed mesh whose normals point out
} raylanes_stretch;
/// A stretch of a ray of doubles.
typedef struct raylanes_stretchd {
  double entry, exit;
  uint32_t entered_by, left_by;
  int32_t winding;
} raylanes_stretchd;
/// A stretch of a ray within an instance.
typedef struct raylanes_scene_stretch {
  float entry, exit;
  uint32_t entered_by, left_by;
  int32_t winding;
  uint32_t geometry, instance;
} raylanes_scene_stretch;
/// A stretch of a ray of doubles within an instance.
typedef struct raylanes_scene_stretch_d {
  double entry, exit;
  uint32_t entered_by, left_by;
  int32_t winding;
  uint32_t unused;
  uint32_t geometry, instance;
} raylanes_scene_stretch_d;

/// How often a ray crosses the surface, and the sum of the sides.
typedef struct raylanes_crossing_count {
  uint32_t crossings;
  int32_t winding;
} raylanes_crossing_count;

/// The closest point of a mesh. If there is none, distance_squared is infinite.
typedef struct raylanes_closest_point {
  double distance_squared;
  float point[3], u, v;
  uint32_t primitive;  ///< the index of the triangle, or RAYLANES_NO_PRIMITIVE
} raylanes_closest_point;
/// The closest point of a mesh of doubles.
typedef struct raylanes_closest_pointd {
  double distance_squared, distance, point[3], u, v;
  uint32_t primitive, unused;
} raylanes_closest_pointd;

/// A sphere. If the radius is negative or NaN, or its square overflows, nothing hits it.
typedef struct raylanes_sphere {
  float centre[3], radius;
} raylanes_sphere;

/// How a scene is traced. Meshes that stand where they were made are traced as one tree, the common tree.
typedef struct raylanes_scene_report {
  size_t common_trees;         ///< common trees: up to four, for instances of different masks
  size_t common_instances;     ///< instances in them
  size_t common_triangles;     ///< their triangles
  size_t common_bytes;         ///< their memory, besides the trees of geometries
  size_t mesh_triangles;       ///< triangles of all geometries
  size_t meshes_without_tree;  ///< meshes that needed no tree of their own so far
} raylanes_scene_report;

// Functions of the caller get the pointer that was given with them.

/// A function that rejects hits of a batch. hits[k] is a hit of ray rays[k] of the call: a raylanes_hit, in trees of
/// doubles a raylanes_hitd, in scenes a raylanes_scene_hit, in scenes of doubles a raylanes_scene_hit_d. Set
/// rejected[k], which is 0, to 1 to trace the ray on after that hit. Return 0, or any other number to end the call with
/// RAYLANES_CANCELLED.
/// The calling thread calls it, with one hit of each of many rays. It sees the hits of a ray in order, each once, up to
/// the one that it keeps. Calls with one ray ask about one hit, in any order, perhaps behind the result and more than
/// once.
typedef int32_t (*raylanes_filter)(void* context, size_t count, const size_t* rays, const void* hits,
                                   uint8_t* rejected);
/// A function that a long call calls with the share of its work that is done: 0 first, 1 last, never decreasing. Return
/// 0, or any other number to end the call with RAYLANES_CANCELLED.
/// A build calls it from any of its threads, one at a time; a query from the calling thread, about every 20 ms.
typedef int32_t (*raylanes_progress)(void* context, double share);
/// A test of a primitive of your own: if the ray hits it with tmin <= t <= tmax, set t, u and v of *hit and return 1,
/// else 0. Any thread that traces calls it. Hits must lie in the box of the primitive. <raylanes/bounded_tree.hpp> says
/// how a primitive has several hits.
typedef int32_t (*raylanes_primitive_test)(void* context, uint32_t primitive, const raylanes_ray* ray,
                                           raylanes_hit* hit);

/// The closest point of a scene, in its space. If there is none, distance_squared is infinite.
typedef struct raylanes_scene_closest_point {
  double distance_squared;
  float point[3], u, v;
  uint32_t primitive, geometry, instance;  ///< as in raylanes_scene_hit
} raylanes_scene_closest_point;
/// The closest point of a scene of doubles, in its space.
typedef struct raylanes_scene_closest_point_d {
  double distance_squared, distance, point[3], u, v;
  uint32_t primitive, geometry, instance, unused;
} raylanes_scene_closest_point_d;

/// An instance of one level of scenes within scenes, by the numbers of the scene at that level.
typedef struct raylanes_instance_level {
  uint32_t instance, geometry;  ///< what it places
} raylanes_instance_level;

/// An instance that contains a point. If there is none, RAYLANES_NO_PART and RAYLANES_OUTSIDE.
typedef struct raylanes_containing_part {
  uint32_t geometry, instance;
  uint8_t location;  ///< a raylanes_location: inside the instance, or on its surface
} raylanes_containing_part;

/// Builders of trees: queries return the same bytes, times differ. Trees of doubles have no spatial splits.
enum raylanes_builder {
  RAYLANES_BUILDER_MEDIAN = 0,
  RAYLANES_BUILDER_EQUAL_PARTITION = 1,
  RAYLANES_BUILDER_BINNED_SAH = 2,  ///< the default
  RAYLANES_BUILDER_SWEEP_SAH = 3,
  RAYLANES_BUILDER_SPATIAL_SPLITS = 4,  ///< for long triangles and many rays
  RAYLANES_BUILDER_MORTON = 5           ///< the fastest to build
};
/// The sides of triangles that rays hit. The front is where v0, v1, v2 run counter-clockwise.
enum raylanes_facing { RAYLANES_FACING_ANY = 0, RAYLANES_FACING_FRONT = 1, RAYLANES_FACING_BACK = 2 };
/// The location of a point.
enum raylanes_location { RAYLANES_OUTSIDE = 0, RAYLANES_INSIDE = 1, RAYLANES_ON = 2 };
/// When a point is inside. For a closed surface that does not intersect itself all rules agree.
enum raylanes_inside_rule {
  RAYLANES_RULE_PARITY = 0,   ///< a ray crosses the surface an odd number of times
  RAYLANES_RULE_NONZERO = 1,  ///< the sides of the crossings do not add up to 0: solids that overlap
  RAYLANES_RULE_VOTE = 2,     ///< four of six rays cross an odd number of times: meshes with holes
  RAYLANES_RULE_WINDING = 3   ///< the winding number is 1/2 or more: any triangles
};
/// Error bounds of roots, from the tightest on.
enum raylanes_accuracy {
  RAYLANES_CORRECTLY_ROUNDED = 0,  ///< not offered by raylanes_rsqrtd()
  RAYLANES_WITHIN_1_ULP = 1,
  RAYLANES_WITHIN_2_ULP = 2,
  RAYLANES_WITHIN_2_TO_MINUS_44 = 3,  ///< a relative error, as are those below
  RAYLANES_WITHIN_2_TO_MINUS_22 = 4,
  RAYLANES_WITHIN_2_TO_MINUS_16 = 5,
  RAYLANES_WITHIN_2_TO_MINUS_11 = 6,
  RAYLANES_WITHIN_2_TO_MINUS_4 = 7
};

// Options begin with their size, so that later versions may add members. A library accepts smaller structs, whose
// missing members have their defaults, and refuses larger ones. Sizes are multiples of 8.

/// How a tree is built.
typedef struct raylanes_build_options {
  size_t size;                 ///< sizeof(raylanes_build_options)
  int32_t builder;             ///< a raylanes_builder
  int32_t threads;             ///< 1, the default: the calling thread; n: up to n; 0: one a core
  int32_t optimize;            ///< not 0: subtrees are moved to where they cost less; default 0
  int32_t choose;              ///< not 0: the builder is chosen by the mesh and `rays`; default 0
  double rays;                 ///< with `choose`: about how many rays will be traced; default 0: many
  raylanes_progress progress;  ///< default NULL
  void* progress_context;
  /// For primitives of your own: the most in a leaf, 1 to 8; default 1.
  uint32_t max_in_leaf;
  /// For primitives of your own: by how much boxes are enlarged for rounding errors of your test, as a share of the
  /// largest coordinate of boxes and ray origins, 0 to 1; default 2^-20.
  float slack;
} raylanes_build_options;

/// How rays are traced.
typedef struct raylanes_ray_options {
  size_t size;            ///< sizeof(raylanes_ray_options)
  int32_t threads;        ///< as in raylanes_build_options; default 1
  int32_t facing;         ///< a raylanes_facing; of crossings, front: side -1, back: side 1
  const char* path;       ///< the name of an ISA path; default NULL
  const uint8_t* active;  ///< the active rays: bit i % 8 of byte i / 8; default NULL: all
  /// For each ray the uint32_t of a triangle that is not there for it, or RAYLANES_NO_PRIMITIVE; default NULL: none.
  /// These may be the primitives of hits, sizeof(raylanes_hit) bytes apart. Scenes also read the instance of each:
  /// skip_to_instance says where. There a stride of 0 means hits side by side: skip = &hits[0].primitive.
  const void* skip;
  size_t skip_stride;
  /// all_hits, crossings and stretches keep the first so many items of each ray; default SIZE_MAX.
  size_t max_count;
  /// In closest and closest_crossing, for each ray a hit of the tree, after which its first one is found, in the order
  /// of t, then of primitives; in scenes of t, then instance, then primitive. After a miss there is none, after
  /// t = -infinity the first. Default NULL: none.
  const void* after;
  size_t after_stride;
  /// In scenes: instances whose mask has a bit in common with it are there; in trees it goes with `masks`. Default all
  /// bits.
  uint32_t mask;
  /// In scenes: the bytes from the primitives of `skip` to their instances; default as in hits of scenes.
  int32_t skip_to_instance;
  raylanes_filter filter;  ///< of closest, closest1 and occluded…; others refuse it; default NULL
  void* filter_context;
  raylanes_progress progress;  ///< of batches; default NULL
  void* progress_context;
  /// In trees: a word for each triangle up to mask_count, which is there if its word has a bit in common with `mask`;
  /// triangles behind them are there. A filter is asked only about triangles whose word has a bit in common with
  /// filter_mask, and about those without a word. Default NULL and 0: all are there; and all bits. Scenes refuse them.
  const uint32_t* masks;
  size_t mask_count;
  uint32_t filter_mask;
  uint32_t unused;
} raylanes_ray_options;

/// How points are looked up.
typedef struct raylanes_point_options {
  size_t size;            ///< sizeof(raylanes_point_options)
  int32_t threads;        ///< as in raylanes_build_options; default 1
  int32_t rule;           ///< of locate and signed_distances: a raylanes_inside_rule; default parity
  const char* path;       ///< the name of an ISA path; default NULL
  const uint8_t* active;  ///< the active points: bit i % 8 of byte i / 8; default NULL: all
  /// In closest_points and signed_distances, triangles farther away are ignored, by NaN all. Default infinity. Trees of
  /// floats round it to float.
  double max_distance;
  double accuracy;             ///< of winding_numbers: the greatest error of expansions; default 1e-6
  raylanes_progress progress;  ///< default NULL
  void* progress_context;
  uint32_t mask;  ///< in scenes, as in raylanes_ray_options; default all bits
  uint32_t unused;
} raylanes_point_options;

#endif

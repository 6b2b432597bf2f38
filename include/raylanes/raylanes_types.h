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
  RAYLANES_BAD_FILE = 4,          ///< Bytes are no tree, or a file cannot be opened, read or written.
  RAYLANES_SMALL_BUFFER = 5,      ///< The caller's buffer is too small.
  RAYLANES_FAILED = 6             ///< Anything else, such as a thread that cannot be started.
} raylanes_status;

/// The primitive of a miss.
#define RAYLANES_NO_PRIMITIVE 0xffffffffu

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
  size_t size;       ///< sizeof(raylanes_build_options)
  int32_t builder;   ///< a raylanes_builder
  int32_t threads;   ///< 1, the default: the calling thread; n: up to n; 0: one a core
  int32_t optimize;  ///< not 0: subtrees are moved to where they cost less; default 0
  int32_t choose;    ///< not 0: the builder is chosen by the mesh and `rays`; default 0
  double rays;       ///< with `choose`: about how many rays will be traced; default 0: many
} raylanes_build_options;

/// How rays are traced.
typedef struct raylanes_ray_options {
  size_t size;            ///< sizeof(raylanes_ray_options)
  int32_t threads;        ///< as in raylanes_build_options; default 1
  int32_t facing;         ///< a raylanes_facing; of crossings, front: side -1, back: side 1
  const char* path;       ///< the name of an ISA path; default NULL
  const uint8_t* active;  ///< the active rays: bit i % 8 of byte i / 8; default NULL: all
  /// For each ray the uint32_t of a triangle that is not there for it, or RAYLANES_NO_PRIMITIVE; default NULL: none.
  /// These may be the primitives of hits, sizeof(raylanes_hit) bytes apart.
  const void* skip;
  size_t skip_stride;
  size_t max_count;  ///< all_hits and crossings keep the first so many items of each ray; default SIZE_MAX
  /// In closest and closest_crossing, for each ray a hit of the tree, after which its first one is found, in the order
  /// of t, then of primitives. After a miss there is none, after t = -infinity the first. Default NULL: none.
  const void* after;
  size_t after_stride;
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
  double accuracy;  ///< of winding_numbers: the greatest error of expansions; default 1e-6
} raylanes_point_options;

#endif

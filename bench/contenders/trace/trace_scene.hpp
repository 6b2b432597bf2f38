// One scene: build, trace every ray set on every path and mode, compare, time.
#pragma once

#include <raylanes/kdtree.hpp>

#include "../../rows/tree_counts.hpp"
#include "../../support/rulers/measure.hpp"
#include "../../support/rulers/undecided_lanes.hpp"
#include "../../support/scenes/mesh_and_camera.hpp"
#include "../workload.hpp"
#include "agreement.hpp"

namespace raylanes::bench {

struct SceneTraceOptions {
  std::vector<const Path*> paths = {};
  std::vector<RayKind> ray_sets = {};
  std::vector<TraversalMode> modes = {};
  bool calls = false;  // beside the modes: a call for each ray, as users call
  std::vector<TriangleTest> tests = {TriangleTest::exact};
  TraceOptions trace = {};                        // grade, threads
  TreeFamily tree = TreeFamily::bvh;              // automatic: a BVH as BuildOptions::choose has it
  TreeBuilder builder = TreeBuilder::binned_sah;  // of a BVH
  bool optimize = false;
  KdBuilder kd_builder = KdBuilder::sah;
  bool against_embree = false;
  // Compares scenes, and for nearest hits a user's own test, with the BVH's modes automatic and call by the exact test;
  // see scene_contenders.hpp.
  bool against_scene = false, against_user = false;
  // In how many parts the mesh is cut for scenes and for Embree, which has a geometry for each part; 1: it is not.
  std::size_t parts = 1;
  bool by_groups = false;  // the parts are the groups of the file
  bool counts = false;     // what ours cost, too
  bool counts_pixels = false;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  PixelOrder order = PixelOrder::rows;
  std::uint32_t samples = 1;               // of a pixel
  std::vector<std::size_t> batches = {0};  // rays of our calls; 0: all at once
  std::vector<std::size_t> streams = {};   // rays of Embree's streams; empty: of `batches`
  double seconds = 3;                      // to time each ray set on each instruction set
  bool skips = false;                      // rays leave out the triangle that they begin on; see RaySet::left
  bool warm = false;                       // each contender traces the rays once more before its clock starts
};

struct TraceRow {
  RayKind rays = RayKind::primary;
  Query query = Query::closest;
  std::size_t ray_count = 0;
  std::string path;
  std::string isa;
  std::string contender;  // raylanes, embree, embree_instances, or one of scene_contenders.hpp
  std::string mode;
  std::size_t batch = 0;             // rays of a call, for Embree only if `batches` has sizes; 0: all at once
  std::optional<TriangleTest> test;  // of ours
  std::string build;
  double mrays_per_second = 0.0;
  double spread = 0.0;  // of its rounds, see Timing
  std::vector<double> rounds_mrays_per_second;
  // Our speed by Embree's on the same instruction set, by rounds: by its best mode over trees of either quality, by its
  // best single rays over these, by its best mode over its robust tree; and by its best mode from rays in its own
  // layout. Calls with a ray are compared with its calls with a ray, batches with modes that take no more rays a call.
  // Scenes have the first one only: those whose parts will move by Embree's instances.
  std::optional<Quartiles> ratio, ratio_to_single, ratio_to_robust, ratio_to_packed;
  std::string ratio_to;                     // which its best mode is
  std::optional<Quartiles> ratio_to_calls;  // of our batches: to our own loop of calls
  std::optional<Quartiles>
      ratio_to_tree;  // of scenes and user's tests: to the tree's own mode of the same name
  std::size_t hits = 0;
  // For all but Embree: rays per million with another primitive, or another yes or no, than by exact arithmetic.
  std::optional<double> wrong_per_million;
  // For tests without the promise that modes agree: rays per million with another primitive, or another yes or no, than
  // single rays of the same test, grade and path.
  std::optional<double> apart_per_million;
  std::optional<UndecidedLanes> open;  // of the exact test
  std::optional<CountedRays> counted;  // of ours
  std::optional<Agreement> agreement;  // with Embree; of its own rows, with our reproducible answers
  double build_seconds = 0.0;
  std::size_t bytes = 0;
};

struct SceneTrace {
  Scene scene;
  std::string summary;
  std::string build;  // by which builder
  std::size_t parts = 1;
  std::vector<TraceRow> rows;
  std::string verdict;
  bool sound = true;  // what must have the same bytes has, and exact arithmetic blames us for no disagreement
  std::vector<std::uint8_t> picture;  // rgb, width·height
  PixelTests pixels;  // of the primary rays of that picture, one by one on the first of the paths
};

// Checks every contender's answers before timing it, against single rays with the exact test. Ours must have the same
// bytes where they promise it. If others differ, exact arithmetic judges each ray: it must not blame ours for any.
// Wrong answers of Embree are counted, and so are rays that differ between modes of tests that promise nothing about
// it.
SceneTrace trace_scene(Scene scene, const SceneTraceOptions& options);

}  // namespace raylanes::bench

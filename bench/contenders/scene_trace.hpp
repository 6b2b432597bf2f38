// One scene: build, trace every ray set on every path and mode, compare, time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../rays/workload.hpp"
#include "../scenes/scene.hpp"
#include "agreement.hpp"

namespace raylanes::bench {

struct SceneTraceOptions {
  std::vector<const Path*> paths;
  std::vector<std::string> ray_sets;
  std::vector<TraversalMode> modes;
  TraceOptions trace;  // test, grade, threads
  bool against_embree = false;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  double seconds = 1;  // to time each ray set
};

struct TraceRow {
  std::string rays;
  Query query = Query::closest;
  std::size_t ray_count = 0;
  std::string path;
  std::string isa;
  std::string contender;  // raylanes or embree
  std::string mode;
  std::string build;
  double mrays_per_second = 0.0;
  double spread = 0.0;
  std::optional<double> ratio;            // of ours to Embree's best mode on the same instruction set
  std::optional<double> ratio_to_single;  // of ours to Embree's single rays there
  std::size_t hits = 0;
  std::optional<Agreement> agreement;  // with Embree
  double build_seconds = 0.0;
  std::size_t bytes = 0;
};

struct SceneTrace {
  Scene scene;
  std::string summary;
  std::vector<TraceRow> rows;
  std::string verdict;
  bool sound = true;  // what must have the same bytes has, and exact arithmetic blames us for no disagreement
  std::vector<std::uint8_t> picture;  // rgb, width·height
};

// Every answer is checked before it is timed: in the reproducible grade with the watertight test all paths
// and modes must give the same bytes; against Embree exact arithmetic must not blame us for any disagreement.
SceneTrace trace_scene(Scene scene, const SceneTraceOptions& options);

}  // namespace raylanes::bench

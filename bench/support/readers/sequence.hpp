// Sequences of frames: trees that follow them, and what that takes.
#pragma once

#include <raylanes/bvh.hpp>

#include "../rulers/measure.hpp"
#include "../scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

// The response to a mesh that has moved: refit the tree, build it again, or choose between these by their cost.
enum class MotionPolicy : std::uint8_t { refit, rebuild, automatic };
inline constexpr std::array<std::string_view, 3> motion_policy_names{"refit", "rebuild", "auto"};

// A tree that follows a mesh from frame to frame. The automatic policy refits, until what tracing is expected to have
// lost since the last build would have paid for another. It takes Bvh::decay() for the loss: a tree with decay d traces
// d times as long as a new one. Whatever comes, it wastes at most about as much as one build more than it needs (the
// rule for renting skis; Karlin, Manasse, Rudolph, Sleator 1988).
class Follower {
 public:
  // `threads` means the same as in TraceOptions, for builds and refits.
  Follower(MotionPolicy policy, const Mesh& first, int threads);

  // Makes it the tree of the next frame, a mesh with as many triangles; returns whether it was built.
  bool follow(const Mesh& frame);
  // Tells the seconds that the rays of the frame took, for later decisions.
  void traced(double seconds);

  const Bvh& tree() const { return tree_; }

 private:
  void build(const Mesh& frame);
  // The seconds that the frame before would lose with the tree as it is now.
  double expected_loss() const;

  MotionPolicy policy_;
  int threads_;
  Bvh tree_;
  double build_seconds_ = 0;
  double fresh_trace_seconds_ = 0;  // of the frame before, had its tree been new
  double lost_ = 0;                 // since the last build, in seconds
};

// A mesh in motion, seen by a camera that stays. All frames have as many triangles.
struct Sequence {
  std::string name;
  Camera camera;
  std::vector<Mesh> frames;
};

// Reads a mesh file for each frame; the camera is that of the first, as load_scene has it. `copies` of each lie side by
// side along x, a diagonal of the first frame apart. Throws as load_scene does, and std::invalid_argument naming the
// file for one with another number of triangles than the first, or fewer than two frames.
Sequence load_sequence(const std::vector<std::string>& files, std::size_t copies);

struct SequenceOptions {
  std::vector<MotionPolicy> policies = {};
  const Path* path = nullptr;
  std::uint32_t width = 0, height = 0;
  int threads = 1;
  int rounds = 3;
};

// One policy in one frame; medians of the rounds.
struct FrameRow {
  std::size_t frame = 0;
  std::string policy;
  bool is_built = false;  // in the last round
  double update_seconds = 0;
  std::size_t primary_rays = 0, diffuse_rays = 0;
  double primary_seconds = 0, diffuse_seconds = 0;
  double decay = 0, sah_cost = 0;
  double total_seconds() const { return update_seconds + primary_seconds + diffuse_seconds; }
};

// A policy over all frames but the first, which is always a build.
struct PolicyRow {
  std::string policy;
  std::size_t frames = 0, builds = 0;
  double update_seconds = 0, primary_mrays = 0, diffuse_mrays = 0;  // medians of frames; mrays: per second
  Quartiles total_seconds{};                                        // of rounds
  std::optional<Quartiles>
      ratio_to_best_fixed;  // of auto's total to the less of refit's and rebuild's, by rounds
};

struct SequenceTrace {
  std::vector<FrameRow> frames;
  std::vector<PolicyRow> policies;
  std::size_t checked = 0;  // hits held to exact arithmetic over all triangles
};

// Every policy follows the sequence, interleaved by frame, and traces primary and diffuse rays with the exact test. All
// must give the same bytes, and some of these are held to exact arithmetic over all triangles: std::runtime_error names
// the first frame that is wrong.
SequenceTrace trace_sequence(const Sequence& sequence, const SequenceOptions& options);

// Seconds of our refit and of Embree's in each frame but the first, one thread each, interleaved; medians of `rounds`.
// While Embree lives, oneTBB has one thread.
struct RefitTimes {
  std::vector<double> ours, embree;
  Quartiles ratio{};  // of Embree's time to ours, by frames and rounds
};
RefitTimes refit_beside_embree(const Sequence& sequence, int rounds);

}  // namespace raylanes::bench

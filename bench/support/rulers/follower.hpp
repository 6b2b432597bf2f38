// A tree that follows a mesh from frame to frame, by a policy.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <raylanes/bvh.hpp>

namespace raylanes::bench {

// The response to a mesh that has moved: refit the tree, build it again, or choose between these by their cost.
enum class MotionPolicy : std::uint8_t { refit, rebuild, automatic };
inline constexpr std::array<std::string_view, 3> motion_policy_names{"refit", "rebuild", "auto"};

// The automatic one refits, until what tracing is expected to have lost since the last build would have paid for
// another. It takes Bvh::decay() for the loss: a tree with decay d traces d times as long as a new one. Whatever
// comes, it wastes at most about as much as one build more than it needs (the rule for renting skis; Karlin, Manasse,
// Rudolph, Sleator 1988).
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

}  // namespace raylanes::bench

#include "follower.hpp"

#include <algorithm>

#include "measure.hpp"

namespace raylanes::bench {

Follower::Follower(MotionPolicy policy, const Mesh& first, int threads) : policy_(policy), threads_(threads) {
  build(first);
}

void Follower::build(const Mesh& frame) {
  build_seconds_ = seconds_of([&] { tree_ = Bvh(frame, {.threads = threads_}); });
  lost_ = 0;
}

double Follower::expected_loss() const {
  return fresh_trace_seconds_ * std::max(0.0, tree_.decay() - 1);
}

bool Follower::follow(const Mesh& frame) {
  bool is_built = policy_ == MotionPolicy::rebuild;
  if (!is_built) {
    tree_.refit(frame.vertices, frame.triangles, threads_);
    if (policy_ == MotionPolicy::automatic) {
      lost_ += expected_loss();
      is_built = lost_ > build_seconds_;
    }
  }
  if (is_built) build(frame);
  return is_built;
}

void Follower::traced(double seconds) {
  fresh_trace_seconds_ = seconds / std::max(1.0, tree_.decay());
}

}  // namespace raylanes::bench

// Contenders of one race, with the rows they fill.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../../support/oracles/disagreement.hpp"
#include "../contenders.hpp"
#include "trace_scene.hpp"

namespace raylanes::bench {

// A contender and the row it fills.
struct Entry {
  Contender contender;
  oracle::Form form;
  TraceRow row;
  Timing timing = {};
  bool is_exact = false;  // compared by scene_contenders.hpp

  bool is_ours() const { return row.contender == "raylanes"; }
  bool is_embree() const { return row.contender == "embree"; }
  bool is_call() const { return row.mode.starts_with("call"); }
  bool is_robust() const { return form == oracle::Form::embree_robust; }
};

// A ray set, and what every contender has to answer.
struct Question {
  RayKind kind;
  RaySet set;
  Answers reference;
  std::optional<UndecidedLanes> open;
};

// Compares entries that were timed together: calls with calls, batches with batches.
void rate(std::vector<Entry>& entries);

}  // namespace raylanes::bench

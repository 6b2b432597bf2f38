// Contenders of one race with the rows they fill, and whether they answer a ray set right, before they are timed.
#pragma once

#include "../../support/oracles/disagreement.hpp"
#include "../contenders.hpp"
#include "agreement.hpp"
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
  bool is_embree() const { return row.contender.starts_with("embree"); }
  bool is_scene() const { return row.contender.starts_with("scene"); }
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

class AnswerCheck {
 public:
  // `reference` gives the reference results; ours trace `tree`. All arguments must outlive the object.
  AnswerCheck(const Scene& scene, const TriangleTree& tree, const Contender& reference,
              const TraceOptions& trace)
      : scene_(scene), tree_(tree), reference_(reference), trace_(trace) {}

  // Traces once by each entry and fills in the results' part of its row.
  void check(std::vector<Entry>& entries, const Question& question);
  void complain(const Entry& entry, const std::string& what);
  // The errors, a sentence each.
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  // `single`: Embree's single rays and their answers, or null.
  void check_ours(Entry& entry, const Question& question, const Answers& answers, const Entry* single,
                  const Answers& of_single);
  void check_scene(Entry& entry, const Question& question, const Answers& answers);
  void check_embree(Entry& entry, const Question& question, const Answers& answers);
  // The results of single rays by the entry's test and path.
  Answers single_answers(const Entry& entry, const Question& question) const;
  Answered reference_of(const Question& question) const;

  const Scene& scene_;
  const TriangleTree& tree_;
  const Contender& reference_;
  TraceOptions trace_;  // grade, threads
  std::vector<std::string> complaints_;
};

}  // namespace raylanes::bench

// Whether contenders answer a ray set right, before they are timed.
#pragma once

#include <string>
#include <vector>

#include "agreement.hpp"
#include "trace_entries.hpp"

namespace raylanes::bench {

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

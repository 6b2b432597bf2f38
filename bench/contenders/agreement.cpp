#include "agreement.hpp"

namespace raylanes::bench {
namespace {

constexpr std::size_t shown_sentences = 3;

std::vector<std::size_t> disagreeing_rays(const Answers& ours, const Answers& theirs) {
  std::vector<std::size_t> rays;
  for (std::size_t i = 0; i < ours.hits.size(); ++i)
    if (oracle::disagree(ours.hits[i], theirs.hits[i])) rays.push_back(i);
  for (std::size_t i = 0; i < ours.occluded.size(); ++i)
    if (ours.occluded[i] != theirs.occluded[i]) rays.push_back(i);
  return rays;
}

// The closest hits of some rays of a set.
Answers closest_hits(const Contender& contender, const RaySet& set, const std::vector<std::size_t>& rays) {
  RaySet part{set.name, Query::closest, {}};
  for (const std::size_t i : rays) part.rays.push_back(set.rays[i]);
  Answers answers(part);
  contender.trace(part, answers);
  return answers;
}

// Flags that differ although the closest hits agree: who contradicts its own closest hit is wrong.
oracle::Explanation judge_flag(bool occluded, const Hit& our_hit, const oracle::Explanation& of_hits) {
  if (of_hits.excuse != oracle::Excuse::none_needed && of_hits.excuse != oracle::Excuse::same_depth)
    return of_hits;
  if (occluded == (our_hit.primitive != no_primitive))
    return {oracle::Excuse::theirs_wrong, "theirs finds the closest hit but not any, or the reverse"};
  return {oracle::Excuse::ours_wrong, "ours finds the closest hit but not any, or the reverse"};
}

void add(Agreement& agreement, const std::string& ray, const oracle::Explanation& explanation) {
  const bool ours_wrong = explanation.excuse == oracle::Excuse::ours_wrong;
  const bool embree_wrong = explanation.excuse == oracle::Excuse::theirs_wrong;
  ++agreement.disagreements;
  agreement.ours_wrong += ours_wrong;
  agreement.embree_wrong += embree_wrong;
  agreement.within_rounding += !ours_wrong && !embree_wrong;
  if (ours_wrong || agreement.sentences.size() < shown_sentences)
    agreement.sentences.push_back(ray + explanation.sentence);
}

}  // namespace

Agreement compare_answers(const Scene& scene, const RaySet& set, const Answered& ours,
                          const Answered& theirs) {
  const std::vector<std::size_t> rays = disagreeing_rays(ours.answers, theirs.answers);
  const Answers our_hits = closest_hits(ours.contender, set, rays);
  const Answers their_hits = closest_hits(theirs.contender, set, rays);
  Agreement agreement;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Hit& our_hit = our_hits.hits[k];
    oracle::Explanation explanation =
        oracle::explain(set.rays[rays[k]], scene.mesh.vertices, scene.mesh.triangles, our_hit, ours.form,
                        their_hits.hits[k], theirs.form);
    if (set.query == Query::closest && explanation.excuse == oracle::Excuse::same_depth) continue;
    if (set.query == Query::any)
      explanation = judge_flag(ours.answers.occluded[rays[k]] != 0, our_hit, explanation);
    add(agreement, "ray " + std::to_string(rays[k]) + ": ", explanation);
  }
  return agreement;
}

}  // namespace raylanes::bench

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

}  // namespace

Agreement compare_answers(const Scene& scene, const RaySet& set, const Answers& our_answers,
                          const Answers& embree_answers, const Contender& ours, oracle::Form our_form,
                          const Contender& embree) {
  const std::vector<std::size_t> rays = disagreeing_rays(our_answers, embree_answers);
  const Answers our_hits = closest_hits(ours, set, rays);
  const Answers embree_hits = closest_hits(embree, set, rays);
  Agreement agreement;
  agreement.disagreements = rays.size();
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const oracle::Explanation explanation =
        oracle::explain(set.rays[rays[k]], scene.mesh.vertices, scene.mesh.triangles, our_hits.hits[k],
                        our_form, embree_hits.hits[k], oracle::Form::embree_fast);
    // An any-hit query that differs although the closest hits agree has no excuse.
    const bool unexplained = explanation.excuse == oracle::Excuse::unexplained ||
                             explanation.excuse == oracle::Excuse::none_needed;
    agreement.unexplained += unexplained;
    if (unexplained || agreement.sentences.size() < shown_sentences)
      agreement.sentences.push_back("ray " + std::to_string(rays[k]) + ": " + explanation.sentence);
  }
  return agreement;
}

}  // namespace raylanes::bench

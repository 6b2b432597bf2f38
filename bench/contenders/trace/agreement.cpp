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

// The closest hits of some rays of a set: those that were found, or of flags those that are found now.
std::vector<Hit> closest_hits(const Answered& answered, const RaySet& set,
                              const std::vector<std::size_t>& rays) {
  RaySet part{set.name, Query::closest, {}};
  for (const std::size_t i : rays) part.rays.push_back(set.rays[i]);
  Answers answers(part);
  if (set.query == Query::any) answered.contender.trace(part, answers);
  for (std::size_t k = 0; k < rays.size() && set.query == Query::closest; ++k)
    answers.hits[k] = answered.answers.hits[rays[k]];
  return answers.hits;
}

bool must_hit(const Ray& ray, const Mesh& mesh, std::uint32_t primitive, oracle::Form form) {
  const auto& [a, b, c] = mesh.triangles[primitive];
  const Triangle triangle{{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}};
  return oracle::classify(ray, triangle, form) == oracle::Class::must_hit;
}

// The ray from the other end of its segment, where packets of rays that end at one point are seen from.
Ray reversed(const Ray& ray) {
  Ray back{.tmin = 0, .tmax = ray.tmax - ray.tmin};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    back.origin[axis] = ray.origin[axis] + ray.tmax * ray.direction[axis];
    back.direction[axis] = -ray.direction[axis];
  }
  return back;
}

// Flags that differ although the closest hits agree.
oracle::Explanation judge_flag(const Answered& ours, bool occluded, const Ray& ray, const Mesh& mesh,
                               const Hit& our_hit, const oracle::Explanation& of_hits) {
  if (of_hits.excuse != oracle::Excuse::none_needed && of_hits.excuse != oracle::Excuse::same_depth)
    return of_hits;
  if (occluded == (our_hit.primitive != no_primitive))
    return {oracle::Excuse::theirs_wrong, "theirs finds the closest hit but not any, or the reverse"};
  const bool had_to_hit = !occluded && must_hit(ray, mesh, our_hit.primitive, ours.form) &&
                          (!ours.may_reverse || must_hit(reversed(ray), mesh, our_hit.primitive, ours.form));
  return {ours.modes_agree || had_to_hit ? oracle::Excuse::ours_wrong : oracle::Excuse::modes_apart,
          "ours finds the closest hit but not any, or the reverse"};
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
  const std::vector<Hit> our_hits = closest_hits(ours, set, rays),
                         their_hits = closest_hits(theirs, set, rays);
  const Mesh& mesh = scene.mesh;
  Agreement agreement;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Ray& ray = set.rays[rays[k]];
    oracle::Explanation explanation = oracle::explain(ray, mesh.vertices, mesh.triangles, our_hits[k],
                                                      ours.form, their_hits[k], theirs.form);
    if (set.query == Query::closest && explanation.excuse == oracle::Excuse::same_depth) continue;
    if (set.query == Query::any)
      explanation =
          judge_flag(ours, ours.answers.occluded[rays[k]] != 0, ray, mesh, our_hits[k], explanation);
    add(agreement, "ray " + std::to_string(rays[k]) + ": ", explanation);
  }
  return agreement;
}

}  // namespace raylanes::bench

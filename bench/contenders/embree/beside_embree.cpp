#include "../../support/readers/sequence.hpp"
#include "embree_contender.hpp"

namespace raylanes::bench {

RefitTimes refit_beside_embree(const Sequence& sequence, int rounds) {
  const Mesh& first = sequence.frames[0];
  Bvh ours(first);
  EmbreeContender embree(first.vertices, first.triangles, "", EmbreeBuild::refitted);
  std::vector<std::vector<double>> our_times(sequence.frames.size()), embree_times(sequence.frames.size());
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t frame = 1; frame < sequence.frames.size(); ++frame) {
      const Mesh& mesh = sequence.frames[frame];
      our_times[frame].push_back(seconds_of([&] { ours.refit(mesh.vertices, mesh.triangles); }));
      embree_times[frame].push_back(embree.move(mesh.vertices));
      ratios.push_back(embree_times[frame].back() / our_times[frame].back());
    }
  RefitTimes times{.ours = {}, .embree = {}, .ratio = quartiles_of(ratios)};
  for (std::size_t frame = 1; frame < sequence.frames.size(); ++frame) {
    times.ours.push_back(quartiles_of(our_times[frame]).median);
    times.embree.push_back(quartiles_of(embree_times[frame]).median);
  }
  return times;
}

}  // namespace raylanes::bench

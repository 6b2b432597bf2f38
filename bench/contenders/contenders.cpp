#include "contenders.hpp"

#include <algorithm>
#include <cstring>

namespace raylanes::bench {

Answers::Answers(const RaySet& set)
    : hits(set.query == Query::closest ? set.rays.size() : 0),
      occluded(set.query == Query::any ? set.rays.size() : 0) {}

std::size_t Answers::hit_count() const {
  const auto closest =
      std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.primitive != no_primitive; });
  return static_cast<std::size_t>(closest + std::count(occluded.begin(), occluded.end(), std::uint8_t{1}));
}

std::size_t Answers::count_other_decisions(const Answers& other) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) count += hits[i].primitive != other.hits[i].primitive ? 1 : 0;
  for (std::size_t i = 0; i < occluded.size(); ++i) count += occluded[i] != other.occluded[i] ? 1 : 0;
  return count;
}
bool Answers::same_bytes(const Answers& other) const {
  return hits.size() == other.hits.size() && occluded == other.occluded &&
         (hits.empty() || std::memcmp(hits.data(), other.hits.data(), hits.size() * sizeof(Hit)) == 0);
}

Contender our_contender(const TriangleTree& tree, const TraceOptions& options, std::size_t batch) {
  return {std::string(traversal_mode_names[static_cast<std::size_t>(options.mode)]),
          [&tree, options, batch](const RaySet& set, Answers& answers) {
            const std::span<const Ray> rays(set.rays);
            const std::size_t step = batch == 0 ? rays.size() : batch;
            for (std::size_t i = 0; i < rays.size(); i += step) {
              const std::size_t count = std::min(step, rays.size() - i);
              if (set.query == Query::closest)
                tree.closest(rays.subspan(i, count), std::span(answers.hits).subspan(i, count), options);
              else
                tree.occluded(rays.subspan(i, count), std::span(answers.occluded).subspan(i, count), options);
            }
          }};
}

std::vector<Contender> embree_contenders(const EmbreeContender& embree) {
  std::vector<Contender> contenders;
  const auto add = [&](std::string name, EmbreeMode mode, bool coherent) {
    contenders.push_back({std::move(name), [&embree, mode, coherent](const RaySet& set, Answers& answers) {
                            if (set.query == Query::closest)
                              embree.closest(mode, coherent, set.rays, answers.hits);
                            else
                              embree.any(mode, coherent, set.rays, answers.occluded);
                          }});
  };
  add("single", EmbreeMode::single, false);
  const std::pair<const char*, EmbreeMode> packets[] = {
      {"packet4", EmbreeMode::packet4}, {"packet8", EmbreeMode::packet8}, {"packet16", EmbreeMode::packet16}};
  for (const auto& [name, mode] : packets) {
    if (!embree.native(mode)) continue;
    add(name, mode, false);
    add(std::string(name) + "_coherent", mode, true);
  }
  return contenders;
}

}  // namespace raylanes::bench

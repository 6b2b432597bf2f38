#include "contenders.hpp"

namespace raylanes::bench {
namespace {

// The lanes of a mode's packets.
std::size_t lanes_of(EmbreeMode mode) {
  constexpr std::size_t lanes[] = {1, 4, 8, 16, 1, 16};
  return lanes[static_cast<std::size_t>(mode)];
}

Contender packed_contender(std::string name, const EmbreeContender& embree, EmbreeMode mode, bool coherent) {
  const auto timed = [&embree, mode, coherent](const RaySet& set, Answers& answers) {
    return embree.trace_packed(mode, coherent, set, answers);
  };
  return {std::move(name), timed, timed, lanes_of(mode)};
}

// With the conversion of rays and hits. `batch`: rays of a call.
Contender converting_contender(std::string name, const EmbreeContender& embree, EmbreeMode mode,
                               bool coherent, std::size_t batch) {
  return {std::move(name),
          [&embree, mode, coherent, batch](const RaySet& set, Answers& answers) {
            embree.trace(mode, coherent, set, answers, batch);
          },
          {},
          batch};
}

}  // namespace

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

Contender our_contender(const TriangleTree& tree, const TraceOptions& given, std::size_t batch, bool skips) {
  return {std::string(traversal_mode_names[static_cast<std::size_t>(given.mode)]),
          [&tree, given, batch, skips](const RaySet& set, Answers& answers) {
            const std::span<const Ray> rays(set.rays);
            TraceOptions options = given;
            if (options.path == &active_path()) options.path = nullptr;
            const std::size_t step = batch == 0 ? rays.size() : batch;
            for (std::size_t i = 0; i < rays.size(); i += step) {
              const std::size_t count = std::min(step, rays.size() - i);
              if (skips && !set.left.empty()) options.skip = std::span(set.left).subspan(i, count);
              if (set.query == Query::closest)
                tree.closest(rays.subspan(i, count), std::span(answers.hits).subspan(i, count), options);
              else
                tree.occluded(rays.subspan(i, count), std::span(answers.occluded).subspan(i, count), options);
            }
          }};
}

Contender our_caller(const TriangleTree& tree, const TraceOptions& options, bool skips) {
  const bool is_usual = (options.path == nullptr || options.path == &active_path()) &&
                        options.test == TraceOptions{}.test && options.grade == TraceOptions{}.grade;
  const auto call_each = [](const RaySet& set, Answers& answers, const auto& closest, const auto& occluded) {
    if (set.query == Query::closest)
      for (std::size_t i = 0; i < set.rays.size(); ++i) answers.hits[i] = closest(set.rays[i]);
    else
      for (std::size_t i = 0; i < set.rays.size(); ++i) answers.occluded[i] = occluded(set.rays[i]) ? 1 : 0;
  };
  return {"call", [&tree, options, is_usual, call_each, skips](const RaySet& set, Answers& answers) {
            TraceOptions skipping = options;
            const std::uint32_t* left = set.left.data();
            const auto next = [&]() -> const TraceOptions& {
              return skipping.skip = std::span(left++, 1), skipping;
            };
            if (skips && !set.left.empty())
              call_each(
                  set, answers, [&](const Ray& ray) { return tree.closest(ray, next()); },
                  [&](const Ray& ray) { return tree.occluded(ray, next()); });
            else if (is_usual)
              call_each(
                  set, answers, [&](const Ray& ray) { return tree.closest(ray); },
                  [&](const Ray& ray) { return tree.occluded(ray); });
            else
              call_each(
                  set, answers, [&](const Ray& ray) { return tree.closest(ray, options); },
                  [&](const Ray& ray) { return tree.occluded(ray, options); });
          }};
}

std::vector<Contender> embree_callers(const EmbreeContender& embree) {
  return {converting_contender("call", embree, EmbreeMode::single, false, 1),
          packed_contender("call_packed", embree, EmbreeMode::single, false)};
}

std::vector<Contender> embree_contenders(const EmbreeContender& embree, bool are_scattered,
                                         std::span<const std::size_t> streams) {
  std::vector<Contender> contenders{converting_contender("single", embree, EmbreeMode::single, false, 1)};
  const auto add_both = [&](const std::string& name, EmbreeMode mode, std::size_t batch) {
    contenders.push_back(converting_contender(name, embree, mode, false, batch));
    if (!are_scattered)
      contenders.push_back(converting_contender(name + "_coherent", embree, mode, true, batch));
  };
  const std::pair<const char*, EmbreeMode> packets[] = {
      {"packet4", EmbreeMode::packet4}, {"packet8", EmbreeMode::packet8}, {"packet16", EmbreeMode::packet16}};
  for (const auto& [name, mode] : packets)
    if (embree.native(mode)) add_both(name, mode, lanes_of(mode));
  for (const std::size_t batch : streams)
    for (const auto& [name, mode] :
         {std::pair("stream", EmbreeMode::stream), std::pair("packet_stream", EmbreeMode::packet_stream)})
      if (batch >= lanes_of(mode) && batch <= max_embree_stream && embree.native(mode))
        add_both(name, mode, batch);
  for (const auto& [name, mode] : {packets[2], packets[1], packets[0]}) {
    if (!embree.native(mode)) continue;
    contenders.push_back(packed_contender(std::string(name) + "_packed", embree, mode, false));
    if (!are_scattered)
      contenders.push_back(packed_contender(std::string(name) + "_coherent_packed", embree, mode, true));
    break;
  }
  return contenders;
}

}  // namespace raylanes::bench

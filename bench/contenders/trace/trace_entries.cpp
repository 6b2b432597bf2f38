#include "trace_entries.hpp"

namespace raylanes::bench {
namespace {

// The one whose rounds are the fastest, of those that `counts` takes; null if there is none.
template <class Counts>
const Entry* candidate_of(const std::vector<Entry>& entries, const Counts& counts) {
  const Entry* best = nullptr;
  for (const Entry& entry : entries)
    if (counts(entry) && (best == nullptr || entry.timing.median_seconds < best->timing.median_seconds))
      best = &entry;
  return best;
}

}  // namespace

void rate(std::vector<Entry>& entries) {
  const auto best_of = [&](bool calls, bool packed, const auto& counts) {
    return candidate_of(entries, [&](const Entry& e) {
      return e.is_embree() && e.is_call() == calls && e.contender.is_packed() == packed && counts(e);
    });
  };
  const auto is_fast = [](const Entry& e) { return !e.is_robust(); };
  const auto is_single = [&](const Entry& e) {
    return is_fast(e) && (e.is_call() || e.row.mode == "single");
  };
  const auto is_robust = [](const Entry& e) { return e.is_robust(); };
  for (Entry& entry : entries) {
    const bool calls = entry.is_call();
    const Entry* const tree = candidate_of(entries, [&](const Entry& e) {
      return e.is_ours() && e.row.path == entry.row.path && e.row.mode == entry.row.mode &&
             e.row.batch == entry.row.batch;
    });
    if (!entry.is_ours() && !entry.is_embree() && tree != nullptr)
      entry.row.ratio_to_tree = speed_ratio(entry.timing, tree->timing);
    const Entry* const best = best_of(calls, false, is_fast);
    if (!entry.is_ours() || best == nullptr) continue;
    entry.row.ratio = speed_ratio(entry.timing, best->timing);
    entry.row.ratio_to = best->row.build + " " + best->row.mode;
    entry.row.ratio_to_single = speed_ratio(entry.timing, best_of(calls, false, is_single)->timing);
    entry.row.ratio_to_robust = speed_ratio(entry.timing, best_of(calls, false, is_robust)->timing);
    if (const Entry* const packed = best_of(calls, true, is_fast))
      entry.row.ratio_to_packed = speed_ratio(entry.timing, packed->timing);
  }
}

}  // namespace raylanes::bench

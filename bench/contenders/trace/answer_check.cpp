#include "answer_check.hpp"

#include "../scene_contenders.hpp"

namespace raylanes::bench {
namespace {

// A name that is no traversal mode, as that of calls, means single rays.
TraversalMode mode_of(std::string_view name) {
  const auto found = std::find(traversal_mode_names.begin(), traversal_mode_names.end(), name);
  return found == traversal_mode_names.end()
             ? TraversalMode::single
             : static_cast<TraversalMode>(found - traversal_mode_names.begin());
}

double others_per_million(const Answers& answers, const Answers& reference) {
  const std::size_t rays = answers.hits.size() + answers.occluded.size();
  return 1e6 * static_cast<double>(answers.count_other_decisions(reference)) /
         static_cast<double>(std::max<std::size_t>(1, rays));
}

}  // namespace

void AnswerCheck::check(std::vector<Entry>& entries, const Question& question) {
  const auto is_single = [](const Entry& e) {
    return e.row.contender == "embree" && (e.row.mode == "single" || e.is_call()) && e.row.build == "medium";
  };
  const auto single = std::find_if(entries.begin(), entries.end(), is_single);
  Answers of_single(question.set), answers(question.set);
  if (single != entries.end()) single->contender.trace(question.set, of_single);
  for (Entry& entry : entries) {
    entry.contender.trace(question.set, answers);
    entry.row.hits = answers.hit_count();
    if (entry.is_ours())
      check_ours(entry, question, answers, single == entries.end() ? nullptr : &*single, of_single);
    else if (entry.is_embree())
      check_embree(entry, question, answers);
    else
      check_scene(entry, question, answers);
  }
}

void AnswerCheck::check_ours(Entry& entry, const Question& question, const Answers& answers,
                             const Entry* single, const Answers& of_single) {
  const bool modes_agree = bench::modes_agree(*entry.row.test, trace_.grade);
  const bool may_reverse = bench::may_reverse(*entry.row.test, trace_.grade, mode_of(entry.row.mode));
  const Answered ours{answers, entry.contender, entry.form, modes_agree, may_reverse};
  entry.row.wrong_per_million = others_per_million(answers, question.reference);
  if (!modes_agree)
    entry.row.apart_per_million = others_per_million(answers, single_answers(entry, question));
  if (!answers.same_bytes(question.reference)) {
    if (entry.row.test == TriangleTest::exact)
      complain(entry, "other bytes than single rays on the active path");
    const Agreement agreement = compare_answers(scene_, question.set, ours, reference_of(question));
    if (agreement.ours_wrong + agreement.embree_wrong > 0)
      complain(entry, "wrong by exact arithmetic: " + agreement.sentences.back());
  }
  if (single == nullptr) return;
  entry.row.agreement =
      compare_answers(scene_, question.set, ours, {of_single, single->contender, single->form});
  if (entry.row.agreement->ours_wrong > 0) complain(entry, "wrong by exact arithmetic, see above");
}

void AnswerCheck::check_scene(Entry& entry, const Question& question, const Answers& answers) {
  entry.row.wrong_per_million = others_per_million(answers, question.reference);
  if (entry.is_exact ? !answers.same_bytes(question.reference)
                     : *entry.row.wrong_per_million > max_others_per_million)
    complain(entry, "other hits than the tree");
}

void AnswerCheck::check_embree(Entry& entry, const Question& question, const Answers& answers) {
  entry.row.agreement =
      compare_answers(scene_, question.set, reference_of(question), {answers, entry.contender, entry.form});
  if (entry.row.agreement->ours_wrong > 0) complain(entry, "shows that ours is wrong by exact arithmetic");
}

Answers AnswerCheck::single_answers(const Entry& entry, const Question& question) const {
  TraceOptions trace = trace_;
  trace.test = *entry.row.test, trace.path = &find_path(entry.row.path), trace.mode = TraversalMode::single;
  Answers answers(question.set);
  our_contender(tree_, trace).trace(question.set, answers);
  return answers;
}

Answered AnswerCheck::reference_of(const Question& question) const {
  return {question.reference, reference_, oracle::Form::exact};
}

void AnswerCheck::complain(const Entry& entry, const std::string& what) {
  complaints_.push_back(name_of(entry.row.rays) + " " + entry.row.path + " " + entry.row.contender + " " +
                        entry.row.build + " " + entry.row.mode + ": " + what);
}

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
  const auto is_fast = [](const Entry& e) { return !e.is_robust(); };
  const auto is_single = [&](const Entry& e) {
    return is_fast(e) && (e.is_call() || e.row.mode == "single");
  };
  const auto is_robust = [](const Entry& e) { return e.is_robust(); };
  for (Entry& entry : entries) {
    TraceRow& row = entry.row;
    const auto ours_of = [&](const auto& counts) {
      return candidate_of(entries,
                          [&](const Entry& e) { return e.is_ours() && e.row.path == row.path && counts(e); });
    };
    // Calls beside calls, and batches beside what takes no more rays a call.
    const auto rival_of = [&](const char* name, bool packed, const auto& counts) {
      return candidate_of(entries, [&](const Entry& e) {
        return e.row.contender == name && e.is_call() == entry.is_call() &&
               e.contender.is_packed() == packed &&
               e.row.batch <= (row.batch == 0 ? row.ray_count : row.batch) && counts(e);
      });
    };
    const Entry* const tree =
        ours_of([&](const Entry& e) { return e.row.mode == row.mode && e.row.batch == row.batch; });
    if (!entry.is_ours() && !entry.is_embree() && tree != nullptr)
      row.ratio_to_tree = speed_ratio(entry.timing, tree->timing);
    const Entry* const loop = ours_of([&](const Entry& e) { return e.is_call() && e.row.test == row.test; });
    if (entry.is_ours() && !entry.is_call() && loop != nullptr)
      row.ratio_to_calls = speed_ratio(entry.timing, loop->timing);
    const Entry* const best =
        rival_of(row.contender == "scene_moving" ? "embree_instances" : "embree", false, is_fast);
    if (!(entry.is_ours() || entry.is_scene()) || best == nullptr) continue;
    row.ratio = speed_ratio(entry.timing, best->timing);
    row.ratio_to = best->row.build + " " + best->row.mode;
    if (!entry.is_ours()) continue;
    row.ratio_to_single = speed_ratio(entry.timing, rival_of("embree", false, is_single)->timing);
    row.ratio_to_robust = speed_ratio(entry.timing, rival_of("embree", false, is_robust)->timing);
    if (const Entry* const packed = rival_of("embree", true, is_fast))
      row.ratio_to_packed = speed_ratio(entry.timing, packed->timing);
  }
}

}  // namespace raylanes::bench

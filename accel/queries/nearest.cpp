// The nearest hit, or whether there is one: options and views are checked, then rays are traced.
#include <stdexcept>
#include <string>

#include <raylanes/rays.hpp>
#include <raylanes/triangle_tree.hpp>

#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../batch/checked_call.hpp"
#include "../batch/few_rays.hpp"
#include "lists.hpp"
#include "traced_tree.hpp"

namespace raylanes {
namespace {

std::size_t checked_test(TriangleTest test) {
  const std::size_t number = checked_index("trace", "test", test, std::size(triangle_tests));
  if (serves_trees(test)) return number;
  std::string allowed;
  for (const std::string_view name : tree_test_names)
    allowed += (allowed.empty() ? "" : ", ") + std::string(name);
  throw std::invalid_argument(std::string("trace: the test ") + triangle_tests[number].name +
                              " is one for arrays; trees take " + allowed);
}

// The rows of a test and grade as the options ask for them: plain or counted.
class RowsOfOptions {
 public:
  RowsOfOptions(TreeKind kind, const TraceOptions& options, std::size_t test, std::size_t grade)
      : test_(test), grade_(grade) {
    const KernelTable& kernels = kernels_of(checked_path(options.path));
    const bool counts = options.counters != nullptr;
    modes_ = counts ? &kernels.counted : &kernels.traversal;
    single_ = &row_in(modes_->mode[static_cast<std::size_t>(TraversalMode::single)]);
    if (counts) require_counters("trace", kernels.has_counters());
    // Eights of cells are the faster way, also for rays alone: planes are walked where that is asked for.
    if (kind == TreeKind::kdtree && options.mode == TraversalMode::single &&
        options.test == TriangleTest::exact && options.grade == Grade::reproducible)
      single_ = counts ? &kernels.kdtree.counted : &kernels.kdtree.plain;
    if (single_->closest == nullptr)
      throw std::invalid_argument(std::string("trace: the test ") + triangle_tests[test].name +
                                  " in the grade " + std::string(grade_names[grade]) +
                                  " is not counted; allowed is the grade reproducible");
    const auto stream = static_cast<std::size_t>(TraversalMode::stream);
    if (options.mode != TraversalMode::single && row_in(modes_->mode[stream]).closest == nullptr)
      throw std::invalid_argument(std::string("trace: the test ") + triangle_tests[test].name +
                                  " is counted in the mode single alone; exact is in every mode");
  }
  const TraversalRow* single() const { return single_; }
  const CallRow* call() const {
    const CallRow& row = modes_->call.row[test_][grade_];
    return row.closest != nullptr ? &row : nullptr;
  }
  // Counted rows of tests that round are of single rays.
  const TraversalRow* of(TraversalMode mode) const {
    if (mode == TraversalMode::single) return single_;
    const TraversalRow& row = row_in(modes_->mode[static_cast<std::size_t>(mode)]);
    return row.closest != nullptr ? &row : single_;
  }

 private:
  const TraversalRow& row_in(const TraversalRows& rows) const { return rows.row[test_][grade_]; }

  std::size_t test_, grade_;
  const TraversalKernels* modes_;
  const TraversalRow* single_;
};

// Automatic asks how far apart rays are, and whether single rays of the exact test have code for some at a time.
void set_what_tells(TraversalChoice& choice, const TraceOptions& options) {
  const Path& path = checked_path(options.path);
  choice.nearest_triangle = kernels_of(path).traversal.nearest_triangle;
  choice.may_fly = options.test == TriangleTest::exact && has_flights(path);
}

TraversalChoice choice_of_both_sides(TreeKind kind, const TraceOptions& options, std::size_t test,
                                     std::size_t grade) {
  const RowsOfOptions rows(kind, options, test, grade);
  TraversalChoice choice{rows.single(),
                         rows.of(TraversalMode::packet),
                         rows.of(TraversalMode::stream),
                         options.mode,
                         options.hint,
                         options.counters};
  choice.call = rows.call();
  set_what_tells(choice, options);
  return choice;
}
// The rows of triangles that the caller chooses.
TraversalChoice choice_of_chosen(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        options.facing == Facing::any
            ? std::string("trace: skip takes the test exact")
            : "trace: facing " + std::string(facing_names[static_cast<std::size_t>(options.facing)]) +
                  " takes the test exact; with other tests only facing any is allowed");
  const QueryKernels& rows = checked_queries<float>("trace", options);
  const TraversalRow* const single = &rows.chosen_single;
  const TraversalRow* const together = rows.chosen_stream.closest != nullptr ? &rows.chosen_stream : single;
  const TraversalRows& packets =
      kernels_of(checked_path(options.path)).traversal.mode[static_cast<std::size_t>(TraversalMode::packet)];
  constexpr auto exact = static_cast<std::size_t>(TriangleTest::exact);
  const bool counts = options.counters != nullptr;
  TraversalChoice choice{single,         counts ? together : &packets.row[exact][0],
                         together,       options.mode,
                         options.hint,   options.counters,
                         options.facing, counts ? nullptr : &rows.chosen_call};
  set_what_tells(choice, options);
  return choice;
}

// Whether a call with one ray sets no more than facing, skip, after, test, grade, path, and what is for batches.
bool is_usual_but_chosen(const TraceOptions& options) {
  return options.mode == TraversalMode::automatic &&
         static_cast<std::size_t>(options.hint) < batch_hint_names.size() && options.threads >= 0 &&
         options.counters == nullptr && static_cast<std::size_t>(options.grade) < grade_names.size();
}
// Whether a call with one ray may go straight to the kernel: there is a tree, and nothing traps.
bool is_quick(const TreeView* ready) {
  return ready != nullptr && !QuietFloats::are_wanted();
}
// A batch of few rays, by the rows of calls with one ray. False if the batch is to go another way.
template <class Answer, class OfUsual, class OfChosen>
bool trace_few(const TreeView* ready, const RayView& rays, Answer* answers, std::size_t count,
               const TraceOptions& options, OfUsual usual, OfChosen of_chosen) {
  if (!is_quick(ready)) return false;
  const FewRays few(rays, answers, count, options, batch_size_of(*ready));
  if (!few || few.may_be_packet()) return false;
  if (const CallRow* const row = usual_row(options)) {
    few.trace([&, call = row->*usual](const Ray& ray, std::size_t) { return call(*ready, ray); });
    return true;
  }
  const ChosenCallRow* const row = chosen_row(options, rays.count);
  if (row == nullptr) return false;
  few.trace([&, call = row->*of_chosen](const Ray& ray, std::size_t i) {
    return call(*ready, ray, options.facing, skipped_of(options, i));
  });
  return true;
}
void trace_occluded(const TracedTree& tree, const RaySource& rays, std::span<std::uint8_t> occluded,
                    const TraceOptions& options) {
  const CheckedCall call("trace", rays, occluded, options);
  Traversal traversal = checked_traversal(tree, call.options);
  traversal.choice.facing = rays.sides(options.facing);
  trace(traversal.tree, traversal.choice, call.rays, SpanSink<std::uint8_t>{occluded}, options.threads);
}

}  // namespace

const CallRow* usual_row(const TraceOptions& options) {
  const auto test = static_cast<std::size_t>(options.test), grade = static_cast<std::size_t>(options.grade);
  const bool is_usual = is_usual_but_chosen(options) && options.facing == Facing::any &&
                        options.after.first == nullptr && options.skip.first == nullptr &&
                        test < std::size(triangle_tests);
  if (!is_usual) return nullptr;
  const KernelTable& kernels = kernels_of(checked_path(options.path));
  const CallRow& row = kernels.traversal.call.row[test][grade];
  return row.closest != nullptr ? &row : nullptr;
}
bool is_usual_kept(const TraceOptions& options, std::size_t rays) {
  return is_usual_but_chosen(options) && options.test == TriangleTest::exact &&
         static_cast<std::size_t>(options.facing) < facing_names.size() &&
         options.skip.count == (options.skip.first != nullptr ? rays : 0);
}
const ChosenCallRow* chosen_row(const TraceOptions& options, std::size_t rays) {
  return is_usual_kept(options, rays) && options.after.first == nullptr
             ? &kernels_of(checked_path(options.path)).queries.plain.chosen_call
             : nullptr;
}
const CallRow& default_row() {
  constexpr TraceOptions options;
  constexpr auto test = static_cast<std::size_t>(options.test),
                 grade = static_cast<std::size_t>(options.grade);
  return kernels_of(path_in_use()).traversal.call.row[test][grade];
}

void trace_hits(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                const TraceOptions& options) {
  const CheckedCall call("trace", rays, hits, options);
  const Traversal traversal = checked_traversal(tree, call.options);
  if (options.after.first != nullptr) return trace_next(tree, call.rays, hits, call.options);
  trace(traversal.tree, traversal.choice, call.rays, HitSink<Hit>{hits}, options.threads);
}

Traversal checked_traversal(const TracedTree& tree, const TraceOptions& options) {
  const std::size_t test = checked_test(options.test);
  const std::size_t grade = checked_index("trace", "grade", options.grade, grade_names.size());
  checked_index("trace", "mode", options.mode, traversal_mode_names.size());
  checked_index("trace", "hint", options.hint, batch_hint_names.size());
  require_threads("trace", options.threads);
  checked_index("trace", "facing", options.facing, facing_names.size());
  Traversal traversal{tree.view, options.facing == Facing::any && options.skip.first == nullptr
                                     ? choice_of_both_sides(tree.kind, options, test, grade)
                                     : choice_of_chosen(options)};
  traversal.choice.progress = options.progress;
  traversal.choice.fixed_parts = options.test != TriangleTest::exact && options.mode != TraversalMode::single;
  return traversal;
}

Hit TriangleTree::closest(const Ray& ray) const {
  return is_quick(ready_) ? default_row().closest(*ready_, ray) : closest_by_options(ray, {});
}
Hit TriangleTree::closest(const Ray& ray, const TraceOptions& options) const {
  if (!is_quick(ready_)) return closest_by_options(ray, options);
  if (const CallRow* const row = usual_row(options)) return row->closest(*ready_, ray);
  const ChosenCallRow* const chosen = chosen_row(options);
  return chosen != nullptr ? chosen->closest(*ready_, ray, options.facing, skipped_by_one(options))
                           : closest_by_options(ray, options);
}
bool TriangleTree::occluded(const Ray& ray) const {
  return is_quick(ready_) ? default_row().any(*ready_, ray) : occluded_by_options(ray, {});
}
bool TriangleTree::occluded(const Ray& ray, const TraceOptions& options) const {
  if (!is_quick(ready_)) return occluded_by_options(ray, options);
  if (const CallRow* const row = usual_row(options)) return row->any(*ready_, ray);
  const ChosenCallRow* const chosen = chosen_row(options);
  return chosen != nullptr ? chosen->any(*ready_, ray, options.facing, skipped_by_one(options))
                           : occluded_by_options(ray, options);
}

RayCalls<TriangleTree> TriangleTree::calls(const TraceOptions& options) const& {
  RayCalls<TriangleTree> calls(*this, options);
  checked_traversal(traced(), options);
  skip_of_one("trace", options), require_after("trace", options.after, 1);
  calls.options_.path = &checked_path(options.path);
  if (!is_quick(ready_)) return calls;
  if (const CallRow* const row = usual_row(calls.options_))
    calls.kernels_ = {ready_, row->closest, row->any};
  else if (const ChosenCallRow* const chosen = chosen_row(calls.options_))
    calls.kernels_ = {ready_, nullptr, nullptr, chosen->closest, chosen->any};
  return calls;
}

Hit TriangleTree::closest_by_options(const Ray& ray, const TraceOptions& options) const {
  const Traversal traversal = checked_traversal(traced(), options);
  const QuietFloats quiet;
  const std::uint32_t skipped = skip_of_one("trace", options);
  require_after("trace", options.after, 1);
  Hit hit;
  if (options.after.first != nullptr) {
    TraceOptions unreported = options;
    unreported.progress = nullptr;
    trace_next(traced(), {.records = RayView(&ray, 1), .skip = options.skip}, HitView(&hit, 1), unreported);
    return hit;
  }
  TraceBatch batch;
  batch.rays = &ray, batch.size = 1, batch.hits = &hit, batch.counters = options.counters;
  batch.facing = options.facing, batch.skip = &skipped;
  traversal.choice.single->closest(traversal.tree, batch);
  return hit;
}

bool TriangleTree::occluded_by_options(const Ray& ray, const TraceOptions& options) const {
  const Traversal traversal = checked_traversal(traced(), options);
  const QuietFloats quiet;
  std::uint8_t occluded = 0;
  const std::uint32_t skipped = skip_of_one("trace", options);
  TraceBatch batch;
  batch.rays = &ray, batch.size = 1, batch.occluded = &occluded, batch.counters = options.counters;
  batch.facing = options.facing, batch.skip = &skipped;
  traversal.choice.single->any(traversal.tree, batch);
  return occluded != 0;
}

void TriangleTree::closest(RayView rays, HitView hits, const TraceOptions& options) const {
  if (trace_few(ready_, rays, HitSink<Hit>{hits}.in_place(), hits.count, options, &CallRow::closest,
                &ChosenCallRow::closest))
    return;
  trace_hits(traced(), source_of(rays, options), hits, options);
}
void TriangleTree::closest(const RayArrays& rays, HitView hits, const TraceOptions& options) const {
  trace_hits(traced(), source_of(rays, options), hits, options);
}
void TriangleTree::occluded(RayView rays, std::span<std::uint8_t> occluded,
                            const TraceOptions& options) const {
  if (trace_few(ready_, rays, occluded.data(), occluded.size(), options, &CallRow::any, &ChosenCallRow::any))
    return;
  trace_occluded(traced(), source_of(rays, options), occluded, options);
}
void TriangleTree::occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                            const TraceOptions& options) const {
  trace_occluded(traced(), source_of(rays, options), occluded, options);
}
void TriangleTree::occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                                 const SegmentEnds& ends, const TraceOptions& options) const {
  trace_occluded(traced(), source_of(Segments{from, points, ends}, options), occluded, options);
}
void TriangleTree::occluded_towards(const Float3& direction, VertexView points,
                                    std::span<std::uint8_t> occluded, const TraceOptions& options) const {
  trace_occluded(traced(), source_of(Segments{direction, points, {}, true}, options), occluded, options);
}

Box TriangleTree::bounds() const noexcept {
  return traced().view.bounds;
}

}  // namespace raylanes

// The nearest hit, or whether there is one: options and views are checked, then rays are traced.

#include <raylanes/rays.hpp>
#include <raylanes/triangle_tree.hpp>

#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "answers/ray_answers.hpp"
#include "filters/found_parts.hpp"
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
// The rows of triangles that the caller chooses, by side, skip or masks.
TraversalChoice choice_by_rule(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        options.facing == Facing::any
            ? std::string("trace: skip and masks take the test exact")
            : "trace: facing " + std::string(facing_names[static_cast<std::size_t>(options.facing)]) +
                  " takes the test exact; with other tests only facing any is allowed");
  const QueryKernels& rows = checked_queries<float>("trace", options);
  const TraversalRow* const single = &rows.ruled_single;
  const TraversalRow* const together = rows.ruled_stream.closest != nullptr ? &rows.ruled_stream : single;
  const TraversalRows& packets =
      kernels_of(checked_path(options.path)).traversal.mode[static_cast<std::size_t>(TraversalMode::packet)];
  constexpr auto exact = static_cast<std::size_t>(TriangleTest::exact);
  const bool counts = options.counters != nullptr;
  TraversalChoice choice{single,         counts ? together : &packets.row[exact][0],
                         together,       options.mode,
                         options.hint,   options.counters,
                         options.facing, counts ? nullptr : &rows.ruled_call};
  set_what_tells(choice, options);
  return choice;
}

// Whether a call with one ray sets no more than facing, skip, after, test, grade, path, and what is for batches.
bool is_usual_but_for_rule(const TraceOptions& options) {
  return options.mode == TraversalMode::automatic &&
         static_cast<std::size_t>(options.hint) < batch_hint_names.size() && options.threads >= 0 &&
         options.counters == nullptr && static_cast<std::size_t>(options.grade) < grade_names.size();
}
// And that they choose triangles by the exact test, for so many rays.
bool has_usual_rule(const TraceOptions& options, std::size_t rays) {
  return options.test == TriangleTest::exact &&
         static_cast<std::size_t>(options.facing) < facing_names.size() &&
         options.skip.count == (options.skip.first != nullptr ? rays : 0);
}
}  // namespace

bool is_usual_kept(const TraceOptions& options, std::size_t rays) {
  return is_usual_but_for_rule(options) && has_usual_rule(options, rays);
}
RowsOfCalls rows_of_calls(const TraceOptions& options, std::size_t rays) {
  const auto test = static_cast<std::size_t>(options.test), grade = static_cast<std::size_t>(options.grade);
  if (!is_usual_but_for_rule(options) || options.after.first != nullptr) return {};
  const bool is_ruled =
      options.facing != Facing::any || options.skip.first != nullptr || !options.masks.empty();
  if (is_ruled ? !has_usual_rule(options, rays) : test >= std::size(triangle_tests)) return {};
  const KernelTable& kernels = kernels_of(checked_path(options.path));
  if (is_ruled) return {nullptr, &kernels.queries.plain.ruled_call};
  const CallRow& row = kernels.traversal.call.row[test][grade];
  return {row.closest != nullptr ? &row : nullptr};
}
const CallRow& default_row() {
  constexpr TraceOptions options;
  constexpr auto test = static_cast<std::size_t>(options.test),
                 grade = static_cast<std::size_t>(options.grade);
  return kernels_of(path_in_use()).traversal.call.row[test][grade];
}

Traversal checked_traversal(const TracedTree& tree, const TraceOptions& options) {
  const std::size_t test = checked_test(options.test);
  const std::size_t grade = checked_index("trace", "grade", options.grade, grade_names.size());
  checked_index("trace", "mode", options.mode, traversal_mode_names.size());
  checked_index("trace", "hint", options.hint, batch_hint_names.size());
  require_threads("trace", options.threads);
  checked_index("trace", "facing", options.facing, facing_names.size());
  const bool takes_all =
      options.facing == Facing::any && options.skip.first == nullptr && options.masks.empty();
  Traversal traversal{
      tree.view, takes_all ? choice_of_both_sides(tree.kind, options, test, grade) : choice_by_rule(options)};
  traversal.tree.masks = masks_of(options);
  traversal.choice.progress = options.progress;
  traversal.choice.fixed_parts = options.test != TriangleTest::exact && options.mode != TraversalMode::single;
  return traversal;
}

namespace {

// A tree's kernels of calls with one ray, by options.
class KernelsOfTree {
 public:
  // `ready`: null if there are none to be used.
  [[gnu::always_inline]] KernelsOfTree(const LastingView<TreeView>* ready, const TraceOptions& options,
                                       std::size_t rays, bool are_default)
      : ready_(ready),
        options_(options),
        rows_(ready == nullptr ? RowsOfCalls()
              : are_default    ? RowsOfCalls{&default_row()}
                               : rows_of_calls(options, rays)) {
    if (rows_.by_rule != nullptr && !options.masks.empty())
      ready_ = &masked_for_call(*ready, masks_of(options));
  }
  explicit operator bool() const { return static_cast<bool>(rows_); }
  std::size_t batch_size() const { return batch_size_of(*ready_); }
  template <class Answer>
  bool takes(const FewRays<Ray, Answer>& few, bool may_be_alike) const {
    return !few.may_be_packet(ready_->bounds, rows_.by_rule == nullptr, may_be_alike);
  }
  template <class Answer>
  bool trace_alike(const FewRays<Ray, Answer>& few) const {
    TraceBatch batch = few.batch();
    set_answers(batch, few.answers());
    return raylanes::trace_alike(*ready_, batch);
  }
  Hit closest(const Ray& ray, std::size_t i) const {
    return rows_.closest(*ready_, ray, options_.facing, [&] { return skipped_of(options_, i); });
  }
  bool any(const Ray& ray, std::size_t i) const {
    return rows_.any(*ready_, ray, options_.facing, [&] { return skipped_of(options_, i); });
  }

 private:
  const TreeView* ready_;
  const TraceOptions& options_;
  RowsOfCalls rows_;
};

void require_filterable(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument("trace: a filter takes the test exact; other tests have no order of hits");
}

}  // namespace

template <>
class RayDoor<TriangleTree> {
 public:
  static constexpr const char* name = "trace";

  explicit RayDoor(const TriangleTree& tree) : tree_(tree), ready_(TreeAccess::ready(tree)) {}

  Hit closest(const Ray& ray) const {
    return is_quick() ? default_row().closest(*ready_, ray) : closest_by(ray, {});
  }
  bool any(const Ray& ray) const { return is_quick() ? default_row().any(*ready_, ray) : any_by(ray, {}); }
  [[gnu::always_inline]] KernelsOfTree kernels(const TraceOptions& options, std::size_t rays,
                                               bool are_default = false) const {
    return {is_quick() ? ready_ : nullptr, options, rays, are_default};
  }
  [[gnu::cold, gnu::noinline]] Hit closest_by(const Ray& ray, const TraceOptions& options) const {
    Hit hit;
    TraceBatch batch;
    batch.hits = &hit;
    trace_one(ray, options, batch, &TraversalRow::closest);
    return hit;
  }
  [[gnu::cold, gnu::noinline]] bool any_by(const Ray& ray, const TraceOptions& options) const {
    std::uint8_t occluded = 0;
    TraceBatch batch;
    batch.occluded = &occluded;
    trace_one(ray, options, batch, &TraversalRow::any);
    return occluded != 0;
  }
  void trace(const RaySource& rays, const HitView& hits, const TraceOptions& options) const {
    const CheckedCall call(name, rays, hits, options);
    const TracedTree tree = TreeAccess::traced(tree_);
    const Traversal traversal = checked_traversal(tree, call.options);
    if (options.after.first != nullptr) return trace_after(tree, call.rays, hits, call.options);
    raylanes::trace(traversal.tree, traversal.choice, call.rays, HitSink<Hit>{hits}, options.threads);
  }
  void trace(const RaySource& rays, std::span<std::uint8_t> occluded, const TraceOptions& options) const {
    const CheckedCall call(name, rays, occluded, options);
    Traversal traversal = checked_traversal(TreeAccess::traced(tree_), call.options);
    traversal.choice.facing = rays.sides(options.facing);
    raylanes::trace(traversal.tree, traversal.choice, call.rays, SpanSink<std::uint8_t>{occluded},
                    options.threads);
  }
  bool find_parts(const RaySource& rays, std::span<TreeReference> parts, const TraceOptions& options) const {
    raylanes::find_parts(TreeAccess::traced(tree_), rays, parts, options);
    return true;
  }
  void hits_in_parts(const RaySource& rays, std::span<const TreeReference> parts,
                     std::span<const std::size_t> some, std::span<Hit> hits,
                     const TraceOptions& options) const {
    raylanes::hits_in_parts(TreeAccess::traced(tree_), rays, parts, some, hits, options);
  }

  template <class Sink>
  bool keep(const RaySource& rays, const Sink& sink, const detail::BatchRejection<Hit>& rejected,
            const TraceOptions& by) const {
    return keep_in_tree(TreeAccess::traced(tree_), rays, sink, rejected, by, AsHitOfTree());
  }
  static void require_order(const TraceOptions& options) { require_exact(options); }
  TreeLists<float, TracedTree> lists(const TraceOptions&) const { return {TreeAccess::traced(tree_)}; }
  using KeptOfTree = KeptCalls<TreeView, float>;
  KeptOfTree kept_at_once() const {
    return {is_quick() ? &kernels_of(path_in_use()).queries.plain.kept : nullptr, ready_};
  }
  Hit closest_kept(const Ray& ray, const detail::Rejection<Hit>& rejection,
                   const TraceOptions& options) const {
    require_filterable(options);
    if (options.counters != nullptr)
      return first_kept(rejection, options,
                        [&](const TraceOptions& next) { return tree_.closest(ray, next); });
    return asking<Hit>(rejection, options, [&](const KeptOfTree& kept, const AskedOf<float>& asked) {
      return kept.closest(ray, asked);
    });
  }
  bool any_kept(const Ray& ray, const detail::Rejection<Hit>& rejection, const TraceOptions& options) const {
    require_filterable(options);
    if (options.counters != nullptr) return static_cast<bool>(closest_kept(ray, rejection, options));
    return asking<bool>(rejection, options, [&](const KeptOfTree& kept, const AskedOf<float>& asked) {
      return kept.any(ray, asked);
    });
  }

  detail::KernelsOfCalls<TriangleTree> kernels_of_calls(const TraceOptions& options) const {
    const RowsOfCalls rows = is_quick() ? rows_of_calls(options, 1) : RowsOfCalls();
    detail::KernelsOfCalls<TriangleTree> kernels{ready_};
    if (rows.usual != nullptr) kernels.closest = rows.usual->closest, kernels.occluded = rows.usual->any;
    if (rows.by_rule == nullptr) return kernels;
    kernels.closest_by_rule = rows.by_rule->closest, kernels.occluded_by_rule = rows.by_rule->any;
    return with_masks(std::move(kernels), options);
  }

 private:
  // Whether a call with one ray may go straight to the kernel: there is a tree, and nothing traps.
  bool is_quick() const { return ready_ != nullptr && !QuietFloats::are_wanted(); }
  // Usual options need no rows of other kernels, and no copy of the tree, whose vectors would wait for its stores.
  template <class Answer, class Call>
  Answer asking(const detail::Rejection<Hit>& rejection, const TraceOptions& options,
                const Call& call) const {
    const KeptCall<float> kept(rejection, options);
    const auto* const row = &kernels_of(checked_path(options.path)).queries.plain.kept;
    const QuietFloats quiet;
    if (ready_ != nullptr && is_usual_kept(options) && options.masks.empty())
      return call(KeptOfTree{row, ready_}, kept.asked);
    const TreeView tree = checked_traversal(TreeAccess::traced(tree_), options).tree;
    return call(KeptOfTree{row, &tree}, kept.asked);
  }
  void trace_one(const Ray& ray, const TraceOptions& options, TraceBatch& batch,
                 decltype(&TraversalRow::any) row) const {
    const TracedTree tree = TreeAccess::traced(tree_);
    const Traversal traversal = checked_traversal(tree, options);
    const QuietFloats quiet;
    const std::uint32_t skipped = skip_of_one(name, options);
    if (batch.hits != nullptr) require_after(name, options.after, 1);
    if (batch.hits != nullptr && options.after.first != nullptr) {
      TraceOptions unreported = options;
      unreported.progress = nullptr;
      return trace_after(tree, {.records = RayView(&ray, 1), .skip = options.skip}, HitView(batch.hits, 1),
                         unreported);
    }
    batch.rays = &ray, batch.size = 1, batch.counters = options.counters;
    batch.facing = options.facing, batch.skip = &skipped;
    (traversal.choice.single->*row)(traversal.tree, batch);
  }

  const TriangleTree& tree_;
  const LastingView<TreeView>* ready_;
};
template class RayQueries<TriangleTree>;

RayCalls<TriangleTree> TriangleTree::calls(const TraceOptions& options) const& {
  RayCalls<TriangleTree> calls(*this, options);
  checked_traversal(traced(), options);
  skip_of_one("trace", options), require_after("trace", options.after, 1);
  calls.options_.path = &checked_path(options.path);
  calls.kernels_ = RayDoor<TriangleTree>(*this).kernels_of_calls(calls.options_);
  return calls;
}

Box TriangleTree::bounds() const noexcept {
  return traced().view.bounds;
}

}  // namespace raylanes

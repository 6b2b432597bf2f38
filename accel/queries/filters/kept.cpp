// One ray whose caller rejects hits.
#include <stdexcept>

#include "../../../dispatch/quiet_floats.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../next.hpp"
#include "../traced_tree.hpp"

namespace raylanes {
namespace {

void require_filterable(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument("trace: a filter takes the test exact; other tests have no order of hits");
}

// The tree, if options are right. Usual ones need no rows of other kernels.
TreeView tree_by(const TracedTree& tree, const TraceOptions& options) {
  return is_usual_kept(options) ? tree.view : checked_traversal(tree, options).tree;
}

}  // namespace

// options: null for the default ones.
Hit TriangleTree::closest_kept(const Ray& ray, const detail::Rejection<Hit>& rejection,
                               const TraceOptions* options) const {
  if (options == nullptr && ready_ != nullptr && !QuietFloats::are_wanted())
    return kernels_of(path_in_use()).queries.plain.kept.closest(*ready_, ray, asked_by(rejection));
  const TraceOptions by = options != nullptr ? *options : TraceOptions();
  require_filterable(by);
  if (by.counters != nullptr)
    return first_kept(rejection, by, [&](const TraceOptions& next) { return closest(ray, next); });
  const TreeView tree = tree_by(traced(), by);
  const KeptCall<float> call(rejection, by);
  const QuietFloats quiet;
  return kernels_of(checked_path(by.path)).queries.plain.kept.closest(tree, ray, call.asked);
}
bool TriangleTree::any_kept(const Ray& ray, const detail::Rejection<Hit>& rejection,
                            const TraceOptions* options) const {
  if (options == nullptr && ready_ != nullptr && !QuietFloats::are_wanted())
    return kernels_of(path_in_use()).queries.plain.kept.any(*ready_, ray, asked_by(rejection));
  TraceOptions by = options != nullptr ? *options : TraceOptions();
  require_filterable(by);
  by.after = {};  // of closest() only
  if (by.counters != nullptr) return static_cast<bool>(closest_kept(ray, rejection, &by));
  const TreeView tree = tree_by(traced(), by);
  const KeptCall<float> call(rejection, by);
  const QuietFloats quiet;
  return kernels_of(checked_path(by.path)).queries.plain.kept.any(tree, ray, call.asked);
}

}  // namespace raylanes

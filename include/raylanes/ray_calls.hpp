// Calls with one ray, prepared once: for loops that trace ray by ray.
#pragma once

#include <cstdint>
#include <memory>

#include <raylanes/numbers.hpp>
#include <raylanes/queries.hpp>

namespace raylanes {

namespace detail {

// The kernels of a tree's calls: by default options, and with sides and a primitive to skip.
template <class Tree>
struct KernelsOfCalls {
  using View = typename QueryTypes<Tree>::View;
  using Ray = RayOf<typename QueryTypes<Tree>::Number>;
  using Hit = typename QueryTypes<Tree>::Hit;
  const View* view = nullptr;
  Hit (*closest)(const View&, const Ray&) = nullptr;
  bool (*occluded)(const View&, const Ray&) = nullptr;
  Hit (*closest_by_rule)(const View&, const Ray&, Facing, std::uint32_t) = nullptr;
  bool (*occluded_by_rule)(const View&, const Ray&, Facing, std::uint32_t) = nullptr;
  std::shared_ptr<const View> masked = nullptr;  // `view`, if options have masks
};

}  // namespace detail

/// Calls with one ray by a tree's `calls(options)`: `closest(ray)` and `occluded(ray)` return what the tree's
/// `closest(ray, options)` and `occluded(ray, options)` return, in less time for rays that are traced quickly.
/// The object asks once what those functions ask in each call: whether floating-point exceptions trap, which ISA path
/// is active, and which kernel traces by the options. If options need more than a kernel, such as counters, calls take
/// the usual way.
/// - Make it in the thread that uses it, once a thread or loop. Copies are cheap. Many threads may use one object if
///   none of them lets exceptions trap.
/// - It is valid until the tree is destroyed, moved, assigned to or refitted, and refers to what the options refer to.
///   options.skip[0] and options.after[0] are read in each call.
/// - If exceptions trap when it is made, calls mask them as all calls do. If you let them trap later, calls may trap.
/// - force_path() does not change it.
template <class Tree>
class RayCalls {
 public:
  using Ray = typename detail::KernelsOfCalls<Tree>::Ray;      ///< a ray of the tree's numbers
  using Hit = typename detail::QueryTypes<Tree>::Hit;          ///< its hit
  using Options = typename detail::QueryTypes<Tree>::Options;  ///< how rays are traced

  /// Returns the nearest hit of the ray, or a miss.
  Hit closest(const Ray& ray) const {
    if (kernels_.closest != nullptr) return kernels_.closest(*kernels_.view, ray);
    if (kernels_.closest_by_rule == nullptr) return tree_->closest(ray, options_);
    return kernels_.closest_by_rule(*kernels_.view, ray, options_.facing, skipped());
  }
  /// Returns whether the ray's segment hits any triangle.
  bool occluded(const Ray& ray) const {
    if (kernels_.occluded != nullptr) return kernels_.occluded(*kernels_.view, ray);
    if (kernels_.occluded_by_rule == nullptr) return tree_->occluded(ray, options_);
    return kernels_.occluded_by_rule(*kernels_.view, ray, options_.facing, skipped());
  }

 private:
  friend Tree;
  RayCalls(const Tree& tree, const Options& options) : tree_(&tree), options_(options) {}
  std::uint32_t skipped() const { return options_.skip.first != nullptr ? options_.skip[0] : no_primitive; }

  detail::KernelsOfCalls<Tree> kernels_;
  const Tree* tree_;
  Options options_;
};

}  // namespace raylanes

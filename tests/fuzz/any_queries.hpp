// The queries of a run to a tree over a mesh of any floats or doubles, judged by rational numbers.
#pragma once

#include "any_filters.hpp"
#include "any_masks.hpp"
#include "query_checks.hpp"

namespace raylanes::testing {

// A tree over a mesh; now and then one over triangles of other vertices, of which some collapse or come back at a
// refit.
template <class Tree, class AnyMesh>
Tree any_refitted(Bytes& bytes, const AnyMesh& mesh, TreeBuilder builder) {
  AnyMesh before = mesh;
  const bool refits = bytes.chance(64);
  for (std::uint32_t i = 0; refits && i < before.triangles.size(); ++i)
    before.triangles[i] = {i, i + 1, i + 2};
  Tree tree(before.vertices, before.triangles, {.builder = builder});
  if (refits) tree.refit(mesh.vertices, mesh.triangles);
  return tree;
}

template <class T>
class AnyQueries {
 public:
  const Path* const path;
  const Facing facing;
  std::vector<std::uint32_t> skip;  // empty: nothing is skipped
  const std::uint32_t mask;
  const std::span<const std::uint32_t> masks;  // before a page that faults
  ExpectedLists<T> expected;

  AnyQueries(Bytes& bytes, const oracle::MeshOf<T>& mesh, const std::vector<RayOf<T>>& rays)
      : path(bytes.pick(fuzzed_paths())),
        facing(bytes.chance(128)   ? Facing::any
               : bytes.chance(128) ? Facing::front
                                   : Facing::back),
        mask(static_cast<std::uint32_t>(bytes.below(8))),
        masks(any_masks(bytes, mesh.triangles.size())),
        bytes_(bytes),
        whole_(mesh),
        mesh_(seen_by(mesh, masks, mask)),
        rays_(rays),
        rule_(static_cast<InsideRule>(bytes.below(inside_rule_names.size()))),
        max_count_(bytes.chance(128) ? ~0u : static_cast<std::uint32_t>(bytes.below(70))),
        threads_(bytes.chance(32) ? 2 : 1),
        accuracy_(bytes.pick({0.0, 1e-6, 0.1})) {
    const bool skips = bytes.chance(96);
    for (const RayOf<T>& ray : rays) {
      std::uint32_t skipped = no_primitive;
      if (skips && bytes.chance(160)) {
        const auto all = oracle::exact_hits(mesh_, ray);
        skipped = all.empty() ? static_cast<std::uint32_t>(bytes.below(1000)) : bytes.pick(all).primitive;
      }
      if (skips) skip.push_back(skipped);
      expected.hits.push_back(oracle_hits(mesh_, ray, facing, skipped));
      std::erase_if(expected.crossings.emplace_back(oracle::exact_crossings(mesh_, ray)), [&](const auto& c) {
        return c.primitive == skipped ||
               (facing != Facing::any && c.side != (facing == Facing::front ? -1 : 1));
      });
      names_.push_back(static_cast<std::uint32_t>(bytes.below(mesh.triangles.size() + 2)) - 1);
    }
  }

  // Results that depend on subnormal numbers may differ where these are flushed: only faults and the order of lists are
  // checked.
  template <class Tree>
  void ask(const Tree& tree, bool flush) const {
    const Options options{
        .path = path, .threads = threads_, .facing = facing, .skip = skip, .mask = mask, .masks = masks};
    expect_corners(tree, whole_, names_);
    run_out_of_memory(bytes_, tree, rays_, rule_);
    expect_active_alone(tree, rays_, path, rule_);
    expect_locations(tree, !flush);
    expect_windings(tree, whole_, rays_, {.accuracy = accuracy_, .path = path, .threads = threads_}, !flush);
    if (flush) return expect_order(tree, options);
    expect_lists(tree, rays_, expected,
                 {.max_count = max_count_,
                  .facing = facing,
                  .path = path,
                  .threads = threads_,
                  .skip = skip,
                  .mask = mask,
                  .masks = masks});
    expect_closest_crossings(tree, mesh_, rays_, options);
    expect_kept(tree, rays_, expected.hits, options);
    expect_hits_after(tree, rays_, expected, options);
  }

 private:
  using Options = std::conditional_t<std::is_same_v<T, float>, TraceOptions, TraceOptionsD>;

  VertexRecords<T> origins() const { return {rays_.data(), rays_.size(), sizeof(RayOf<T>)}; }

  template <class Tree>
  void expect_order(const Tree& tree, const Options& options) const {
    std::vector<HitOf<T>> closest_crossings(rays_.size());
    tree.closest_crossing(rays_, closest_crossings, options);
    const auto hits = tree.all_hits(rays_, {.max_count = max_count_,
                                            .facing = facing,
                                            .path = path,
                                            .skip = skip,
                                            .mask = mask,
                                            .masks = masks});
    const auto crossings = tree.crossings(rays_, {.max_count = max_count_, .path = path});
    for (std::size_t i = 0; i < rays_.size(); ++i)
      if (!std::ranges::is_sorted(hits[i], {}, &HitOf<T>::t) ||
          !std::ranges::is_sorted(crossings[i], {}, &CrossingOf<T>::t))
        fail("a list is not in order");
  }

  // Meshes of any bits are not closed: inside depends on the direction, which is not known here.
  template <class Tree>
  void expect_locations(const Tree& tree, bool is_exact) const {
    static Fence fence(max_queries * sizeof(Location)), distance_fence(max_queries * sizeof(T));
    const LocateOptions options{.rule = rule_, .path = path, .threads = threads_};
    const std::span<Location> locations(fence.last<Location>(rays_.size()), rays_.size());
    const std::span<T> distances(distance_fence.last<T>(rays_.size()), rays_.size());
    tree.locate(origins(), locations, options);
    fence.expect_intact("locations");
    tree.signed_distances(origins(), distances, {.rule = rule_, .path = path, .threads = threads_});
    distance_fence.expect_intact("signed distances");
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const auto& point = rays_[i].origin;
      if (locations[i] > Location::on) fail("no location");
      const Location side = distances[i] == 0  ? Location::on
                            : distances[i] < 0 ? Location::inside
                                               : Location::outside;
      if (side != locations[i]) fail("a signed distance of another sign than its location");
      if (is_exact && (is_finite(point) && is_on(whole_, point)) != (locations[i] == Location::on))
        fail(std::string(path->name) + ": point " + std::to_string(i) + ": on is wrong");
      if (i > 0) expect_place_in_line(tree, i, locations[i], options);
    }
  }
  // A point in a line of many has the place that it has beside its neighbour alone, which is found in another way.
  template <class Tree>
  void expect_place_in_line(const Tree& tree, std::size_t i, Location location,
                            const LocateOptions& options) const {
    int equal = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      equal += rays_[i - 1].origin[axis] == rays_[i].origin[axis] ? 1 : 0;
    if (equal < 2) return;
    Location pair[2];
    tree.locate(VertexRecords<T>(&rays_[i - 1], 2, sizeof(RayOf<T>)), pair, options);
    if (pair[1] != location) fail("a point in a line has another place than beside its neighbour");
  }

  Bytes& bytes_;
  const oracle::MeshOf<T>& whole_;
  const oracle::MeshOf<T> mesh_;  // what the masks see
  const std::vector<RayOf<T>>& rays_;
  const InsideRule rule_;
  const std::uint32_t max_count_;
  const int threads_;
  const double accuracy_;
  std::vector<std::uint32_t> names_;
};

}  // namespace raylanes::testing

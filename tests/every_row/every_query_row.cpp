// The rows of boundaries, and of lists, crossings and next hits: the bytes of scalar, whatever order lists come in.
#include "../../accel/mesh/boundary_tree.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../../dispatch/table/winding.hpp"
#include "../support/same_bytes.hpp"
#include "every_row.hpp"
#include "kept_rows.hpp"
#include "small_tree.hpp"

namespace raylanes::testing {
namespace {

using Lister = std::size_t (*)(const TreeView& tree, const ListBatch& batch);
using Bytes = std::size_t (*)(std::size_t rays, std::size_t room);

// Each ray's list in order.
template <class Entry>
std::vector<std::vector<Entry>> lists_of(Lister lister, const TreeView& tree, const std::vector<Ray>& rays,
                                         ListKind kind, ListStop stop, Bytes scratch_bytes,
                                         TraceCounters& counters) {
  std::vector<ListEntryOf<float>> list(rays.size() * most);
  std::vector<Hit> hits(list.size());
  std::vector<std::size_t> ends(rays.size());
  ListBatch batch;
  batch.rays = rays.data(), batch.size = rays.size(), batch.kind = kind, batch.stop = stop,
  batch.counters = &counters;
  batch.list = list.data(), batch.hits = hits.data(), batch.room = list.size(), batch.end = ends.data();
  std::vector<Line> scratch;
  if (scratch_bytes != nullptr) scratch.resize(scratch_bytes(rays.size(), list.size()) / sizeof(Line) + 1);
  batch.scratch = scratch.data();
  EXPECT_EQ(lister(tree, batch), rays.size());
  std::vector<Entry> items;
  if constexpr (std::is_same_v<Entry, Hit>)
    items = hits;
  else
    items = list;
  std::vector<std::vector<Entry>> lists;
  for (std::size_t i = 0, at = 0; i < rays.size(); at = ends[i++]) {
    std::vector<Entry>& of_ray = lists.emplace_back(items.begin() + static_cast<std::ptrdiff_t>(at),
                                                    items.begin() + static_cast<std::ptrdiff_t>(ends[i]));
    std::ranges::sort(of_ray, {}, &Entry::primitive);
  }
  return lists;
}

template <class Entry>
void compare_lists(EveryRow& every, Lister mine, Lister of_scalar, const std::vector<Ray>& rays,
                   ListKind kind, ListStop stop, Bytes scratch_bytes = nullptr) {
  if (!every.offers(mine, of_scalar)) return;
  const SmallTree tree;
  TraceCounters my_counters, scalar_counters;
  const auto lists = lists_of<Entry>(mine, tree.view, rays, kind, stop, scratch_bytes, my_counters),
             scalar = lists_of<Entry>(of_scalar, tree.view, rays, kind, stop, scratch_bytes, scalar_counters);
  EXPECT_EQ(my_counters.triangle_tests == 0, scalar_counters.triangle_tests == 0);
  std::size_t found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_TRUE(same_bytes(lists[i], scalar[i])) << "kind " << static_cast<int>(kind) << " ray " << i;
    found += lists[i].size();
  }
  EXPECT_GT(found, 20u);
}

// Counts with the least room, which lists of some rays outgrow, against sums of lists.
void compare_counts(EveryRow& every, Lister mine, Lister of_scalar, Bytes scratch_bytes = nullptr) {
  if (!every.offers(mine, of_scalar)) return;
  const SmallTree tree;
  const std::vector<Ray> rays = some_rays();
  constexpr std::size_t room = 16;
  TraceCounters counters;
  std::vector<ListEntryOf<float>> list(room);
  std::vector<CrossingCount> counts(rays.size());
  std::vector<Line> scratch;
  if (scratch_bytes != nullptr) scratch.resize(scratch_bytes(rays.size(), room) / sizeof(Line) + 1);
  ListBatch batch;
  batch.rays = rays.data(), batch.size = rays.size(), batch.kind = ListKind::sides,
  batch.counters = &counters;
  batch.list = list.data(), batch.room = room, batch.scratch = scratch.data(), batch.counts = counts.data();
  EXPECT_EQ(mine(tree.view, batch), rays.size());
  const auto lists = lists_of<ListEntryOf<float>>(of_scalar, tree.view, rays, ListKind::sides,
                                                  ListStop::never, scratch_bytes, counters);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CrossingCount expected;
    for (const auto& crossing : lists[i]) ++expected.crossings, expected.winding += crossing.side;
    EXPECT_EQ(counts[i], expected) << "ray " << i;
  }
}

std::vector<Ray> rays_along_axes() {
  std::vector<Ray> rays = some_rays();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Float3 direction{};
    direction[i % 3] = i % 2 == 0 ? 1.0f : -1.0f;
    for (float& x : rays[i].origin) x *= 0.4f;
    rays[i] = {rays[i].origin, 0, direction, infinity};
  }
  return rays;
}

void compare_next(EveryRow& every, const QueryKernels& mine, const QueryKernels& of_scalar) {
  if (!every.offers(mine.next, of_scalar.next)) return;
  const SmallTree tree;
  const std::vector<Ray> rays = some_rays();
  std::vector<Hit> last(most, Hit{-infinity, 0, 0, 0}), found(most), scalar(most);
  for (int layer = 0; layer < 3; ++layer) {
    TraceCounters counters;
    TraceBatch batch;
    batch.rays = rays.data(), batch.size = most, batch.after = last.data(), batch.counters = &counters;
    batch.hits = found.data(), mine.next(tree.view, batch);
    batch.hits = scalar.data(), of_scalar.next(tree.view, batch);
    EXPECT_TRUE(same_bytes(found, scalar)) << "layer " << layer;
    EXPECT_GT(std::ranges::count_if(found, [](const Hit& hit) { return bool(hit); }), 3);
    last = found;
  }
}

struct NextOf {
  const QueryKernels& kernels;
  const TreeView& tree;

  Hit operator()(const Ray& ray, Facing facing, std::uint32_t skipped, const Hit* last) const {
    Hit hit;
    TraceBatch batch;
    batch.rays = &ray, batch.size = 1, batch.hits = &hit;
    batch.facing = facing, batch.skip = &skipped, batch.after = last;
    kernels.next(tree, batch);
    return hit;
  }
};

// Hits of chosen triangles, of rays alone or together, against next hits of these of scalar. chosen: for packets.
void compare_chosen(EveryRow& every, const TraversalRow& mine, const TraversalRow& of_scalar,
                    const QueryKernels& scalar_queries, std::size_t bytes,
                    const ChosenCallRow* chosen = nullptr) {
  const bool has_closest = every.offers(mine.closest, of_scalar.closest);
  every.offers(mine.any, of_scalar.any), every.offers(mine.scratch_bytes, of_scalar.scratch_bytes);
  if (!has_closest) return;
  const SmallTree tree;
  std::vector<Ray> rays = some_rays();
  if (chosen != nullptr)
    for (Ray& ray : rays) ray.origin = {0.1f, -0.2f, 0.3f};
  std::vector<Line> scratch(bytes / sizeof(Line) + 1);
  std::vector<std::vector<Hit>> of_sides;
  std::vector<std::uint32_t> skip(most, no_primitive);
  for (const auto& [side, skips] : {std::pair(Facing::front, false), std::pair(Facing::back, false),
                                    std::pair(Facing::any, true), std::pair(Facing::back, true)}) {
    std::vector<Hit> found(most), scalar(most);
    std::vector<std::uint8_t> occluded(most, 7);
    TraceCounters counters;
    TraceBatch batch;
    batch.rays = rays.data(), batch.size = most, batch.counters = &counters, batch.facing = side;
    batch.scratch = scratch.data(), batch.skip = skips ? skip.data() : nullptr, batch.chosen = chosen;
    batch.hits = scalar.data(), scalar_queries.next(tree.view, batch);
    batch.hits = found.data(), mine.closest(tree.view, batch);
    batch.occluded = occluded.data(), mine.any(tree.view, batch);
    EXPECT_TRUE(same_bytes(found, scalar));
    for (std::size_t i = 0; i < most; ++i) EXPECT_EQ(occluded[i], scalar[i] ? 1 : 0) << "ray " << i;
    EXPECT_GT(std::ranges::count_if(found, [](const Hit& hit) { return bool(hit); }), 3);
    for (std::size_t i = 0; i < most; ++i) {
      EXPECT_TRUE(!skips || found[i].primitive != skip[i] || !found[i]);
      if (i % 4 != 0 && found[i]) skip[i] = found[i].primitive;
    }
    of_sides.push_back(std::move(found));
  }
  EXPECT_FALSE(same_bytes(of_sides[0], of_sides[1]));
  EXPECT_FALSE(same_bytes(of_sides[1], of_sides[3]));
}

// Single calls against the single rays of scalar.
void compare_chosen_calls(EveryRow& every, const ChosenCallRow& mine, const ChosenCallRow& of_scalar,
                          const TraversalRow& single_of_scalar) {
  if (!every.offers(mine.closest, of_scalar.closest) || !every.offers(mine.any, of_scalar.any) ||
      !every.offers(mine.nearer, of_scalar.nearer))
    return;
  constexpr std::uint32_t no_triangle = ~0u;
  const SmallTree tree;
  const auto* const blocks = static_cast<const LeafBlock<9>*>(tree.view.blocks);
  std::size_t found = 0;
  for (const Facing side : {Facing::any, Facing::front, Facing::back})
    for (const Ray& ray : some_rays())
      for (std::uint32_t skipped = no_primitive, turn = 0; turn < 3; ++turn) {
        Hit hit;
        TraceBatch batch;
        batch.rays = &ray, batch.size = 1, batch.hits = &hit, batch.facing = side, batch.skip = &skipped;
        single_of_scalar.closest(tree.view, batch);
        EXPECT_TRUE(same_bytes(hit, mine.closest(tree.view, ray, side, skipped)));
        EXPECT_TRUE(same_bytes(hit, of_scalar.closest(tree.view, ray, side, skipped)));
        EXPECT_EQ(mine.any(tree.view, ray, side, skipped), bool(hit));
        EXPECT_EQ(of_scalar.any(tree.view, ray, side, skipped), bool(hit));
        NearestSoFar best{hit.t, hit.t, no_triangle};
        if (hit)
          best.t_lo = best.tmax = std::nextafter(hit.t, infinity),
          mine.nearer(tree.view, ray, best, side, skipped);
        const std::uint32_t triangle = best.leaf_triangle;
        EXPECT_EQ(triangle == no_triangle ? no_primitive
                                          : blocks[triangle / tree_width].primitive[triangle % tree_width],
                  hit.primitive);
        found += hit ? 1 : 0, skipped = hit.primitive;
      }
  EXPECT_GT(found, 20u);
}

// The rays that came to each leaf: a ray that nothing stops is at all leaves that its box tests let through, at least
// at the leaves of its hits.
void compare_visits(EveryRow& every, const QueryKernels& mine, const QueryKernels& of_scalar,
                    std::size_t bytes, bool share_origin) {
  if (!every.offers(mine.visit, of_scalar.visit)) return;
  const SmallTree tree;
  std::vector<Ray> rays = some_rays();
  if (share_origin)
    for (Ray& ray : rays) ray.origin = {0.1f, -0.2f, 0.3f};
  std::vector<Hit> hits(most);
  TraceCounters counters;
  TraceBatch closest;
  closest.rays = rays.data(), closest.size = most, closest.hits = hits.data(), closest.counters = &counters;
  std::vector<Hit> before_all(most, Hit{-infinity, 0, 0, 0});
  closest.after = before_all.data();
  mine.next(tree.view, closest);
  struct Seen {
    std::vector<std::set<std::uint32_t>> of = std::vector<std::set<std::uint32_t>>(most);
  } seen;
  std::vector<float> tmax;
  for (const Ray& ray : rays) tmax.push_back(ray.tmax);
  std::vector<Line> scratch(bytes / sizeof(Line) + 1);
  VisitBatch batch;
  batch.rays = rays.data(), batch.size = most, batch.tmax = tmax.data(), batch.scratch = scratch.data();
  batch.counters = &counters, batch.context = &seen, batch.share_origin = share_origin;
  batch.visit = [](void* context, const VisitedLeaf& leaf) {
    for (std::size_t k = 0; k < leaf.count; ++k)
      EXPECT_TRUE(static_cast<Seen*>(context)->of[leaf.rays[k]].insert(leaf.first).second);
  };
  mine.visit(tree.view, batch);
  const auto* const blocks = static_cast<const LeafBlock<9>*>(tree.view.blocks);
  std::size_t found = 0;
  for (std::size_t i = 0; i < most; ++i) {
    if (!hits[i]) continue;
    const bool is_there = std::ranges::any_of(seen.of[i], [&](std::uint32_t block) {
      return std::ranges::count(blocks[block].primitive, hits[i].primitive) > 0;
    });
    EXPECT_TRUE(is_there) << "ray " << i;
    ++found;
  }
  EXPECT_GT(found, 3u);
}

TEST_P(EveryRow, of_rays_in_another_space) {
  const double map[12] = {0.1, -2, 3, 5, 7, 0.3, -1, 1e-3, 2, 4, 0.7, -9};
  const std::vector<Ray> rays = some_rays();
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < most; ++i) numbers.push_back(static_cast<std::uint32_t>(most) - 1 - i);
  for (const bool numbered : {false, true}) {
    const std::uint32_t* const some = numbered ? numbers.data() : nullptr;
    std::vector<Ray> mine(most), of_scalar(most);
    if (!offers(kernels_of(path()).queries.map_rays, kernels_of(scalar()).queries.map_rays)) return;
    kernels_of(path()).queries.map_rays(rays.data(), some, most, map, mine.data());
    kernels_of(scalar()).queries.map_rays(rays.data(), some, most, map, of_scalar.data());
    EXPECT_TRUE(same_bytes(mine, of_scalar));
  }
}

// Corners and points are numbers T: doubles are thirds of floats, moved by an offset.
template <class T>
void compare_boundaries(T offset, const auto& mine, const auto& of_scalar) {
  std::vector<CornersOf<T>> triangles;
  const auto number = [&](float x) { return std::is_same_v<T, float> ? T(x) : T(x) / 3 + offset; };
  const auto point = [&](const Float3& p) { return PointOf<T>{number(p[0]), number(p[1]), number(p[2])}; };
  for (const Triangle& triangle : some_triangles())
    triangles.push_back({{point(triangle.corner[0]), point(triangle.corner[1]), point(triangle.corner[2])}});
  const BoundaryTree tree(boundary_loops(triangles));
  std::vector<double> columns[3], found(most), scalar_terms(most);
  for (const Ray& ray : some_rays())
    for (std::size_t k = 0; k < 3; ++k) columns[k].push_back(static_cast<double>(point(ray.origin)[k]));
  BoundaryBatch batch;
  batch.size = most;
  for (std::size_t k = 0; k < 3; ++k) batch.points[k] = columns[k].data();
  for (batch.axis = 0; batch.axis < 3; ++batch.axis)
    for (const double accuracy : {0.0, 1e-4}) {
      batch.accuracy = accuracy, batch.sign = -batch.sign;
      batch.terms = found.data(), mine(tree.view(), batch);
      batch.terms = scalar_terms.data(), of_scalar(tree.view(), batch);
      EXPECT_TRUE(same_bytes(found, scalar_terms));
      EXPECT_GT(std::ranges::count_if(found, [](double term) { return std::abs(term) > 0.01; }), 3);
    }
}

TEST_P(EveryRow, of_boundaries) {
  const WindingKernels &mine = kernels_of(path()).winding, &of_scalar = kernels_of(scalar()).winding;
  if (!offers(mine.boundary_terms, of_scalar.boundary_terms) ||
      !offers(mine.boundary_terms_of_doubles, of_scalar.boundary_terms_of_doubles))
    return;
  compare_boundaries<float>(0, mine.boundary_terms, of_scalar.boundary_terms);
  compare_boundaries<double>(5e6, mine.boundary_terms_of_doubles, of_scalar.boundary_terms_of_doubles);
  expect_all_called(mine);
}

TEST_P(EveryRow, of_queries) {
  const AllQueryKernels &mine = kernels_of(path()).queries, &of_scalar = kernels_of(scalar()).queries;
  for (const auto kernels : {&AllQueryKernels::plain, &AllQueryKernels::counted}) {
    const QueryKernels &rows = mine.*kernels, &scalars = of_scalar.*kernels;
    const auto compare = [&]<class Entry>(ListKind kind, Entry) {
      compare_lists<Entry>(*this, rows.list, scalars.list, some_rays(), kind, ListStop::never);
      compare_lists<Entry>(*this, rows.list_together, scalars.list_together, some_rays(), kind,
                           ListStop::never, mine.plain.scratch_bytes);
    };
    compare(ListKind::hits, Hit());
    for (const ListKind kind : {ListKind::crossings, ListKind::sides}) compare(kind, ListEntryOf<float>());
    compare_counts(*this, rows.list, scalars.list);
    compare_counts(*this, rows.list_together, scalars.list_together, mine.plain.scratch_bytes);
    compare_lists<ListEntryOf<float>>(*this, rows.list_along_axes, scalars.list_along_axes, rays_along_axes(),
                                      ListKind::sides, ListStop::at_origin);
    compare_next(*this, rows, scalars);
    const TraversalKernels& traversal = kernels_of(path()).traversal;
    const std::size_t of_streams = traversal.scratch_bytes(TraversalMode::stream, most),
                      of_packets = traversal.scratch_bytes(TraversalMode::packet, most);
    compare_chosen(*this, rows.chosen_single, scalars.chosen_single, scalars, of_streams);
    compare_chosen(*this, rows.chosen_stream, scalars.chosen_stream, scalars, of_streams);
    if (kernels == &AllQueryKernels::plain) {
      const auto packets = [](const KernelTable& of) {
        return of.traversal.mode[static_cast<std::size_t>(TraversalMode::packet)]
            .row[static_cast<std::size_t>(TriangleTest::exact)][0];
      };
      compare_chosen(*this, packets(kernels_of(path())), packets(kernels_of(scalar())), scalars, of_packets,
                     &rows.chosen_call);
    }
    compare_chosen_calls(*this, rows.chosen_call, scalars.chosen_call, scalars.chosen_single);
    const SmallTree tree;
    compare_kept<float>(*this, rows.kept, scalars.kept, tree.view, some_rays(), NextOf{scalars, tree.view});
    compare_visits(*this, rows, scalars, of_streams, false);
    compare_visits(*this, rows, scalars, of_packets, true);
    offers(rows.scratch_bytes, scalars.scratch_bytes);  // asked for by list_together
  }
  expect_all_called(mine.plain), expect_all_called(mine.counted);
}

}  // namespace
}  // namespace raylanes::testing

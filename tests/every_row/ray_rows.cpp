// The rows of rays beyond the nearest hit, of floats and doubles by one text: sides and triangles that count, filters,
// lists, next hits; and visits of leaves.
#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../support/same_bytes.hpp"
#include "box_rows.hpp"

namespace raylanes::testing {
namespace {

template <class T>
constexpr const char* number_name = std::is_same_v<T, float> ? "floats " : "doubles ";

template <class T>
void expect_hits(const char* what, Rules rules, const Tracer<T>& trace, const std::string& way,
                 bool counts = false) {
  expect_recorded(number_name<T> + std::string(what), hash_of_hits(trace, rules, counts), way);
}

// --- A ray whose caller rejects the hits of every `divisor`-th primitive; 0: nobody is asked.
template <class T, class View>
Tracer<T> by_kept_row(const KeptRow<View, T>& row, const View& tree, const std::uint32_t& divisor) {
  const auto asked = [&divisor](const TraceBatchOf<T>& batch, std::size_t i) {
    const auto rejects = [](void* by, const HitOf<T>& hit) {
      return hit.primitive % *static_cast<const std::uint32_t*>(by) == 0;
    };
    return AskedOf<T>{divisor != 0 ? rejects : static_cast<decltype(AskedOf<T>::rejects)>(nullptr),
                      const_cast<std::uint32_t*>(&divisor), batch.facing, skipped_by(batch, i),
                      batch.after != nullptr ? batch.after + i : nullptr};
  };
  return by_calls<T>(
      [=](const auto& ray, const auto& batch, std::size_t i) {
        return row.closest(tree, ray, asked(batch, i));
      },
      [=](const auto& ray, const auto& batch, std::size_t i) { return row.any(tree, ray, asked(batch, i)); });
}
template <class T, class View>
void check_kept(EveryRow& every, const KeptRow<View, T>& row, const View& tree) {
  if (!every.offers(row.closest) || !every.offers(row.any)) return;
  Hash hash;
  for (const std::uint32_t divisor : {2u, 3u, 0u}) {
    const Tracer<T> trace = by_kept_row<T>(row, tree, divisor);
    if (divisor == 0)
      expect_hits<T>("behind", Rules::behind, trace, "kept");
    else
      hash.add_hash(hash_of_hits(trace, Rules::behind).value());
  }
  expect_recorded(number_name<T> + std::string("kept"), hash, "kept");
}

// Batches whose caller does the same.
struct RejectedByStreams {
  const QueryKernels& kernels;
  const TreeView& tree;
  std::uint32_t divisor;  // 0: no hit is rejected

  static void ask(void* self, const std::uint32_t*, const Hit* hits, std::uint8_t* rejected,
                  std::size_t count) {
    const std::uint32_t by = static_cast<const RejectedByStreams*>(self)->divisor;
    EXPECT_TRUE(count > 0 && count <= hits_of_list);
    for (std::size_t k = 0; k < count; ++k) rejected[k] = by != 0 && hits[k].primitive % by == 0 ? 1 : 0;
  }
  void operator()(const TraceBatch& batch) {
    KeptBatch nearest{batch, ask, this};
    const std::size_t bytes = kernels.ruled_stream.scratch_bytes(batch.size);
    Scratch scratch(Scratch::bytes_of<std::byte>(bytes));
    nearest.scratch = scratch.take<std::byte>(bytes);
    KeptBatch whether = nearest;
    nearest.occluded = nullptr, whether.hits = nullptr;
    kernels.kept_together(tree, nearest), kernels.kept_together(tree, whether);
  }
};
void check_kept_together(EveryRow& every, const QueryKernels& kernels, const TreeView& tree) {
  if (!every.offers(kernels.kept_together)) return;
  for (const std::uint32_t divisor : {2u, 3u, 0u}) {
    RejectedByStreams together{kernels, tree, divisor};
    const Tracer<float> trace = [&](const TraceBatch& batch) { together(batch); };
    if (divisor == 0)
      expect_hits<float>("chosen", Rules::chosen, trace, "kept together");
    else
      EXPECT_EQ(hash_of_hits(trace, Rules::chosen).value(),
                hash_of_hits(by_kept_row<float>(kernels.kept, tree, divisor), Rules::chosen).value())
          << divisor;
  }
}

// --- Lists, each ray's in the order of primitives.
template <class T>
using Lister = std::size_t (*)(const TreeViewOf<T>& tree, const ListBatchOf<T>& batch);
using Bytes = std::size_t (*)(std::size_t rays, std::size_t room);

template <class T>
void add_list(Hash& hash, Lister<T> lister, const TreeViewOf<T>& tree, const std::vector<RayOf<T>>& rays,
              ListBatchOf<T> batch, Bytes bytes) {
  std::vector<ListEntryOf<T>> list(rays.size() * most);
  std::vector<HitOf<T>> hits(list.size());
  std::vector<std::size_t> ends(rays.size());
  batch.rays = rays.data(), batch.size = rays.size();
  batch.list = list.data(), batch.hits = hits.data(), batch.room = list.size(), batch.end = ends.data();
  const std::size_t size = bytes != nullptr ? bytes(rays.size(), list.size()) : 0;
  Scratch scratch(Scratch::bytes_of<std::byte>(size));
  batch.scratch = scratch.take<std::byte>(size);
  EXPECT_EQ(lister(tree, batch), rays.size());
  for (std::size_t i = 0, at = 0; i < rays.size(); at = ends[i++]) {
    hash.add(static_cast<std::uint32_t>(ends[i]));
    const auto in_order = [&](auto& items) {
      const auto some = std::span(items).subspan(at, ends[i] - at);
      std::ranges::sort(some, {}, [](const auto& item) { return item.primitive; });
      return some;
    };
    if (batch.kind == ListKind::hits)
      for (const HitOf<T>& hit : in_order(hits)) hash.add(hit);
    else
      for (const ListEntryOf<T>& entry : in_order(list)) {
        hash.add(entry.t), hash.add(entry.primitive), hash.add(static_cast<std::uint32_t>(entry.side));
        hash.add(primitive_of(tree, entry.leaf_triangle));
      }
  }
}

template <class T>
void check_lists(EveryRow& every, Lister<T> lister, const TreeViewOf<T>& tree, const std::string& way,
                 Bytes bytes = nullptr, bool counts = false) {
  if (!every.offers(lister)) return;
  Hash all, stopped;
  TraceCounters counters;
  const std::vector<RayOf<T>> rays = some_rays<T>();
  for (const ListKind kind : {ListKind::hits, ListKind::crossings, ListKind::sides})
    for (const Facing facing : {Facing::any, Facing::front, Facing::back})
      for (const ListStop stop : {ListStop::never, ListStop::at_origin, ListStop::undecided}) {
        if (stop != ListStop::never && (bytes != nullptr || kind == ListKind::hits)) continue;
        ListBatchOf<T> batch;
        batch.kind = kind, batch.facing = facing, batch.stop = stop, batch.counters = &counters;
        add_list<T>(stop == ListStop::never ? all : stopped, lister, tree, rays, batch, bytes);
      }
  EXPECT_EQ(counters.triangle_tests > 0, counts);
  expect_recorded(number_name<T> + std::string("lists"), all, way);
  if (bytes == nullptr) expect_recorded(number_name<T> + std::string("lists that stop"), stopped, way);
}

// Counts with the least room, which lists of some rays outgrow.
void check_counts(EveryRow& every, Lister<float> lister, const std::string& way, Bytes bytes = nullptr) {
  if (!every.offers(lister)) return;
  const std::vector<Ray> rays = some_rays<float>();
  constexpr std::size_t room = 16;
  std::vector<ListEntryOf<float>> list(room);
  std::vector<CrossingCount> counts(rays.size());
  TraceCounters counters;
  const std::size_t size = bytes != nullptr ? bytes(rays.size(), room) : 0;
  Scratch scratch(Scratch::bytes_of<std::byte>(size));
  ListBatch batch;
  batch.rays = rays.data(), batch.size = rays.size(), batch.kind = ListKind::sides;
  batch.list = list.data(), batch.room = room, batch.counts = counts.data(), batch.counters = &counters;
  batch.scratch = scratch.take<std::byte>(size);
  EXPECT_EQ(lister(small_view<float>(), batch), rays.size());
  Hash hash;
  for (const CrossingCount& count : counts)
    hash.add(count.crossings), hash.add(static_cast<std::uint32_t>(count.winding));
  expect_recorded("floats counts", hash, way);
}

void check_lists_along_axes(EveryRow& every, Lister<float> lister, const std::string& way) {
  if (!every.offers(lister)) return;
  std::vector<Ray> rays = some_rays<float>();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (float& x : rays[i].origin) x *= 0.4f;
    rays[i] = {rays[i].origin, 0, {}, infinity};
    rays[i].direction[i % 3] = i % 2 == 0 ? 1.0f : -1.0f;
  }
  Hash hash;
  TraceCounters counters;
  ListBatch batch;
  batch.kind = ListKind::sides, batch.stop = ListStop::at_origin, batch.counters = &counters;
  add_list<float>(hash, lister, small_view<float>(), rays, batch, nullptr);
  expect_recorded("floats lists along axes", hash, way);
}

// A ray in a call of its own; and the triangle of its hit, found again from its t on.
Tracer<float> by_chosen_calls(const RuledCallRow& row, const TreeView& tree) {
  return by_calls<float>(
      [&row, tree](const Ray& ray, const TraceBatch& batch, std::size_t i) {
        const Hit hit = row.closest(tree, ray, batch.facing, skipped_by(batch, i));
        if (hit) {
          const float behind = std::nextafter(hit.t, infinity);
          NearestSoFar best{behind, behind, no_leaf_triangle};
          row.nearer(tree, ray, best, batch.facing, skipped_by(batch, i));
          EXPECT_EQ(primitive_of(tree, best.leaf_triangle), hit.primitive);
        }
        return hit;
      },
      [&row, tree](const Ray& ray, const TraceBatch& batch, std::size_t i) {
        return row.any(tree, ray, batch.facing, skipped_by(batch, i));
      });
}

void check_queries(EveryRow& every, const QueryKernels& kernels, const TraversalKernels& traversal,
                   bool counts) {
  const TreeView tree = small_view<float>();
  const std::string way = counts ? "counted " : "";
  for (const auto& [name, row] :
       {std::pair("single", &kernels.ruled_single), std::pair("stream", &kernels.ruled_stream)}) {
    every.offers(row->any), every.offers(row->scratch_bytes);
    if (every.offers(row->closest))
      expect_hits<float>("chosen", Rules::chosen, by_batches(tree, *row), way + name, counts);
  }
  if (every.offers(kernels.ruled_call.closest) && every.offers(kernels.ruled_call.any) &&
      every.offers(kernels.ruled_call.nearer)) {
    expect_hits<float>("chosen", Rules::chosen, by_chosen_calls(kernels.ruled_call, tree), "calls");
    const TraversalRow& packets = traversal.mode[static_cast<std::size_t>(TraversalMode::packet)]
                                      .row[static_cast<std::size_t>(TriangleTest::exact)][0];
    expect_hits<float>(
        "chosen", Rules::chosen,
        [&](TraceBatch batch) {
          batch.by_rule = &kernels.ruled_call;
          by_batches(tree, packets)(batch);
        },
        "packets");
  }
  check_kept<float>(every, kernels.kept, tree);
  check_kept_together(every, kernels, tree);
  if (every.offers(kernels.closest_after))
    expect_hits<float>("behind", Rules::behind, by_batches<float>(tree, kernels.closest_after, nullptr),
                       way + "next", counts);
  every.offers(kernels.scratch_bytes);  // asked for by list_together
  check_lists<float>(every, kernels.list, tree, way + "list", nullptr, counts);
  check_lists<float>(every, kernels.list_together, tree, way + "list_together", kernels.scratch_bytes,
                     counts);
  check_counts(every, kernels.list, way + "list");
  check_counts(every, kernels.list_together, way + "list_together", kernels.scratch_bytes);
  check_lists_along_axes(every, kernels.list, way + "list");
  check_lists_along_axes(every, kernels.list_along_axes, way + "list_along_axes");
  check_visits(every, kernels, traversal.scratch_bytes(TraversalMode::stream, most), false);
  check_visits(every, kernels, traversal.scratch_bytes(TraversalMode::packet, most), true);
  check_visits_of_rays(every, kernels);
  check_spheres(every, kernels);
}

TEST_P(EveryRow, of_queries) {
  const AllQueryKernels &mine = kernels().queries, &of_scalar = scalar().queries;
  for (const auto rows : {&AllQueryKernels::plain, &AllQueryKernels::counted}) {
    check_queries(*this, mine.*rows, kernels().traversal, rows == &AllQueryKernels::counted);
    expect_all_called(mine.*rows, of_scalar.*rows);
  }
}

TEST_P(EveryRow, of_doubles) {
  const DoubleRayKernels& rows = kernels().doubles;
  const DoubleTreeView tree = small_view<double>();
  if (offers(rows.closest) && offers(rows.any))
    for (const bool in_flight : {false, true}) {
      const DoubleTreeView view = small_view<double>(in_flight);
      const std::string way = in_flight ? "in flight" : "single";
      expect_hits<double>("nearest", Rules::none, by_batches<double>(view, rows.closest, rows.any), way);
      expect_hits<double>("chosen", Rules::chosen, by_batches<double>(view, rows.closest, rows.any), way);
      expect_hits<double>("behind", Rules::behind, by_batches<double>(view, rows.closest, nullptr), way);
    }
  if (offers(rows.closest_stream) && offers(rows.any_stream) && offers(rows.stream_bytes))
    expect_hits<double>("chosen", Rules::chosen,
                        by_batches<double>(tree, rows.closest_stream, rows.any_stream, rows.stream_bytes),
                        "stream");
  if (offers(rows.packet) && offers(rows.packet_bytes)) {
    const Tracer<double> trace = by_batches<double>(tree, rows.packet, rows.packet, rows.packet_bytes);
    expect_hits<double>("nearest", Rules::none, trace, "packet");
  }
  if (offers(rows.closest_of_ray) && offers(rows.any_of_ray) && offers(rows.nearest_triangle))
    expect_hits<double>(
        "chosen", Rules::chosen,
        by_calls<double>(
            [&](const RayD& ray, const auto& batch, std::size_t i) {
              const HitD hit = rows.closest_of_ray(tree, ray, batch.facing, skipped_by(batch, i));
              EXPECT_TRUE(batch.facing != Facing::any || batch.skip != nullptr ||
                          primitive_of(tree, rows.nearest_triangle(tree, ray)) == hit.primitive);
              return hit;
            },
            [&](const RayD& ray, const auto& batch, std::size_t i) {
              return rows.any_of_ray(tree, ray, batch.facing, skipped_by(batch, i));
            }),
        "calls");
  check_kept<double>(*this, rows.kept, tree);
  check_lists<double>(*this, rows.list, tree, "list");
  offers(rows.closest_of_point), offers(rows.closest_in_tree);  // of_points calls them
  expect_all_called(rows, scalar().doubles);
}

// As Calls.in_flight_keep_what_waits_in_deep_trees of floats: triangles around an axis, each thinner than the last and
// longer, so that a ray along the axis has many boxes waiting.
TEST_P(EveryRow, of_doubles_in_flight_keep_what_waits) {
  const DoubleRayKernels& rows = kernels().doubles;
  if (!offers(rows.closest) || !offers(rows.any)) return;
  std::vector<Double3> vertices;
  std::vector<Index3> triangles;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const double s = std::pow(0.98, i);
    vertices.insert(vertices.end(), {{s, -s, -0.001 * i}, {-s, s, -0.001 * i}, {-0.9 * s, -0.9 * s, 1}});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const BvhDArrays tree = build_bvh_d(vertices, triangles, {.builder = TreeBuilder::sweep_sah});
  Source random(85);
  std::vector<RayD> rays;
  for (int i = 0; i < 300; ++i) {
    const double s = std::pow(10, i % 4 == 0 ? random.number(-35, 0) : random.number(-7, -5));
    rays.push_back({{random.number(-1, 1) * s, random.number(-1, 1) * s, -10}, 0, {0, 0, 1}, 100});
  }
  Hash hash[2];
  for (const bool in_flight : {false, true}) {
    DoubleTreeView view = tree.view();
    view.tree.rays_wait = in_flight;
    std::vector<HitD> hits(rays.size());
    add_hits(hash[in_flight], by_batches<double>(view, rows.closest, rows.any), {}, rays, hits);
  }
  EXPECT_EQ(hash[0].value(), hash[1].value());
}

}  // namespace
}  // namespace raylanes::testing

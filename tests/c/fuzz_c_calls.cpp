// The C interface with any arguments: rays and meshes of any bits, null pointers, strides and sizes that are too small
// or too large, options of any values and sizes, damaged files. Right arguments give the bytes of the classes; wrong
// ones are refused, and nothing is written.
#include <raylanes/roots.hpp>

#include "../../dispatch/table/numbers.hpp"
#include "../support/same_bytes.hpp"
#include "any_arguments.hpp"
#include "calls.hpp"

namespace raylanes::testing {
namespace {

template <class Number>
class Caller {
  using C = CallsOf<Number>;
  using Hit = HitOf<Number>;

 public:
  explicit Caller(Bytes& bytes)
      : bytes_(bytes), world_(bytes), tree_(world_.mesh.vertices, world_.mesh.triangles), arguments_(bytes) {
    of_c_ = made<TreeOfC<Number>>([&](auto** tree) {
      C::create(tree, world_.mesh.vertices.data(), world_.mesh.vertices.size(), 0,
                world_.mesh.triangles.data(), world_.mesh.triangles.size(), 0, nullptr);
    });
    if (of_c_ == nullptr) fail(raylanes_last_message());
    rays_.take(world_.rays.size(), bytes_.below(max_gap));
    rays_.put(world_.rays);
  }

  void ask() {
    const auto* const tree = arguments_.pointer(of_c_.get());
    const std::size_t n = arguments_.count(world_.rays.size());
    const void* const rays = arguments_.first(rays_);
    const std::size_t kind = bytes_.below(15);
    const std::size_t stride = arguments_.stride(rays_, kind < 8     ? sizeof(RayOf<Number>)
                                                        : kind == 12 ? sizeof(std::uint32_t)
                                                                     : 3 * sizeof(Number));
    if (kind < 8)
      ask_rays(kind, tree, rays, n, stride);
    else if (kind == 12)
      ask_corners(tree, rays, n, stride);
    else if (kind > 12)
      ask_shadows(kind == 13, tree, rays, n, stride);
    else
      ask_points(kind, tree, rays, n, stride);
    rays_.expect_intact("rays");
  }

  void build() {
    const auto& vertices = world_.mesh.vertices;
    const auto& triangles = world_.mesh.triangles;
    const raylanes_build_options* const c = arguments_.build_options();
    const std::size_t count = arguments_.count(vertices.size());
    const std::size_t vertex_stride = arguments_.stride(0, 3 * sizeof(Number));
    const std::size_t triangle_stride = arguments_.stride(0, sizeof(Index3));
    bool is_right = arguments_.are_right();
    const auto other = made<TreeOfC<Number>>([&](auto** tree) {
      const raylanes_status status = C::create(tree, vertices.data(), count, vertex_stride, triangles.data(),
                                               triangles.size(), triangle_stride, c);
      try {
        if (is_right) typename C::Tree(vertices, triangles, arguments_.build_options_of_cpp());
      } catch (const std::invalid_argument&) {
        is_right = false;
      }
      arguments_.expect("create", status, is_right);
      if ((*tree != nullptr) != is_right) fail("a tree that was not made, or was");
    });
    const raylanes_status status =
        C::refit(other.get(), vertices.data(), vertices.size(), 0, triangles.data(), triangles.size(), 0,
                 static_cast<std::int32_t>(bytes_.below(3)));
    arguments_.expect("refit", status, is_right);
  }

  void save_and_load() {
    std::ostringstream saved;
    tree_.save(saved);
    std::string file = saved.str();
    static Fence fence(std::size_t{1} << 21);
    const std::size_t capacity = bytes_.chance(128) ? file.size() : bytes_.below(65536);
    unsigned char* const buffer = fence.last<unsigned char>(capacity);
    std::size_t size = 0;
    const raylanes_status status = C::save(of_c_.get(), buffer, capacity, &size);
    fence.expect_intact("a saved tree");
    if (size != file.size() || status != (size <= capacity ? RAYLANES_OK : RAYLANES_SMALL_BUFFER))
      fail("the size of a saved tree");
    if (status == RAYLANES_OK && std::memcmp(buffer, file.data(), size) != 0)
      fail("the bytes of a saved tree");
    for (std::size_t left = bytes_.below(4); left > 0; --left) damage(bytes_, file);
    if (bytes_.chance(200)) put_right_checksum(file);
    load(file);
  }

 private:
  void ask_rays(std::size_t kind, const auto* tree, const void* rays, std::size_t n, std::size_t stride) {
    using After = AfterRecords<Hit>;  // hits of any bits: the first ones of rays
    const After after =
        kind < 5 ? After(world_.rays.data(), world_.rays.size(), sizeof(RayOf<Number>)) : After();
    const raylanes_ray_options* const c = arguments_.ray_options(world_.rays.size(), after);
    const auto trace = arguments_.template ray_options_of_cpp<typename C::Trace>(world_.rays.size());
    const auto list = arguments_.template ray_options_of_cpp<ListOptions>(world_.rays.size());
    const std::size_t gap = bytes_.below(max_gap);
    switch (kind) {
      case 0:
      case 1:
        return compare<Hit>(
            "closest", gap,
            [&](void* hits, std::size_t apart) { return C::closest(tree, rays, n, stride, hits, apart, c); },
            [&](auto& hits) { tree_.closest(world_.rays, hits, trace); });
      case 2:
        return compare<Hit>(
            "closest_crossing", gap,
            [&](void* hits, std::size_t apart) {
              return C::closest_crossing(tree, rays, n, stride, hits, apart, c);
            },
            [&](auto& hits) { tree_.closest_crossing(world_.rays, hits, trace); });
      case 3:
      case 4:
        return compare<std::uint8_t>(
            "occluded", 0,
            [&](void* bits, std::size_t) {
              return C::occluded(tree, rays, n, stride, static_cast<std::uint8_t*>(bits), c);
            },
            [&](auto& bits) { tree_.occluded(world_.rays, bits, trace); });
      case 5:
        return compare_lists(
            "all_hits", [&](raylanes_lists** lists) { return C::all_hits(tree, rays, n, stride, lists, c); },
            [&] { return tree_.all_hits(world_.rays, list); });
      case 6:
        return compare<CrossingCount>(
            "count_crossings", 0,
            [&](void* counts, std::size_t) {
              return C::count_crossings(tree, rays, n, stride, static_cast<raylanes_crossing_count*>(counts),
                                        c);
            },
            [&](auto& counts) { tree_.count_crossings(world_.rays, counts, list); });
      default:
        compare_lists(
            "crossings",
            [&](raylanes_lists** lists) { return C::crossings(tree, rays, n, stride, lists, c); },
            [&] { return tree_.crossings(world_.rays, list); });
    }
  }

  // The shadows of a light or of a sun, at the origins of rays.
  void ask_shadows(bool is_of_light, const auto* tree, const void* rays, std::size_t n, std::size_t stride) {
    const VertexRecords<Number> points(world_.rays.data(), world_.rays.size(), sizeof(RayOf<Number>));
    PointOf<Number> light;
    for (Number& number : light) number = bytes_.number<Number>();
    if (!world_.rays.empty() && bytes_.chance(192))
      light = is_of_light ? world_.rays[0].origin : world_.rays[0].direction;
    SegmentEndsOf<Number> ends;
    if (bytes_.chance(128)) ends = {bytes_.number<Number>(), bytes_.number<Number>()};
    static Fence fence(sizeof light);
    Number* const given = fence.last<Number>(3);
    std::copy(light.begin(), light.end(), given);
    const Number* const from = arguments_.pointer(given);
    const raylanes_ray_options* const c = arguments_.ray_options(world_.rays.size(), AfterRecords<Hit>());
    const auto trace = arguments_.template ray_options_of_cpp<typename C::Trace>(world_.rays.size());
    compare<std::uint8_t>(
        is_of_light ? "occluded_from" : "occluded_towards", 0,
        [&](void* bits, std::size_t) {
          auto* const dark = static_cast<std::uint8_t*>(bits);
          return is_of_light ? C::occluded_from(tree, from, rays, n, stride, ends.start, ends.end, dark, c)
                             : C::occluded_towards(tree, from, rays, n, stride, dark, c);
        },
        [&](auto& dark) {
          is_of_light ? tree_.occluded_from(light, points, dark, ends, trace)
                      : tree_.occluded_towards(light, points, dark, trace);
        });
  }

  void ask_points(std::size_t kind, const auto* tree, const void* rays, std::size_t n, std::size_t stride) {
    const VertexRecords<Number> points(world_.rays.data(), world_.rays.size(), sizeof(RayOf<Number>));
    const raylanes_point_options* const c = arguments_.point_options(kind == 8 || kind == 9, kind == 10);
    switch (kind) {
      case 8:
        return compare<Location>(
            "locate", 0,
            [&](void* locations, std::size_t) {
              return C::locate(tree, rays, n, stride, static_cast<std::uint8_t*>(locations), c);
            },
            [&](auto& locations) {
              tree_.locate(points, locations, arguments_.template point_options_of_cpp<LocateOptions>());
            });
      case 9:
        return compare<Number>(
            "signed_distances", 0,
            [&](void* distances, std::size_t) {
              return C::signed_distances(tree, rays, n, stride, static_cast<Number*>(distances), c);
            },
            [&](auto& distances) {
              tree_.signed_distances(points, distances,
                                     arguments_.template point_options_of_cpp<typename C::Distances>());
            });
      case 10:
        return compare<Number>(
            "winding_numbers", 0,
            [&](void* numbers, std::size_t) {
              return C::winding_numbers(tree, rays, n, stride, static_cast<Number*>(numbers), c);
            },
            [&](auto& numbers) {
              tree_.winding_numbers(points, numbers,
                                    arguments_.template point_options_of_cpp<WindingOptions>());
            });
      default:
        compare<ClosestPointOf<Number>>(
            "closest_points", 0,
            [&](void* closest, std::size_t) {
              return C::closest_points(tree, rays, n, stride,
                                       static_cast<typename C::CClosestPoint*>(closest), c);
            },
            [&](auto& closest) {
              tree_.closest_points(points, closest,
                                   arguments_.template point_options_of_cpp<typename C::Closest>());
            });
    }
  }

  // The first words of rays are primitives, of which the tree has few.
  void ask_corners(const auto* tree, const void* rays, std::size_t n, std::size_t stride) {
    compare<typename C::Corners>(
        "corners", 0,
        [&](void* corners, std::size_t) {
          return C::corners(tree, rays, n, stride, static_cast<Number*>(corners));
        },
        [&](auto& corners) {
          tree_.corners({world_.rays.data(), world_.rays.size(), sizeof(RayOf<Number>)}, corners);
        });
  }

  template <class Result, class OfC, class OfCpp>
  void compare(const char* what, std::size_t gap, const OfC& of_c, const OfCpp& of_cpp) {
    static Strided<Result, max_elements> results;
    results.take(world_.rays.size(), gap);
    std::vector<Result> expected = results.get();
    void* const first = arguments_.first(results);
    const std::size_t stride = gap == 0 ? 0 : arguments_.stride(results, sizeof(Result));
    const raylanes_status status = of_c(first, stride);
    arguments_.expect(what, status, arguments_.are_right());
    if (arguments_.are_right()) of_cpp(expected);
    if (!same_bytes(results.get(), expected)) fail(std::string(what) + ": other bytes than the class has");
    results.expect_intact(what);
  }

  template <class OfC, class OfCpp>
  void compare_lists(const char* what, const OfC& of_c, const OfCpp& of_cpp) {
    const bool is_right = arguments_.are_right();
    raylanes_lists* made_by_c = nullptr;
    const raylanes_status status = of_c(&made_by_c);
    const ListsOfC lists(made_by_c);
    arguments_.expect(what, status, is_right);
    if ((lists != nullptr) != is_right) fail(std::string(what) + ": lists that were not made, or were");
    if (!is_right) return;
    const auto expected = of_cpp();
    const std::size_t* const offsets = raylanes_lists_offsets(lists.get());
    if (!std::equal(expected.offsets.begin(), expected.offsets.end(), offsets) ||
        (!expected.items.empty() && std::memcmp(raylanes_lists_items(lists.get()), expected.items.data(),
                                                expected.items.size() * sizeof expected.items[0]) != 0))
      fail(std::string(what) + ": other lists than the class has");
  }

  void load(const std::string& file) {
    raylanes_status expected = RAYLANES_OK;
    std::vector<Hit> hits(world_.rays.size()), hits_of_c(hits);
    try {
      std::istringstream stream(file);
      C::Tree::load(stream).closest(world_.rays, hits);
    } catch (const std::runtime_error&) {
      expected = RAYLANES_BAD_FILE;
    }
    const auto loaded = made<TreeOfC<Number>>([&](auto** tree) {
      const raylanes_status status = C::load(tree, file.data(), file.size());
      if (status != expected) fail("load: " + std::string(raylanes_last_message()));
    });
    if (loaded == nullptr) return;
    C::closest(loaded.get(), world_.rays.data(), hits.size(), 0, hits_of_c.data(), 0, nullptr);
    if (!same_bytes(hits, hits_of_c)) fail("load: other hits than the class has");
  }

  Bytes& bytes_;
  World<Number> world_;
  typename C::Tree tree_;
  TreeOfC<Number> of_c_;
  AnyArguments arguments_;
  static inline Strided<RayOf<Number>, max_elements> rays_;
};

template <class T>
void ask_roots(Bytes& bytes, auto of_c, auto of_cpp) {
  static Strided<T, max_elements> x, y;
  AnyArguments arguments(bytes);
  x.take(bytes.below(max_elements + 1), 0), y.take(x.count, 0);
  std::vector<T> values(x.count), expected = y.get();
  for (T& value : values) value = bytes.number<T>();
  x.put(values);
  const auto accuracy = static_cast<std::int32_t>(bytes.below(10)) - 1;
  const char* const path = arguments.path();
  const std::size_t n = arguments.count(x.count);
  const void* const from = arguments.first(x);
  void* const to = arguments.first(y);
  bool is_right = arguments.are_right() && accuracy >= 0 && accuracy < 8;
  const raylanes_status status = of_c(static_cast<const T*>(from), static_cast<T*>(to), n, accuracy, path);
  try {
    if (is_right)
      of_cpp(std::span<const T>(values), std::span<T>(expected), static_cast<Accuracy>(accuracy),
             path == nullptr ? nullptr : &find_path(path));
  } catch (const std::invalid_argument&) {
    is_right = false;
  }
  arguments.expect("roots", status, is_right);
  if (!same_bytes(y.get(), expected)) fail("roots: other bytes than the function has");
  x.expect_intact("numbers"), y.expect_intact("roots");
}

template <class Number>
void ask_tree(Bytes& bytes) {
  Caller<Number> caller(bytes);
  const std::size_t kind = bytes.below(8);
  kind == 0 ? caller.build() : kind == 1 ? caller.save_and_load() : caller.ask();
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_c_calls(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  const auto root = [](auto... arguments) { raylanes::sqrt(arguments...); };
  const auto reciprocal_root = [](auto... arguments) { raylanes::rsqrt(arguments...); };
  const auto reciprocal = [](auto... arguments) { raylanes::reciprocal(arguments...); };
  const std::size_t kind = bytes.below(14);
  kind == 0           ? ask_roots<float>(bytes, raylanes_sqrt, root)
  : kind == 1         ? ask_roots<double>(bytes, raylanes_sqrtd, root)
  : kind == 2         ? ask_roots<float>(bytes, raylanes_rsqrt, reciprocal_root)
  : kind == 3         ? ask_roots<double>(bytes, raylanes_rsqrtd, reciprocal_root)
  : kind == 4         ? ask_roots<float>(bytes, raylanes_reciprocal, reciprocal)
  : kind == 5         ? ask_roots<double>(bytes, raylanes_reciprocald, reciprocal)
  : bytes.chance(128) ? ask_tree<float>(bytes)
                      : ask_tree<double>(bytes);
  return 0;
}

// The C interface with any arguments: rays and meshes of any bits, null pointers, strides and sizes that are too small
// or too large, options of any values and sizes, damaged files. Right arguments give the bytes of the classes; wrong
// ones are refused, and nothing is written.
#include <raylanes/numbers.hpp>
#include <raylanes/roots.hpp>

#include "../support/same_bytes.hpp"
#include "any_arguments.hpp"
#include "queries.hpp"

namespace raylanes::testing {
namespace {

template <class Kind>
class Caller {
  using C = CallsOf<Kind>;
  using Number = typename C::Number;
  using Queries = QueriesOf<Kind>;
  using Hit = HitOfKind<Kind>;
  static constexpr bool is_tree = std::is_arithmetic_v<Kind>;
  template <class Query>
  using OptionsOf = typename std::decay_t<Query>::Options;

 public:
  explicit Caller(Bytes& bytes)
      : bytes_(bytes), world_(bytes), tree_(world_.tree()), of_c_(world_.tree_of_c()), arguments_(bytes) {
    if (of_c_ == nullptr) fail(raylanes_last_message());
    rays_.take(world_.rays.size(), bytes_.below(max_gap));
    rays_.put(world_.rays);
  }

  void ask() {
    const std::size_t group = bytes_.below(is_tree ? 10 : 9);
    const auto* const tree = arguments_.pointer(of_c_.get());
    const std::size_t n = arguments_.count(world_.rays.size());
    const void* const from = arguments_.first(rays_);
    const std::size_t stride = arguments_.stride(rays_, group < 6    ? sizeof(RayOf<Number>)
                                                        : group == 9 ? sizeof(std::uint32_t)
                                                                     : 3 * sizeof(Number));
    if (group < 4)
      some_query(Queries::of_rays(), bytes_.below(4), [&](const auto& query) {
        ask_array(query, ray_options<OptionsOf<decltype(query)>>(query.takes_filter), world_.rays, tree, from,
                  n, stride);
      });
    else if (group < 6)
      some_query(Queries::of_lists(), bytes_.below(std::tuple_size_v<decltype(Queries::of_lists())>),
                 [&](const auto& query) { ask_lists(query, tree, from, n, stride); });
    else if (group == 6)
      ask_shadows(bytes_.chance(128), tree, from, n, stride);
    else if (group < 9)
      some_query(Queries::of_points(), bytes_.below(4), [&](const auto& query) {
        ask_array(query, point_options<OptionsOf<decltype(query)>>(), points(), tree, from, n, stride);
      });
    else if constexpr (is_tree)
      ask_corners(tree, from, n, stride);
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
    const auto other = made<TreeOfC<Kind>>([&](auto** tree) {
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
    if (bytes_.chance(200)) put_right_checksums(file);
    load(file);
  }

 private:
  // The options of a call by C, and as the class takes them.
  template <class OfC, class OfCpp>
  struct BothOptions {
    const OfC* c;
    OfCpp cpp;
  };
  template <class Options>
  auto ray_options(bool takes_filter) {
    // Hits of any bits: the first ones of rays.
    HitRecords<Hit> after;
    if constexpr (requires(Options options) { options.after; })
      after = {world_.rays.data(), world_.rays.size(), sizeof(RayOf<Number>)};
    const std::size_t n = world_.rays.size();
    const raylanes_ray_options* const c = arguments_.ray_options(n, after, takes_filter);
    return BothOptions<raylanes_ray_options, Options>{
        c, arguments_.template ray_options_of_cpp<Options, Hit>(n)};
  }
  template <class Options>
  auto point_options() {
    const raylanes_point_options* const c = arguments_.template point_options<Options>();
    return BothOptions<raylanes_point_options, Options>{c,
                                                        arguments_.template point_options_of_cpp<Options>()};
  }
  VertexRecords<Number> points() const {
    return {world_.rays.data(), world_.rays.size(), sizeof(RayOf<Number>)};
  }

  void ask_array(const auto& query, const auto& by, const auto& elements, const auto* tree, const void* from,
                 std::size_t n, std::size_t stride) {
    compare<typename std::decay_t<decltype(query)>::Result>(
        query.name, query.has_stride ? bytes_.below(max_gap) : 0,
        [&](void* to, std::size_t apart) { return query.of_c(tree, from, n, stride, to, apart, by.c); },
        [&](auto& to) {
          if constexpr (std::decay_t<decltype(query)>::takes_filter)
            if (arguments_.has_filter())
              return query.of_cpp(tree_, elements, to, HitFilterOf<Hit>(reject_in_cpp<Hit>), by.cpp);
          query.of_cpp(tree_, elements, to, by.cpp);
        });
  }

  // The shadows of a light or of a sun, at the origins of rays.
  void ask_shadows(bool is_of_light, const auto* tree, const void* rays, std::size_t n, std::size_t stride) {
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
    const auto by = ray_options<typename C::Trace>(true);
    compare<std::uint8_t>(
        is_of_light ? "occluded_from" : "occluded_towards", 0,
        [&](void* bits, std::size_t) {
          auto* const dark = static_cast<std::uint8_t*>(bits);
          return is_of_light ? C::occluded_from(tree, from, rays, n, stride, ends.start, ends.end, dark, by.c)
                             : C::occluded_towards(tree, from, rays, n, stride, dark, by.c);
        },
        [&](auto& dark) {
          const HitFilterOf<Hit> filter = arguments_.has_filter() ? reject_in_cpp<Hit> : HitFilterOf<Hit>();
          is_of_light ? tree_.occluded_from(light, points(), dark, filter, ends, by.cpp)
                      : tree_.occluded_towards(light, points(), dark, filter, by.cpp);
        });
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

  void ask_lists(const auto& query, const auto* tree, const void* from, std::size_t n, std::size_t stride) {
    const auto by = ray_options<ListOptions>(false);
    bool is_right = arguments_.are_right();
    std::invoke_result_t<decltype(query.of_cpp), const decltype(tree_)&, decltype(world_.rays)&,
                         const ListOptions&>
        expected;
    try {
      if (is_right) expected = query.of_cpp(tree_, world_.rays, by.cpp);
    } catch (const std::invalid_argument&) {  // sides of stretches
      is_right = false;
    }
    raylanes_lists* made_by_c = nullptr;
    const raylanes_status status = query.of_c(tree, from, n, stride, &made_by_c, by.c);
    const ListsOfC lists(made_by_c);
    arguments_.expect(query.name, status, is_right);
    if ((lists != nullptr) != is_right) fail(std::string(query.name) + ": lists that were not made, or were");
    if (!is_right) return;
    using Item = typename decltype(expected.items)::value_type;
    const std::size_t* const offsets = raylanes_lists_offsets(lists.get());
    const auto* const items = static_cast<const Item*>(raylanes_lists_items(lists.get()));
    const auto is_same = [](const Item& a, const Item& b) {
      if constexpr (requires { a == b; })
        return a == b;
      else
        return same_bytes(a, b);
    };
    if (!std::equal(expected.offsets.begin(), expected.offsets.end(), offsets) ||
        !std::equal(expected.items.begin(), expected.items.end(), items, is_same))
      fail(std::string(query.name) + ": other lists than the class has");
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
    const auto loaded = made<TreeOfC<Kind>>([&](auto** tree) {
      const raylanes_status status = C::load(tree, file.data(), file.size());
      if (status != expected) fail("load: " + std::string(raylanes_last_message()));
    });
    if (loaded == nullptr) return;
    C::closest(loaded.get(), world_.rays.data(), hits.size(), 0, hits_of_c.data(), 0, nullptr);
    if (!same_bytes(hits, hits_of_c)) fail("load: other hits than the class has");
  }

  Bytes& bytes_;
  World<Kind> world_;
  typename C::Tree tree_;
  TreeOfC<Kind> of_c_;
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

template <class Kind>
void ask_tree(Bytes& bytes) {
  Caller<Kind> caller(bytes);
  const std::size_t kind = bytes.below(8);
  if (kind == 1) return caller.save_and_load();
  if constexpr (std::is_arithmetic_v<Kind>)
    if (kind == 0) return caller.build();
  caller.ask();
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_c_calls(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  const auto root = [](auto... arguments) { raylanes::sqrt(arguments...); };
  const auto reciprocal_root = [](auto... arguments) { raylanes::rsqrt(arguments...); };
  const auto reciprocal = [](auto... arguments) { raylanes::reciprocal(arguments...); };
  const std::size_t kind = bytes.below(20);
  kind == 0           ? ask_roots<float>(bytes, raylanes_sqrt, root)
  : kind == 1         ? ask_roots<double>(bytes, raylanes_sqrtd, root)
  : kind == 2         ? ask_roots<float>(bytes, raylanes_rsqrt, reciprocal_root)
  : kind == 3         ? ask_roots<double>(bytes, raylanes_rsqrtd, reciprocal_root)
  : kind == 4         ? ask_roots<float>(bytes, raylanes_reciprocal, reciprocal)
  : kind == 5         ? ask_roots<double>(bytes, raylanes_reciprocald, reciprocal)
  : kind < 9          ? ask_tree<raylanes::Scene>(bytes)
  : kind < 12         ? ask_tree<raylanes::SceneD>(bytes)
  : bytes.chance(128) ? ask_tree<float>(bytes)
                      : ask_tree<double>(bytes);
  return 0;
}

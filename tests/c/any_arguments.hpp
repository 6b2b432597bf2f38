// Arguments of C functions for the fuzz target: right ones, and now and then a wrong one, which it remembers.
#pragma once

#include <raylanes/raylanes.h>

#include "../fuzz/damaged_file.hpp"
#include "../fuzz/strided.hpp"
#include "any_worlds.hpp"

namespace raylanes::testing {

template <class AnyHit>
inline constexpr bool names_instance = requires(const AnyHit& hit) {
  hit.instance;
};

class AnyArguments {
 public:
  explicit AnyArguments(Bytes& bytes) : bytes_(bytes) {}

  // Whether all arguments that were made are right.
  bool are_right() const { return are_right_; }
  void expect(const char* what, raylanes_status status, bool is_right) const {
    if (status == (is_right ? RAYLANES_OK : RAYLANES_INVALID_ARGUMENT)) return;
    fail(std::string(what) + ": status " + std::to_string(status) +
         (is_right ? " of a right call: " : " of a wrong call: ") + raylanes_last_message());
  }

  template <class T>
  T* pointer(T* address) {
    return is_wrong() ? refused<T*>(nullptr) : address;
  }
  // An array of no elements may be null.
  template <class T, std::size_t capacity>
  void* first(const Strided<T, capacity>& array) {
    return array.count > 0 ? pointer<void>(array.first) : bytes_.chance(128) ? nullptr : array.first;
  }
  // Any number of elements that memory cannot hold is wrong.
  std::size_t count(std::size_t n) {
    constexpr auto most = std::numeric_limits<std::size_t>::max();
    return is_wrong() ? refused(bytes_.pick({most, most / 2, most / 2 + 1, most / 4 + 2})) : n;
  }
  std::size_t stride(std::size_t right, std::size_t of_element) {
    return is_wrong() ? refused(1 + bytes_.below(of_element - 1)) : right;
  }
  template <class T, std::size_t capacity>
  std::size_t stride(const Strided<T, capacity>& array, std::size_t of_element) {
    const bool is_dense = array.stride == of_element && bytes_.chance(128);
    return stride(is_dense ? 0 : array.stride, of_element);
  }

  const char* path() {
    if (is_wrong()) return refused(bytes_.pick({"", "sse9", "avx2 "}));
    return bytes_.chance(64) ? nullptr : bytes_.pick(fuzzed_paths())->name;
  }

  const raylanes_build_options* build_options() {
    raylanes_build_options defaults;
    raylanes_init_build_options(&defaults, sizeof defaults);
    build_ = defaults;
    build_.builder = enumerator(6);
    build_.threads = threads();
    build_.optimize = static_cast<std::int32_t>(bytes_.below(2));
    build_.choose = static_cast<std::int32_t>(bytes_.below(2));
    build_.rays = bytes_.number<double>();
    if (bytes_.chance(48)) build_.progress = go_on;
    return given(build_, defaults);
  }
  BuildOptions build_options_of_cpp() const {
    return {.builder = static_cast<TreeBuilder>(build_.builder),
            .threads = build_.threads,
            .optimize = build_.optimize != 0,
            .choose = build_.choose != 0,
            .rays = build_.rays};
  }

  // hits: what the option `after` may be. AnyHit: what the object finds.
  template <class AnyHit>
  const raylanes_ray_options* ray_options(std::size_t n, const HitRecords<AnyHit>& hits, bool takes_filter) {
    constexpr bool is_in_scene = names_instance<AnyHit>;
    rays_ = default_ray_options();
    rays_.threads = threads();
    rays_.facing = enumerator(3);
    rays_.path = path();
    if (bytes_.chance(64)) rays_.active = mask();
    if (bytes_.chance(64)) {
      // In hits of scenes: options of an earlier version say neither how far these lie apart nor where instances do.
      using Skipped = std::conditional_t<is_in_scene, AnyHit, SceneHit>;
      static Strided<Skipped, max_elements> skip;
      skip.take(n, bytes_.below(max_gap));
      std::vector<Skipped> skipped(n);
      for (Skipped& each : skipped) {
        each.primitive = static_cast<std::uint32_t>(bytes_.below(48)) - 4;
        each.instance = static_cast<std::uint32_t>(bytes_.below(6));
      }
      skip.put(skipped);
      if (n > 0) {
        rays_.skip = skip.first + offsetof(Skipped, primitive);
        rays_.skip_stride = is_wrong() ? refused(1 + bytes_.below(3)) : skip.stride;
      }
      if (is_in_scene && n > 0 && is_wrong()) rays_.skip_to_instance = refused(0);
    }
    if (hits.first != nullptr && hits.count > 0 && bytes_.chance(64))
      rays_.after = hits.first, rays_.after_stride = stride(hits.stride, sizeof(AnyHit));
    if (bytes_.chance(64)) rays_.mask = static_cast<std::uint32_t>(bytes_.below(4));
    if (!is_in_scene && bytes_.chance(64)) {
      for (std::uint32_t& word : words_) word = static_cast<std::uint32_t>(bytes_.below(4));
      rays_.masks = words_, rays_.mask_count = bytes_.below(std::size(words_) + 1);
      rays_.filter_mask = static_cast<std::uint32_t>(bytes_.below(4));
      if (is_wrong()) rays_.masks = refused(nullptr), rays_.mask_count = 1 + bytes_.below(9);
    }
    if (bytes_.chance(48)) rays_.progress = go_on;
    if (takes_filter ? bytes_.chance(48) : is_wrong())
      rays_.filter = takes_filter ? reject_in_c<AnyHit> : refused(reject_in_c<AnyHit>);
    rays_.max_count = bytes_.chance(128) ? rays_.max_count : bytes_.below(80);
    return given(rays_, default_ray_options());
  }
  bool has_filter() const { return rays_.filter != nullptr; }
  template <class Options, class AnyHit>
  Options ray_options_of_cpp(std::size_t n) const {
    Options options;
    options.path = path_named(rays_.path), options.threads = rays_.threads, options.active = rays_.active;
    options.facing = static_cast<Facing>(rays_.facing);
    const std::size_t side_by_side = names_instance<AnyHit> ? sizeof(AnyHit) : sizeof(std::uint32_t);
    if (rays_.skip != nullptr)
      options.skip = {rays_.skip, n, rays_.skip_stride == 0 ? side_by_side : rays_.skip_stride,
                      rays_.skip_to_instance};
    if constexpr (requires { options.mask; }) options.mask = rays_.mask;
    if constexpr (requires { options.filter_mask; }) options.filter_mask = rays_.filter_mask;
    if constexpr (requires { options.masks; }) options.masks = {rays_.masks, rays_.mask_count};
    if constexpr (requires { options.after; })
      if (rays_.after != nullptr)
        options.after = HitRecords<AnyHit>(const_cast<void*>(rays_.after), n,
                                           rays_.after_stride == 0 ? sizeof(AnyHit) : rays_.after_stride);
    if constexpr (requires { options.max_count; })
      options.max_count = static_cast<std::uint32_t>(std::min<std::size_t>(rays_.max_count, 0xffffffffu));
    return options;
  }

  // For a query with these options of C++.
  template <class Options>
  const raylanes_point_options* point_options() {
    constexpr bool have_rule = requires(Options options) {
      options.rule;
    }
    , have_accuracy = requires(Options options) {
      options.accuracy;
    };
    points_ = default_point_options();
    points_.threads = threads();
    points_.path = path();
    if (bytes_.chance(64)) points_.active = mask();
    points_.max_distance = bytes_.chance(128) ? HUGE_VAL : static_cast<double>(bytes_.number<float>());
    points_.rule = have_rule ? enumerator(4) : static_cast<std::int32_t>(bytes_.word<std::uint32_t>());
    points_.accuracy = bytes_.number<double>();
    if (bytes_.chance(64)) points_.mask = static_cast<std::uint32_t>(bytes_.below(4));
    if (bytes_.chance(48)) points_.progress = go_on;
    if (have_accuracy && !(points_.accuracy >= 0)) are_right_ = false;
    return given(points_, default_point_options());
  }
  template <class Options>
  Options point_options_of_cpp() const {
    Options options;
    options.path = path_named(points_.path), options.threads = points_.threads,
    options.active = points_.active;
    if constexpr (requires { options.rule; }) options.rule = static_cast<InsideRule>(points_.rule);
    if constexpr (requires { options.max_distance; })
      options.max_distance = static_cast<decltype(options.max_distance)>(points_.max_distance);
    if constexpr (requires { options.accuracy; }) options.accuracy = points_.accuracy;
    if constexpr (requires { options.mask; }) options.mask = points_.mask;
    return options;
  }

 private:
  static std::int32_t go_on(void*, double share) {
    if (!(share >= 0 && share <= 1)) fail("a share that is none");
    return 0;
  }
  bool is_wrong() { return bytes_.chance(8); }
  template <class T>
  T refused(T value) {
    are_right_ = false;
    return value;
  }
  std::int32_t threads() { return is_wrong() ? refused(-1) : static_cast<std::int32_t>(bytes_.below(3)); }
  std::int32_t enumerator(std::int32_t count) {
    if (is_wrong())
      return refused(bytes_.pick({-1, count, 256, 257, std::numeric_limits<std::int32_t>::min()}));
    return static_cast<std::int32_t>(bytes_.below(static_cast<std::size_t>(count)));
  }
  const std::uint8_t* mask() {
    for (std::uint8_t& byte : mask_) byte = bytes_.byte();
    return mask_;
  }
  // Options at the end of readable memory, sometimes of an earlier version, which has fewer members: then the others
  // have their defaults.
  template <class Options>
  const Options* given(Options& options, const Options& defaults) {
    static Fence fence(sizeof(Options));
    if (are_right_ && bytes_.chance(32)) {
      options = defaults;
      return nullptr;
    }
    std::size_t held = sizeof options;
    options.size = held;
    if (is_wrong())
      options.size = refused(bytes_.pick({held + 8, held - 4, std::size_t{0}, ~std::size_t{7}}));
    else if (are_right_ && bytes_.chance(48))
      options.size = held = 8 * (1 + bytes_.below(held / 8));
    auto* const memory = fence.last<unsigned char>(held);
    std::memcpy(memory, &options, held);
    options = defaults;
    std::memcpy(&options, memory, held);
    return reinterpret_cast<const Options*>(memory);
  }
  const Path* path_named(const char* name) const {
    return are_right_ && name != nullptr ? &find_path(name) : nullptr;
  }

  Bytes& bytes_;
  bool are_right_ = true;
  raylanes_build_options build_;
  raylanes_ray_options rays_;
  raylanes_point_options points_;
  std::uint8_t mask_[(max_elements + 7) / 8];
  std::uint32_t words_[24];
};

}  // namespace raylanes::testing

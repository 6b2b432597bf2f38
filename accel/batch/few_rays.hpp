// Batches of few rays: the loop of calls with one ray, behind as few checks as those calls have.
#pragma once

#include <raylanes/traversal.hpp>
#include <raylanes/triangle_tree.hpp>

#include "../../dispatch/table/traversal.hpp"
#include "ray_source.hpp"

namespace raylanes {

// Fewer rays gain nothing from each other: what is found out about a batch, and streams, take more time than the loop.
// If single rays wait for memory or ask for nearest hits of doubles, more of them fly
// (kernels/traverse/fused/in_flight.hpp).
inline constexpr std::size_t min_batch = 64, min_flying_batch = 32;
inline std::size_t batch_size_of(const TreeView& tree) {
  return tree.rays_wait ? min_flying_batch : min_batch;
}

// But from so many rays of floats on, nearest hits of rays with one origin may be a packet's. From min_columns on alike
// rays go as columns (kernels/traverse/stream_few.hpp), so many at a time: measured.
inline constexpr std::size_t min_packet = 32, min_columns = 8, rays_of_columns = min_batch;

// From how many rays on alike ones go as columns: measured. Parallel rays, as to a sun, are spread, and each of them
// finds a hit soon. is_usual: no side, skip or mask.
inline constexpr std::size_t min_parallel = 128;
template <class AnyRay>
bool are_parallel(std::span<const AnyRay> rays) {
  return rays.front().direction == rays.back().direction;
}
inline std::size_t least_in_columns(std::span<const Ray> rays, bool only_decides, bool is_usual) {
  constexpr std::size_t by_rule = 16;
  if (only_decides && are_parallel(rays)) return min_parallel;
  return is_usual ? min_columns : by_rule;
}

// Whether rays go one way from about one place: some of them in one octant, within 30 degrees and a fifth of the box.
inline bool are_alike(std::span<const Ray> rays, const Box& box) {
  constexpr float max_apart = 0.2f, min_cosine = 0.87f;
  const Ray& a = rays[0];
  float size = 0, of_a = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float side = box.hi[axis] - box.lo[axis];
    size += side * side, of_a += a.direction[axis] * a.direction[axis];
  }
  for (std::size_t k = 1; k <= 3; ++k) {
    const Ray& b = rays[(rays.size() - 1) * k / 3];
    float apart = 0, product = 0, of_b = 0;
    bool is_one_octant = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float d = a.direction[axis], e = b.direction[axis], way = b.origin[axis] - a.origin[axis];
      apart += way * way, product += d * e, of_b += e * e;
      is_one_octant &= (d < 0) == (e < 0);
    }
    const bool is_near = apart <= max_apart * max_apart * size,
               is_parallel = product > 0 && product * product >= min_cosine * min_cosine * of_a * of_b;
    if (!(is_near && is_parallel && is_one_octant)) return false;
  }
  return true;
}

// Whether options are the defaults, but for the mask and the threads. Without a branch for each of them.
template <class Options>
bool are_defaults(const Options& options) {
  const auto bits = [](const auto* pointer) { return reinterpret_cast<std::uintptr_t>(pointer); };
  std::uintptr_t some = bits(options.path) | bits(options.active) | bits(options.progress) |
                        bits(options.skip.first) | options.skip.count | bits(options.after.first) |
                        options.after.count;
  if constexpr (requires { options.facing; }) some |= static_cast<std::uintptr_t>(options.facing);
  if constexpr (requires { options.masks; }) some |= options.masks.size();
  if constexpr (requires { options.counters; }) some |= bits(options.counters);
  if constexpr (requires { options.hint; }) {
    struct Choices {
      TriangleTest test;
      Grade grade;
      TraversalMode mode;
      BatchHint hint;
    };
    static_assert(offsetof(Options, hint) == offsetof(Choices, hint) &&
                  sizeof(Choices) == sizeof(std::uint32_t));
    constexpr Options by_default;
    constexpr Choices usual{by_default.test, by_default.grade, by_default.mode, by_default.hint};
    std::uint32_t given;
    std::memcpy(&given, &options, sizeof given);
    some |= given ^ std::bit_cast<std::uint32_t>(usual);
  }
  return some == 0 && options.threads >= 0;
}

// Rays that lie as kernels read them and the answers to them in a row. False if there are many of them, or something is
// asked of the batch that the loop does not have.
template <class AnyRay, class Answer>
class FewRays {
 public:
  // are_default: as are_defaults() of the options. limit: so many rays are many.
  template <class Options>
  [[gnu::always_inline]] FewRays(const RayRecords<AnyRay>& rays, Answer* answers, std::size_t count,
                                 const Options& options, bool are_default, std::size_t limit)
      : rays_(static_cast<const AnyRay*>(rays.first)), answers_(answers), size_(rays.count) {
    if (std::is_same_v<AnyRay, RayD> && !only_decides) limit = std::min(limit, min_flying_batch);
    const bool is_plain = size_ < std::max(limit, min_parallel) && count == size_ && answers != nullptr &&
                          lie_plain(rays) &&
                          are_apart(rays_, size_ * sizeof(AnyRay), answers, size_ * sizeof(Answer)) &&
                          (are_default || stay_plain(options));
    const auto go_to_a_sun = [&] { return only_decides && limit == min_batch && are_parallel(some()); };
    if (!is_plain || (size_ >= limit && !go_to_a_sun())) rays_ = nullptr;
  }
  explicit operator bool() const { return rays_ != nullptr; }
  // Whether they may be better off together: rays of floats.
  bool may_be_packet(const Box& box, bool is_usual, bool may_be_alike) const {
    if (!only_decides && size_ >= min_packet && rays_[0].origin == rays_[size_ - 1].origin) return true;
    return may_be_alike && fill_columns(is_usual) && are_alike(some(), box);
  }
  bool may_be_columns() const { return size_ <= rays_of_columns && fill_columns(true); }
  Answer* answers() const { return answers_; }
  // Without answers.
  TraceBatchOf<float> batch() const requires std::is_same_v<AnyRay, Ray> {
    TraceBatchOf<float> batch;
    batch.rays = rays_, batch.size = size_;
    return batch;
  }
  // answers[i] = call(rays[i], i)
  template <class Call>
  void trace(const Call& call) const {
    for (std::size_t i = 0; i < size_; ++i) answers_[i] = call(rays_[i], i);
  }

 private:
  static constexpr bool only_decides = std::is_same_v<Answer, std::uint8_t>;
  std::span<const AnyRay> some() const { return {rays_, size_}; }
  // Whether they are enough for columns, if they are alike.
  bool fill_columns(bool is_usual) const {
    return size_ >= min_columns && size_ >= least_in_columns(some(), only_decides, is_usual);
  }
  static bool are_apart(const void* a, std::size_t bytes_of_a, const void* b, std::size_t bytes_of_b) {
    const auto at_a = reinterpret_cast<std::uintptr_t>(a), at_b = reinterpret_cast<std::uintptr_t>(b);
    return at_b - at_a >= bytes_of_a && at_a - at_b >= bytes_of_b;
  }
  template <class Options>
  bool stay_plain(const Options& options) const {
    return options.active == nullptr && options.progress == nullptr && options.after.first == nullptr &&
           options.after.count == 0 && skips_stay(options.skip);
  }
  // Whether no answer is written where what a later ray skips is read: that is elsewhere, or in the ray's own answer.
  bool skips_stay(const PrimitiveView& skip) const {
    if (skip.first == nullptr) return skip.count == 0;
    constexpr std::ptrdiff_t most_to_instance = 64;
    if (skip.count != size_ || skip.to_instance < 0 || skip.to_instance > most_to_instance) return false;
    const std::size_t of_one = sizeof(std::uint32_t) + static_cast<std::size_t>(skip.to_instance);
    const std::size_t at =
        reinterpret_cast<std::uintptr_t>(skip.first) - reinterpret_cast<std::uintptr_t>(answers_);
    if (skip.stride == sizeof(Answer) && at < sizeof(Answer) && at + of_one <= sizeof(Answer)) return true;
    return are_apart(skip.first, size_ * skip.stride + of_one, answers_, size_ * sizeof(Answer));
  }

  const AnyRay* rays_ = nullptr;
  Answer* answers_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace raylanes

// Batches of few rays: the loop of calls with one ray, behind as few checks as those calls have.
#pragma once

#include <raylanes/traversal.hpp>

#include "../../dispatch/table/tree_view.hpp"
#include "ray_source.hpp"

namespace raylanes {

// Fewer rays gain nothing from each other: what is found out about a batch, and streams, take more time than the loop.
// If single rays wait for memory or ask for nearest hits of doubles, more of them fly
// (kernels/traverse/fused/in_flight.hpp).
inline constexpr std::size_t min_batch = 64, min_flying_batch = 32;
inline std::size_t batch_size_of(const TreeView& tree) {
  return tree.rays_wait ? min_flying_batch : min_batch;
}

// But from so many rays of floats on, nearest hits of rays with one origin may be a packet's: measured.
inline constexpr std::size_t min_packet = 32;

// Rays that lie as kernels read them and the answers to them in a row. False if there are many of them, or something is
// asked of the batch that the loop does not have.
template <class AnyRay, class Answer>
class FewRays {
 public:
  FewRays() = default;  // many
  template <class Options>
  FewRays(const RayRecords<AnyRay>& rays, Answer* answers, std::size_t count, const Options& options,
          std::size_t limit)
      : rays_(static_cast<const AnyRay*>(rays.first)), answers_(answers), size_(rays.count) {
    if (std::is_same_v<AnyRay, RayD> && !only_decides) limit = std::min(limit, min_flying_batch);
    const bool is_plain = size_ < limit && count == size_ && answers != nullptr && lie_plain(rays) &&
                          options.active == nullptr && options.progress == nullptr &&
                          options.after.first == nullptr && options.after.count == 0 &&
                          are_apart(rays_, size_ * sizeof(AnyRay), answers, size_ * sizeof(Answer)) &&
                          skips_stay(options.skip);
    if (!is_plain) rays_ = nullptr;
  }
  explicit operator bool() const { return rays_ != nullptr; }
  bool may_be_packet() const {
    return !only_decides && size_ >= min_packet && rays_[0].origin == rays_[size_ - 1].origin;
  }
  // answers[i] = call(rays[i], i)
  template <class Call>
  void trace(const Call& call) const {
    for (std::size_t i = 0; i < size_; ++i) answers_[i] = call(rays_[i], i);
  }

 private:
  static constexpr bool only_decides = std::is_same_v<Answer, std::uint8_t>;
  static bool are_apart(const void* a, std::size_t bytes_of_a, const void* b, std::size_t bytes_of_b) {
    const auto at_a = reinterpret_cast<std::uintptr_t>(a), at_b = reinterpret_cast<std::uintptr_t>(b);
    return at_b - at_a >= bytes_of_a && at_a - at_b >= bytes_of_b;
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

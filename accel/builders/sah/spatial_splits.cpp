
#include "object_bins.hpp"

namespace raylanes {
namespace {

// References that splits may add, as a share of those given.
constexpr std::size_t budget_divisor = 4;
// Nothing is cut if the common part of both sides of a border of whole references has too little surface: less than
// this share of the part's, or less than a share of the root's. The budget and the time are better spent elsewhere
// (Stich, Friedrich, Dietrich 2009).
constexpr float min_overlap = 0.25f, min_of_root = 1e-5f;

bool is_empty(const Box4& box) {
  return !(box.lo[0] <= box.hi[0] && box.lo[1] <= box.hi[1] && box.lo[2] <= box.hi[2]);
}

// A plane that references are cut at, with the boxes and counts of both sides as the bins have them.
struct SpatialSplit {
  float cost = infinite_float;
  std::size_t axis = 0;
  float at = 0.0f;
  Box4 left, right;
  std::uint32_t left_count = 0, right_count = 0;
};

// Bins that cut space along the longest axis: each has what is left of the references' boxes within it. The primitives
// themselves are cut only where a split is made, and other axes are not tried: both find about as good trees, in a
// fraction of the time.
class SpatialBins {
 public:
  explicit SpatialBins(const Box4& box) : axis_(longest_axis(box)), origin_(box.lo[axis_]) {
    bins_.fill({empty_four_box, 0, 0});
    cell_ = (box.hi[axis_] - origin_) / static_cast<float>(max_bins);
    inverse_ = 1.0f / cell_;
  }

  void add(std::span<const Reference> references) {
    for (const Reference& reference : references) {
      Box4 rest = reference.box;
      const std::size_t first = bin_at(rest.lo[axis_]), last = std::max(first, bin_at(rest.hi[axis_]));
      ++bins_[first].begin, ++bins_[last].end;
      for (std::size_t i = first; i < last; ++i) {
        Box4 below = rest;
        below.hi[axis_] = rest.lo[axis_] = plane(i);
        extend(bins_[i].box, below);
      }
      extend(bins_[last].box, rest);
    }
  }
  void add(const SpatialBins& other) {
    for (std::size_t i = 0; i < max_bins; ++i) {
      extend(bins_[i].box, other.bins_[i].box);
      bins_[i].begin += other.bins_[i].begin, bins_[i].end += other.bins_[i].end;
    }
  }

  // Infinite cost where no plane separates anything, or numbers overflow.
  SpatialSplit best() const {
    SpatialSplit best;
    if (!(cell_ > 0.0f && cell_ < infinite_float && inverse_ < infinite_float)) return best;
    std::array<Box4, max_bins> right;
    std::array<std::uint32_t, max_bins> right_count;
    Box4 box = empty_four_box;
    std::uint32_t count = 0;
    for (std::size_t i = max_bins - 1; i > 0; --i) {
      extend(box, bins_[i].box);
      right[i] = box, right_count[i] = count += bins_[i].end;
    }
    box = empty_four_box, count = 0;
    for (std::size_t i = 1; i < max_bins; ++i) {
      extend(box, bins_[i - 1].box);
      count += bins_[i - 1].begin;
      const float cost = cost_of_side(box, count) + cost_of_side(right[i], right_count[i]);
      if (count > 0 && right_count[i] > 0 && cost < best.cost)
        best = {cost, axis_, plane(i - 1), box, right[i], count, right_count[i]};
    }
    return best;
  }

 private:
  struct Bin {
    Box4 box;
    std::uint32_t begin, end;  // references of which it holds the first and the last part
  };

  // The upper end of a bin.
  float plane(std::size_t bin) const { return origin_ + cell_ * static_cast<float>(bin + 1); }
  // The first bin if the position is not a number.
  std::size_t bin_at(float x) const {
    const float bin = (x - origin_) * inverse_;
    return bin > 0.0f ? static_cast<std::size_t>(std::min(bin, max_bins - 1.0f)) : 0;
  }

  std::size_t axis_;
  float origin_, cell_, inverse_;
  std::array<Bin, max_bins> bins_;
};

class SpatialSplits : public InPlace {
 public:
  SpatialSplits(Array<Reference> references, std::uint32_t count, const BuildInput& input)
      : InPlace(std::move(references), input.run.memory), count_(count), clipper_(*input.clipper) {}

  Part all(int threads) {
    Part part = measured(count_, threads);
    part.capacity = static_cast<std::uint32_t>(size());
    min_area_ = min_of_root * half_area(part.box);
    return part;
  }

  bool split(const Part& part, int depth, int threads, Part& left, Part& right) {
    if (part.count <= max_in_leaf) return false;
    if (!divide_by_area(part, depth, threads, left, right)) halve(part, left, right);
    // A part that may become one leaf stays together.
    if (part.count > tree_width && part.count < part.capacity) share_room(part, left, right);
    return true;
  }

 private:
  bool divide_by_area(const Part& part, int depth, int threads, Part& left, Part& right) {
    if (depth >= last_split_depth) return false;
    const Binning binning(part.centres, part.count);
    const BinBorder border = best_border(of(part), binning, threads);
    if (part.count > tree_width && part.count < part.capacity && overlaps(part, border)) {
      const SpatialSplit cut = best_cut(part, threads);
      const bool has_room = cut.left_count + cut.right_count <= part.capacity;
      if (cut.cost < border.cost && has_room && cut_at(part, cut, left, right)) return true;
    }
    if (border.cost == infinite_float) return false;
    const auto is_below = [&](Vec4 at) { return binning.is_below(at, border); };
    return partition(part, is_below, {border.left, border.right}, left, right);
  }

  // Whether the sides of a border have so much in common that cutting may pay. Sides of no border have nothing.
  bool overlaps(const Part& part, const BinBorder& border) const {
    const Box4 common{greatest(border.left.lo, border.right.lo), least(border.left.hi, border.right.hi)};
    return !is_empty(common) && half_area(common) > std::max(min_overlap * half_area(part.box), min_area_);
  }

  SpatialSplit best_cut(const Part& part, int threads) {
    constexpr std::size_t grain = 1 << 13;
    const std::span<const Reference> list = of(part);
    SpatialBins all(part.box);
    std::mutex mutex;
    in_parallel(list.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
      SpatialBins mine(part.box);
      mine.add(list.subspan(begin, end - begin));
      const std::lock_guard lock(mutex);
      all.add(mine);
    });
    return all.best();
  }

  // The references of both sides. False, and nothing has changed, where one has none.
  bool cut_at(const Part& part, SpatialSplit cut, Part& left, Part& right) {
    std::vector<Reference> below, above;
    below.reserve(cut.left_count), above.reserve(cut.right_count);
    for (const Reference& reference : of(part)) {
      const float lo = reference.box.lo[cut.axis], hi = reference.box.hi[cut.axis];
      const int side = hi <= cut.at ? -1 : lo >= cut.at ? 1 : side_of_whole(reference.box, cut);
      if (side < 0) {
        below.push_back(reference);
      } else if (side > 0) {
        above.push_back(reference);
      } else {
        const std::uint32_t primitive = reference.primitive();
        const Clipper::Halves halves = clipper_.cut(primitive, reference.box, cut.axis, cut.at);
        if (!is_empty(halves.below)) below.push_back(Reference::make(halves.below, primitive));
        if (!is_empty(halves.above)) above.push_back(Reference::make(halves.above, primitive));
      }
    }
    if (below.empty() || above.empty() || below.size() + above.size() > part.capacity) return false;
    Part all = part;
    all.count = static_cast<std::uint32_t>(below.size() + above.size());
    std::copy(below.begin(), below.end(), of(all).begin());
    std::copy(above.begin(), above.end(), of(all).begin() + static_cast<std::ptrdiff_t>(below.size()));
    divide(all, static_cast<std::uint32_t>(below.size()), left, right);
    return true;
  }

  // The side on which a reference that lies across the plane is cheaper as a whole; the side then grows. 0: in both
  // sides.
  static int side_of_whole(const Box4& box, SpatialSplit& cut) {
    const auto cost = [](const Box4& b, std::uint32_t count) {
      return half_area(b) * static_cast<float>(count);
    };
    const Box4 left = united(cut.left, box), right = united(cut.right, box);
    const float as_left = cost(left, cut.left_count) + cost(cut.right, cut.right_count - 1);
    const float as_right = cost(cut.left, cut.left_count - 1) + cost(right, cut.right_count);
    const float as_both = cost(cut.left, cut.left_count) + cost(cut.right, cut.right_count);
    if (cut.right_count > 1 && as_left < as_both && as_left <= as_right) {
      cut.left = left, --cut.right_count;
      return -1;
    }
    if (cut.left_count > 1 && as_right < as_both) {
      cut.right = right, --cut.left_count;
      return 1;
    }
    return 0;
  }

  // Moves the right part up, so that each has room in proportion to its references.
  void share_room(const Part& part, Part& left, Part& right) {
    const std::uint32_t count = left.count + right.count, spare = part.capacity - count;
    const auto for_left = static_cast<std::uint32_t>(std::uint64_t{spare} * left.count / count);
    const std::span<Reference> from = of(right);
    left.capacity = left.count + for_left;
    right.begin = part.begin + left.capacity;
    right.capacity = part.capacity - left.capacity;
    std::memmove(of(right).data(), from.data(), from.size_bytes());
  }

  std::uint32_t count_;
  const Clipper& clipper_;
  float min_area_ = 0.0f;
};

}  // namespace

BinaryTree build_spatial_splits(BuildInput input) {
  const std::size_t count = input.references.size();
  Array<Reference> roomy(count + count / budget_divisor);
  std::copy_n(input.references.data(), count, roomy.data());
  input.references = {};
  SpatialSplits splitter(std::move(roomy), static_cast<std::uint32_t>(count), input);
  const Part root = splitter.all(input.run.threads);
  return TopDown(splitter, splitter.size(), input).build(root);
}

}  // namespace raylanes

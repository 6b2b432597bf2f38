#include <array>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include "boxes.hpp"
#include "builders.hpp"

namespace raylanes {
namespace {

constexpr std::size_t bin_count = 16;
constexpr int last_sah_depth = 64;

struct Bin {
  Box box = empty_box;
  std::uint32_t count = 0;
};

// Maps a centre to its bin; monotone, so a border between bins is a border in space.
struct Binning {
  float origin = 0.0f;
  float scale = 0.0f;
  std::size_t operator()(float at) const {
    const float position = (at - origin) * scale;
    // The centre of an empty box is NaN, and falls into the first bin.
    return position >= 0.0f ? static_cast<std::size_t>(std::min(position, bin_count - 1.0f)) : 0;
  }
};

struct Split {
  std::size_t axis = 0;
  std::size_t bin = 0;  // bins below it go left
  Binning binning;
  float cost = std::numeric_limits<float>::infinity();
};

using AxisBins = std::array<std::array<Bin, bin_count>, 3>;

std::array<Binning, 3> fit_binnings(const Box& centres) {
  std::array<Binning, 3> binnings;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float extent = centres.hi[axis] - centres.lo[axis];
    // Just below bin_count/extent, so that the last centre falls into the last bin.
    const float scale = static_cast<float>(bin_count) * (1.0f - 1e-6f) / extent;
    if (extent > 0.0f && extent <= std::numeric_limits<float>::max() &&
        scale <= std::numeric_limits<float>::max())
      binnings[axis] = {centres.lo[axis], scale};
  }
  return binnings;
}

void evaluate_borders(const std::array<Bin, bin_count>& bins, std::size_t axis, const Binning& binning,
                      Split& best) {
  std::array<float, bin_count> right_cost{};
  Bin right, left;
  for (std::size_t i = bin_count - 1; i > 0; --i) {
    extend(right.box, bins[i].box);
    right.count += bins[i].count;
    right_cost[i] = half_area(right.box) * static_cast<float>(right.count);
  }
  const std::uint32_t total = right.count + bins[0].count;
  for (std::size_t i = 1; i < bin_count; ++i) {
    extend(left.box, bins[i - 1].box);
    left.count += bins[i - 1].count;
    const float cost = half_area(left.box) * static_cast<float>(left.count) + right_cost[i];
    if (left.count > 0 && left.count < total && cost < best.cost) best = {axis, i, binning, cost};
  }
}

class BinnedSah {
 public:
  BinnedSah(std::span<const Box> boxes, const Progress& progress) : boxes_(boxes), progress_(progress) {
    tree_.order.resize(boxes.size());
    std::iota(tree_.order.begin(), tree_.order.end(), 0u);
    tree_.nodes.reserve(2 * boxes.size());
  }

  BinaryTree build() {
    if (boxes_.empty()) return std::move(tree_);
    tree_.nodes.push_back(make_node(0, static_cast<std::uint32_t>(boxes_.size())));
    std::vector<Pending> pending{{0, 0}};
    while (!pending.empty()) {
      const Pending next = pending.back();
      pending.pop_back();
      if (tree_.nodes[next.node].count == 1) {
        report_leaf();
        continue;
      }
      if (next.depth >= max_binary_depth)
        throw std::length_error("binned SAH: deeper than " + std::to_string(max_binary_depth) + " nodes");
      const std::uint32_t left = split(next);
      // The larger part waits below: the stack stays logarithmic.
      const bool left_is_larger = tree_.nodes[left].count > tree_.nodes[left + 1].count;
      pending.push_back({left_is_larger ? left : left + 1, next.depth + 1});
      pending.push_back({left_is_larger ? left + 1 : left, next.depth + 1});
    }
    return std::move(tree_);
  }

 private:
  struct Pending {
    std::uint32_t node;
    int depth;
  };

  std::span<std::uint32_t> primitives(const BinaryNode& node) {
    return std::span(tree_.order).subspan(node.begin, node.count);
  }

  BinaryNode make_node(std::uint32_t begin, std::uint32_t count) {
    BinaryNode node{empty_box, begin, count, 0};
    for (const std::uint32_t p : primitives(node)) extend(node.box, boxes_[p]);
    return node;
  }

  std::optional<Split> find_split(const BinaryNode& node) {
    Box centres = empty_box;
    for (const std::uint32_t p : primitives(node)) extend(centres, centre(boxes_[p]));
    const std::array<Binning, 3> binnings = fit_binnings(centres);
    AxisBins bins;
    for (const std::uint32_t p : primitives(node))
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Bin& bin = bins[axis][binnings[axis](centre(boxes_[p], axis))];
        extend(bin.box, boxes_[p]);
        ++bin.count;
      }
    Split best;
    for (std::size_t axis = 0; axis < 3; ++axis) evaluate_borders(bins[axis], axis, binnings[axis], best);
    if (best.cost == std::numeric_limits<float>::infinity()) return std::nullopt;
    return best;
  }

  std::uint32_t partition(const BinaryNode& node, int depth) {
    if (depth < last_sah_depth) {
      if (const std::optional<Split> s = find_split(node)) {
        const auto list = primitives(node);
        const auto middle = std::partition(list.begin(), list.end(), [&](std::uint32_t p) {
          return s->binning(centre(boxes_[p], s->axis)) < s->bin;
        });
        return static_cast<std::uint32_t>(middle - list.begin());
      }
    }
    return node.count / 2;
  }

  // Returns the left child; the right one follows it.
  std::uint32_t split(const Pending& at) {
    const BinaryNode node = tree_.nodes[at.node];
    const std::uint32_t left_count = partition(node, at.depth);
    const auto left = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.push_back(make_node(node.begin, left_count));
    tree_.nodes.push_back(make_node(node.begin + left_count, node.count - left_count));
    tree_.nodes[at.node].left = left;
    return left;
  }

  void report_leaf() {
    constexpr std::size_t interval = 1 << 14;
    if (progress_ && ++leaves_ % interval == 0)
      progress_(static_cast<double>(leaves_) / static_cast<double>(boxes_.size()));
  }

  std::span<const Box> boxes_;
  const Progress& progress_;
  BinaryTree tree_;
  std::size_t leaves_ = 0;
};

}  // namespace

BinaryTree build_binned_sah(std::span<const Box> boxes, const Progress& progress) {
  return BinnedSah(boxes, progress).build();
}

}  // namespace raylanes

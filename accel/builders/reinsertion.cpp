
#include "../batch/array.hpp"
#include "../batch/in_parallel.hpp"
#include "builder_table.hpp"
#include "linked_tree.hpp"

namespace raylanes {
namespace {

// Each round looks for places for one in so many nodes, those with the largest boxes: measured; more gains little.
constexpr int rounds = 3;
constexpr std::size_t one_in = 10;
// Nodes that a search looks at: thirty on average, but all of a tree whose boxes are all alike.
constexpr int max_steps = 512;
// About the share of a build's progress.
constexpr double share_of_build = 0.2;

struct Move {
  std::uint32_t node, target;
  float gain;  // of area; 0: it stays
};

// Finds the best place for a subtree: from its parent upwards, in the subtrees on the other side of each ancestor, by
// branch and bound.
class Search {
 public:
  explicit Search(const LinkedTree& tree) : tree_(tree) {}

  Move best_for(std::uint32_t node) {
    best_ = {node, 0, 0.0f};
    box_ = tree_[node].box, area_ = finite_half_area(box_);
    const std::uint32_t parent = tree_[node].parent, beside = LinkedTree::sibling(node);
    Box4 without = tree_[beside].box;  // of an ancestor, once the node is cut out
    float gain = finite_half_area(tree_[parent].box);
    steps_ = 0;
    look_below(beside, gain);
    for (std::uint32_t at = parent; at != 0; at = tree_[at].parent) {
      const std::uint32_t across = LinkedTree::sibling(at), above = tree_[at].parent;
      look_below(across, gain);
      extend(without, tree_[across].box);
      gain += finite_half_area(tree_[above].box) - finite_half_area(without);
    }
    if (best_.target == beside) best_.gain = 0.0f;  // where it is: the parent's box was larger than needed
    return best_;
  }

 private:
  struct Open {
    std::uint32_t node;
    float gain;  // so far: of what became smaller above, less what became larger
  };

  void look_below(std::uint32_t root, float gain) {
    open_.assign(1, {root, gain});
    while (!open_.empty() && steps_ < max_steps) {
      const Open at = open_.back();
      open_.pop_back();
      // A new parent has at least the area of the node itself.
      if (at.gain - area_ <= best_.gain) continue;
      ++steps_;
      const LinkedTree::Node& target = tree_[at.node];
      const float left = at.gain - finite_half_area(united(target.box, box_));
      if (left > best_.gain) best_.gain = left, best_.target = at.node;
      if (target.is_leaf()) continue;
      const float below = left + finite_half_area(target.box);
      open_.push_back({target.left, below}), open_.push_back({target.left + 1, below});
    }
  }

  const LinkedTree& tree_;
  Move best_{};
  Box4 box_;
  float area_ = 0.0f;
  int steps_ = 0;
  std::vector<Open> open_;
};

class Reinsertion {
 public:
  Reinsertion(LinkedTree& tree, const BuildRun& run)
      : tree_(tree),
        run_(run),
        sized_(tree.size()),
        touched_(tree.size()),
        held_(run.memory, sized_.bytes() + tree.size() / 8) {}

  void round() {
    const std::size_t count = choose();
    moves_.resize(count);
    in_parallel(count, 256, run_.threads, [&](std::size_t begin, std::size_t end) {
      Search search(tree_);
      for (std::size_t i = begin; i < end; ++i) moves_[i] = search.best_for(sized_[i].node);
    });
    std::erase_if(moves_, [](const Move& move) { return !(move.gain > 0.0f); });
    std::sort(moves_.begin(), moves_.end(), [](const Move& a, const Move& b) {
      return a.gain > b.gain || (a.gain == b.gain && a.node < b.node);
    });
    touched_.assign(tree_.size(), false);
    for (const Move& move : moves_)
      if (can_still(move)) tree_.move(move.node, move.target);
  }

 private:
  struct Sized {
    std::uint32_t node;
    float area;
  };

  // The nodes with the largest boxes first; of the root's children neither can move.
  std::size_t choose() {
    std::size_t count = 0;
    for (std::uint32_t i = 1; i < tree_.size(); ++i)
      if (tree_[i].parent != 0) sized_[count++] = {i, finite_half_area(tree_[i].box)};
    const std::size_t chosen = (count + one_in - 1) / one_in;
    std::nth_element(sized_.data(), sized_.data() + chosen, sized_.data() + count,
                     [](const Sized& a, const Sized& b) {
                       return a.area > b.area || (a.area == b.area && a.node < b.node);
                     });
    std::sort(sized_.data(), sized_.data() + chosen,
              [](const Sized& a, const Sized& b) { return a.node < b.node; });
    return chosen;
  }

  // Whether no move of the round, of those that gain more, has changed what this one is about.
  bool can_still(const Move& move) {
    const std::uint32_t parent = tree_[move.node].parent, beside = LinkedTree::sibling(move.node);
    const std::uint32_t places[] = {move.node, beside, parent, move.target, tree_[move.target].parent};
    if (parent == 0 ||
        std::any_of(std::begin(places), std::end(places), [&](auto i) { return touched_[i]; }) ||
        tree_.is_below(move.target, move.node))
      return false;
    for (const std::uint32_t place : places) touched_[place] = true;
    return true;
  }

  LinkedTree& tree_;
  const BuildRun& run_;
  Array<Sized> sized_;
  std::vector<bool> touched_;
  HeldMemory held_;
  std::vector<Move> moves_;
};

}  // namespace

BinaryTree reinserted(BinaryTree tree, const BuildRun& run) {
  if (tree.nodes.size() < 5) return tree;
  LinkedTree linked(tree);
  const HeldMemory held(run.memory, linked.bytes());
  const double before = linked.inner_area();
  {
    Reinsertion reinsertion(linked, run);
    for (int i = 0; i < rounds; ++i) {
      reinsertion.round();
      run.progress.advance(share_of_build / rounds);
    }
  }
  if (!(linked.inner_area() < before)) return tree;
  const HeldMemory both(run.memory, tree.bytes());
  std::optional<BinaryTree> better = linked.binary(tree, max_binary_depth);
  return better ? std::move(*better) : std::move(tree);
}

}  // namespace raylanes

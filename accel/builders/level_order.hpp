// The order in which every tree grows from its root, for any type of node. Parts with many references are divided level
// by level, each level shared out among threads; then subtrees, each by one thread.
#pragma once

#include "../batch/in_parallel.hpp"
#include "../batch/meters.hpp"

namespace raylanes {

// References that fit into a core's cache: subtrees are built in it, and a large mesh has some hundred of them to share
// out.
inline constexpr std::uint32_t subtree_size = 1 << 13;

// `Part` is what may be divided; part.count() its references, of `total` in the tree.
template <class Part>
class LevelOrder {
 public:
  LevelOrder(std::size_t total, const BuildRun& run) : total_(static_cast<double>(total)), run_(run) {}

  // Many threads call divide(part); then one thread calls take(part, its division, next) in the order of the parts,
  // and next.push_back takes what is open below. Gives the parts of at most `subtree_size` references.
  template <class Divide, class Take>
  std::vector<Part> divide_large(Part root, const Divide& divide, const Take& take) const {
    using Division = decltype(divide(root));
    std::vector<Part> small, level;
    level.push_back(std::move(root));
    double levels = 1.0;
    for (double count = total_; count > subtree_size; count /= 2) ++levels;
    while (!level.empty()) {
      std::vector<Part> large, next;
      for (Part& part : level) (part.count() <= subtree_size ? small : large).push_back(std::move(part));
      std::vector<Division> divisions(large.size());
      in_parallel(large.size(), 1, run_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          divisions[i] = divide(large[i]);
          run_.progress.advance(share_of_large / levels * share_of(large[i]));
        }
      });
      for (std::size_t i = 0; i < large.size(); ++i) take(large[i], divisions[i], next);
      level = std::move(next);
    }
    return small;
  }

  // Many threads call grow(i) for each of the parts that divide_large gave.
  template <class Grow>
  void grow_subtrees(const std::vector<Part>& small, const Grow& grow) const {
    in_parallel(small.size(), 1, run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const double share = share_of(small[i]);
        grow(i);
        // References that splits have doubled count twice: the caller's phase ends where it ends.
        run_.progress.advance((1.0 - share_of_large) * share);
      }
    });
  }

 private:
  static constexpr double share_of_large = 0.4;  // of the progress of a tree, about
  double share_of(const Part& part) const { return static_cast<double>(part.count()) / total_; }

  double total_;
  const BuildRun& run_;
};

}  // namespace raylanes

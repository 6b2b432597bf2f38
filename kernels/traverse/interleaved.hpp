// Single rays through a tree by turns, a node or a leaf each: what one waits for comes while others go on. For rays
// that have little in common, in batches too small for streams.
#pragma once

#include <new>

#include "single.hpp"

namespace raylanes {
namespace {

// More than a core waits for at a time gain nothing; measured.
inline constexpr int rays_by_turns = 16;

template <class Test, class Query>
struct RayInTurn {
  SingleRay<Test> prepared;
  Query query;
  Walk<Test, Query> walk;
  std::size_t number;

  RayInTurn(const TreeView& tree, const Ray& ray, std::size_t number_)
      : prepared(ray, tree.bounds), query(ray), walk(tree), number(number_) {}
};
template <class Test, class Query>
struct TurnScratch {
  struct alignas(RayInTurn<Test, Query>) Place {
    std::byte bytes[sizeof(RayInTurn<Test, Query>)];
  };
  Place place[rays_by_turns];
};

// Where answers go: of a test that decides apart, winners wait for a register of them.
template <class Test, class Query>
class Answers {
 public:
  Answers(const TreeView& tree, const TraceBatch& batch) : triangles_(tree), batch_(batch) {}

  void set(std::size_t number, const Query& query) {
    if constexpr (Query::only_decides) {
      batch_.occluded[number] = query.found;
    } else if constexpr (decides_apart<Test>) {
      winners_.set(count_, triangles_, batch_.rays[number], query.slot);
      number_[count_++] = number;
      if (count_ == native_lanes) store();
    } else {
      batch_.hits[number] = query.best;
    }
  }
  // Those that wait.
  void store() {
    Hit hits[native_lanes];
    if (count_ != 0) winners_.store(hits);
    for (int i = 0; i < count_; ++i) batch_.hits[number_[i]] = hits[i];
    count_ = 0;
  }

 private:
  TreeTriangles triangles_;
  const TraceBatch& batch_;
  WinnersApart<native_lanes> winners_;
  std::size_t number_[native_lanes];
  int count_ = 0;
};

template <class Test, class Query, class Counters>
class RaysByTurns {
 public:
  RaysByTurns(const TreeView& tree, const TraceBatch& batch)
      : tree_(tree), batch_(batch), counters_(batch), answers_(tree, batch) {}

  void trace() {
    auto& scratch = *static_cast<TurnScratch<Test, Query>*>(batch_.scratch);
    InTurn* ray[rays_by_turns];
    int going = 0;
    for (auto& place : scratch.place)
      if (InTurn* const first = start(&place)) ray[going++] = first;
    while (going != 0)
      for (int k = 0; k < going;) {
        if (step(*ray[k])) {
          ++k;
        } else {
          answers_.set(ray[k]->number, ray[k]->query);
          InTurn* const other = start(ray[k]);
          ray[k] = other != nullptr ? other : ray[--going];
        }
      }
    answers_.store();
  }

 private:
  using InTurn = RayInTurn<Test, Query>;

  // The next ray of the batch, or null. Those that hit nothing whatever there is take no turns.
  InTurn* start(void* place) {
    for (; next_ < batch_.size; ++next_) {
      const Ray& ray = batch_.rays[next_];
      if (is_valid(ray)) return ::new (place) InTurn(tree_, ray, next_++);
      answers_.set(next_, Query(ray));
    }
    return nullptr;
  }
  bool step(InTurn& ray) {
    if (!ray.walk.step(tree_, batch_.rays[ray.number], ray.prepared, ray.query, counters_)) return false;
    prefetch<Test>(tree_, ray.walk.next());
    return true;
  }

  const TreeView& tree_;
  const TraceBatch& batch_;
  Counters counters_;
  Answers<Test, Query> answers_;
  std::size_t next_ = 0;
};

template <class Test, bool only_decides>
using QueryOf = std::conditional_t<only_decides, AnyHit, ClosestOf<Test>>;

template <class Test, bool only_decides, class Counters>
[[gnu::flatten, gnu::noinline]] void trace_by_turns(const TreeView& tree, const TraceBatch& batch) {
  if (tree.root == empty_reference) return trace_singles<Test, only_decides, Counters>(tree, batch);
  RaysByTurns<Test, QueryOf<Test, only_decides>, Counters>(tree, batch).trace();
}

}  // namespace
}  // namespace raylanes

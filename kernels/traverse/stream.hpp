// Many rays of one octant of directions through a tree together: each node is met by a list of rays, and gives each of
// its children a list of those that enter it (streams: Barringer, Akenine-Möller 2014; Fuetterling et al. 2015). Nodes
// are tested a register of rays against one child at a time, leaves a register against one triangle, lists of a few
// rays one ray at a time.
#pragma once

#include "stream_octant.hpp"

namespace raylanes {
namespace {

// Fewer rays than this are traced one by one.
inline constexpr std::uint32_t min_stream = stream_lanes < 8 ? 2 : 4;
// Members that all waiting lists have room for together, a ray of the stream; where they do not, rays go on alone.
inline constexpr std::size_t entries_per_ray = 48;

template <class Counters>
class Stream {
 public:
  Stream(StreamOctant<Counters>& of, ListEntry* entries, std::size_t max_entries)
      : of_(of),
        tree_(of.tree_),
        rows_(of.rays_.rows),
        prefetches_leaves_(of.calls_.prefetch_leaf != nullptr),
        entries_(entries),
        max_entries_(max_entries) {}

  void trace() {
    const std::uint32_t size = of_.rays_.size;
    for (std::uint32_t i = 0; i < size; ++i) entries_[i] = i;
    top_ = stack_;
    *top_++ = {tree_.root, 0, size, size + stream_lanes};
    bool is_new = true;  // a list just made holds nothing that another leaf has ended
    while (top_ != stack_) {
      WaitingList at = *--top_;
      if (of_.needs_.shortens_rays && !is_new) at.size = without_late_ones(entries_ + at.begin, at.size);
      is_new = false;
      if (at.size < min_stream)
        trace_singly(at);
      else if (refers_to_leaf(at.reference))
        of_.calls_.visit_leaf(of_, at.reference, whole_registers(at), at.size);
      else
        is_new = visit_node(at);
    }
  }

 private:
  // Without a branch: half of them may stay.
  [[gnu::noinline]] std::uint32_t without_late_ones(ListEntry* list, std::uint32_t size) const {
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; i < size; ++i) {
      const ListEntry m = list[i];
      list[left] = m;
      left += entry_of(m) <= rows_[index_of(m)].tmax ? 1u : 0u;
    }
    return left;
  }

  // A list that may be read in whole registers: its last member again behind its end.
  ListEntry* whole_registers(const WaitingList& at) const {
    ListEntry* const list = entries_ + at.begin;
    for (std::uint32_t i = 0; i < stream_lanes; ++i) list[at.size + i] = list[at.size - 1];
    return list;
  }

  // True if a child waits on top.
  [[gnu::noinline, gnu::flatten]] bool visit_node(const WaitingList& at) {
    const WideNode& node = tree_.nodes[at.reference];
    const std::uint32_t room = at.size + stream_lanes;
    if (at.end + std::size_t{tree_width} * room > max_entries_) {
      trace_singly(at);
      return false;
    }
    of_.counters().node();
    OctantNode planes(node, of_.octant_, of_.padding_);
    ListEntry* list = whole_registers(at);
    ListEntry* lists[tree_width];
    for (std::uint32_t child = 0; child < tree_width; ++child)
      lists[child] = entries_ + at.end + child * room;
    for (std::uint32_t i = 0; i < at.size; i += stream_lanes)
      enter_children(planes, node.occupied, list + i, at.size - i, lists);
    return of_.needs_.only_decides ? push_children<false>(node, at, room, lists)
                                   : push_children<true>(node, at, room, lists);
  }

  // Appends a register of rays, or the first `size`, to the lists of the children that they enter.
  void enter_children(const OctantNode& planes, std::uint32_t occupied, const ListEntry* list,
                      std::uint32_t size, ListEntry* (&lists)[tree_width]) const {
    const void* rows[stream_lanes];
    for (int lane = 0; lane < stream_lanes; ++lane) rows[lane] = rows_ + index_of(list[lane]);
    StreamFloats ray[row_floats];
    load_rows(rows, ray);
    StreamBits index = StreamBits::load(list) & StreamBits(index_mask);
    auto taking_part = FloatMask<stream_lanes>::first(size < stream_lanes ? size : stream_lanes);
    for (int child = 0; child < tree_width; ++child) {
      if ((occupied >> child & 1u) == 0) continue;
      of_.counters().boxes(first_lanes<stream_lanes>(size));
      const auto distance = [&](const float(&plane)[3][tree_width], int axis) {
        return multiply_add<Grade::fast>(StreamFloats(plane[axis][child]), ray[axis], ray[3 + axis]);
      };
      StreamFloats entry =
          max(max(distance(planes.near, 0), distance(planes.near, 1)), max(distance(planes.near, 2), ray[6]));
      StreamFloats exit =
          min(min(distance(planes.far, 0), distance(planes.far, 1)), min(distance(planes.far, 2), ray[7]));
      StreamBits list_entry = (as<std::uint32_t>(entry) & StreamBits(~index_mask)) | index;
      lists[child] += compress_store(lists[child], (entry <= exit) & taking_part, list_entry);
    }
  }

  // The nearest on top, by where the first ray of each list enters; where any hit will do, the first.
  template <bool sorts>
  bool push_children(const WideNode& node, const WaitingList& at, std::uint32_t room,
                     ListEntry* const (&ends)[tree_width]) {
    WaitingList* const base = top_;
    for (std::uint32_t children = node.occupied; children != 0;) {
      const auto child = static_cast<std::uint32_t>(std::bit_width(children) - 1);
      children ^= 1u << child;
      const std::uint32_t begin = at.end + child * room,
                          size = static_cast<std::uint32_t>(ends[child] - entries_) - begin;
      if (size == 0) continue;
      WaitingList* place = top_++;
      if constexpr (sorts)
        for (; place != base && entries_[place[-1].begin] < entries_[begin]; --place) *place = place[-1];
      *place = {node.child[child], begin, size, at.end + tree_width * room};
      if (refers_to_leaf(node.child[child]) && prefetches_leaves_)
        of_.calls_.prefetch_leaf(of_, node.child[child]);
      else
        raylanes::prefetch<OfCorners>(tree_, node.child[child]);
    }
    return top_ != base;
  }

  void trace_singly(const WaitingList& at) {
    of_.calls_.trace_singly(of_, at.reference, entries_ + at.begin, at.size);
  }

  StreamOctant<Counters>& of_;
  const TreeView& tree_;
  const StreamRow* const rows_;
  const bool prefetches_leaves_;
  ListEntry* entries_;
  std::size_t max_entries_;
  WaitingList stack_[max_stack], *top_ = stack_;
};

}  // namespace
}  // namespace raylanes

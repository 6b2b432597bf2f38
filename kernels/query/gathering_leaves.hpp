// The leaves of streams that gather what rays meet before anything is made of it: a register of rays against one
// triangle at a time.
#pragma once

#include "../traverse/streams.hpp"

namespace raylanes {
namespace {

// The hits of rays, a column for each number: the ray; the leaf triangle; the primitive, which takes 28 bits, with
// the sign of the side above.
struct FoundColumns {
  std::uint32_t *ray, *leaf_triangle, *primitive;
  std::size_t size, room;
  static constexpr std::uint32_t sign = 0x80000000u;

  int side(std::size_t k) const { return (primitive[k] & sign) != 0 ? -1 : 1; }
  std::uint32_t of_mesh(std::size_t k) const { return primitive[k] & ~sign; }
  // Adds the hits of a register of rays, for which there is room: the side is against the normal where the bits of
  // `against` have the sign.
  void append(FloatMask<stream_lanes> lanes, StreamBits rays, StreamBits against, std::uint32_t triangle,
              std::uint32_t primitive_of_mesh) {
    compress_store(ray + size, lanes, rays);
    compress_store(leaf_triangle + size, lanes, StreamBits(triangle));
    size += static_cast<std::size_t>(compress_store(
        primitive + size, lanes, StreamBits(primitive_of_mesh) | (against & StreamBits(sign))));
  }
};

// Self has:
//   make_room()                              before a register of rays; false: no more is wanted
//   segment(packed, ends)                    where rays begin and end
//   names(packed, list)                      what hits of rays go by
//   put(lanes, names, against, leaf_triangle, primitive)
//   put_undecided(lanes, list, leaf_triangle)
template <class Self, class Test, class Counters>
class GatheringLeaves : public StreamOctant<Counters> {
  using Base = StreamOctant<Counters>;

 protected:
  using Base::counters, Base::farthest_, Base::needs_, Base::rays_, Base::tree_;

  template <class Batch>
  GatheringLeaves(StreamNeeds needs, const TreeView& tree, const Batch& batch)
      : Base(Base::template calls_of<Self>, with_rays(needs, tree), tree, batch) {}

  void gather(TreeReference leaf, const ListEntry* list, std::uint32_t size) {
    const LeafBlock<9>& block = leaf_block<Test>(tree_, leaf);
    const int triangles = leaf_size(leaf);
    counters().leaf();
    const LeafScreen screen(block, triangles, farthest_, needs_.scale);
    for (std::uint32_t i = 0; i < size && self().make_room(); i += stream_lanes) {
      const void *rows[stream_lanes], *ends[stream_lanes];
      for (int lane = 0; lane < stream_lanes; ++lane) {
        const std::uint32_t ray = index_of(list[i + static_cast<std::uint32_t>(lane)]);
        rows[lane] = rays_.packed + ray, ends[lane] = rays_.rows[ray].half();
      }
      StreamFloats packed[row_floats], columns[4];
      load_rows(rows, packed), load_rows(ends, columns);
      const RayLanes<StreamFloats> rays{vec3(packed), vec3(packed + 3)};
      const auto segment = self().segment(packed, columns);
      const StreamBits names = self().names(packed, list + i);
      const auto going = FloatMask<stream_lanes>::first(size - i < stream_lanes ? size - i : stream_lanes);
      for (int triangle = 0; triangle < triangles; ++triangle) {
        counters().triangles(bits(going));
        const auto verdict = screen.classify(rays, packed[6], triangle, segment);
        const auto certain = verdict.certain & going, undecided = verdict.undecided & going;
        counters().hits(bits(certain)), counters().undecided(bits(undecided));
        const std::uint32_t leaf_triangle = leaf_triangle_of(leaf, triangle);
        // Without a branch: half of the registers have a hit, and nothing foretells which.
        self().put(certain, names, as<std::uint32_t>(-verdict.det), leaf_triangle, block.primitive[triangle]);
        if (any(undecided)) [[unlikely]]
          self().put_undecided(bits(undecided), list + i, leaf_triangle);
      }
    }
  }

 private:
  Self& self() { return static_cast<Self&>(*this); }
  static StreamNeeds with_rays(StreamNeeds needs, const TreeView& tree) {
    needs.packs_rays = needs.packs_lengths = true, needs.scale = screen_scale<Test>(tree.bounds);
    return needs;
  }
};

}  // namespace
}  // namespace raylanes

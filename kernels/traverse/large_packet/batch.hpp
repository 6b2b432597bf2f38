// A batch of rays with a common origin as large packets. Groups of consecutive rays are sorted into tiles of each face
// of the cube around the origin, so that any order of groups makes compact packets (sort-tile-recursive: Leutenegger,
// Lopez, Edgington 1997). Rays that no packet takes are traced one by one.
#pragma once

#include "packet.hpp"
#include "winners.hpp"

namespace raylanes {
namespace {

inline constexpr int most_tiles = 4096;

// A group of consecutive rays, as one face of the cube sees it.
struct GroupPlace {
  std::uint32_t first;  // the number of its first ray
  std::uint8_t face;
  bool is_first_face;  // of two that see it
  float x, y;          // slopes of one of its rays
};

class LargePacketScratch {
 public:
  LargePacketRays* rays;
  GroupPlace *places, *of_face;
  std::uint32_t* sorted;
  std::uint32_t* counts;  // of tiles

  LargePacketScratch(void* scratch, std::size_t count) : next_(static_cast<std::byte*>(scratch)) {
    const std::size_t most = places_of(count);
    rays = take<LargePacketRays>(1);
    places = take<GroupPlace>(most), of_face = take<GroupPlace>(most);
    sorted = take<std::uint32_t>(most), counts = take<std::uint32_t>(most_tiles + 1);
  }
  static constexpr std::size_t bytes(std::size_t count) {
    return sizeof(LargePacketRays) + places_of(count) * (2 * sizeof(GroupPlace) + sizeof(std::uint32_t)) +
           (most_tiles + 1) * sizeof(std::uint32_t) + 5 * 64;
  }

 private:
  // Two faces a group.
  static constexpr std::size_t places_of(std::size_t count) {
    return 2 * ((count + group_lanes - 1) / group_lanes);
  }
  template <class T>
  T* take(std::size_t count) {
    T* const here = reinterpret_cast<T*>(next_);
    next_ += (count * sizeof(T) + 63) / 64 * 64;
    return here;
  }

  std::byte* next_;
};

// Tiles of a face: strips of equal height, and columns in each, forth and back.
class FaceTiles {
 public:
  FaceTiles(const GroupPlace* places, std::uint32_t count) {
    lo_x_ = lo_y_ = 1.0f;
    float hi_x = -1.0f, hi_y = -1.0f;
    for (std::uint32_t i = 0; i < count; ++i) {
      lo_x_ = places[i].x < lo_x_ ? places[i].x : lo_x_, hi_x = places[i].x > hi_x ? places[i].x : hi_x;
      lo_y_ = places[i].y < lo_y_ ? places[i].y : lo_y_, hi_y = places[i].y > hi_y ? places[i].y : hi_y;
    }
    const float width = hi_x - lo_x_ + 1e-6f, height = hi_y - lo_y_ + 1e-6f;
    const float packets = static_cast<float>(count) / most_groups;
    strips_ = rounded(Floats<1>(sqrt(Floats<1>(packets * height / width))).raw, most_tiles / 8);
    columns_ = rounded(8.0f * packets / static_cast<float>(strips_), most_tiles / strips_);
    scale_x_ = static_cast<float>(columns_) / width, scale_y_ = static_cast<float>(strips_) / height;
  }
  int count() const { return strips_ * columns_; }
  int of(const GroupPlace& place) const {
    const int strip = at_most(static_cast<int>((place.y - lo_y_) * scale_y_), strips_ - 1);
    const int column = at_most(static_cast<int>((place.x - lo_x_) * scale_x_), columns_ - 1);
    return strip * columns_ + (strip % 2 == 0 ? column : columns_ - 1 - column);
  }

 private:
  static int at_most(int i, int last) { return i < last ? i : last; }
  static int rounded(float x, int most) {
    const int i = x < static_cast<float>(most) ? static_cast<int>(x + 0.5f) : most;
    return i < 1 ? 1 : i;
  }

  float lo_x_, lo_y_, scale_x_, scale_y_;
  int strips_, columns_;
};

template <class Test, bool only_decides>
class LargePackets {
 public:
  LargePackets(const TreeView& tree, const TraceBatch& batch)
      : tree_(tree),
        batch_(batch),
        origin_(batch.rays[0].origin),
        reach_(reach(batch.rays[0], tree.bounds)),
        triangles_(tree, origin_),
        scratch_(batch.scratch, batch.size) {}

  void trace() {
    const std::uint32_t places = find_places();
    for (int face = 0; face < cube_faces; ++face) {
      std::uint32_t count = 0;
      for (std::uint32_t i = 0; i < places; ++i)
        if (scratch_.places[i].face == face) scratch_.of_face[count++] = scratch_.places[i];
      if (count > 0) trace_face(face, count);
    }
  }

 private:
  // The faces that the first and the last ray of a group go through see all of it, almost always.
  std::uint32_t find_places() {
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < batch_.size; i += group_lanes) {
      const GroupPlace first = place_of(i, i, true), last = place_of(i, last_of(i), false);
      scratch_.places[count++] = first;
      if (last.face != first.face) scratch_.places[count++] = last;
    }
    return count;
  }
  std::size_t last_of(std::size_t first) const {
    return (batch_.size - first < group_lanes ? batch_.size : first + group_lanes) - 1;
  }
  GroupPlace place_of(std::size_t first, std::size_t number, bool is_first) const {
    const Float3& d = batch_.rays[number].direction;
    const int face = CubeFace::number_of(d);
    const SharedAxes axes(shear_axes(CubeFace(face).axis, CubeFace(face).is_negative));
    const float size = __builtin_fabsf(d[axes.order[2]]);
    return {static_cast<std::uint32_t>(first), static_cast<std::uint8_t>(face), is_first,
            slope_or_zero(d[axes.order[0]] / size), slope_or_zero(d[axes.order[1]] / size)};
  }
  static float slope_or_zero(float slope) { return slope >= -1.0f && slope <= 1.0f ? slope : 0.0f; }

  void trace_face(int face, std::uint32_t count) {
    const FaceTiles tiles(scratch_.of_face, count);
    for (int tile = 0; tile <= tiles.count(); ++tile) scratch_.counts[tile] = 0;
    for (std::uint32_t i = 0; i < count; ++i) ++scratch_.counts[tiles.of(scratch_.of_face[i]) + 1];
    for (int tile = 0; tile < tiles.count(); ++tile) scratch_.counts[tile + 1] += scratch_.counts[tile];
    for (std::uint32_t i = 0; i < count; ++i)
      scratch_.sorted[scratch_.counts[tiles.of(scratch_.of_face[i])]++] = i;
    const PacketFrame frame(origin_, CubeFace(face), reach_);
    LargePacketRays& rays = *scratch_.rays;
    rays.groups = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      add_group(scratch_.of_face[scratch_.sorted[i]], frame);
      if (rays.groups == most_groups || (i + 1 == count && rays.groups > 0)) {
        rays.fill_up();
        LargePacket<Test, only_decides>(tree_, batch_, frame, reach_, rays).trace();
        store_answers();
        rays.groups = 0;
      }
    }
  }

  [[gnu::noinline, gnu::flatten]] void add_group(const GroupPlace& place, const PacketFrame& frame) {
    const Ray* lines[group_lanes];
    for (std::size_t lane = 0; lane < group_lanes; ++lane) {
      const std::size_t number = place.first + lane;
      lines[lane] = batch_.rays + (number < batch_.size ? number : batch_.size - 1);
    }
    RayColumns columns(lines);
    const SharedOriginLanes shared(columns, origin_);
    const std::uint32_t present = first_lanes<group_lanes>(batch_.size - place.first);
    const std::uint32_t taken = shared.seen_by(place.face) & present;
    LargePacketRays& rays = *scratch_.rays;
    if (taken != 0) rays.set_group(rays.groups++, place.first, taken, columns, frame);
    if (place.is_first_face) trace_others(place, shared, taken, present);
  }
  // Rays that neither of the group's faces sees.
  void trace_others(const GroupPlace& place, const SharedOriginLanes& shared, std::uint32_t taken,
                    std::uint32_t present) {
    std::uint32_t others = present & ~taken;
    if (others == 0) return;
    const int last = CubeFace::number_of(batch_.rays[last_of(place.first)].direction);
    if (last != place.face) others &= ~shared.seen_by(last);
    for (; others != 0; others &= others - 1)
      trace_alone(place.first + static_cast<std::size_t>(std::countr_zero(others)));
  }
  void trace_alone(std::size_t number) {
    TraceBatch one = batch_;
    one.rays += number, one.size = 1;
    if constexpr (only_decides) {
      one.occluded += number;
      any_single<Test>(tree_, one);
    } else {
      one.hits += number;
      closest_single<Test>(tree_, one);
    }
  }

  void store_answers() {
    const LargePacketRays& rays = *scratch_.rays;
    for (int g = 0; g < rays.groups; ++g) {
      if constexpr (only_decides)
        for (std::uint32_t lanes = rays.taken[g]; lanes != 0; lanes &= lanes - 1) {
          const int lane = std::countr_zero(lanes);
          batch_.occluded[rays.first[g] + static_cast<std::size_t>(lane)] =
              (rays.going[g] >> lane & 1u) == 0 ? 1 : 0;
        }
      else
        store_hits(tree_, rays, g, triangles_, batch_);
    }
  }

  const TreeView& tree_;
  const TraceBatch& batch_;
  Float3 origin_;
  float reach_;
  TrianglesFromOrigin triangles_;
  LargePacketScratch scratch_;
};

inline bool can_be_large_packets(const TreeView& tree, const TraceBatch& batch) {
  return batch.size > 0 && tree.root != empty_reference && can_be_shared(batch.rays[0].origin, tree.bounds);
}
template <class Test>
void closest_large_packet(const TreeView& tree, const TraceBatch& batch) {
  if (!can_be_large_packets(tree, batch)) return closest_single<Test>(tree, batch);
  LargePackets<Test, false>(tree, batch).trace();
}
template <class Test>
void any_large_packet(const TreeView& tree, const TraceBatch& batch) {
  if (!can_be_large_packets(tree, batch)) return any_single<Test>(tree, batch);
  LargePackets<Test, true>(tree, batch).trace();
}

}  // namespace
}  // namespace raylanes

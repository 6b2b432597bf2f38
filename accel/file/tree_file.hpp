// Trees in files: their beginning, their checksum, arrays that are read without trust in counts, and the validation of
// what was read. docs/tree_file.md has the layout.
#pragma once

#include <iosfwd>

#include "../doubles/bvh_d_arrays.hpp"
#include "../layout/kdtree_arrays.hpp"
#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

// Trees are BvhArrays or BvhDArrays.

// Throws std::runtime_error if the stream does not take it.
template <class Tree>
void save_tree(const Tree& tree, std::ostream& file);

// Reads what save_tree wrote, and nothing behind it. Throws std::runtime_error, in one line, for anything else: memory
// is asked for as the file turns out to hold what it says.
template <class Tree>
Tree load_tree(std::istream& file);

// Saves and loads like save_tree and load_tree.
void save_cells(const KdTreeArrays& tree, std::ostream& file);
KdTreeArrays load_cells(std::istream& file);

// --- The common parts.
// The kind of the object in a file.
enum class FileKind : std::uint8_t {
  bvh,
  bvh_of_doubles,
  kd_tree,
  scene,
  nested_scene,
  scene_of_doubles,
  nested_scene_of_doubles
};

struct FilePart {
  const void* bytes;
  std::size_t size;
};
// The start of a file, and its parts behind it. Throws std::runtime_error if the stream does not take them.
void write_tree(std::ostream& file, FileKind kind, std::uint32_t version, std::span<const FilePart> parts);

// Throws std::runtime_error in one line.
[[noreturn]] void refuse_file(const std::string& why);

// Earlier versions stored the number of a triangle test, up to this, and the same leaves for each.
inline constexpr std::uint32_t max_older_test = 7;
void require_older_test(std::uint32_t test);

// A file from its start on, which must have that kind and version.
class TreeReader {
 public:
  TreeReader(std::istream& file, FileKind kind, std::uint32_t version);
  ~TreeReader();
  TreeReader(const TreeReader&) = delete;
  TreeReader& operator=(const TreeReader&) = delete;

  void read(void* to, std::size_t size);
  // Reads `count` elements of `size` bytes: grow(n) makes memory for n more and returns its address.
  template <class Grow>
  void read_array(std::uint64_t count, std::size_t size, const Grow& grow) {
    constexpr std::uint64_t step_bytes = std::uint64_t{1} << 26;
    require_room(count, size);
    for (std::uint64_t done = 0; done < count;) {
      const std::uint64_t step = knows_its_end() ? count : std::max(step_bytes / size, done);
      const auto n = static_cast<std::size_t>(std::min(step, count - done));
      read(grow(n), n * size);
      done += n;
    }
  }
  template <class T, class Allocator>
  void read_array(std::uint64_t count, std::vector<T, Allocator>& to) {
    read_array(count, sizeof(T), [&](std::size_t n) {
      to.resize(to.size() + n);
      return to.data() + to.size() - n;
    });
  }
  template <class T>
  void read_array(std::uint64_t count, Array<T>& to) {
    to = Array<T>();
    read_array(count, sizeof(T), [&](std::size_t n) { return grow(to, n); });
  }
  // Reads leaves of triangles with corners.
  void read_array(std::uint64_t count, Leaves& to);
  // Refuses the file unless all that was read is what was written.
  void require_checksum() const;

 private:
  bool knows_its_end() const { return left_ >= 0; }
  void require_room(std::uint64_t count, std::size_t size) const;
  void read_unchecked(void* to, std::size_t size);

  std::istream& file_;
  std::int64_t left_ = -1;  // bytes in the file; −1: nobody knows
  std::uint64_t expected_ = 0;
  std::unique_ptr<class Checksum> checksum_;
};

// Throws std::runtime_error, which names the offender.
[[noreturn]] void refuse(const char* what, std::size_t number, const char* why);

// Whether both are finite, and not inverted.
template <class T>
bool is_box(T lo, T hi) {
  return std::isfinite(lo) && std::isfinite(hi) && lo <= hi;
}

// Refuses bounds that are none; of an empty tree, those that are some.
template <class AnyBox>
void validate_bounds(const AnyBox& bounds, bool is_empty) {
  constexpr auto none = empty_box_of<AnyBox, typename decltype(AnyBox::lo)::value_type>();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!is_empty && !is_box(bounds.lo[axis], bounds.hi[axis])) refuse("bounds along axis", axis, "are none");
  if (is_empty && (bounds.lo != none.lo || bounds.hi != none.hi))
    refuse("bounds of", 0, "triangles are not empty");
}

// The bytes of a block of eight triangles with corners of floats, and of half a leaf of doubles.
inline constexpr std::size_t block_bytes = sizeof(LeafBlock<9>);

// The blocks of a leaf of so many triangles whose corners have numbers of type T.
template <class T>
constexpr std::size_t blocks_of_leaf(std::size_t size) {
  return std::is_same_v<T, float> ? 1 : halves_of_leaf(static_cast<std::uint32_t>(size));
}

// Whether nine rows of `lanes` numbers are finite in the first `size` lanes and NaN in the others. By
// their bits without a branch, for registers of lanes.
template <std::size_t lanes, class T>
bool has_corners(const T* numbers, std::size_t size) {
  using Bits = std::conditional_t<std::is_same_v<T, float>, std::int32_t, std::int64_t>;
  constexpr Bits no_sign = std::numeric_limits<Bits>::max(),
                 infinite = std::bit_cast<Bits>(std::numeric_limits<T>::infinity());
  Bits negate[lanes], all[lanes];
  for (std::size_t lane = 0; lane < lanes; ++lane) negate[lane] = lane < size ? 0 : -1, all[lane] = -1;
  for (std::size_t k = 0; k < 9; ++k)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Bits above = (std::bit_cast<Bits>(numbers[k * lanes + lane]) & no_sign) - infinite;
      all[lane] &= (above ^ negate[lane]) - negate[lane];
    }
  return std::all_of(all, all + lanes, [](Bits bits) { return bits < 0; });
}

// Refuses the leaf that begins at that block unless its first `size` lanes have finite corners and a triangle of the
// mesh, and the others NaN and no_primitive. The bits behind lanes must be set. `take` gets the triangles.
template <class T, class Take>
void validate_leaf(const void* blocks, std::size_t index, std::size_t size, std::size_t mesh_triangles,
                   const Take& take) {
  const std::size_t leaf_bytes = block_bytes * blocks_of_leaf<T>(size),
                    lanes = std::is_same_v<T, float> ? tree_width
                                                     : lanes_of_leaf(static_cast<std::uint32_t>(size));
  const auto* const leaf = static_cast<const std::byte*>(blocks) + block_bytes * index;
  const auto* const numbers = reinterpret_cast<const T*>(leaf);
  const auto* const primitives = reinterpret_cast<const std::uint32_t*>(numbers + 9 * lanes);
  for (std::size_t lane = 0; lane < lanes; ++lane)
    if (lane < size ? primitives[lane] >= mesh_triangles : primitives[lane] != no_primitive)
      refuse("block", index, "has a triangle that the mesh has not");
  if (!(lanes == tree_width ? has_corners<tree_width>(numbers, size)
                            : has_corners<tree_width / 2>(numbers, size)))
    refuse("block", index, "has a corner that is none");
  for (std::size_t lane = 0; lane < size; ++lane) take(primitives[lane]);
  const auto* const behind = reinterpret_cast<const std::byte*>(primitives + lanes);
  if (std::any_of(behind, leaf + leaf_bytes, [](std::byte byte) { return byte != std::byte{0xff}; }))
    refuse("block", index, "has something behind it");
}

}  // namespace raylanes

// The common parts of tree files: their beginning, their checksum, arrays that are read without trust in counts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "../layout/leaves.hpp"

namespace raylanes {

// The kind of the object in a file.
enum class FileKind : std::uint8_t { bvh, bvh_of_doubles, kd_tree, scene };

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

}  // namespace raylanes

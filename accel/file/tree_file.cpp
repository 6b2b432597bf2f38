#include "tree_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <istream>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>

// Its functions here, not in a library to link.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "valid_tree.hpp"

namespace raylanes {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the file has the numbers of little-endian machines");

// With an end of line and one of text, which careless copies change.
constexpr std::array<char, 16> magic{'r', 'a', 'y', 'l', 'a', 'n',  'e',  's',
                                     ' ', 't', 'r', 'e', 'e', '\r', '\n', '\x1a'};
constexpr std::uint32_t byte_order = 0x04030201u, version = 1;

// The file's first bytes. The checksum is of all that comes behind it, to the end of the tree.
struct Start {
  std::array<char, 16> magic;
  std::uint32_t byte_order, version;
  std::uint64_t checksum;
};
struct Header {
  std::uint64_t nodes, blocks, left_out, mesh_triangles;
  double built_cost;
  Box bounds;
  Float3 direction;
  std::uint32_t root, test, builder;
};
static_assert(sizeof(Start) == 32 && sizeof(Header) == 88 && alignof(Header) == 8, "no padding");

// Of the builder.
constexpr std::uint32_t optimised_bit = 0x80000000u;

class Checksum {
 public:
  Checksum() { XXH3_64bits_reset(&state_); }
  void add(const void* bytes, std::size_t size) { XXH3_64bits_update(&state_, bytes, size); }
  std::uint64_t value() const { return XXH3_64bits_digest(&state_); }

 private:
  XXH3_state_t state_;
};

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error("tree file: " + why);
}

// --- Writing

struct Part {
  const void* bytes;
  std::size_t size;
};

Header header_of(const WideTree& tree) {
  Header header{};
  header.nodes = tree.nodes.size(), header.blocks = tree.corners.count();
  header.left_out = tree.left_out.size(), header.mesh_triangles = tree.mesh_triangles;
  header.built_cost = tree.built_cost, header.bounds = tree.bounds;
  header.direction = tree.built_with.direction;
  header.root = tree.root, header.test = static_cast<std::uint32_t>(tree.prepared_for);
  header.builder =
      static_cast<std::uint32_t>(tree.built_with.builder) | (tree.built_with.optimise ? optimised_bit : 0);
  return header;
}

// --- Reading

class Reader {
 public:
  explicit Reader(std::istream& file) : file_(file) {
    // Where the stream knows its end each array is read at once; else by steps, so that no size is trusted.
    const auto here = file.tellg();
    if (here == std::istream::pos_type(-1)) return;
    file.seekg(0, std::ios::end);
    left_ = file.tellg() - here;
    file.seekg(here);
  }

  void read(void* to, std::size_t size) {
    file_.read(static_cast<char*>(to), static_cast<std::streamsize>(size));
    if (static_cast<std::size_t>(file_.gcount()) != size) refuse("it ends before the tree does");
  }
  void read_checked(void* to, std::size_t size) {
    read(to, size);
    checksum_.add(to, size);
  }
  // `count` elements of `size` bytes: grow(n) makes room for n more and says where.
  template <class Grow>
  void read_array(std::uint64_t count, std::size_t size, const Grow& grow) {
    constexpr std::uint64_t step_bytes = std::uint64_t{1} << 26;
    if (left_ >= 0 && count > static_cast<std::uint64_t>(left_) / size)
      refuse("it ends before the tree does");
    for (std::uint64_t done = 0; done < count;) {
      const std::uint64_t step = left_ >= 0 ? count : std::max(step_bytes / size, done);
      const auto n = static_cast<std::size_t>(std::min(step, count - done));
      read_checked(grow(n), n * size);
      done += n;
    }
  }
  std::uint64_t checksum() const { return checksum_.value(); }

 private:
  std::istream& file_;
  std::streamoff left_ = -1;  // bytes in the file; −1: nobody knows
  Checksum checksum_;
};

Start read_start(Reader& reader) {
  Start start;
  reader.read(&start, sizeof start);
  if (start.magic != magic) refuse("it does not begin as one does");
  if (start.byte_order != byte_order) refuse("its numbers have another byte order");
  if (start.version != version)
    refuse("version " + std::to_string(start.version) + ", this library reads " + std::to_string(version));
  return start;
}

template <class T>
void read_vector(Reader& reader, std::uint64_t count, std::vector<T>& to) {
  reader.read_array(count, sizeof(T), [&](std::size_t n) {
    to.resize(to.size() + n);
    return to.data() + to.size() - n;
  });
}

// Numbers that no tree has, before they are multiplied or cast.
void require_possible(const Header& header) {
  if (header.nodes >= leaf_bit || header.blocks > leaf_block_mask ||
      header.mesh_triangles > max_mesh_triangles || header.left_out > header.mesh_triangles)
    refuse("its counts are impossible");
  if (header.test >= std::size(triangle_tests))
    refuse("test " + std::to_string(header.test) + " does not exist");
  const std::uint32_t builder = header.builder & ~optimised_bit;
  if (builder >= tree_builder_names.size()) refuse("builder " + std::to_string(builder) + " does not exist");
}

}  // namespace

void save_tree(const WideTree& tree, std::ostream& file) {
  const Header header = header_of(tree);
  const Part parts[] = {{&header, sizeof header},
                        {tree.nodes.data(), tree.nodes.size() * sizeof(WideNode)},
                        {tree.corners.blocks(), tree.corners.bytes()},
                        {tree.left_out.data(), tree.left_out.size() * sizeof(std::uint32_t)}};
  Checksum checksum;
  for (const Part& part : parts) checksum.add(part.bytes, part.size);
  const Start start{magic, byte_order, version, checksum.value()};
  file.write(reinterpret_cast<const char*>(&start), sizeof start);
  for (const Part& part : parts)
    file.write(static_cast<const char*>(part.bytes), static_cast<std::streamsize>(part.size));
  file.flush();
  if (!file) refuse("it cannot be written");
}

WideTree load_tree(std::istream& file) {
  if (!file) refuse("it cannot be read");
  Reader reader(file);
  const Start start = read_start(reader);
  Header header;
  reader.read_checked(&header, sizeof header);
  WideTree tree;
  require_possible(header);
  read_vector(reader, header.nodes, tree.nodes);
  tree.corners = Leaves(TriangleTest::exact, {}, 0);
  reader.read_array(header.blocks, sizeof(LeafBlock<9>), [&](std::size_t n) { return tree.corners.grow(n); });
  read_vector(reader, header.left_out, tree.left_out);
  if (reader.checksum() != start.checksum) refuse("its checksum is wrong: it was damaged");
  tree.root = header.root, tree.bounds = header.bounds;
  tree.mesh_triangles = static_cast<std::size_t>(header.mesh_triangles);
  tree.built_cost = header.built_cost;
  tree.built_with.test = static_cast<TriangleTest>(header.test);
  tree.built_with.builder = static_cast<TreeBuilder>(header.builder & ~optimised_bit);
  tree.built_with.optimise = (header.builder & optimised_bit) != 0;
  tree.built_with.direction = header.direction;
  validate_tree(tree);
  prepare_leaves(tree, tree.built_with.test, header.direction);
  return tree;
}

}  // namespace raylanes

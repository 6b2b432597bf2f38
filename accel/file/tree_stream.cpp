#include <istream>
#include <ostream>

#include "tree_file.hpp"

// xxHash as a header: there is no library to link.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace raylanes {

class Checksum {
 public:
  Checksum() { XXH3_64bits_reset(&state_); }
  void add(const void* bytes, std::size_t size) { XXH3_64bits_update(&state_, bytes, size); }
  std::uint64_t value() const { return XXH3_64bits_digest(&state_); }

 private:
  XXH3_state_t state_;
};

namespace {

static_assert(std::endian::native == std::endian::little,
              "the file has the numbers of little-endian machines");

constexpr std::uint32_t byte_order = 0x04030201u;

// With an end of line and one of text, which careless copies change.
using Magic = std::array<char, 16>;
struct KindOfFile {
  Magic magic;
  const char* name;
};
constexpr KindOfFile kind_named(const char (&word)[5], const char* name) {
  return {
      {'r', 'a', 'y', 'l', 'a', 'n', 'e', 's', ' ', word[0], word[1], word[2], word[3], '\r', '\n', '\x1a'},
      name};
}
// Indexed by FileKind.
constexpr KindOfFile kinds[] = {kind_named("tree", "Bvh"),
                                kind_named("doub", "BvhD"),
                                kind_named("cell", "KdTree"),
                                kind_named("scen", "Scene"),
                                kind_named("nest", "scene in a Scene"),
                                kind_named("scnd", "SceneD"),
                                kind_named("nesd", "scene in a SceneD")};
const KindOfFile& info_of(FileKind kind) {
  return kinds[static_cast<std::size_t>(kind)];
}

void require_kind(const Magic& magic, FileKind kind) {
  const KindOfFile& wanted = info_of(kind);
  if (magic == wanted.magic) return;
  for (const KindOfFile& other : kinds)
    if (magic == other.magic)
      refuse_file(std::string("it begins as that of a ") + other.name + " does, not as that of a " +
                  wanted.name);
  refuse_file("it does not begin as one does");
}

// The file's first bytes. The checksum is of all that comes after it, to the end of the tree.
struct Start {
  Magic magic;
  std::uint32_t byte_order, version;
  std::uint64_t checksum;
};
static_assert(sizeof(Start) == 32, "no padding");

}  // namespace

void refuse_file(const std::string& why) {
  throw std::runtime_error("tree file: " + why);
}

void refuse(const char* what, std::size_t number, const char* why) {
  throw std::runtime_error(std::string("tree: ") + what + ' ' + std::to_string(number) + ' ' + why);
}

void require_older_test(std::uint32_t test) {
  if (test > max_older_test) refuse_file("test " + std::to_string(test) + " does not exist");
}

void write_tree(std::ostream& file, FileKind kind, std::uint32_t version, std::span<const FilePart> parts) {
  Checksum checksum;
  for (const FilePart& part : parts) checksum.add(part.bytes, part.size);
  const Start start{info_of(kind).magic, byte_order, version, checksum.value()};
  file.write(reinterpret_cast<const char*>(&start), sizeof start);
  for (const FilePart& part : parts)
    file.write(static_cast<const char*>(part.bytes), static_cast<std::streamsize>(part.size));
  file.flush();
  if (!file) refuse_file("it cannot be written");
}

TreeReader::TreeReader(std::istream& file, FileKind kind, std::uint32_t version)
    : file_(file), checksum_(std::make_unique<Checksum>()) {
  if (!file) refuse_file("it cannot be read");
  // If the stream knows its end, each array is read at once; else in steps, so that no size is trusted.
  const auto here = file.tellg();
  if (here != std::istream::pos_type(-1)) {
    file.seekg(0, std::ios::end);
    left_ = file.tellg() - here;
    file.seekg(here);
  }
  Start start;
  read_unchecked(&start, sizeof start);
  require_kind(start.magic, kind);
  if (start.byte_order != byte_order) refuse_file("its numbers have another byte order");
  if (start.version != version)
    refuse_file("version " + std::to_string(start.version) + ", this library reads " +
                std::to_string(version));
  expected_ = start.checksum;
}
TreeReader::~TreeReader() = default;

void TreeReader::read_unchecked(void* to, std::size_t size) {
  file_.read(static_cast<char*>(to), static_cast<std::streamsize>(size));
  if (static_cast<std::size_t>(file_.gcount()) != size) refuse_file("it ends before the tree does");
}
void TreeReader::read(void* to, std::size_t size) {
  read_unchecked(to, size);
  checksum_->add(to, size);
}
void TreeReader::require_room(std::uint64_t count, std::size_t size) const {
  if (knows_its_end() && count > static_cast<std::uint64_t>(left_) / size)
    refuse_file("it ends before the tree does");
}
void TreeReader::read_array(std::uint64_t count, Leaves& to) {
  to = Leaves(0);
  read_array(count, sizeof(LeafBlock<9>), [&](std::size_t n) { return to.grow(n); });
}
void TreeReader::require_checksum() const {
  if (checksum_->value() != expected_) refuse_file("its checksum is wrong: it was damaged");
}

}  // namespace raylanes

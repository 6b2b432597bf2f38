// Trees as bytes: what is loaded traces as what was saved did, and what is cut or damaged is refused.
#include <streambuf>

#include <raylanes/scene.hpp>

#include "../fuzz/damaged_file.hpp"
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"
#include "both_trees.hpp"

namespace raylanes::testing {
namespace {

template <class Tree>
class SavedTrees : public ::testing::Test {};
TYPED_TEST_SUITE(SavedTrees, SavedKinds, TreeKindNames);

// Says what is in it, but neither where it is nor how much is left.
class Pipe : public std::streambuf {
 public:
  explicit Pipe(const std::string& bytes) : bytes_(bytes) {}

 protected:
  int_type underflow() override {
    if (next_ == bytes_.size()) return traits_type::eof();
    byte_ = bytes_[next_++];
    setg(&byte_, &byte_, &byte_ + 1);
    return traits_type::to_int_type(byte_);
  }

 private:
  std::string bytes_;
  std::size_t next_ = 0;
  char byte_ = 0;
};

TYPED_TEST(SavedTrees, trace_the_same_bytes) {
  for (const std::size_t size : {0u, 1u, 8u, 9u, 65u, 700u}) {
    SCOPED_TRACE(size);
    const auto mesh = soup_for<TypeParam>(size, size);
    const auto rays = rays_for(mesh, by_level(300), 71);
    const auto tree = built<TypeParam>(mesh);
    const std::string bytes = saved(tree);
    const auto again = loaded<TypeParam>(bytes);
    for (const TriangleTestInfo& test : triangle_tests)
      if (serves<TypeParam>(test.test)) expect_same(tree, again, rays, test.test);
    EXPECT_EQ(saved(again), bytes);
  }
  expect_same(TypeParam(), loaded<TypeParam>(saved(TypeParam())), rays_for(soup_for<TypeParam>(0, 1), 20, 72),
              TriangleTest::exact);
}

TYPED_TEST(SavedTrees, of_every_builder_trace_the_same_bytes) {
  for (const auto& [name, options] : builds_of<TypeParam>())
    for (const std::size_t size : {0u, 1u, 9u, 500u}) {
      SCOPED_TRACE(name);
      const auto mesh = soup_for<TypeParam>(size, size);
      const auto rays = rays_for(mesh, by_level(200), 71);
      const TypeParam tree(mesh.vertices, mesh.triangles, options);
      const auto again = loaded<TypeParam>(saved(tree));
      expect_same(tree, again, rays, TriangleTest::exact);
      EXPECT_EQ(saved(again), saved(tree));
      EXPECT_EQ(again.report().builder, options.builder);
    }
}

TYPED_TEST(SavedTrees, may_lie_among_other_things_and_come_through_a_pipe) {
  const auto mesh = soup_for<TypeParam>(200, 73);
  const auto rays = rays_for(mesh, 200, 74);
  const auto tree = built<TypeParam>(mesh);
  const std::string bytes = "before" + saved(tree) + saved(TypeParam()) + "behind";
  const auto expect_read = [&](std::istream& file) {
    std::string word(6, ' ');
    file.read(word.data(), 6);
    expect_same(tree, TypeParam::load(file), rays, TriangleTest::exact);
    EXPECT_EQ(TypeParam::load(file).leaf_count(), 0u);
    file.read(word.data(), 6);
    EXPECT_EQ(word, "behind");
  };
  std::istringstream file(bytes);
  expect_read(file);
  Pipe pipe(bytes);
  std::istream stream(&pipe);
  expect_read(stream);
}

TYPED_TEST(SavedTrees, are_refused_if_they_were_cut_anywhere) {
  const std::string bytes = saved(built<TypeParam>(soup_for<TypeParam>(20, 78)));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string cut = bytes.substr(0, size);
    Pipe pipe(cut);
    std::istream stream(&pipe);
    for (const std::string& message : {message_of<std::runtime_error>([&] { loaded<TypeParam>(cut); }),
                                       message_of<std::runtime_error>([&] { TypeParam::load(stream); })})
      ASSERT_NE(message.find("ends before"), std::string::npos) << size << ": " << message;
  }
}

TYPED_TEST(SavedTrees, are_refused_with_any_bit_the_other_way) {
  const auto tree = built<TypeParam>(soup_for<TypeParam>(20, 79));
  std::string bytes = saved(tree);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    char& byte = bytes[bit / 8];
    byte = static_cast<char>(byte ^ 1 << bit % 8);
    ASSERT_THROW(loaded<TypeParam>(bytes), std::runtime_error) << "bit " << bit;
    byte = static_cast<char>(byte ^ 1 << bit % 8);
  }
  EXPECT_EQ(loaded<TypeParam>(bytes).leaf_count(), tree.leaf_count());
}

TYPED_TEST(SavedTrees, say_what_is_wrong) {
  const std::string bytes = saved(built<TypeParam>(soup_for<TypeParam>(20, 80)));
  const auto message = [&](std::size_t at, char byte) {
    std::string wrong = bytes;
    wrong[at] = byte;
    return message_of<std::runtime_error>([&] { loaded<TypeParam>(wrong); });
  };
  expect_words(message(0, 'x'), {"tree file", "begin"});
  expect_words(message(16, 4), {"byte order"});
  expect_words(message(20, 9), {"version 9", "1"});
  expect_words(message(24, static_cast<char>(bytes[24] + 1)), {"checksum"});
  expect_words(message(bytes.size() - 1, 'x'), {"checksum"});
  std::ostringstream full;
  full.setstate(std::ios::badbit);
  expect_words(message_of<std::runtime_error>([&] { TypeParam().save(full); }), {"tree file", "written"});
  std::istringstream bad(bytes);
  bad.setstate(std::ios::badbit);
  expect_words(message_of<std::runtime_error>([&] { TypeParam::load(bad); }), {"tree file", "read"});
}

// Earlier versions stored the number of a triangle test, and the same leaves for each.
TYPED_TEST(SavedTrees, of_earlier_versions_load) {
  constexpr std::size_t at = std::is_same_v<TypeParam, KdTree> ? 100 : 112;
  constexpr char max_test = has_doubles<TypeParam> ? 0 : 7;
  const std::string bytes = saved(built<TypeParam>(soup_for<TypeParam>(20, 81)));
  for (const char test : {char{0}, char{1}, char{7}, char{8}, char{99}}) {
    std::string older = bytes;
    older[at] = test;
    put_right_checksums(older);
    if (test <= max_test)
      EXPECT_EQ(saved(loaded<TypeParam>(older)), bytes);
    else
      expect_words(message_of<std::runtime_error>([&] { loaded<TypeParam>(older); }),
                   {"tree file", has_doubles<TypeParam> ? "unused" : "test " + std::to_string(test)});
  }
}

// The refusal of a file where another kind of tree is loaded.
template <class Wanted>
void expect_refused(const std::string& bytes, const char* kind, const char* wanted) {
  if (std::string(kind) == wanted) return;
  expect_words(message_of<std::runtime_error>([&] { loaded<Wanted>(bytes); }),
               {"begins", "of a " + std::string(kind) + ' ', "not", "of a " + std::string(wanted)});
}

TEST(SavedKinds, are_told_apart) {
  for (const auto& [kind, bytes] : {std::pair<const char*, std::string>{"Bvh", saved(Bvh())},
                                    {"BvhD", saved(BvhD())},
                                    {"KdTree", saved(KdTree())},
                                    {"Scene", saved(Scene())}}) {
    expect_refused<Bvh>(bytes, kind, "Bvh");
    expect_refused<BvhD>(bytes, kind, "BvhD");
    expect_refused<KdTree>(bytes, kind, "KdTree");
    expect_refused<Scene>(bytes, kind, "Scene");
  }
}

}  // namespace
}  // namespace raylanes::testing

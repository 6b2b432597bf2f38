// Trees of C beside the classes: corners, builds, refits and files.
#include "as_cpp.hpp"

namespace raylanes::testing {
namespace {

template <class Kind>
class CTrees : public CCalls<Kind> {};
using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CTrees, Numbers);

TYPED_TEST(CTrees, write_the_corners_of_the_classes) {
  using C = CallsOf<TypeParam>;
  std::vector<HitOf<TypeParam>> hits(count);
  this->cpp_tree.closest(this->rays, hits);
  this->template expect_same<typename C::Corners>(
      "corners", 0,
      [&](auto& corners) {
        return C::corners(this->c_tree.get(), &hits[0].primitive, count, sizeof hits[0],
                          static_cast<TypeParam*>(corners.data()));
      },
      [&](auto& corners) { this->cpp_tree.corners(hits, corners); });
}

TYPED_TEST(CTrees, build_refit_and_save_the_trees_of_the_classes) {
  using C = CallsOf<TypeParam>;
  const auto saved = [](const auto& tree) {
    std::ostringstream file;
    tree.save(file);
    return file.str();
  };
  const auto saved_by_c = [](const auto* tree) {
    std::size_t size = 0;
    EXPECT_EQ(C::save(tree, nullptr, 0, &size), RAYLANES_SMALL_BUFFER);
    Apart<char> bytes(size);
    EXPECT_EQ(C::save(tree, bytes.data(), size, &size), RAYLANES_OK);
    const std::vector<char> all = bytes.values();
    return std::string(all.begin(), all.end());
  };
  const auto& given = this->mesh;
  for (std::int32_t builder = 0; builder < 6; ++builder) {
    if (std::is_same_v<TypeParam, double> && builder == RAYLANES_BUILDER_SPATIAL_SPLITS) continue;
    SCOPED_TRACE(tree_builder_names[static_cast<std::size_t>(builder)]);
    raylanes_build_options c;
    raylanes_init_build_options(&c, sizeof c);
    c.builder = builder, c.optimize = builder % 2, c.threads = builder % 3;
    c.choose = builder == 5, c.rays = 1e6;
    const BuildOptions options{.builder = static_cast<TreeBuilder>(builder),
                               .optimize = builder % 2 == 1,
                               .choose = builder == 5,
                               .rays = 1e6};
    typename C::Tree tree(given.vertices, given.triangles, options);
    const auto of_c = made<TreeOfC<TypeParam>>([&](auto** address) {
      C::create(address, given.vertices.data(), given.vertices.size(), 0, given.triangles.data(),
                given.triangles.size(), 0, &c);
    });
    EXPECT_EQ(saved(tree), saved_by_c(of_c.get()));
    auto other = given.vertices;
    for (auto& vertex : other) std::swap(vertex[0], vertex[2]);
    Apart<PointOf<TypeParam>> moved(other, 4);
    tree.refit(other, given.triangles);
    ASSERT_EQ(C::refit(of_c.get(), moved.data(), other.size(), moved.stride(), given.triangles.data(),
                       given.triangles.size(), 0, 2),
              RAYLANES_OK);
    const std::string bytes = saved(tree);
    EXPECT_EQ(bytes, saved_by_c(of_c.get()));
    Apart<char> file(std::vector<char>(bytes.begin(), bytes.end()), 0);
    const auto loaded =
        made<TreeOfC<TypeParam>>([&](auto** address) { C::load(address, file.data(), bytes.size()); });
    EXPECT_EQ(bytes, saved_by_c(loaded.get()));
  }
}

}  // namespace
}  // namespace raylanes::testing

// The DLL as a program uses it: calls, exceptions through it, files with names that are not ASCII.
#include <gtest/gtest.h>
#include <windows.h>

#include <clocale>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <raylanes/raylanes.hpp>

namespace raylanes::testing {
namespace {

// A fan of triangles around the axis z.
Mesh fan(std::uint32_t triangles) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}}, {}};
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const float share = static_cast<float>(i + 1) / static_cast<float>(triangles);
    mesh.vertices.push_back({1 - 2 * share, share * (1 - share), share});
    mesh.triangles.push_back({0, i + 1, i + 2});
  }
  return mesh;
}
std::vector<Ray> rays_down(std::size_t count) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count);
    rays.push_back({.origin = {1 - 2 * share, 0.1f * share, 4}, .direction = {0, 0, -1}});
  }
  return rays;
}

// Set by Windows, not by the program's own C library. The first test, as the first call keeps what it reads.
TEST(Dll, reads_its_variable_from_the_system) {
  SetEnvironmentVariableA("RAYLANES_PATH", "scalar");
  EXPECT_STREQ(active_path().name, "scalar");
  SetEnvironmentVariableA("RAYLANES_PATH", nullptr);
}

TEST(Dll, gives_a_batch_what_it_gives_single_rays) {
  const Bvh tree(fan(300));
  const std::vector<Ray> rays = rays_down(20'000);
  std::vector<Hit> hits(rays.size());
  tree.closest(rays, hits, {.threads = 0});
  std::size_t found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit hit = tree.closest(rays[i]);
    ASSERT_EQ(hit.t, hits[i].t);
    ASSERT_EQ(hit.primitive, hits[i].primitive);
    found += hit ? 1 : 0;
  }
  EXPECT_GT(found, 1000u);
}

TEST(Dll, throws_what_programs_catch) {
  const Bvh tree(fan(3));
  std::vector<Hit> hits(2);
  EXPECT_THROW(tree.closest(rays_down(3), hits), std::invalid_argument);
  EXPECT_THROW(force_path("none"), std::invalid_argument);
  std::istringstream nothing("nothing");
  EXPECT_THROW(Bvh::load(nothing), std::runtime_error);
}

struct OfThisProgram {
  int value;
};

TEST(Dll, passes_on_exceptions_of_a_filter) {
  const Bvh tree(fan(300));
  const std::vector<Ray> rays = rays_down(5000);
  std::vector<Hit> hits(rays.size());
  for (const int threads : {1, 0}) try {
      tree.closest(rays, hits,
                   [](std::span<const std::size_t>, std::span<const Hit>, std::span<std::uint8_t>) {
                     throw OfThisProgram{7};
                   },
                   {.threads = threads});
      ADD_FAILURE() << "nothing was thrown";
    } catch (const OfThisProgram& thrown) {
      EXPECT_EQ(thrown.value, 7);
    }
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Dll, saves_and_loads_files_with_any_name) {
  const Bvh tree(fan(40));
  std::ostringstream expected;
  tree.save(expected);
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / u8"raylanes Bäume";
  std::filesystem::create_directories(folder);
  for (const char8_t* name : {u8"plain.bin", u8"дерево.bin", u8"木.bin", u8"🌲.bin"}) {
    const std::filesystem::path file = folder / name;
    std::ofstream out(file, std::ios::binary);
    tree.save(out);
    out.close();
    ASSERT_EQ(bytes_of(file), expected.str());
    std::ifstream in(file, std::ios::binary);
    std::ostringstream again;
    Bvh::load(in).save(again);
    EXPECT_EQ(again.str(), expected.str());
  }
  std::filesystem::remove_all(folder);
}

// The user's locale, with its decimal comma, changes neither files nor messages.
TEST(Dll, does_not_depend_on_the_locale) {
  const auto saved_and_said = [] {
    std::ostringstream file;
    Bvh(fan(1200)).save(file);
    std::vector<Hit> hits(1);
    try {
      Bvh(fan(3)).closest(rays_down(1200), hits);
    } catch (const std::invalid_argument& error) {
      file << error.what();
    }
    return file.str();
  };
  const std::string before = saved_and_said();
  EXPECT_NE(before.find("1200"), std::string::npos);
  for (const char* name : {"German_Germany.1252", "de_DE", ""}) std::setlocale(LC_ALL, name);
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale usual = std::locale::global(std::locale(std::locale::classic(), new Comma));
  EXPECT_EQ(saved_and_said(), before);
  std::locale::global(usual);
  std::setlocale(LC_ALL, "C");
}

}  // namespace
}  // namespace raylanes::testing

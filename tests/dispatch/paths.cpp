// The list of paths, and which of them a recorded machine chooses or is refused.
#include <raylanes/paths.hpp>
#include <raylanes/version.hpp>

#include "../../dispatch/table/kernel_table.hpp"
#include "../support/message_of.hpp"
#include "recorded_machines.hpp"

namespace raylanes {
namespace {

// All that there are, worst first, and what their flags let the compiler use.
const std::string avx_features = "sse2, sse3, ssse3, sse4_1, sse4_2, popcnt, avx";
const std::string avx512_features = "avx512f, avx512cd, avx512dq, avx512bw, avx512vl";
const struct {
  std::string name, row, required;
} known_paths[] = {
    {"scalar", "scalar none 1", ""},
    {"neon", "neon highway 4", "asimd"},
    {"sse2", "sse2 xsimd 4", "sse2"},
    {"avx", "avx xsimd 8", avx_features},
    {"avx2-highway", "avx2 highway 8", avx_features + ", f16c, fma, avx2, bmi1, bmi2, lzcnt, aes, pclmulqdq"},
    {"avx2", "avx2 xsimd 8", avx_features + ", fma, avx2, bmi1, bmi2, lzcnt"},
    {"avx512-highway", "avx512 highway 16",
     avx_features + ", f16c, fma, avx2, bmi1, bmi2, lzcnt, aes, pclmulqdq, " + avx512_features},
    {"avx512", "avx512 xsimd 16", avx_features + ", f16c, fma, avx2, bmi1, bmi2, lzcnt, " + avx512_features},
};

// The paths that the build lists: RAYLANES_BUILT_PATHS is "scalar,sse2,…".
bool is_built(const std::string& name) {
  return std::string("," RAYLANES_BUILT_PATHS ",").find("," + name + ",") != std::string::npos;
}

// The paths for x86.
class AllPaths : public testing::Test {
 protected:
  void SetUp() override {
    if (paths().size() != std::size(known_paths) - 1)
      GTEST_SKIP() << "SKIPPED: this build has only the paths " RAYLANES_BUILT_PATHS;
  }
};

TEST(Paths, the_list_is_that_of_the_build_and_in_order) {
  std::ostringstream list, expected;
  std::set<const KernelTable*> tables;
  for (const Path& path : paths()) {
    list << path.name << ' ' << path.isa << ' ' << path.library << ' ' << path.lanes << ": "
         << feature_names(path.required) << '\n';
    tables.insert(&kernels_of(path));
  }
  for (const auto& known : known_paths)
    if (is_built(known.name)) expected << known.name << ' ' << known.row << ": " << known.required << '\n';
  EXPECT_EQ(list.str(), expected.str());
  EXPECT_STREQ(paths()[0].name, "scalar");
  EXPECT_EQ(tables.size(), paths().size()) << "two paths share a kernel table";
}

TEST(Paths, every_required_feature_is_missed) {
  const CpuFeatures all = detect_features(everything()) | detect_features(ArmCapabilities{~0u, 0});
  for (const Path& path : paths()) {
    const bool of_arm = path.required.contains({CpuFeature::asimd});
    EXPECT_EQ(supported(path, all.without({CpuFeature::asimd})), !of_arm) << path.name;
    EXPECT_TRUE(supported(path, all));
    EXPECT_TRUE(supported(path, path.required));
    for (const ExpectedBit& expected : expected_bits) {
      const bool needed = path.required.contains({expected.feature});
      EXPECT_EQ(supported(path, all.without({expected.feature})), !needed) << path.name << expected.name;
    }
  }
}

TEST_F(AllPaths, are_chosen_by_recorded_machines) {
  for (const Recorded& machine : recorded_machines) {
    SCOPED_TRACE(machine.cpu);
    const CpuFeatures features = detect_features(machine.registers);
    EXPECT_STREQ(best_path(features).name, machine.best) << feature_names(features);
    EXPECT_EQ(&choose_path(features, nullptr), &best_path(features));
    EXPECT_EQ(&choose_path(features, ""), &best_path(features));
  }
}

TEST(Paths, are_chosen_by_recorded_arm_machines) {
  for (const RecordedArm& machine : recorded_arm_machines) {
    const CpuFeatures features = detect_features(machine.capabilities);
    EXPECT_STREQ(best_path(features).name, is_built("neon") ? machine.best : "scalar") << machine.cpu;
  }
}

TEST_F(AllPaths, of_highway_need_more_than_those_of_xsimd) {
  const CpuFeatures no_aes = features_of("constructed: Haswell, AES off");
  EXPECT_TRUE(supported(find_path("avx2", no_aes), no_aes));
  EXPECT_EQ(message_of<std::invalid_argument>([&] { find_path("avx2-highway", no_aes); }),
            "find_path: path \"avx2-highway\" is not supported on this machine, which lacks aes; supported: "
            "scalar, sse2, avx, avx2");
  EXPECT_STREQ(find_path("avx2-highway", features_of("Core i7-4770")).name, "avx2-highway");
}

TEST(Paths, names_are_found_or_refused_on_every_recorded_machine) {
  for (const Recorded& machine : recorded_machines) {
    const CpuFeatures features = detect_features(machine.registers);
    for (const Path& path : paths()) {
      SCOPED_TRACE(std::string(path.name) + " on " + machine.cpu);
      if (supported(path, features)) {
        EXPECT_EQ(&find_path(path.name, features), &path);
        EXPECT_EQ(&choose_path(features, path.name), &path);
      } else {
        EXPECT_THROW(find_path(path.name, features), std::invalid_argument);
        EXPECT_THROW(choose_path(features, path.name), std::invalid_argument);
      }
    }
  }
}

TEST_F(AllPaths, say_what_is_missing) {
  const CpuFeatures phi = features_of("Xeon Phi 7210");
  EXPECT_EQ(
      message_of<std::invalid_argument>([&] { choose_path(phi, "avx512"); }),
      "RAYLANES_PATH: path \"avx512\" is not supported on this machine, which lacks avx512dq, avx512bw, "
      "avx512vl; supported: scalar, sse2, avx, avx2-highway, avx2");
}

TEST_F(AllPaths, are_listed_for_an_unknown_name) {
  const CpuFeatures sandy_bridge = features_of("Core i5-2400");
  const std::string names =
      "; paths: scalar, sse2, avx, avx2-highway, avx2, avx512-highway, avx512; supported: scalar, sse2, avx";
  for (const std::string name : {"neon", "AVX", " avx", "avx ", "av", "avx2-", "avx,sse2", " "}) {
    EXPECT_EQ(message_of<std::invalid_argument>([&] { find_path(name, sandy_bridge); }),
              "find_path: there is no path \"" + name + "\"" + names);
    EXPECT_EQ(message_of<std::invalid_argument>([&] { choose_path(sandy_bridge, name.c_str()); }),
              "RAYLANES_PATH: there is no path \"" + name + "\"" + names);
  }
  EXPECT_EQ(message_of<std::invalid_argument>([&] { find_path("", sandy_bridge); }),
            "find_path: there is no path \"\"" + names);
  EXPECT_EQ(message_of<std::invalid_argument>([&] { find_path("a\n\xc3\x7f", sandy_bridge); }),
            "find_path: there is no path \"a???\"" + names);
}

TEST(Version, of_the_library_is_that_of_its_headers) {
  EXPECT_STREQ(version(), RAYLANES_VERSION);
}

}  // namespace
}  // namespace raylanes

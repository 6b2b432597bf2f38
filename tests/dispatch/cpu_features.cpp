// Detection of instruction sets: every bit for itself, and this machine against what others say of it.
#if defined(__x86_64__)
#include <immintrin.h>
#endif
#ifdef _WIN32
#include <windows.h>
#endif

#include <fstream>

#include "recorded_machines.hpp"

namespace raylanes {
namespace {

TEST(CpuFeatures, every_feature_is_its_bit_and_no_other) {
  const CpuFeatures all = detect_features(everything());
  for (const ExpectedBit& expected : expected_bits) {
    SCOPED_TRACE(expected.name);
    EXPECT_EQ(feature_names({expected.feature}), expected.name);
    EXPECT_TRUE(all.contains({expected.feature}));
    CpuidRegisters machine = everything();
    machine.*expected.word &= ~(1u << expected.bit);
    EXPECT_EQ(feature_names(all.without(detect_features(machine))), expected.also_lost);
  }
}

TEST(CpuFeatures, no_other_bit_matters) {
  CpuidRegisters machine = everything();
  for (const ExpectedBit& expected : expected_bits) machine.*expected.word &= ~(1u << expected.bit);
  EXPECT_EQ(feature_names(detect_features(machine)), "");
}

TEST(CpuFeatures, sets_behave_as_sets) {
  const CpuFeatures a{CpuFeature::sse2, CpuFeature::avx};
  const CpuFeatures b{CpuFeature::avx, CpuFeature::fma};
  EXPECT_TRUE(CpuFeatures{}.empty());
  EXPECT_FALSE(a.empty());
  EXPECT_TRUE(a.contains({}));
  EXPECT_FALSE(a.contains(b));
  EXPECT_TRUE((a | b).contains(a));
  EXPECT_EQ(a.without(b), CpuFeatures{CpuFeature::sse2});
  EXPECT_EQ(feature_names(a | b), "sse2, avx, fma");
  EXPECT_EQ(CpuFeatures::from_bits(a.bits()), a);
}

// The compiler's run-time library reads the same registers with code of its own.
TEST(CpuFeatures, this_machine_agrees_with_the_compilers_run_time_library) {
#if defined(__x86_64__)
  const CpuFeatures here = machine_features();
  EXPECT_EQ(here, detect_features(read_cpuid()));
  EXPECT_EQ(here.contains({CpuFeature::sse2}), __builtin_cpu_supports("sse2") != 0);
  EXPECT_EQ(here.contains({CpuFeature::sse4_2}), __builtin_cpu_supports("sse4.2") != 0);
  EXPECT_EQ(here.contains({CpuFeature::popcnt}), __builtin_cpu_supports("popcnt") != 0);
  EXPECT_EQ(here.contains({CpuFeature::avx}), __builtin_cpu_supports("avx") != 0);
  EXPECT_EQ(here.contains({CpuFeature::fma}), __builtin_cpu_supports("fma") != 0);
  EXPECT_EQ(here.contains({CpuFeature::avx2}), __builtin_cpu_supports("avx2") != 0);
  EXPECT_EQ(here.contains({CpuFeature::bmi1}), __builtin_cpu_supports("bmi") != 0);
  EXPECT_EQ(here.contains({CpuFeature::bmi2}), __builtin_cpu_supports("bmi2") != 0);
  EXPECT_EQ(here.contains({CpuFeature::aes}), __builtin_cpu_supports("aes") != 0);
  EXPECT_EQ(here.contains({CpuFeature::pclmulqdq}), __builtin_cpu_supports("pclmul") != 0);
  EXPECT_EQ(here.contains({CpuFeature::avx512f}), __builtin_cpu_supports("avx512f") != 0);
  EXPECT_EQ(here.contains({CpuFeature::avx512vl}), __builtin_cpu_supports("avx512vl") != 0);
  EXPECT_EQ(read_arm_capabilities(), ArmCapabilities{});
#else
  EXPECT_EQ(read_cpuid(), CpuidRegisters{});
  EXPECT_EQ(machine_features(), detect_features(read_arm_capabilities()));
#endif
}

TEST(CpuFeatures, of_recorded_arm_machines_are_the_bit_of_theirs) {
  for (const RecordedArm& machine : recorded_arm_machines) {
    const bool has = std::string(machine.best) == "neon";
    EXPECT_EQ(feature_names(detect_features(machine.capabilities)), has ? "asimd" : "") << machine.cpu;
  }
  ArmCapabilities all{~std::uint64_t{0}, ~std::uint64_t{0}};
  EXPECT_EQ(feature_names(detect_features(all)), "asimd");
  all.hwcap ^= 2;
  EXPECT_EQ(feature_names(detect_features(all)), "");
}

#ifdef _WIN32
// Windows says it of some instruction sets, registers that it saves included; Wine 8 of none above AVX2.
TEST(CpuFeatures, this_machine_claims_what_windows_does) {
  constexpr struct {
    CpuFeature feature;
    DWORD of_windows;  // PF_…_INSTRUCTIONS_AVAILABLE
  } rows[] = {{CpuFeature::sse2, 10},   {CpuFeature::sse3, 13},   {CpuFeature::ssse3, 36},
              {CpuFeature::sse4_1, 37}, {CpuFeature::sse4_2, 38}, {CpuFeature::avx, 39},
              {CpuFeature::avx2, 40}};
  for (const auto& row : rows)
    EXPECT_EQ(machine_features().contains({row.feature}), IsProcessorFeaturePresent(row.of_windows) != 0)
        << feature_names({row.feature});
}
#endif

#if defined(__x86_64__)
// 31; a processor without LZCNT executes BSR, which finds 0.
[[gnu::target("lzcnt"), gnu::noinline]] unsigned zeros_before_one(unsigned one) {
  return _lzcnt_u32(one);
}
#endif

// The kernel lists what it lets programs use: we must claim nothing beyond it. Some virtual machines execute LZCNT and
// have kernels that do not list it.
TEST(CpuFeatures, this_machine_claims_nothing_the_kernel_does_not_list) {
  std::ifstream cpuinfo("/proc/cpuinfo");
  std::set<std::string> flags;
  for (std::string line; flags.empty() && std::getline(cpuinfo, line);) {
    if (!line.starts_with("flags") && !line.starts_with("Features")) continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) flags.insert(word);
  }
  if (flags.empty()) GTEST_SKIP() << "SKIPPED: /proc/cpuinfo lists no flags on this system";
#if defined(__aarch64__)
  if (!flags.contains("fp")) GTEST_SKIP() << "SKIPPED: /proc/cpuinfo is that of the machine that emulates";
  EXPECT_EQ(machine_features().contains({CpuFeature::asimd}), flags.contains("asimd"));
#endif
  for (const ExpectedBit& expected : expected_bits) {
    if (!machine_features().contains({expected.feature})) continue;
    std::string flag = expected.name;
    if (flag == "sse3") flag = "pni";
    if (flag == "lzcnt") flag = "abm";
#if defined(__x86_64__)
    if (flag == "abm" && !flags.contains(flag)) {
      EXPECT_EQ(zeros_before_one(1), 31u);
      continue;
    }
#endif
    EXPECT_TRUE(flags.contains(flag)) << expected.name;
  }
}

}  // namespace
}  // namespace raylanes

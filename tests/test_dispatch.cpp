// Instruction-set detection on recorded machines, and the choice of a path: best, forced, by environment,
// before main and from many threads.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "../dispatch/cpu_features.hpp"
#include "../dispatch/paths.hpp"

namespace raylanes {
namespace {

// Runs before any other dynamic initialisation of the program, that of the library included, and is the first
// to ask for the active path: from several threads at once.
struct BeforeMain {
  std::array<const Path*, 8> seen{};
  std::array<std::string, 8> error;

  BeforeMain() {
    std::atomic<int> waiting{8};
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      threads.emplace_back([this, i, &waiting] {
        --waiting;
        while (waiting != 0) std::this_thread::yield();
        try {
          seen[i] = &active_path();
        } catch (const std::invalid_argument& e) {
          error[i] = e.what();
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
};
const BeforeMain before_main __attribute__((init_priority(101)));

// Sets RAYLANES_PATH, or unsets it for null, and puts the old value back.
class ScopedEnvironment {
 public:
  explicit ScopedEnvironment(const char* value) {
    if (const char* old = std::getenv("RAYLANES_PATH")) old_ = old;
    set(value);
  }
  ~ScopedEnvironment() { set(old_ ? old_->c_str() : nullptr); }
  ScopedEnvironment(const ScopedEnvironment&) = delete;
  ScopedEnvironment& operator=(const ScopedEnvironment&) = delete;

 private:
  static void set(const char* value) {
    if (value != nullptr) {
      setenv("RAYLANES_PATH", value, 1);
    } else {
      unsetenv("RAYLANES_PATH");
    }
  }
  std::optional<std::string> old_;
};

struct Recorded {
  const char* cpu;
  CpuidRegisters registers;
  const char* best;
};

constexpr std::uint32_t intel_last = 0x80000008u;

// Columns: max_leaf, max_extended_leaf, leaf 1 ECX and EDX, leaf 7 EBX, ECX and EDX, leaf 0x80000001 ECX,
// XCR0. Unless marked "constructed", the numbers are those the named processor was seen to return in public
// CPUID dumps (the InstLatx64 collection). The dumps hold no XCR0: it is inferred from the size of the
// enabled save area in leaf 0xD (0x240: XMM only, 0x340: with YMM, 0x980 or 0xa80: with ZMM, 0x2b00: with
// tiles too).
const Recorded recorded_machines[] = {
    // No AVX in hardware.
    {"Athlon 64 3200+ (K8 Venice)",
     {0x1, 0x80000018, 0x00000001, 0x078bfbff, 0, 0, 0, 0x00000001, 0},
     "sse2"},
    {"Core 2 Duo P8400 (Penryn)", {0xa, intel_last, 0x0008e3fd, 0xbfebfbff, 0, 0, 0, 0x00000001, 0}, "sse2"},
    {"Core i7 sample at 3.2 GHz (Nehalem, Bloomfield)",
     {0xb, intel_last, 0x0098e3bd, 0xbfebfbff, 0, 0, 0, 0x00000001, 0},
     "sse2"},
    {"Celeron G1610 (Ivy Bridge with AVX fused off)",
     {0xd, intel_last, 0x0d9ae3bf, 0xbfebfbff, 0x00000281, 0, 0, 0x00000001, 0x3},
     "sse2"},
    {"Pentium G4400 (Skylake with AVX fused off)",
     {0x16, intel_last, 0x4ffaebbf, 0xbfebfbff, 0x02942603, 0, 0, 0x00000121, 0x3},
     "sse2"},
    {"Celeron J3455 (Goldmont)",
     {0x15, intel_last, 0x4ff8ebbf, 0xbfebfbff, 0x2294e283, 0, 0, 0x00000101, 0x3},
     "sse2"},
    // AVX in hardware, not enabled by the operating system.
    {"VIA Eden X4 C4250 (Isaiah CNR), OSXSAVE off",
     {0xd, intel_last, 0x76fa63ab, 0xbfcbfbff, 0x000c25ab, 0, 0, 0x00000121, 0},
     "sse2"},
    {"Core i7-2600 (Sandy Bridge), OSXSAVE on, YMM state off",
     {0xd, intel_last, 0x1fbae3ff, 0xbfebfbff, 0, 0, 0, 0x00000001, 0x3},
     "sse2"},
    {"Xeon E3-1230 V2 (Ivy Bridge), OSXSAVE on, YMM state off",
     {0xd, intel_last, 0x7fbae3ff, 0xbfebfbff, 0x00000281, 0, 0, 0x00000001, 0x3},
     "sse2"},
    // AVX without AVX2.
    {"Core i5-2400 (Sandy Bridge)",
     {0xd, intel_last, 0x1fbae3ff, 0xbfebfbff, 0, 0, 0, 0x00000001, 0x7},
     "avx"},
    {"Core i7-3770K (Ivy Bridge: F16C)",
     {0xd, intel_last, 0x7f9ae3bf, 0xbfebfbff, 0x00000281, 0, 0, 0x00000001, 0x7},
     "avx"},
    {"AMD sample ZD302046W4K43 (Bulldozer: FMA4, no FMA)",
     {0xd, 0x8000001e, 0x1e98220b, 0x178bfbff, 0, 0, 0, 0x01c9bfff, 0x7},
     "avx"},
    {"FX-8350 (Piledriver: FMA, BMI1, LZCNT)",
     {0xd, 0x8000001e, 0x3e98320b, 0x178bfbff, 0x00000008, 0, 0, 0x01ebbfff, 0x7},
     "avx"},
    {"KaiXian KX-U6780A (Zhaoxin ZX-E: BMI2, neither AVX2 nor FMA)",
     {0xd, intel_last, 0x7fda63eb, 0xbfcbfbff, 0x200c258b, 0x00000004, 0x24000000, 0x00000121, 0x7},
     "avx"},
    // AVX2, but not all that the avx2 path requires.
    {"constructed: VIA Eden X4 C4250 with OSXSAVE and YMM state on (AVX2 without FMA)",
     {0xd, intel_last, 0x7efa63ab, 0xbfcbfbff, 0x000c25ab, 0, 0, 0x00000121, 0x7},
     "avx"},
    // AVX2.
    {"Core i7-4770 (Haswell)",
     {0xd, intel_last, 0x7ffafbff, 0xbfebfbff, 0x000027ab, 0, 0, 0x00000021, 0x7},
     "avx2"},
    {"Opteron X3216 (Excavator)",
     {0xd, 0x8000001e, 0x7ed8320b, 0x178bfbff, 0x000001a9, 0, 0, 0x2fabbfff, 0x7},
     "avx2"},
    {"Core i7-6500U (Skylake)",
     {0x16, intel_last, 0x7ffafbbf, 0xbfebfbff, 0x029c67af, 0, 0, 0x00000121, 0x1f},
     "avx2"},
    {"Ryzen 9 PRO 3900 (Zen 2)",
     {0x10, 0x80000020, 0x7ed8320b, 0x178bfbff, 0x219c91a9, 0x00400004, 0, 0x75c237ff, 0x7},
     "avx2"},
    {"Core i9-12900K (Alder Lake, AVX-512 off)",
     {0x20, intel_last, 0x7ffafbff, 0xbfebfbff, 0x239ca7eb, 0x98c027ac, 0xfc1cc410, 0x00000121, 0x207},
     "avx2"},
    {"Xeon Phi 7210 (Knights Landing: AVX512F and CD without DQ, BW, VL)",
     {0xd, intel_last, 0x7ff8f39f, 0xbfebfbff, 0x1c0d23ab, 0x00000001, 0x04000000, 0x00000121, 0xe7},
     "avx2"},
    // AVX-512.
    {"Core i9-7900X (Skylake-X)",
     {0x16, intel_last, 0x7ffefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x00000121, 0xff},
     "avx512"},
    {"Core i7-1065G7 (Ice Lake)",
     {0x1b, intel_last, 0x7ffafbbf, 0xbfebfbff, 0xf2bf27ef, 0x40405f4e, 0xbc000410, 0x00000121, 0xe7},
     "avx512"},
    {"Core i9-12900K (Alder Lake, AVX-512 on)",
     {0x20, intel_last, 0x7ffafbff, 0xbfebfbff, 0xf3bfa7eb, 0x98c07fee, 0xfc9cc510, 0x00000121, 0xe7},
     "avx512"},
    {"Xeon w7-2475X (Sapphire Rapids)",
     {0x20, intel_last, 0x7ffefbff, 0xbfebfbff, 0xf3bfbffb, 0xbb417fee, 0xffdd4430, 0x00000121, 0x602e7},
     "avx512"},
    {"Ryzen 5 7600X (Zen 4)",
     {0x10, 0x80000028, 0x7ef8320b, 0x178bfbff, 0xf1bf97a9, 0x00405fce, 0x10000010, 0x75c237ff, 0xe7},
     "avx512"},
    // Constructed by masking a recorded machine, as an operating system, a BIOS or a hypervisor does.
    {"constructed: Skylake-X, ZMM state off",
     {0x16, intel_last, 0x7ffefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x00000121, 0x7},
     "avx2"},
    {"constructed: Skylake-X, only the mask registers off",
     {0x16, intel_last, 0x7ffefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x00000121, 0xc7},
     "avx2"},
    {"constructed: Skylake-X, only the upper halves off",
     {0x16, intel_last, 0x7ffefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x00000121, 0xa7},
     "avx2"},
    {"constructed: Skylake-X, only the upper registers off",
     {0x16, intel_last, 0x7ffefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x00000121, 0x67},
     "avx2"},
    {"constructed: Skylake-X, ZMM state on, YMM state off",
     {0x16, intel_last, 0x7ffefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x00000121, 0xe3},
     "sse2"},
    {"constructed: Skylake-X, OSXSAVE off, stale XCR0",
     {0x16, intel_last, 0x77fefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x00000121, 0xff},
     "sse2"},
    {"constructed: Skylake-X, AVX masked, AVX2 and AVX-512 not",
     {0x16, intel_last, 0x6ffefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x00000121, 0xff},
     "sse2"},
    {"constructed: Skylake-X, AVX512F masked, its relatives not",
     {0x16, intel_last, 0x7ffefbbf, 0xbfebfbff, 0xd39efffb, 0, 0, 0x00000121, 0xff},
     "avx2"},
    {"constructed: Haswell, leaf 7 masked",
     {0xd, intel_last, 0x7ffafbff, 0xbfebfbff, 0, 0, 0, 0x00000021, 0x7},
     "avx"},
    {"constructed: Haswell, max_leaf limited to 6, leaf 7 not masked",
     {0x6, intel_last, 0x7ffafbff, 0xbfebfbff, 0x000027ab, 0, 0, 0x00000021, 0x7},
     "avx"},
    {"constructed: Haswell, no extended leaf 1, so no LZCNT",
     {0xd, 0x80000000, 0x7ffafbff, 0xbfebfbff, 0x000027ab, 0, 0, 0x00000021, 0x7},
     "avx"},
    {"constructed: Haswell, LZCNT off",
     {0xd, intel_last, 0x7ffafbff, 0xbfebfbff, 0x000027ab, 0, 0, 0x00000001, 0x7},
     "avx"},
    {"constructed: Haswell, BMI1 off",
     {0xd, intel_last, 0x7ffafbff, 0xbfebfbff, 0x000027a3, 0, 0, 0x00000021, 0x7},
     "avx"},
    {"constructed: Haswell, BMI2 off",
     {0xd, intel_last, 0x7ffafbff, 0xbfebfbff, 0x000026ab, 0, 0, 0x00000021, 0x7},
     "avx"},
    {"constructed: Haswell, FMA off",
     {0xd, intel_last, 0x7ffaebff, 0xbfebfbff, 0x000027ab, 0, 0, 0x00000021, 0x7},
     "avx"},
    {"constructed: Haswell, AES off (avx2-highway goes, avx2 stays)",
     {0xd, intel_last, 0x7dfafbff, 0xbfebfbff, 0x000027ab, 0, 0, 0x00000021, 0x7},
     "avx2"},
    {"constructed: Haswell, POPCNT off",
     {0xd, intel_last, 0x7f7afbff, 0xbfebfbff, 0x000027ab, 0, 0, 0x00000021, 0x7},
     "sse2"},
    {"constructed: not an x86", {}, "scalar"},
};

CpuidRegisters everything() {
  return {0x20, 0x80000028, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~std::uint64_t{0}};
}

// The machine whose dump the name begins with.
CpuFeatures features_of(const std::string& cpu) {
  for (const Recorded& machine : recorded_machines) {
    if (std::string(machine.cpu).starts_with(cpu)) return detect_features(machine.registers);
  }
  throw std::invalid_argument("no recorded machine " + cpu);
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "no exception";
}

struct ExpectedBit {
  CpuFeature feature;
  const char* name;
  std::uint32_t CpuidRegisters::*word;
  unsigned bit;
  const char* also_lost;  // what goes too when the bit goes
};

// From Intel's manual, vol. 2A, CPUID, in the order of its tables, not of the code under test.
constexpr const char* needs_avx = "avx, f16c, fma, avx2, avx512f, avx512cd, avx512dq, avx512bw, avx512vl";
constexpr const char* needs_avx512f = "avx512f, avx512cd, avx512dq, avx512bw, avx512vl";
const ExpectedBit expected_bits[] = {
    {CpuFeature::sse3, "sse3", &CpuidRegisters::leaf1_ecx, 0, "sse3"},
    {CpuFeature::pclmulqdq, "pclmulqdq", &CpuidRegisters::leaf1_ecx, 1, "pclmulqdq"},
    {CpuFeature::ssse3, "ssse3", &CpuidRegisters::leaf1_ecx, 9, "ssse3"},
    {CpuFeature::fma, "fma", &CpuidRegisters::leaf1_ecx, 12, "fma"},
    {CpuFeature::sse4_1, "sse4_1", &CpuidRegisters::leaf1_ecx, 19, "sse4_1"},
    {CpuFeature::sse4_2, "sse4_2", &CpuidRegisters::leaf1_ecx, 20, "sse4_2"},
    {CpuFeature::popcnt, "popcnt", &CpuidRegisters::leaf1_ecx, 23, "popcnt"},
    {CpuFeature::aes, "aes", &CpuidRegisters::leaf1_ecx, 25, "aes"},
    {CpuFeature::avx, "avx", &CpuidRegisters::leaf1_ecx, 28, needs_avx},
    {CpuFeature::f16c, "f16c", &CpuidRegisters::leaf1_ecx, 29, "f16c"},
    {CpuFeature::sse2, "sse2", &CpuidRegisters::leaf1_edx, 26, "sse2"},
    {CpuFeature::bmi1, "bmi1", &CpuidRegisters::leaf7_ebx, 3, "bmi1"},
    {CpuFeature::avx2, "avx2", &CpuidRegisters::leaf7_ebx, 5, "avx2"},
    {CpuFeature::bmi2, "bmi2", &CpuidRegisters::leaf7_ebx, 8, "bmi2"},
    {CpuFeature::avx512f, "avx512f", &CpuidRegisters::leaf7_ebx, 16, needs_avx512f},
    {CpuFeature::avx512dq, "avx512dq", &CpuidRegisters::leaf7_ebx, 17, "avx512dq"},
    {CpuFeature::avx512cd, "avx512cd", &CpuidRegisters::leaf7_ebx, 28, "avx512cd"},
    {CpuFeature::avx512bw, "avx512bw", &CpuidRegisters::leaf7_ebx, 30, "avx512bw"},
    {CpuFeature::avx512vl, "avx512vl", &CpuidRegisters::leaf7_ebx, 31, "avx512vl"},
    {CpuFeature::lzcnt, "lzcnt", &CpuidRegisters::extended1_ecx, 5, "lzcnt"},
};

TEST(CpuFeatures, EveryFeatureIsItsBitAndNoOther) {
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

TEST(CpuFeatures, NoOtherBitMatters) {
  CpuidRegisters machine = everything();
  for (const ExpectedBit& expected : expected_bits) machine.*expected.word &= ~(1u << expected.bit);
  EXPECT_EQ(feature_names(detect_features(machine)), "");
}

TEST(CpuFeatures, SetsBehaveAsSets) {
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
TEST(CpuFeatures, ThisMachineAgreesWithTheCompilersRunTimeLibrary) {
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
#else
  EXPECT_EQ(read_cpuid(), CpuidRegisters{});
#endif
}

// The kernel lists what it lets programs use: we must claim nothing beyond it.
TEST(CpuFeatures, ThisMachineClaimsNothingTheKernelDoesNotList) {
  std::ifstream cpuinfo("/proc/cpuinfo");
  std::set<std::string> flags;
  for (std::string line; flags.empty() && std::getline(cpuinfo, line);) {
    if (!line.starts_with("flags")) continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) flags.insert(word);
  }
  if (flags.empty()) GTEST_SKIP() << "SKIPPED: /proc/cpuinfo lists no flags on this system";
  for (const ExpectedBit& expected : expected_bits) {
    if (!machine_features().contains({expected.feature})) continue;
    std::string flag = expected.name;
    if (flag == "sse3") flag = "pni";
    if (flag == "lzcnt") flag = "abm";
    EXPECT_TRUE(flags.contains(flag)) << expected.name;
  }
}

TEST(Paths, TheListIsCompleteAndInOrder) {
  std::ostringstream list;
  std::set<const KernelTable*> tables;
  for (const Path& path : paths()) {
    list << path.name << ' ' << path.isa << ' ' << path.library << ' ' << path.lanes << '\n';
    tables.insert(&path.table);
  }
  EXPECT_EQ(list.str(),
            "scalar scalar none 1\n"
            "sse2 sse2 xsimd 4\n"
            "avx avx xsimd 8\n"
            "avx2-highway avx2 highway 8\n"
            "avx2 avx2 xsimd 8\n"
            "avx512-highway avx512 highway 16\n"
            "avx512 avx512 xsimd 16\n");
  EXPECT_EQ(tables.size(), paths().size()) << "two paths share a kernel table";
}

TEST(Paths, RequireAllThatTheirFlagsLetTheCompilerUse) {
  const std::string sse2 = "sse2";
  const std::string avx = "sse2, sse3, ssse3, sse4_1, sse4_2, popcnt, avx";
  const std::string avx512 = "avx512f, avx512cd, avx512dq, avx512bw, avx512vl";
  const std::vector<std::string> required = {
      "",
      sse2,
      avx,
      avx + ", f16c, fma, avx2, bmi1, bmi2, lzcnt, aes, pclmulqdq",
      avx + ", fma, avx2, bmi1, bmi2, lzcnt",
      avx + ", f16c, fma, avx2, bmi1, bmi2, lzcnt, aes, pclmulqdq, " + avx512,
      avx + ", f16c, fma, avx2, bmi1, bmi2, lzcnt, " + avx512,
  };
  ASSERT_EQ(required.size(), paths().size());
  for (std::size_t i = 0; i < required.size(); ++i) {
    EXPECT_EQ(feature_names(paths()[i].required), required[i]) << paths()[i].name;
  }
}

TEST(Paths, EveryRequiredFeatureIsMissed) {
  const CpuFeatures all = detect_features(everything());
  for (const Path& path : paths()) {
    EXPECT_TRUE(supported(path, all));
    EXPECT_TRUE(supported(path, path.required));
    for (const ExpectedBit& expected : expected_bits) {
      const bool needed = path.required.contains({expected.feature});
      EXPECT_EQ(supported(path, all.without({expected.feature})), !needed) << path.name << expected.name;
    }
  }
}

TEST(Paths, RecordedMachinesChooseTheirBestPath) {
  for (const Recorded& machine : recorded_machines) {
    SCOPED_TRACE(machine.cpu);
    const CpuFeatures features = detect_features(machine.registers);
    EXPECT_STREQ(best_path(features).name, machine.best) << feature_names(features);
    EXPECT_EQ(&choose_path(features, nullptr), &best_path(features));
    EXPECT_EQ(&choose_path(features, ""), &best_path(features));
  }
}

TEST(Paths, HighwayNeedsMoreThanXsimd) {
  const CpuFeatures no_aes = features_of("constructed: Haswell, AES off");
  EXPECT_TRUE(supported(find_path("avx2", no_aes), no_aes));
  EXPECT_EQ(message_of([&] { find_path("avx2-highway", no_aes); }),
            "find_path: path \"avx2-highway\" is not supported on this machine, which lacks aes; supported: "
            "scalar, sse2, avx, avx2");
  EXPECT_STREQ(find_path("avx2-highway", features_of("Core i7-4770")).name, "avx2-highway");
}

TEST(Paths, NamesAreFoundOrRefusedOnEveryRecordedMachine) {
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

TEST(Paths, AnUnsupportedNameSaysWhatIsMissing) {
  const CpuFeatures phi = features_of("Xeon Phi 7210");
  EXPECT_EQ(
      message_of([&] { choose_path(phi, "avx512"); }),
      "RAYLANES_PATH: path \"avx512\" is not supported on this machine, which lacks avx512dq, avx512bw, "
      "avx512vl; supported: scalar, sse2, avx, avx2-highway, avx2");
}

TEST(Paths, AnUnknownNameListsTheValidOnes) {
  const CpuFeatures sandy_bridge = features_of("Core i5-2400");
  const std::string names =
      "; paths: scalar, sse2, avx, avx2-highway, avx2, avx512-highway, avx512; supported: scalar, sse2, avx";
  for (const std::string name : {"neon", "AVX", " avx", "avx ", "av", "avx2-", "avx,sse2", " "}) {
    EXPECT_EQ(message_of([&] { find_path(name, sandy_bridge); }),
              "find_path: there is no path \"" + name + "\"" + names);
    EXPECT_EQ(message_of([&] { choose_path(sandy_bridge, name.c_str()); }),
              "RAYLANES_PATH: there is no path \"" + name + "\"" + names);
  }
  EXPECT_EQ(message_of([&] { find_path("", sandy_bridge); }), "find_path: there is no path \"\"" + names);
  EXPECT_EQ(message_of([&] { find_path("a\n\xc3\x7f", sandy_bridge); }),
            "find_path: there is no path \"a???\"" + names);
}

TEST(ActivePath, IsResolvedBeforeMainByThreadsThatRace) {
  for (const std::string& error : before_main.error) EXPECT_EQ(error, "");
  const Path& expected = choose_path(machine_features(), std::getenv("RAYLANES_PATH"));
  for (const Path* path : before_main.seen) EXPECT_EQ(path, &expected);
  EXPECT_EQ(&active_path(), &expected);
}

TEST(ActivePath, CanBeForcedToEverySupportedPathAndNoOther) {
  const Path& resolved = active_path();
  for (const Path& path : paths()) {
    SCOPED_TRACE(path.name);
    force_path("scalar");
    if (supported(path)) {
      force_path(path.name);
      EXPECT_EQ(&active_path(), &path);
      EXPECT_EQ(&find_path(path.name), &path);
    } else {
      EXPECT_NE(message_of([&] { force_path(path.name); }).find("force_path: path \""), std::string::npos);
      EXPECT_STREQ(active_path().name, "scalar") << "a refused name must change nothing";
    }
  }
  EXPECT_THROW(force_path("neon"), std::invalid_argument);
  EXPECT_THROW(force_path(""), std::invalid_argument);
  unforce_path();
  EXPECT_EQ(&active_path(), &resolved);
  unforce_path();
  EXPECT_EQ(&active_path(), &resolved);
}

// The "threadsafe" style starts this program afresh for the statement, so that the child meets the
// environment set here before its own main; the child's standard error is matched.
class ActivePathInChild : public testing::Test {
 protected:
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
  void TearDown() override { testing::FLAGS_gtest_death_test_style = "fast"; }

  [[noreturn]] static void report_and_exit() {
    const auto print = [](const Path* path) { std::fprintf(stderr, "<%s>", path ? path->name : "none"); };
    print(before_main.seen[0]);
    setenv("RAYLANES_PATH", "neither-read-nor-valid", 1);
    print(&active_path());
    force_path("scalar");
    print(&active_path());
    unforce_path();
    print(&active_path());
    std::exit(0);
  }
};

TEST_F(ActivePathInChild, IsThatOfTheEnvironmentKeptAfterTheFirstResolution) {
  for (const Path& path : paths()) {
    if (!supported(path)) continue;
    const ScopedEnvironment environment(path.name);
    const std::string name = "<" + std::string(path.name) + ">";
    EXPECT_EXIT(report_and_exit(), testing::ExitedWithCode(0), name + name + "<scalar>" + name);
  }
}

TEST_F(ActivePathInChild, IsTheBestOneWithoutOrWithAnEmptyEnvironment) {
  const std::string best = "<" + std::string(best_path(machine_features()).name) + ">";
  for (const char* value : {static_cast<const char*>(nullptr), ""}) {
    const ScopedEnvironment environment(value);
    EXPECT_EXIT(report_and_exit(), testing::ExitedWithCode(0), best + best + "<scalar>" + best);
  }
}

TEST_F(ActivePathInChild, AnInvalidEnvironmentThrowsEveryTimeUnlessForced) {
  const ScopedEnvironment environment("neon");
  EXPECT_EXIT(
      {
        std::fprintf(stderr, "<%s>", before_main.error[0].c_str());
        std::fprintf(stderr, "<%s>", message_of([] { active_path(); }).c_str());
        force_path("scalar");
        std::fprintf(stderr, "<%s>", active_path().name);
        std::exit(0);
      },
      testing::ExitedWithCode(0),
      "<RAYLANES_PATH: there is no path \"neon\"; paths: scalar.*>"
      "<RAYLANES_PATH: there is no path \"neon\"; paths: scalar.*><scalar>");
}

TEST(ActivePath, ThreadsThatForceAndReadSeeOnlyValidPaths) {
  const Path& resolved = active_path();
  const Path& best = best_path(machine_features());
  constexpr int rounds = 2000;
  std::atomic<int> invalid{0};
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 8; ++thread) {
    threads.emplace_back([&, thread] {
      for (int round = 0; round < rounds; ++round) {
        if (thread == 0) force_path("scalar");
        if (thread == 1) force_path(best.name);
        if (thread == 2) unforce_path();
        const Path* seen = &active_path();
        if (seen != &resolved && seen != &best && seen != &paths().front()) ++invalid;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  unforce_path();
  EXPECT_EQ(invalid, 0);
  EXPECT_EQ(&active_path(), &resolved);
}

}  // namespace
}  // namespace raylanes

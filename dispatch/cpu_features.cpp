#include <atomic>

#include <raylanes/cpu_features.hpp>

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#elif defined(__aarch64__) && defined(__linux__)
#include <sys/auxv.h>
#endif

namespace raylanes {
namespace {

// The registers an extension computes in, which the operating system must save on a task switch.
enum class State { general_or_xmm, ymm, zmm };

struct FeatureRow {
  CpuFeature feature;
  const char* name;
  std::uint32_t CpuidRegisters::*word;
  unsigned bit;
  State state;
};

// BMI1, BMI2 and LZCNT compute in general registers, which are always saved, although BMI is VEX-encoded.
constexpr FeatureRow feature_rows[] = {
    {CpuFeature::sse2, "sse2", &CpuidRegisters::leaf1_edx, 26, State::general_or_xmm},
    {CpuFeature::sse3, "sse3", &CpuidRegisters::leaf1_ecx, 0, State::general_or_xmm},
    {CpuFeature::ssse3, "ssse3", &CpuidRegisters::leaf1_ecx, 9, State::general_or_xmm},
    {CpuFeature::sse4_1, "sse4_1", &CpuidRegisters::leaf1_ecx, 19, State::general_or_xmm},
    {CpuFeature::sse4_2, "sse4_2", &CpuidRegisters::leaf1_ecx, 20, State::general_or_xmm},
    {CpuFeature::popcnt, "popcnt", &CpuidRegisters::leaf1_ecx, 23, State::general_or_xmm},
    {CpuFeature::avx, "avx", &CpuidRegisters::leaf1_ecx, 28, State::ymm},
    {CpuFeature::f16c, "f16c", &CpuidRegisters::leaf1_ecx, 29, State::ymm},
    {CpuFeature::fma, "fma", &CpuidRegisters::leaf1_ecx, 12, State::ymm},
    {CpuFeature::avx2, "avx2", &CpuidRegisters::leaf7_ebx, 5, State::ymm},
    {CpuFeature::bmi1, "bmi1", &CpuidRegisters::leaf7_ebx, 3, State::general_or_xmm},
    {CpuFeature::bmi2, "bmi2", &CpuidRegisters::leaf7_ebx, 8, State::general_or_xmm},
    {CpuFeature::lzcnt, "lzcnt", &CpuidRegisters::extended1_ecx, 5, State::general_or_xmm},
    {CpuFeature::aes, "aes", &CpuidRegisters::leaf1_ecx, 25, State::general_or_xmm},
    {CpuFeature::pclmulqdq, "pclmulqdq", &CpuidRegisters::leaf1_ecx, 1, State::general_or_xmm},
    {CpuFeature::avx512f, "avx512f", &CpuidRegisters::leaf7_ebx, 16, State::zmm},
    {CpuFeature::avx512cd, "avx512cd", &CpuidRegisters::leaf7_ebx, 28, State::zmm},
    {CpuFeature::avx512dq, "avx512dq", &CpuidRegisters::leaf7_ebx, 17, State::zmm},
    {CpuFeature::avx512bw, "avx512bw", &CpuidRegisters::leaf7_ebx, 30, State::zmm},
    {CpuFeature::avx512vl, "avx512vl", &CpuidRegisters::leaf7_ebx, 31, State::zmm},
};

constexpr std::uint32_t first_extended_leaf = 0x80000001u;
constexpr std::uint32_t osxsave_bit = 1u << 27;  // leaf 1, ECX
constexpr std::uint32_t avx_bit = 1u << 28;      // leaf 1, ECX
constexpr std::uint32_t avx512f_bit = 1u << 16;  // leaf 7, EBX
constexpr std::uint64_t xcr0_ymm = 0x06;         // bits 1 and 2
constexpr std::uint64_t xcr0_zmm = 0xe6;         // these and bits 5, 6 and 7

// An Intel processor answers a leaf above its last one with the last one's numbers, which mean other things.
CpuidRegisters without_absent_leaves(CpuidRegisters machine) noexcept {
  if (machine.max_leaf < 1) machine.leaf1_ecx = machine.leaf1_edx = 0;
  if (machine.max_leaf < 7) machine.leaf7_ebx = machine.leaf7_ecx = machine.leaf7_edx = 0;
  if (machine.max_extended_leaf < first_extended_leaf) machine.extended1_ecx = 0;
  return machine;
}

bool usable(State state, const CpuidRegisters& machine) noexcept {
  if (state == State::general_or_xmm) return true;
  const bool os_saves_more = (machine.leaf1_ecx & osxsave_bit) != 0;
  const bool has_avx = (machine.leaf1_ecx & avx_bit) != 0;
  const bool ymm = os_saves_more && has_avx && (machine.xcr0 & xcr0_ymm) == xcr0_ymm;
  if (state == State::ymm) return ymm;
  return ymm && (machine.leaf7_ebx & avx512f_bit) != 0 && (machine.xcr0 & xcr0_zmm) == xcr0_zmm;
}

// "Auth" of AuthenticAMD, leaf 0, EBX.
constexpr std::uint32_t amd_letters = 0x68747541u;

// The family as manuals number it: where the four bits for it are full, eight more are added.
std::uint32_t family_of(std::uint32_t leaf1_eax) noexcept {
  const std::uint32_t family = leaf1_eax >> 8 & 0xfu;
  return family < 0xfu ? family : family + (leaf1_eax >> 20 & 0xffu);
}

constexpr std::uint64_t hwcap_asimd = 1u << 1;  // in AT_HWCAP

// In the cache below: whether it holds what is known of this machine, and one thing that is no feature. No feature
// has these bits.
constexpr std::uint32_t known_bit = 1u << 31, splits_bit = 1u << 30;
constinit std::atomic<std::uint32_t> machine_cache{0};

}  // namespace

std::string feature_names(CpuFeatures features) {
  std::string names;
  const auto append = [&](CpuFeature feature, const char* name) {
    if (!features.contains({feature})) return;
    if (!names.empty()) names += ", ";
    names += name;
  };
  for (const FeatureRow& row : feature_rows) append(row.feature, row.name);
  append(CpuFeature::asimd, "asimd");
  return names;
}

CpuFeatures detect_features(const CpuidRegisters& machine) noexcept {
  const CpuidRegisters reported = without_absent_leaves(machine);
  CpuFeatures features;
  for (const FeatureRow& row : feature_rows) {
    const bool in_hardware = (reported.*row.word >> row.bit & 1u) != 0;
    if (in_hardware && usable(row.state, reported)) features = features | CpuFeatures{row.feature};
  }
  return features;
}

CpuFeatures detect_features(const ArmCapabilities& machine) noexcept {
  return (machine.hwcap & hwcap_asimd) != 0 ? CpuFeatures{CpuFeature::asimd} : CpuFeatures{};
}

bool splits_512_bits(const CpuidRegisters& machine) noexcept {
  return machine.leaf0_ebx == amd_letters && family_of(machine.leaf1_eax) == 0x19u &&
         detect_features(machine).contains({CpuFeature::avx512f});
}

#if defined(__x86_64__) || defined(__i386__)

CpuidRegisters read_cpuid() noexcept {
  CpuidRegisters machine;
  std::uint32_t eax = 0, ebx = 0, ecx = 0, edx = 0;
  // The casts are for clang, whose header returns int.
  machine.max_leaf = static_cast<std::uint32_t>(__get_cpuid_max(0, nullptr));
  machine.max_extended_leaf = static_cast<std::uint32_t>(__get_cpuid_max(0x80000000u, nullptr));
  if (__get_cpuid(0, &eax, &ebx, &ecx, &edx) != 0) machine.leaf0_ebx = ebx;
  if (__get_cpuid(1, &machine.leaf1_eax, &ebx, &machine.leaf1_ecx, &machine.leaf1_edx) != 0 &&
      (machine.leaf1_ecx & osxsave_bit) != 0) {
    // In assembly because the intrinsic needs -mxsave, which would let the compiler use more than the
    // baseline.
    __asm__ volatile("xgetbv" : "=a"(eax), "=d"(edx) : "c"(0));
    machine.xcr0 = std::uint64_t{edx} << 32 | eax;
  }
  __get_cpuid_count(7, 0, &eax, &machine.leaf7_ebx, &machine.leaf7_ecx, &machine.leaf7_edx);
  if (__get_cpuid(first_extended_leaf, &eax, &ebx, &ecx, &edx) != 0) machine.extended1_ecx = ecx;
  return machine;
}

#else

CpuidRegisters read_cpuid() noexcept {
  return {};
}

#endif

ArmCapabilities read_arm_capabilities() noexcept {
#if defined(__aarch64__) && defined(__linux__)
  return {getauxval(AT_HWCAP), getauxval(AT_HWCAP2)};
#else
  return {};
#endif
}

namespace {

std::uint32_t known_of_machine() noexcept {
  // Relaxed suffices: the word is all there is to publish, and every thread that races computes the same one.
  std::uint32_t cached = machine_cache.load(std::memory_order_relaxed);
  if ((cached & known_bit) == 0) {
    const CpuidRegisters machine = read_cpuid();
    const CpuFeatures features = detect_features(machine) | detect_features(read_arm_capabilities());
    cached = features.bits() | (splits_512_bits(machine) ? splits_bit : 0u) | known_bit;
    machine_cache.store(cached, std::memory_order_relaxed);
  }
  return cached;
}

}  // namespace

CpuFeatures machine_features() noexcept {
  return CpuFeatures::from_bits(known_of_machine() & ~(known_bit | splits_bit));
}

bool machine_splits_512_bits() noexcept {
  return (known_of_machine() & splits_bit) != 0;
}

}  // namespace raylanes

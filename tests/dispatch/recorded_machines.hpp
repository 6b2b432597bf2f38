// The registers that CPUID returned on real and on constructed machines, with the path each should choose, and the bits
// that each feature is.
#pragma once

#include <raylanes/cpu_features.hpp>

#include "../support/testing.hpp"

namespace raylanes {

struct Recorded {
  const char* cpu;
  CpuidRegisters registers;
  const char* best;
};

inline constexpr std::uint32_t intel_last = 0x80000008u;
inline constexpr std::uint32_t amd = 0x68747541u, intel = 0x756e6547u;  // "Auth", "Genu"

// Columns: max_leaf, max_extended_leaf, leaf 1 ECX and EDX, leaf 7 EBX, ECX and EDX, leaf 0x80000001 ECX, XCR0; of
// some, leaf 0 EBX and leaf 1 EAX by their vendor, family, model and stepping. Unless marked "constructed", the other
// numbers are those the named processor was seen to return in public CPUID dumps (the InstLatx64 collection). The
// dumps hold no XCR0: it is inferred from the size of the enabled save area in leaf 0xD (0x240: XMM only, 0x340: with
// YMM, 0x980 or 0xa80: with ZMM, 0x2b00: with tiles too).
using Cpu = CpuidRegisters;
inline constexpr Cpu haswell{0xd, intel_last, 0x7ffafbff, 0xbfebfbff, 0x000027ab, 0, 0, 0x00000021, 0x7},
    skylake_x{0x16, intel_last, 0x7ffefbbf, 0xbfebfbff, 0xd39ffffb, 0, 0, 0x121, 0xff, intel, 0x00050654};
template <class Word>
constexpr Cpu with(Cpu machine, Word Cpu::*word, std::type_identity_t<Word> value) {
  machine.*word = value;
  return machine;
}
inline constexpr Recorded recorded_machines[] = {
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
    {"Core i7-4770 (Haswell)", haswell, "avx2"},
    {"Opteron X3216 (Excavator)",
     {0xd, 0x8000001e, 0x7ed8320b, 0x178bfbff, 0x000001a9, 0, 0, 0x2fabbfff, 0x7},
     "avx2"},
    {"Core i7-6500U (Skylake)",
     {0x16, intel_last, 0x7ffafbbf, 0xbfebfbff, 0x029c67af, 0, 0, 0x00000121, 0x1f},
     "avx2"},
    {"Ryzen 9 PRO 3900 (Zen 2)",
     {0x10, 0x80000020, 0x7ed8320b, 0x178bfbff, 0x219c91a9, 0x00400004, 0, 0x75c237ff, 0x7, amd, 0x00870f10},
     "avx2"},
    {"Core i9-12900K (Alder Lake, AVX-512 off)",
     {0x20, intel_last, 0x7ffafbff, 0xbfebfbff, 0x239ca7eb, 0x98c027ac, 0xfc1cc410, 0x00000121, 0x207},
     "avx2"},
    {"Xeon Phi 7210 (Knights Landing: AVX512F and CD without DQ, BW, VL)",
     {0xd, intel_last, 0x7ff8f39f, 0xbfebfbff, 0x1c0d23ab, 0x00000001, 0x04000000, 0x00000121, 0xe7},
     "avx2"},
    // AVX-512.
    {"Core i9-7900X (Skylake-X)", skylake_x, "avx512"},
    {"Core i7-1065G7 (Ice Lake)",
     {0x1b, intel_last, 0x7ffafbbf, 0xbfebfbff, 0xf2bf27ef, 0x40405f4e, 0xbc000410, 0x00000121, 0xe7},
     "avx512"},
    {"Core i9-12900K (Alder Lake, AVX-512 on)",
     {0x20, intel_last, 0x7ffafbff, 0xbfebfbff, 0xf3bfa7eb, 0x98c07fee, 0xfc9cc510, 0x00000121, 0xe7},
     "avx512"},
    {"Xeon w7-2475X (Sapphire Rapids)",
     {0x20, intel_last, 0x7ffefbff, 0xbfebfbff, 0xf3bfbffb, 0xbb417fee, 0xffdd4430, 0x00000121, 0x602e7,
      intel, 0x000806f8},
     "avx512"},
    {"Ryzen 5 7600X (Zen 4)",
     {0x10, 0x80000028, 0x7ef8320b, 0x178bfbff, 0xf1bf97a9, 0x00405fce, 0x10000010, 0x75c237ff, 0xe7, amd,
      0x00a60f12},
     "avx512"},
    // Constructed by masking a recorded machine, as an operating system, a BIOS or a hypervisor does.
    {"constructed: Skylake-X, ZMM state off", with(skylake_x, &Cpu::xcr0, 0x7), "avx2"},
    {"constructed: Skylake-X, only the mask registers off", with(skylake_x, &Cpu::xcr0, 0xc7), "avx2"},
    {"constructed: Skylake-X, only the upper halves off", with(skylake_x, &Cpu::xcr0, 0xa7), "avx2"},
    {"constructed: Skylake-X, only the upper registers off", with(skylake_x, &Cpu::xcr0, 0x67), "avx2"},
    {"constructed: Skylake-X, ZMM state on, YMM state off", with(skylake_x, &Cpu::xcr0, 0xe3), "sse2"},
    {"constructed: Skylake-X, no OSXSAVE, stale XCR0", with(skylake_x, &Cpu::leaf1_ecx, 0x77fefbbf), "sse2"},
    {"constructed: Skylake-X, AVX alone masked", with(skylake_x, &Cpu::leaf1_ecx, 0x6ffefbbf), "sse2"},
    {"constructed: Skylake-X, AVX512F alone masked", with(skylake_x, &Cpu::leaf7_ebx, 0xd39efffb), "avx2"},
    {"constructed: Haswell, leaf 7 masked", with(haswell, &Cpu::leaf7_ebx, 0), "avx"},
    {"constructed: Haswell, max_leaf limited to 6, leaf 7 not masked", with(haswell, &Cpu::max_leaf, 6),
     "avx"},
    {"constructed: Haswell, no LZCNT without leaf 1", with(haswell, &Cpu::max_extended_leaf, 0x80000000),
     "avx"},
    {"constructed: Haswell, LZCNT off", with(haswell, &Cpu::extended1_ecx, 0x00000001), "avx"},
    {"constructed: Haswell, BMI1 off", with(haswell, &Cpu::leaf7_ebx, 0x000027a3), "avx"},
    {"constructed: Haswell, BMI2 off", with(haswell, &Cpu::leaf7_ebx, 0x000026ab), "avx"},
    {"constructed: Haswell, FMA off", with(haswell, &Cpu::leaf1_ecx, 0x7ffaebff), "avx"},
    // avx2-highway goes, avx2 stays.
    {"constructed: Haswell, AES off", with(haswell, &Cpu::leaf1_ecx, 0x7dfafbff), "avx2"},
    {"constructed: Haswell, POPCNT off", with(haswell, &Cpu::leaf1_ecx, 0x7f7afbff), "sse2"},
    {"constructed: not an x86", {}, "scalar"},
};

struct RecordedArm {
  const char* cpu;
  ArmCapabilities capabilities;
  const char* best;
};

// AT_HWCAP and AT_HWCAP2 by the "Features" that /proc/cpuinfo shows on the named machine.
inline constexpr RecordedArm recorded_arm_machines[] = {
    // fp asimd evtstrm crc32 cpuid
    {"Cortex-A72 (Raspberry Pi 4, no cryptographic extensions)", {0x887, 0}, "neon"},
    // fp asimd evtstrm aes pmull sha1 sha2 crc32 atomics fphp asimdhp cpuid asimdrdm lrcpc dcpop asimddp ssbs
    {"Neoverse N1 (Graviton 2)", {0x10119fff, 0}, "neon"},
    {"constructed: ASIMD not enabled by the kernel", {0x885, 0}, "scalar"},
    {"constructed: not an Arm", {}, "scalar"},
};

// A processor with every bit set.
inline CpuidRegisters everything() {
  return {0x20, 0x80000028, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~std::uint64_t{0}};
}

// The machine whose dump the name begins with.
inline CpuidRegisters registers_of(const std::string& cpu) {
  for (const Recorded& machine : recorded_machines) {
    if (std::string(machine.cpu).starts_with(cpu)) return machine.registers;
  }
  throw std::invalid_argument("no recorded machine " + cpu);
}
inline CpuFeatures features_of(const std::string& cpu) {
  return detect_features(registers_of(cpu));
}

struct ExpectedBit {
  CpuFeature feature;
  const char* name;
  std::uint32_t CpuidRegisters::*word;
  unsigned bit;
  const char* also_lost;  // what goes too when the bit goes
};

// From Intel's manual, vol. 2A, CPUID, in the order of its tables, not of the code under test.
inline constexpr const char* needs_avx =
    "avx, f16c, fma, avx2, avx512f, avx512cd, avx512dq, avx512bw, avx512vl";
inline constexpr const char* needs_avx512f = "avx512f, avx512cd, avx512dq, avx512bw, avx512vl";
inline constexpr ExpectedBit expected_bits[] = {
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

}  // namespace raylanes

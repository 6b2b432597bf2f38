// Which instruction-set extensions a processor has and its operating system lets programs use.
// May be included from code built for any instruction set, as may all public headers: the library calls none of their
// inline functions out of line, so no other translation unit's copy takes their place (tests/gates/inline_functions).
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace raylanes {

// One extension; the value is its bit in CpuFeatures. The order is that of feature_names.
enum class CpuFeature : std::uint32_t {
  sse2 = 1u << 0,
  sse3 = 1u << 1,
  ssse3 = 1u << 2,
  sse4_1 = 1u << 3,
  sse4_2 = 1u << 4,
  popcnt = 1u << 5,
  avx = 1u << 6,
  f16c = 1u << 7,
  fma = 1u << 8,
  avx2 = 1u << 9,
  bmi1 = 1u << 10,
  bmi2 = 1u << 11,
  lzcnt = 1u << 12,
  aes = 1u << 13,
  pclmulqdq = 1u << 14,
  avx512f = 1u << 15,
  avx512cd = 1u << 16,
  avx512dq = 1u << 17,
  avx512bw = 1u << 18,
  avx512vl = 1u << 19,
  asimd = 1u << 20,  // Arm's NEON of 128 bits, as AArch64 has it: with doubles and fused multiply-add
};

// A set of extensions; default constructed it is empty.
class CpuFeatures {
 public:
  constexpr CpuFeatures() noexcept = default;
  constexpr CpuFeatures(std::initializer_list<CpuFeature> features) noexcept {
    for (const CpuFeature feature : features) bits_ |= static_cast<std::uint32_t>(feature);
  }

  // The set whose members are the 1 bits of `bits`, as CpuFeature numbers them: the inverse of bits().
  static constexpr CpuFeatures from_bits(std::uint32_t bits) noexcept {
    CpuFeatures set;
    set.bits_ = bits;
    return set;
  }
  constexpr std::uint32_t bits() const noexcept { return bits_; }

  constexpr bool empty() const noexcept { return bits_ == 0; }
  // True if every member of `other` is a member of this set; the empty set is contained in every set.
  constexpr bool contains(CpuFeatures other) const noexcept { return (other.bits_ & ~bits_) == 0; }
  // The members of this set that are not in `other`.
  constexpr CpuFeatures without(CpuFeatures other) const noexcept { return from_bits(bits_ & ~other.bits_); }

  friend constexpr CpuFeatures operator|(CpuFeatures a, CpuFeatures b) noexcept {
    return from_bits(a.bits_ | b.bits_);
  }
  friend constexpr bool operator==(CpuFeatures a, CpuFeatures b) noexcept = default;

 private:
  std::uint32_t bits_ = 0;
};

// The names of the members as the enumerators spell them, separated by ", "; "" for the empty set.
std::string feature_names(CpuFeatures features);

// What a machine answers when asked what it can do. All zero stands for a machine without CPUID.
struct CpuidRegisters {
  std::uint32_t max_leaf = 0;           // leaf 0, EAX
  std::uint32_t max_extended_leaf = 0;  // leaf 0x80000000, EAX
  std::uint32_t leaf1_ecx = 0;
  std::uint32_t leaf1_edx = 0;
  std::uint32_t leaf7_ebx = 0;  // leaf 7, subleaf 0
  std::uint32_t leaf7_ecx = 0;
  std::uint32_t leaf7_edx = 0;
  std::uint32_t extended1_ecx = 0;  // leaf 0x80000001
  std::uint64_t xcr0 = 0;           // register state the operating system saves; read only if OSXSAVE is set
  std::uint32_t leaf0_ebx = 0;      // the vendor's first four letters
  std::uint32_t leaf1_eax = 0;      // family, model and stepping

  friend bool operator==(const CpuidRegisters&, const CpuidRegisters&) noexcept = default;
};

// The extensions a program may use on the recorded machine. A pure function.
// An extension counts if its CPUID bit is set, the leaf exists (leaf 1, leaf 7 and leaf 0x80000001 are
// ignored above max_leaf and max_extended_leaf), and the operating system saves its registers: AVX, F16C, FMA
// and AVX2 need the AVX bit, OSXSAVE and XCR0 bits 1 and 2 (XMM, YMM); the AVX-512 extensions need on top of
// these AVX512F and XCR0 bits 5, 6 and 7 (masks, upper halves, upper registers). Source: Intel, Software
// Developer's Manual vol. 1, 14.3 and 15.2 (2023); AMD, Programmer's Manual vol. 3, appendix E (2023) for
// LZCNT.
CpuFeatures detect_features(const CpuidRegisters& machine) noexcept;

/// What Linux tells a program on Arm of its processor: getauxval(AT_HWCAP) and getauxval(AT_HWCAP2), 64 bits each. Zero
/// stands for a machine that is no Arm.
struct ArmCapabilities {
  std::uint64_t hwcap = 0;
  std::uint64_t hwcap2 = 0;

  friend bool operator==(const ArmCapabilities&, const ArmCapabilities&) noexcept = default;
};

/// Returns the extensions that a program may use on the recorded Arm machine. A pure function.
/// asimd is bit 1 of hwcap, HWCAP_ASIMD; the kernel sets it only if it saves the registers. Source: Linux,
/// Documentation/arch/arm64/elf_hwcaps.rst.
CpuFeatures detect_features(const ArmCapabilities& machine) noexcept;

// Whether the recorded machine executes operations of 512 bits in two passes of 256: what the divider and the
// multipliers do in a cycle is then in another proportion than where they are twice as wide. True for AMD's family 19h
// with AVX512F (Zen 4; Zen 3, of the same family, has none), false for all others: processors that are not known are
// taken for as wide as their registers. A pure function. Source: AMD, Software Optimization Guide for the Zen 4
// Microarchitecture, 57647 (2023).
bool splits_512_bits(const CpuidRegisters& machine) noexcept;

// Reads the machine this runs on. Leaves it does not have, and XCR0 without OSXSAVE, read as zero, and so
// does everything on a processor that is not an x86. Executes CPUID, which costs microseconds under a
// hypervisor.
CpuidRegisters read_cpuid() noexcept;

/// Reads the machine that this runs on. Both words are zero on a processor that is no Arm, and where there is no
/// getauxval.
ArmCapabilities read_arm_capabilities() noexcept;

// What detect_features makes of read_cpuid() and read_arm_capabilities(), read once and kept. Thread-safe, and usable
// before main.
CpuFeatures machine_features() noexcept;

// splits_512_bits(read_cpuid()), in the same way.
bool machine_splits_512_bits() noexcept;

}  // namespace raylanes

// Which instruction-set extensions a processor has and its operating system lets programs use.
// May be included from code built for any instruction set, as may all public headers: the library calls none of their
// inline functions out of line, so no other translation unit's copy takes their place (tests/gates/inline_functions).
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace raylanes {

/// An extension of an instruction set; the value is its bit in CpuFeatures.
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
  asimd = 1u << 20,  ///< Arm's NEON of AArch64: 128 bits, doubles, fused multiply-add
};

/// A set of extensions; a default-constructed one is empty.
class CpuFeatures {
 public:
  /// Makes the empty set.
  constexpr CpuFeatures() noexcept = default;
  /// Makes the set of these extensions.
  constexpr CpuFeatures(std::initializer_list<CpuFeature> features) noexcept {
    for (const CpuFeature feature : features) bits_ |= static_cast<std::uint32_t>(feature);
  }

  /// Returns the set of the extensions whose bits are 1: the inverse of bits().
  static constexpr CpuFeatures from_bits(std::uint32_t bits) noexcept {
    CpuFeatures set;
    set.bits_ = bits;
    return set;
  }
  /// Returns the bits of the extensions in the set.
  constexpr std::uint32_t bits() const noexcept { return bits_; }

  /// Returns whether the set is empty.
  constexpr bool empty() const noexcept { return bits_ == 0; }
  /// Returns whether every extension in `other` is in this set.
  constexpr bool contains(CpuFeatures other) const noexcept { return (other.bits_ & ~bits_) == 0; }
  /// Returns the extensions in this set that are not in `other`.
  constexpr CpuFeatures without(CpuFeatures other) const noexcept { return from_bits(bits_ & ~other.bits_); }

  /// Returns the extensions in either set.
  friend constexpr CpuFeatures operator|(CpuFeatures a, CpuFeatures b) noexcept {
    return from_bits(a.bits_ | b.bits_);
  }
  friend constexpr bool operator==(CpuFeatures a, CpuFeatures b) noexcept = default;

 private:
  std::uint32_t bits_ = 0;
};

/// Returns the names of the extensions, separated by ", "; an empty string for the empty set.
std::string feature_names(CpuFeatures features);

/// The results of CPUID and XGETBV on an x86 machine. All zeros: a machine without CPUID.
struct CpuidRegisters {
  std::uint32_t max_leaf = 0;           ///< leaf 0, EAX
  std::uint32_t max_extended_leaf = 0;  ///< leaf 0x80000000, EAX
  std::uint32_t leaf1_ecx = 0;
  std::uint32_t leaf1_edx = 0;
  std::uint32_t leaf7_ebx = 0;  ///< leaf 7, subleaf 0
  std::uint32_t leaf7_ecx = 0;
  std::uint32_t leaf7_edx = 0;
  std::uint32_t extended1_ecx = 0;  ///< leaf 0x80000001
  std::uint64_t xcr0 = 0;       ///< registers that the operating system saves; read only if OSXSAVE is set
  std::uint32_t leaf0_ebx = 0;  ///< the first four letters of the vendor
  std::uint32_t leaf1_eax = 0;  ///< family, model and stepping

  friend bool operator==(const CpuidRegisters&, const CpuidRegisters&) noexcept = default;
};

/// Returns the extensions that a program may use on the recorded machine. A pure function.
/// An extension counts if its CPUID bit is set, its leaf exists, and the operating system saves its registers. AVX,
/// F16C, FMA and AVX2 need the AVX bit, OSXSAVE and XCR0 bits 1 and 2 (XMM, YMM). AVX-512 also needs AVX512F and XCR0
/// bits 5, 6 and 7 (masks, upper halves, upper registers).
/// Source: Intel, Software Developer's Manual vol. 1, 14.3 and 15.2 (2023); AMD, Programmer's Manual vol. 3, appendix E
/// (2023) for LZCNT.
CpuFeatures detect_features(const CpuidRegisters& machine) noexcept;

/// The results of getauxval(AT_HWCAP) and getauxval(AT_HWCAP2) on Linux on Arm. Zeros: not an Arm machine.
struct ArmCapabilities {
  std::uint64_t hwcap = 0;
  std::uint64_t hwcap2 = 0;

  friend bool operator==(const ArmCapabilities&, const ArmCapabilities&) noexcept = default;
};

/// Returns the extensions that a program may use on the recorded Arm machine. A pure function.
/// asimd is bit 1 of hwcap, HWCAP_ASIMD; the kernel sets it only if it saves the registers. Source: Linux,
/// Documentation/arch/arm64/elf_hwcaps.rst.
CpuFeatures detect_features(const ArmCapabilities& machine) noexcept;

/// Returns whether the recorded machine executes 512-bit operations in two passes of 256 bits. A pure function.
/// That changes which square root is fastest: the divider is then as fast as the multipliers, by comparison. True for
/// AMD's family 19h with AVX512F (Zen 4), false for all others, unknown processors included.
/// Source: AMD, Software Optimization Guide for the Zen 4 Microarchitecture, 57647 (2023).
bool splits_512_bits(const CpuidRegisters& machine) noexcept;

/// Reads CPUID and XCR0 of this machine. Missing leaves are zeros, and so is everything on processors other than x86.
/// CPUID takes microseconds under a hypervisor.
CpuidRegisters read_cpuid() noexcept;

/// Reads the capabilities of this machine. Both words are zero on processors other than Arm, and without getauxval.
ArmCapabilities read_arm_capabilities() noexcept;

/// Returns the extensions of this machine, detected once. Thread-safe; may be called before main.
CpuFeatures machine_features() noexcept;

/// Returns splits_512_bits() of this machine, detected once. Thread-safe; may be called before main.
bool machine_splits_512_bits() noexcept;

}  // namespace raylanes

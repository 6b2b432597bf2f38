// ISA paths: which builds of the kernels this library contains, which of them this machine can run, and which one is
// active. All functions are thread-safe, and may be called before main.
#pragma once

#include <span>
#include <string_view>

#include <raylanes/cpu_features.hpp>

namespace raylanes {

/// An ISA path: one build of all kernels.
struct Path {
  const char* name;      ///< unique; find_path() and RAYLANES_PATH accept it
  const char* isa;       ///< instruction set: "scalar", "sse2", "avx", "avx2", "avx512" or "neon"
  const char* library;   ///< SIMD library that it is written over: "none", "xsimd" or "highway"
  int lanes;             ///< floats in a vector
  CpuFeatures required;  ///< every extension that the compiler may use in it

  /// Returns whether its grade fast fuses multiply and add.
  constexpr bool has_fma() const noexcept {
    return required.contains({CpuFeature::fma}) || required.contains({CpuFeature::asimd});
  }

 private:
  friend struct PathKernels;
  constexpr Path(const char* name_, const char* isa_, const char* library_, int lanes_, CpuFeatures required_,
                 const struct KernelTable& kernels)
      : name(name_), isa(isa_), library(library_), lanes(lanes_), required(required_), kernels_(kernels) {}

  const KernelTable& kernels_;
};

/// Returns all ISA paths of this build, slowest first. The first is "scalar", which requires nothing.
/// The objects live as long as the program, and never move.
std::span<const Path> paths() noexcept;

/// Returns whether the processor has all that `path` requires, and the operating system saves its registers.
bool supported(const Path& path) noexcept;

/// Returns whether a machine with exactly `features` supports `path`. A pure function.
bool supported(const Path& path, CpuFeatures features) noexcept;

/// Returns the path with this name; names are case-sensitive.
/// Throws std::invalid_argument, with one line, if no path has this name or this machine does not support it. The
/// message names the missing extensions and the supported paths.
const Path& find_path(std::string_view name);

/// Returns the path with this name for a machine with exactly `features`. Throws as find_path(name). A pure function.
const Path& find_path(std::string_view name, CpuFeatures features);

/// Returns the last path in paths() that a machine with `features` supports; "scalar" for the empty set. A pure
/// function.
const Path& best_path(CpuFeatures features) noexcept;

/// Returns the path that a machine with `features` uses if RAYLANES_PATH has the value `environment`.
/// If it is null (unset) or empty, that is best_path(features). Otherwise it is find_path(environment, features), which
/// throws std::invalid_argument; the message names RAYLANES_PATH. A pure function.
const Path& choose_path(CpuFeatures features, const char* environment);

/// Returns the active path: the forced one, else choose_path(machine_features(), getenv("RAYLANES_PATH")).
/// The choice is made at the first call without a forced path, and kept. Threads that race for it get the same path. No
/// thread may change the environment meanwhile.
/// Throws std::invalid_argument if RAYLANES_PATH is not a supported path; the next call reads the variable again.
const Path& active_path();

/// Makes the path with this name the active one for all threads, whatever RAYLANES_PATH says, until the next call of
/// force_path() or unforce_path(). A concurrent active_path() returns the old or the new path.
/// Throws as find_path() does, and then changes nothing.
void force_path(std::string_view name);

/// Undoes force_path(); does nothing if no path is forced.
void unforce_path() noexcept;

}  // namespace raylanes

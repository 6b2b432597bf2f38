// The paths: which builds of the kernels this library contains, which of them this machine can run, and which
// one is in use. Everything here is thread-safe and may be called from a static initialiser, before main.
// Baseline code only, like cpu_features.hpp: never include it from a path's own translation unit.
#pragma once

#include <span>
#include <string_view>

#include <raylanes/cpu_features.hpp>

namespace raylanes {

// One build of all kernels.
struct Path {
  const char* name;      // unique; what find_path and RAYLANES_PATH accept
  const char* isa;       // instruction set: "scalar", "sse2", "avx", "avx2", "avx512" or "neon"
  const char* library;   // what spells the instructions: "none", "xsimd" or "highway"
  int lanes;             // float lanes of its vectors
  CpuFeatures required;  // every extension the compiler may use in it

  // Whether its fast grade fuses multiply and add.
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

// All paths compiled in, worst first; never empty. The first is "scalar", which requires nothing. The objects
// live as long as the program and never move: two references to the same path have the same address.
std::span<const Path> paths() noexcept;

// True if the processor has all that `path` requires and the operating system saves its registers.
bool supported(const Path& path) noexcept;

// The same for a machine with exactly `features`. A pure function.
bool supported(const Path& path, CpuFeatures features) noexcept;

// The path with this name (case counts). Throws std::invalid_argument with a message of one line if there is
// none, naming all paths and those supported here, or if it is not supported here, naming the extensions that
// are missing and the paths supported here.
const Path& find_path(std::string_view name);

// The same for a machine with exactly `features`. A pure function.
const Path& find_path(std::string_view name, CpuFeatures features);

// The last path in paths() that a machine with `features` supports; "scalar" for the empty set. A pure
// function.
const Path& best_path(CpuFeatures features) noexcept;

// The path a machine with `features` uses when RAYLANES_PATH has the value `environment`: null (unset) or ""
// gives best_path, a name gives find_path and throws as it does, with RAYLANES_PATH named in the message.
// A pure function.
const Path& choose_path(CpuFeatures features, const char* environment);

// The path in use: the forced one, else choose_path(machine_features(), getenv("RAYLANES_PATH")), resolved at
// the first call that finds no forced path and kept from then on. Throws std::invalid_argument if
// RAYLANES_PATH is not a supported path; that is not kept, so the next call reads the variable again. Threads
// that race for the first resolution get the same path. As with every getenv, no thread may change the
// environment meanwhile.
const Path& active_path();

// Makes `name` the path in use, whatever RAYLANES_PATH says, for all threads and until the next call of
// force_path or unforce_path. A call of active_path that runs at the same time returns the old or the new
// path. Throws as find_path does and then changes nothing.
void force_path(std::string_view name);

// Undoes force_path; does nothing if no path is forced.
void unforce_path() noexcept;

}  // namespace raylanes

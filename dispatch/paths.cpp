#ifdef _WIN32
#include <windows.h>
#endif

#include <atomic>
#include <cstdlib>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include <raylanes/paths.hpp>
#include <raylanes/version.hpp>

#include "checked.hpp"
#include "table/kernel_table.hpp"
#include "table/traversal.hpp"

namespace raylanes {

// The objects of a path, each from a translation unit of its own, built with the flags of its path, become one table: a
// constant before main. Some come from another path with the same instructions, as the build says.
#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_SHARED(path) detail::RAYLANES_JOIN(RAYLANES_INSTRUCTIONS_OF_, path)
#define RAYLANES_PATH(path)                                                                        \
  namespace RAYLANES_SHARED(path) {                                                                \
    extern const TraversalKernels counted;                                                         \
    extern const PointKernels points;                                                              \
    extern const WindingKernels winding;                                                           \
    extern const AllQueryKernels queries;                                                          \
    extern const DoubleRayKernels doubles;                                                         \
  }                                                                                                \
  namespace detail::path {                                                                         \
  extern const RootKernels roots;                                                                  \
  extern const TriangleKernels triangles;                                                          \
  extern const BoxKernels boxes;                                                                   \
  extern const SphereKernels spheres;                                                              \
  extern const TraversalKernels traversal;                                                         \
  extern const KdKernels kdtree;                                                                   \
  namespace shared = RAYLANES_SHARED(path);                                                        \
  constexpr KernelTable kernels{roots,           triangles,       boxes,           spheres,        \
                                traversal,       kdtree,          shared::counted, shared::points, \
                                shared::winding, shared::queries, shared::doubles};                \
  }
RAYLANES_EACH_PATH(RAYLANES_PATH)

namespace {

using enum CpuFeature;

// The instructions that the compiler may use under each set of flags, including what a flag implies. Under -mavx also
// XSAVE, which OSXSAVE vouches for. A path that required less could meet an illegal instruction.
constexpr CpuFeatures sse2_flags{sse2};
constexpr CpuFeatures avx_flags = sse2_flags | CpuFeatures{sse3, ssse3, sse4_1, sse4_2, popcnt, avx};
constexpr CpuFeatures avx2_flags = avx_flags | CpuFeatures{avx2, fma, bmi1, bmi2, lzcnt};
// F16C because clang takes it to be part of -mavx512f (g++ does not).
constexpr CpuFeatures avx512_flags =
    avx2_flags | CpuFeatures{f16c, avx512f, avx512cd, avx512dq, avx512bw, avx512vl};
// Highway's AVX2 target exists only with these on top of -mavx2 -mfma -mbmi -mbmi2.
constexpr CpuFeatures highway_flags{f16c, aes, pclmulqdq};

// The facts about each path, built or not.
struct PathFacts {
  const char *name, *isa, *library;
  int lanes;
  CpuFeatures required;
};
namespace facts {
constexpr PathFacts scalar{"scalar", "scalar", "none", 1, {}};
[[maybe_unused]] constexpr PathFacts neon{"neon", "neon", "highway", 4, {asimd}};
[[maybe_unused]] constexpr PathFacts sse2{"sse2", "sse2", "xsimd", 4, sse2_flags};
[[maybe_unused]] constexpr PathFacts avx{"avx", "avx", "xsimd", 8, avx_flags};
[[maybe_unused]] constexpr PathFacts avx2_highway{"avx2-highway", "avx2", "highway", 8,
                                                  avx2_flags | highway_flags};
[[maybe_unused]] constexpr PathFacts avx2{"avx2", "avx2", "xsimd", 8, avx2_flags};
[[maybe_unused]] constexpr PathFacts avx512_highway{"avx512-highway", "avx512", "highway", 16,
                                                    avx512_flags | highway_flags};
[[maybe_unused]] constexpr PathFacts avx512{"avx512", "avx512", "xsimd", 16, avx512_flags};
}  // namespace facts

// Those that the build was asked for, worst first. A constant, so that a static initialiser elsewhere finds it
// complete.
#define RAYLANES_ROW(path)                                                                     \
  PathKernels::make(facts::path.name, facts::path.isa, facts::path.library, facts::path.lanes, \
                    facts::path.required, detail::path::kernels),
constexpr Path registry[] = {RAYLANES_EACH_PATH(RAYLANES_ROW)};

constinit std::atomic<const Path*> resolved_path{nullptr};

// Empty: there is no such variable. Windows is asked itself, as a program and a DLL may have C libraries of their own.
std::string environment(const char* name) {
#ifdef _WIN32
  std::string value(GetEnvironmentVariableA(name, nullptr, 0), '\0');
  value.resize(GetEnvironmentVariableA(name, value.data(), static_cast<DWORD>(value.size())));
  return value;
#else
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
#endif
}

// The name between quotes and on one line, whatever a user's environment holds.
std::string quoted(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + '"';
}

std::string all_names() {
  std::string names;
  for (const Path& path : registry) names += (names.empty() ? "" : ", ") + std::string(path.name);
  return names;
}

std::string supported_names(CpuFeatures features) {
  std::string names;
  for (const Path& path : registry) {
    if (supported(path, features)) names += (names.empty() ? "" : ", ") + std::string(path.name);
  }
  return names;
}

// `source` says where the name came from.
const Path& find_or_throw(std::string_view source, std::string_view name, CpuFeatures features) {
  for (const Path& path : registry) {
    if (name != path.name) continue;
    if (supported(path, features)) return path;
    throw std::invalid_argument(
        std::string(source) + ": path " + quoted(name) + " is not supported on this machine, which lacks " +
        feature_names(path.required.without(features)) + "; supported: " + supported_names(features));
  }
  throw std::invalid_argument(std::string(source) + ": there is no path " + quoted(name) +
                              "; paths: " + all_names() + "; supported: " + supported_names(features));
}

}  // namespace

bool KernelTable::has_counters() const {
  return counted.mode[0].row[static_cast<std::size_t>(TriangleTest::exact)][0].closest != nullptr;
}

std::span<const Path> paths() noexcept {
  return registry;
}

bool supported(const Path& path) noexcept {
  return supported(path, machine_features());
}

bool supported(const Path& path, CpuFeatures features) noexcept {
  return features.contains(path.required);
}

const Path& find_path(std::string_view name) {
  return find_path(name, machine_features());
}

const Path& find_path(std::string_view name, CpuFeatures features) {
  return find_or_throw("find_path", name, features);
}

const Path& best_path(CpuFeatures features) noexcept {
  static_assert(registry[0].required.empty(), "some path must run on every machine");
  const Path* best = std::end(registry) - 1;
  while (!supported(*best, features)) --best;
  return *best;
}

const Path& choose_path(CpuFeatures features, const char* environment) {
  if (environment == nullptr || *environment == '\0') return best_path(features);
  return find_or_throw("RAYLANES_PATH", environment, features);
}

namespace detail {

constinit std::atomic<const Path*> path_in_use{nullptr};

const Path& resolve_path() {
  const Path* resolved = resolved_path.load(std::memory_order_acquire);
  if (resolved == nullptr) {
    const Path* chosen = &choose_path(machine_features(), environment("RAYLANES_PATH").c_str());
    // The first thread to get here decides for all, even if the environment changed in between.
    if (resolved_path.compare_exchange_strong(resolved, chosen, std::memory_order_acq_rel)) resolved = chosen;
  }
  const Path* in_use = nullptr;
  return path_in_use.compare_exchange_strong(in_use, resolved, std::memory_order_acq_rel) ? *resolved
                                                                                          : *in_use;
}

}  // namespace detail

const Path& active_path() {
  return path_in_use();
}

void force_path(std::string_view name) {
  detail::path_in_use.store(&find_or_throw("force_path", name, machine_features()),
                            std::memory_order_release);
}

void unforce_path() noexcept {
  detail::path_in_use.store(nullptr, std::memory_order_release);
}

namespace {

#define RAYLANES_TEXT_OF(x) #x
#define RAYLANES_TEXT(x) RAYLANES_TEXT_OF(x)
constexpr std::string_view parts = RAYLANES_TEXT(RAYLANES_VERSION_MAJOR) "." RAYLANES_TEXT(
    RAYLANES_VERSION_MINOR) "." RAYLANES_TEXT(RAYLANES_VERSION_PATCH);
constexpr std::string_view version_text = RAYLANES_VERSION;
static_assert(version_text.substr(0, version_text.find('-')) == parts);
static_assert(version_text == RAYLANES_PROJECT_VERSION,
              "version.hpp and meson.build name different versions");

}  // namespace

const char* version() noexcept {
  return RAYLANES_VERSION;
}

}  // namespace raylanes

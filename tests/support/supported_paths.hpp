// Which paths a test can run here, said aloud: a path that is left out is never left out silently.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <raylanes/paths.hpp>

#include "../../dispatch/table/kernel_table.hpp"
#include "level.hpp"

namespace raylanes::testing {

// Whether the build counts; tests that count are skipped where it does not.
inline bool has_counters() {
  return kernels_of(paths().front()).has_counters();
}
// For suites that count.
class Counting : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_counters()) GTEST_SKIP() << "SKIPPED: this build has no counters (-Dcounters=false)";
  }
};

// The names in an environment variable, which separates them by commas.
inline std::vector<std::string> names_in(const char* variable) {
  std::vector<std::string> names;
  const char* value = std::getenv(variable);
  for (const char c : std::string_view(value != nullptr ? value : "")) {
    if (names.empty() || c == ',') names.emplace_back();
    if (c != ',') names.back() += c;
  }
  return names;
}

// Why `path` is not tested in this process; empty if it is.
inline std::string reason_to_skip(const Path& path) {
  const std::vector<std::string> wanted = names_in("RAYLANES_TEST_PATHS");
  if (!supported(path))
    return "this machine lacks " + feature_names(path.required.without(machine_features()));
  if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), path.name) == wanted.end())
    return "RAYLANES_TEST_PATHS does not name it";
  return "";
}

// The paths that this machine supports, worst first; never empty. RAYLANES_TEST_PATHS=NAME[,NAME...] leaves
// out all others, where an emulator has no time for them. The first call in a process prints one line for
// each path that is left out. Adds a test failure at every call if RAYLANES_EXPECT_PATH=NAME[,NAME...] names
// a path that does not exist or is left out: such a path is meant to be tested.
inline std::vector<const Path*> supported_paths() {
  static bool announced = false;
  std::vector<const Path*> usable;
  for (const Path& path : paths()) {
    const std::string reason = reason_to_skip(path);
    if (reason.empty())
      usable.push_back(&path);
    else if (!announced)
      std::fprintf(stderr, "SKIPPED PATH %s: %s\n", path.name, reason.c_str());
  }
  announced = true;
  for (const std::string& name : names_in("RAYLANES_EXPECT_PATH")) {
    const auto is_name = [&](const Path* path) { return name == path->name; };
    if (std::none_of(usable.begin(), usable.end(), is_name)) {
      ADD_FAILURE() << "RAYLANES_EXPECT_PATH names \"" << name << "\", which is no path supported here";
    }
  }
  return usable;
}

// For INSTANTIATE_TEST_SUITE_P.
inline std::string path_name(const ::testing::TestParamInfo<const Path*>& tested) {
  std::string name = tested.param->name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// The kernels of a path, but other roots.
inline KernelTable with_roots(const KernelTable& of, const RootKernels& roots) {
  return {roots,      of.triangles, of.boxes,   of.spheres, of.traversal, of.kdtree,
          of.counted, of.points,    of.winding, of.queries, of.doubles};
}

// One of the supported paths for each code of queries, points, winding numbers and doubles, which paths with the same
// instructions have in common.
inline std::vector<const Path*> paths_with_own_queries() {
  std::vector<const Path*> own;
  for (const Path* path : supported_paths()) {
    const auto has_its_queries = [&](const Path* other) {
      return &kernels_of(*other).queries == &kernels_of(*path).queries;
    };
    if (std::none_of(own.begin(), own.end(), has_its_queries)) own.push_back(path);
  }
  return own;
}

}  // namespace raylanes::testing

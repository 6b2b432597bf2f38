// Which paths a test can run here, said aloud: a path that is left out is never left out silently.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "../dispatch/paths.hpp"

namespace raylanes::testing {

// True if the environment variable RAYLANES_QUICK is set and neither empty nor "0": the machine is emulated,
// so a suite cuts its number of random cases (never its named edge cases).
inline bool quick() {
  const char* value = std::getenv("RAYLANES_QUICK");
  return value != nullptr && std::string_view(value) != "" && std::string_view(value) != "0";
}

// The names in the environment variable RAYLANES_EXPECT_PATH, which separates them by commas.
inline std::vector<std::string> expected_path_names() {
  std::vector<std::string> names;
  const char* value = std::getenv("RAYLANES_EXPECT_PATH");
  for (const char c : std::string_view(value != nullptr ? value : "")) {
    if (names.empty() || c == ',') names.emplace_back();
    if (c != ',') names.back() += c;
  }
  return names;
}

// The paths that this machine supports, worst first; never empty. The first call in a process prints one line
// for each path that is left out. Adds a test failure at every call if RAYLANES_EXPECT_PATH=NAME[,NAME...]
// names a path that does not exist or is not supported here: whoever sets it means that path to be tested.
inline std::vector<const Path*> supported_paths() {
  static bool announced = false;
  std::vector<const Path*> usable;
  for (const Path& path : paths()) {
    if (supported(path)) {
      usable.push_back(&path);
    } else if (!announced) {
      std::fprintf(stderr, "SKIPPED PATH %s: this machine lacks %s\n", path.name,
                   feature_names(path.required.without(machine_features())).c_str());
    }
  }
  announced = true;
  for (const std::string& name : expected_path_names()) {
    const auto is_name = [&](const Path* path) { return name == path->name; };
    if (std::none_of(usable.begin(), usable.end(), is_name)) {
      ADD_FAILURE() << "RAYLANES_EXPECT_PATH names \"" << name << "\", which is no path supported here";
    }
  }
  return usable;
}

}  // namespace raylanes::testing

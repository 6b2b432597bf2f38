// Calls that are expected to refuse: what they say, and that they do.
#pragma once

#include <exception>

#include <raylanes/paths.hpp>
#include <raylanes/types.hpp>

#include "../../dispatch/table/kernel_table.hpp"
#include "testing.hpp"

namespace raylanes {

// The message of the Error that `call` throws; "no exception" if it throws none. Other exceptions pass through.
template <class Error = std::exception, class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no exception";
}

// One line that has all the words.
inline void expect_words(const std::string& message, const std::vector<std::string>& words) {
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << "\"" << word << "\" is not in: " << message;
}

// Enumerators cast from anything. each(options, check) calls check(name, call) for every call of a door; the first test
// that does not exist is `tests`.
template <class Options, class Each>
void expect_wrong_enumerators_refused(int tests, const Each& each) {
  for (const int wrong : {tests, tests + 1, 100, 255}) {
    const auto expect_named = [&](const char* what) {
      return [=](const std::string& name, auto call) {
        EXPECT_NE(message_of(call).find(what + (' ' + std::to_string(wrong))), std::string::npos) << name;
      };
    };
    each(Options{.test = static_cast<decltype(Options::test)>(wrong)}, expect_named("test"));
    each(Options{.grade = static_cast<Grade>(wrong)}, expect_named("grade"));
  }
}

// A path that is refused everywhere, also by a machine that supports all paths of the build.
inline Path path_of_no_machine() {
  const Path& scalar = paths().front();
  return PathKernels::make("foreign", scalar.isa, scalar.library, scalar.lanes, CpuFeatures::from_bits(~0u),
                           kernels_of(scalar));
}

// Calls on the paths that this machine lacks, and on one that every machine lacks.
template <class Options, class Each>
void expect_foreign_path_refused(const Each& each) {
  const Path of_none = path_of_no_machine();
  std::vector<const Path*> foreign{&of_none};
  for (const Path& path : paths())
    if (!supported(path)) foreign.push_back(&path);
  for (const Path* path : foreign)
    each(Options{.path = path}, [path](const std::string& name, auto call) {
      EXPECT_THROW(call(), std::invalid_argument) << name << " on " << path->name;
    });
}

}  // namespace raylanes

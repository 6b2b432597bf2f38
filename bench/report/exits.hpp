// How the tool ends, so that scripts can tell wrong answers from a wrong command line.
#pragma once

#include <stdexcept>

namespace raylanes::bench {

enum class Exit { good = 0, wrong_answers = 1, usage = 2, input = 3, output = 4 };

inline constexpr const char* exit_footer =
    "Exit status: 0 good; 1 wrong answers: a promise is broken; 2 usage;\n"
    "3 input that cannot be read or used; 4 output that cannot be written";

// An answer breaks a promise of the library.
struct WrongAnswers : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Something cannot be written.
struct OutputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace raylanes::bench

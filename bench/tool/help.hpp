// The form of --help: options in groups, with choices and defaults, in lines of at most 100 characters.
#pragma once

#include <CLI/CLI.hpp>

namespace raylanes::bench {

// Gives the tool and its commands their form of help, the groups of their options, and footers with two examples and
// the exit statuses. Called when all commands are there.
void set_help(CLI::App& tool);

}  // namespace raylanes::bench

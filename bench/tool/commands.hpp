// The commands of the tool.
#pragma once

#include <CLI/CLI.hpp>

namespace raylanes::bench {

// Each adds its command with its options; parsing the command line runs it. Errors leave as exceptions.
void add_isa_command(CLI::App& tool);
void add_roots_command(CLI::App& tool);
void add_kernels_command(CLI::App& tool);
void add_trace_command(CLI::App& tool);
void add_points_command(CLI::App& tool);
void add_trees_command(CLI::App& tool);
void add_report_command(CLI::App& tool);

// Gives the tool and its commands their form of help, the groups of their options, and footers with two examples and
// the exit statuses. Called when all commands are there.
void set_help(CLI::App& tool);

}  // namespace raylanes::bench

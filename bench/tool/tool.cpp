// The tool raylanes. An error is one line on standard error and an exit status of exits.hpp.
#include <exception>
#include <iostream>
#include <new>

#include <raylanes/version.hpp>

#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../support/readers/printable.hpp"
#include "commands.hpp"

namespace {

// A message is one line of at most so many bytes.
constexpr std::size_t longest_message = 1500;

using raylanes::bench::Exit;

int fail(Exit status, const std::string& message) {
  std::cerr << "raylanes: " << raylanes::bench::printable(message, longest_message) << '\n';
  return static_cast<int>(status);
}

int run(int argc, char** argv) {
  CLI::App tool("raylanes: square roots and ray tracing on every instruction set", "raylanes");
  tool.set_version_flag("--version", raylanes::version());
  tool.require_subcommand(1);
  raylanes::bench::add_isa_command(tool);
  raylanes::bench::add_roots_command(tool);
  raylanes::bench::add_kernels_command(tool);
  raylanes::bench::add_trace_command(tool);
  raylanes::bench::add_points_command(tool);
  raylanes::bench::add_trees_command(tool);
  raylanes::bench::add_report_command(tool);
  raylanes::bench::set_help(tool);
  int status = 0;
  try {
    tool.parse(argc, argv);
  } catch (const CLI::Success& help) {
    status = tool.exit(help);
  } catch (const CLI::Error& error) {
    return fail(Exit::usage, error.what() + std::string(" (--help lists the options)"));
  }
  raylanes::bench::check_standard_output();
  return status;
}

}  // namespace

int main(int argc, char** argv) try { return run(argc, argv); } catch (const std::bad_alloc&) {
  return fail(Exit::input, "not enough memory");
} catch (const raylanes::bench::WrongAnswers& error) {
  return fail(Exit::wrong_answers, error.what());
} catch (const raylanes::bench::OutputError& error) {
  return fail(Exit::output, error.what());
} catch (const std::invalid_argument& error) {
  return fail(Exit::usage, error.what());
} catch (const std::exception& error) {
  return fail(Exit::input, error.what());
}

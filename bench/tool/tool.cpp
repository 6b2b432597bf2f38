// raylanes: what a user would otherwise script. Wrong input ends with one line on standard error and exit 2.
#include <exception>
#include <iostream>
#include <new>

#include "../readers/printable.hpp"
#include "../report/output.hpp"
#include "commands.hpp"

namespace {

// Whatever a message quotes, it stays one line of bounded length.
constexpr std::size_t longest_message = 1500;

int fail(const std::string& message) {
  constexpr int wrong_input = 2;
  std::cerr << "raylanes: " << raylanes::bench::printable(message, longest_message) << '\n';
  return wrong_input;
}

int run(int argc, char** argv) {
  CLI::App tool("raylanes: square roots and ray tracing on every instruction set", "raylanes");
  tool.set_version_flag("--version", RAYLANES_VERSION);
  tool.require_subcommand(1);
  raylanes::bench::add_isa_command(tool);
  raylanes::bench::add_sqrt_command(tool);
  raylanes::bench::add_kernels_command(tool);
  raylanes::bench::add_trace_command(tool);
  raylanes::bench::add_scenes_command(tool);
  raylanes::bench::add_inside_command(tool);
  raylanes::bench::add_animate_command(tool);
  raylanes::bench::add_closest_command(tool);
  raylanes::bench::add_trees_command(tool);
  raylanes::bench::add_choose_command(tool);
  raylanes::bench::add_summary_command(tool);
  int status = 0;
  try {
    tool.parse(argc, argv);
  } catch (const CLI::Success& help) {
    status = tool.exit(help);
  } catch (const CLI::Error& error) {
    return fail(error.what() + std::string(" (--help lists the options)"));
  }
  raylanes::bench::check_standard_output();
  return status;
}

}  // namespace

int main(int argc, char** argv) try { return run(argc, argv); } catch (const std::bad_alloc&) {
  return fail("not enough memory");
} catch (const std::exception& error) {
  return fail(error.what());
}

// raylanes: what a user would otherwise script. Wrong input ends with one line on standard error and exit 2.
#include <exception>
#include <iostream>

#include "commands.hpp"

int main(int argc, char** argv) {
  CLI::App tool("raylanes: square roots and ray tracing on every instruction set", "raylanes");
  tool.set_version_flag("--version", RAYLANES_VERSION);
  tool.require_subcommand(1);
  constexpr int wrong_input = 2;
  try {
    raylanes::bench::add_isa_command(tool);
    raylanes::bench::add_sqrt_command(tool);
    raylanes::bench::add_kernels_command(tool);
    raylanes::bench::add_trace_command(tool);
    tool.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return tool.exit(help);
  } catch (const CLI::Error& error) {
    std::cerr << "raylanes: " << error.what() << " (--help lists the options)\n";
    return wrong_input;
  } catch (const std::exception& error) {
    std::cerr << "raylanes: " << error.what() << '\n';
    return wrong_input;
  }
  return 0;
}

// raylanes: what a user would otherwise script. A fault is one line on standard error and a status of exits.hpp.
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <raylanes/version.hpp>

#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../support/readers/printable.hpp"
#include "commands.hpp"

namespace {

// Whatever a message quotes, it stays one line of bounded length.
constexpr std::size_t longest_message = 1500;

using raylanes::bench::Exit;

constexpr std::pair<const char*, const char*> examples_of[] = {
    {"isa", "  raylanes isa\n  raylanes isa --verify --json -\n"},
    {"roots", "  raylanes roots --stride 2048\n  raylanes roots --path all --method hardware,goldschmidt\n"},
    {"kernels", "  raylanes kernels --path all\n  raylanes kernels --test exact,watertight --pairs 100000\n"},
    {"trace",
     "  raylanes trace mesh.obj --image picture.png\n"
     "  raylanes trace mesh.obj --path all --against embree --json out.json\n"},
    {"points",
     "  raylanes points mesh.obj --against embree\n"
     "  raylanes points mesh.obj --query inside --points grid --image slice.png\n"},
    {"trees",
     "  raylanes trees mesh.obj --against embree\n"
     "  raylanes trees --frames frame*.ply --policy refit,rebuild\n"},
    {"report",
     "  raylanes report mesh.obj --out report\n"
     "  raylanes report --compare old/report.json new/report.json\n"}};

int fail(Exit status, const std::string& message) {
  std::cerr << "raylanes: " << raylanes::bench::printable(message, longest_message) << '\n';
  return static_cast<int>(status);
}

int run(int argc, char** argv) {
  CLI::App tool("raylanes: square roots and ray tracing on every instruction set", "raylanes");
  tool.set_version_flag("--version", raylanes::version());
  tool.require_subcommand(1);
  tool.footer(raylanes::bench::exit_footer);
  raylanes::bench::add_isa_command(tool);
  raylanes::bench::add_roots_command(tool);
  raylanes::bench::add_kernels_command(tool);
  raylanes::bench::add_trace_command(tool);
  raylanes::bench::add_points_command(tool);
  raylanes::bench::add_trees_command(tool);
  raylanes::bench::add_report_command(tool);
  for (const auto& [name, examples] : examples_of) {
    CLI::App* const command = tool.get_subcommand(name);
    command->footer("examples:\n" + std::string(examples) + raylanes::bench::exit_footer);
    for (const char* output : {"--json", "--image", "--heatmap", "--counters"})
      if (CLI::Option* const option = command->get_option_no_throw(output)) option->group("Output");
  }
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

// The report is made by Python, which draws plots; this hands its command line on.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "../report/exits.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct ReportOptions {
  std::vector<std::string> scenes, compared;
  std::string out;
  double seconds = 0.2;
  bool resume = false;
};

constexpr const char* script_name = "run_report.py";

// Beside an installed tool, else in the source tree.
std::filesystem::path script_of(const std::filesystem::path& tool) {
  const std::filesystem::path installed =
      tool.parent_path().parent_path() / "share/raylanes/report" / script_name;
  return exists(installed) ? installed : std::filesystem::path(RAYLANES_PLOTS) / script_name;
}

void run(const ReportOptions& options) {
  if (options.out.empty() == options.compared.empty())
    throw std::invalid_argument("report: give either --out DIR or --compare A.json B.json");
  const std::filesystem::path tool = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<std::string> words{RAYLANES_PLOT_PYTHON, script_of(tool).string(), tool.string()};
  if (!options.compared.empty()) {
    words.insert(words.end(), {"--compare=" + options.compared[0], "--compare=" + options.compared[1]});
  } else {
    words.insert(words.end(), {"--out=" + options.out, "--seconds", std::to_string(options.seconds)});
    if (options.resume) words.push_back("--resume");
    for (const std::string& scene : options.scenes) words.push_back("--scene=" + scene);
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  throw std::runtime_error("report: " + words[0] + " cannot be started: " + std::strerror(errno));
}

}  // namespace

void add_report_command(CLI::App& tool) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = tool.add_subcommand(
      "report", "measure this machine: one page with plots, renders and what to call, and its JSON");
  command->add_option("SCENE", options->scenes,
                      "mesh files or built-in scenes (default: spheres hall fractal)");
  command->add_option("--out", options->out, "folder for index.html and report.json");
  command
      ->add_option("--seconds", options->seconds,
                   "seconds to time each ray set on each instruction set (default 0.2)")
      ->check(CLI::Range(0.0, 1e6));
  command->add_flag("--resume", options->resume, "keep what the folder has of the same measurements");
  command
      ->add_option(
          "--compare", options->compared,
          "two report.json: rows whose speed differs beyond the noise; exit status 1 if ours is slower")
      ->expected(2);
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench

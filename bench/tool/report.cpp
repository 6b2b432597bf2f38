// Starts the Python script that measures, draws plots and writes the report.
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "../../dispatch/checked.hpp"
#include "commands.hpp"
#include "shared_options.hpp"

namespace raylanes::bench {
namespace {

struct ReportOptions : SharedOptions {
  std::vector<std::string> compared;
  std::string out, summary;
  bool resume = false;
};

constexpr const char* script_name = "run_report.py";

// The script beside an installed tool, else the script in the source tree.
std::filesystem::path script_of(const std::filesystem::path& tool) {
  const std::filesystem::path installed =
      tool.parent_path().parent_path() / "share/raylanes/report" / script_name;
  return exists(installed) ? installed : std::filesystem::path(RAYLANES_PLOTS) / script_name;
}

void run(const ReportOptions& options) {
  if (!options.out.empty() + !options.compared.empty() + !options.summary.empty() != 1)
    throw std::invalid_argument("report: give --out DIR, --compare A.json B.json or --summary DIR");
  const std::filesystem::path tool = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<std::string> words{RAYLANES_PLOT_PYTHON, script_of(tool).string(), tool.string()};
  if (!options.summary.empty()) {
    words.push_back("--summary=" + options.summary);
  } else if (!options.compared.empty()) {
    words.insert(words.end(), {"--compare=" + options.compared[0], "--compare=" + options.compared[1]});
  } else {
    words.insert(words.end(), {"--out=" + options.out, "--seconds", text_of(options.seconds)});
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
  CLI::App* command =
      tool.add_subcommand("report", "measure this machine, write a page of plots, renders and advice");
  options->seconds = 0.2;
  options->declare(*command, {"SCENE", "--seconds"});
  command->add_option("--out", options->out, "write index.html and report.json to this folder");
  command->add_flag("--resume", options->resume,
                    "keep measurements with the same options that the folder has");
  command
      ->add_option(
          "--compare", options->compared,
          "list rows of two report.json whose speed differs beyond noise; exit status 1 if ours is slower")
      ->expected(2);
  command->add_option("--summary", options->summary,
                      "print isa.json, roots.json and trace.json of this folder on one screen");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench

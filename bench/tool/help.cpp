#include "../report/exits.hpp"
#include "../report/table_format.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

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

constexpr std::pair<const char*, const char*> groups_of[] = {
    {"--json", "Output"},       {"--format", "Output"},      {"--columns", "Output"},
    {"--image", "Output"},      {"--heatmap", "Output"},     {"--counters", "Output"},
    {"--out", "Output"},        {"--resume", "Output"},      {"--path", "Measuring"},
    {"--seconds", "Measuring"}, {"--threads", "Measuring"},  {"--against", "Measuring"},
    {"--rounds", "Measuring"},  {"--pairs", "Measuring"},    {"--leak-rays", "Measuring"},
    {"--stride", "Measuring"},  {"--choose", "Other uses"},  {"--frames", "Other uses"},
    {"--verify", "Other uses"}, {"--compare", "Other uses"}, {"--summary", "Other uses"}};

// Text in lines no longer than a table.
class Wrapped {
 public:
  explicit Wrapped(std::string begin) : line_(std::move(begin)) {}
  // Appends a word, on a new line with an indentation if it does not fit.
  void add(const std::string& word, std::size_t indentation, const std::string& space = " ") {
    if (width_of(line_ + space + word) > max_table_width)
      text_ += line_ + '\n', line_ = std::string(indentation, ' ') + word;
    else
      line_ += space + word;
  }
  // Continues at a column, on a new line if the line is longer.
  void indent(std::size_t column) {
    if (width_of(line_) > column) text_ += line_ + '\n', line_.clear();
    line_.resize(line_.size() + column - width_of(line_), ' ');
  }
  std::string text() const { return text_ + line_ + '\n'; }

 private:
  std::string text_, line_;
};

class Formatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0) return "";
    const std::string type = option->get_type_name();
    const bool is_list = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    return " " + type + (is_list ? " ..." : "");
  }

  // Long lists of choices continue after a comma.
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    constexpr std::size_t deep = 6, column = 22;
    Wrapped lines("  " + make_option_name(option, is_positional));
    std::istringstream parts(make_option_opts(option));
    for (std::string part; parts >> part;) {
      std::string space = " ";
      for (std::size_t begin = 0, end = 0; begin < part.size(); begin = end, space = "") {
        end = std::min(part.size(), part.find(',', begin)) + 1;
        lines.add(part.substr(begin, end - begin), deep, space);
      }
    }
    lines.indent(column - 1);
    std::istringstream words(
        option->get_description() +
        (option->get_default_str().empty() ? "" : " (default: " + option->get_default_str() + ")"));
    for (std::string word; words >> word;) lines.add(word, column);
    return lines.text();
  }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, std::move(name), mode), "\n\n\n",
                                         "\n\n");
  }
};

}  // namespace

void set_help(CLI::App& tool) {
  const auto formatter = std::make_shared<Formatter>();
  tool.formatter(formatter);
  tool.footer(exit_footer);
  for (const auto& [name, examples] : examples_of) {
    CLI::App* const command = tool.get_subcommand(name);
    command->formatter(formatter);
    command->footer("Examples:\n" + std::string(examples) + "\n" + exit_footer);
    for (const auto& [option, group] : groups_of)
      if (CLI::Option* const found = command->get_option_no_throw(option)) found->group(group);
  }
}

}  // namespace raylanes::bench

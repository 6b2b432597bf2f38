#include "commands.hpp"

#include <algorithm>
#include <stdexcept>

#include "../support/readers/printable.hpp"

namespace raylanes::bench {
namespace {

// Rays, hits and a picture take some hundred bytes a pixel.
constexpr std::uint32_t max_side = 32768, max_pixels = 1u << 24;

}  // namespace

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_option("--json", options.json, "also write the rows to this file");
  command.add_option("--path", options.path, "paths to use: NAME[,NAME...] or all (default: the active one)")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_seconds_option(CLI::App& command, double& seconds, const std::string& what) {
  command.add_option("--seconds", seconds, what)->check(CLI::Range(0.0, 1e6));
}

std::string file_name_of(std::string scene) {
  std::replace(scene.begin(), scene.end(), '/', '_');
  return scene;
}

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument("--size \"" + printable(text) + "\": " + why +
                                "allowed is WIDTHxHEIGHT, each 1 to " + std::to_string(max_side) +
                                ", together " + std::to_string(max_pixels) + " pixels (4096x4096)");
  };
  const auto side = [&](const std::string& digits) {
    const bool number =
        !digits.empty() && digits.size() <= 5 && digits.find_first_not_of("0123456789") == digits.npos;
    const unsigned long value = number ? std::stoul(digits) : 0;
    if (value < 1 || value > max_side) refuse("");
    return static_cast<std::uint32_t>(value);
  };
  if (cross == std::string::npos) refuse("");
  const std::uint32_t width = side(text.substr(0, cross)), height = side(text.substr(cross + 1));
  const std::uint64_t pixels = std::uint64_t{width} * height;
  if (pixels > max_pixels) refuse(std::to_string(pixels) + " pixels are too many, ");
  return {width, height};
}

std::vector<const Path*> selected_paths(const std::vector<std::string>& names) {
  std::vector<const Path*> selected;
  if (names.empty()) return {&active_path()};
  for (const std::string& name : names)
    if (name != "all")
      selected.push_back(&find_path(name));
    else
      for (const Path& path : paths())
        if (supported(path)) selected.push_back(&path);
  return selected;
}

CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<std::string>& list,
                      const std::vector<std::string>& names, const std::string& what) {
  return command.add_option(option, list, what)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(names));
}

}  // namespace raylanes::bench

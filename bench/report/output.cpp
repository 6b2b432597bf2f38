#include "output.hpp"

#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <iostream>
#include <thread>

#include <raylanes/version.hpp>

#include "../support/rulers/measure.hpp"
#include "build_facts.hpp"
#include "exits.hpp"
#include "whole_file.hpp"

namespace raylanes::bench {
namespace {

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    constexpr std::string_view key = "model name";
    const std::size_t colon = line.find(": ");
    if (line.compare(0, key.size(), key) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

std::string operating_system() {
  utsname name{};
  return uname(&name) == 0 ? std::string(name.sysname) + " " + name.release : "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

// The average load of the last minute; -1 if the system does not tell.
double load_average() {
  double load = 0.0;
  return getloadavg(&load, 1) == 1 ? load : -1.0;
}

Json machine_description() {
  return {{"processor", processor_name()}, {"cores", std::thread::hardware_concurrency()},
          {"system", operating_system()},  {"compiler", compiler()},
          {"raylanes", version()},         {"date", today()},
          {"commit", build_facts.commit},  {"build_type", build_facts.build_type},
          {"flags", build_facts.flags},    {"load_average", load_average()}};
}

}  // namespace

std::string machine_line() {
  return processor_name() + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores, " +
         compiler() + ", " + today() +
         (ratios_mean_something() ? "" : "\na build without optimization: no ratios");
}

void write_json(const std::string& file, const Json& rows) {
  const std::string text =
      Json{{"schema_version", 1}, {"machine", machine_description()}, {"rows", rows}}.dump(
          1, ' ', false, Json::error_handler_t::replace);
  if (file == "-") {
    std::puts(text.c_str());
    return;
  }
  write_whole_file(file, text + '\n');
}

void keep_standard_output_for_rows() {
  std::cout.rdbuf(std::cerr.rdbuf());
}

void check_standard_output() {
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout))
    throw OutputError("standard output cannot be written");
}

std::string significant(double x, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

std::string milliseconds(double seconds) {
  return significant(1e3 * seconds, 3);
}

std::string hexadecimal(const char* format, unsigned long long bits) {
  char text[24];
  std::snprintf(text, sizeof text, format, bits);
  return text;
}

}  // namespace raylanes::bench

// Runs a fuzz target on bytes made from a seed.
//
// usage: fuzz TARGET [--runs N] [--seconds T] [--seed S] [--first K] [FILE...]
//
// Runs number K, K+1 … of seed S, N of them, or for T seconds and not less than the target's floor at this level.
// Without S the seeds are 1 and then the date. FILEs are run instead, each by its bytes. A fault or a wrong answer ends
// it with the line that repeats that run. Exit status 0: nothing was found.

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <fstream>

#include "../../bench/support/scenes/splitmix.hpp"
#include "../support/level.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace raylanes::testing {
namespace {

using Target = int (*)(const std::uint8_t*, std::size_t);
constexpr struct {
  std::string_view name;
  Target run;
  std::uint64_t floor;  // runs of each seed where the level is quick; twice that by default, 40 times by all
} targets[] = {{"trace", fuzz_trace, 100},
               {"queries", fuzz_queries, 25},
               {"arrays", fuzz_arrays, 1000},
               {"roots", fuzz_roots, 1000},
               {"readers", fuzz_readers, 250},
               {"trees", fuzz_trees, 50},
               {"scenes", fuzz_scenes, 100},
               {"doubles", fuzz_doubles, 10},
               {"c_calls", fuzz_c_calls, 250},
               {"embree", fuzz_embree, 50},
               {"scenes_of_doubles", fuzz_scenes_of_doubles, 8}};

char repeat_line[256] = "fuzz: before the first run\n";

void print_repeat_line() {
  [[maybe_unused]] const auto written =
      write(STDERR_FILENO, repeat_line, static_cast<unsigned>(std::strlen(repeat_line)));
}

extern "C" void on_fault(int number) {
  print_repeat_line();
  signal(number, SIG_DFL);
  raise(number);
}

struct Options {
  std::uint64_t runs = 0, seed = 0, first = 0, floor = 0;  // of runs and seed 0 is none given
  double seconds = 0;
  std::vector<std::string> files;
};

int run_files(Target target, const Options& options) {
  for (const std::string& file : options.files) {
    std::ifstream in(file, std::ios::binary);
    if (!in) {
      std::fprintf(stderr, "fuzz: %s: cannot be read\n", file.c_str());
      return 2;
    }
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::snprintf(repeat_line, sizeof repeat_line, "fuzz: file %s\n", file.c_str());
    target(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  return 0;
}

void run_seed(Target target, const char* name, const Options& options, unsigned long long seed) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  std::string names;
  for (const Path* path : fuzzed_paths()) names += std::string(" ") + path->name;
  std::printf("fuzz %s on%s\n", name, names.c_str());
  std::uint64_t done = 0;
  std::vector<std::uint8_t> bytes;
  for (; options.runs > 0 ? done < options.runs
                          : done < options.floor || (done % 64 != 0 || seconds() < options.seconds);
       ++done) {
    const auto run = static_cast<unsigned long long>(options.first + done);
    std::snprintf(repeat_line, sizeof repeat_line, "repeat it: fuzz %s --seed %llu --first %llu --runs 1\n",
                  name, seed, run);
    bench::SplitMix generator(seed * 0x9e3779b97f4a7c15u + run);
    bytes.resize(8 + generator.next() % 120);
    for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(generator.next() >> 56);
    target(bytes.data(), bytes.size());
  }
  std::printf("fuzz %s: nothing found in %llu runs of seed %llu from %llu on, in %.1f s\n", name,
              static_cast<unsigned long long>(done), seed, static_cast<unsigned long long>(options.first),
              seconds());
}

Options parse(int count, char** arguments) {
  Options options;
  for (int i = 2; i < count; ++i) {
    const std::string_view name = arguments[i];
    if (!name.starts_with("--")) {
      options.files.emplace_back(name);
      continue;
    }
    const char* value = i + 1 < count ? arguments[++i] : "";
    char* end = nullptr;
    if (name == "--seconds")
      options.seconds = std::strtod(value, &end);
    else if (name == "--runs" || name == "--seed" || name == "--first")
      (name == "--runs"   ? options.runs
       : name == "--seed" ? options.seed
                          : options.first) = std::strtoull(value, &end, 10);
    if (end == nullptr || end == value || *end != '\0') {
      std::fprintf(stderr, "fuzz: %s %s: not understood\n", arguments[i - 1], value);
      std::exit(2);
    }
  }
  return options;
}

}  // namespace

int main_of_driver(int count, char** arguments) {
  for (const auto& target : targets) {
    if (count < 2 || target.name != arguments[1]) continue;
    Options options = parse(count, arguments);
    options.floor = target.floor * by_level<std::uint64_t>(1, 2, 40);
    for (const int number : {SIGSEGV, SIGFPE, SIGILL, SIGABRT}) signal(number, on_fault);
#ifndef _WIN32
    for (const int number : {SIGBUS, SIGALRM}) signal(number, on_fault);
#endif
    if (!options.files.empty()) return run_files(target.run, options);
    const auto today = static_cast<std::uint64_t>(std::time(nullptr) / 86400);
    const std::vector<std::uint64_t> seeds =
        options.seed > 0 ? std::vector{options.seed} : std::vector<std::uint64_t>{1, today};
    for (const std::uint64_t seed : seeds) run_seed(target.run, arguments[1], options, seed);
    return 0;
  }
  std::fprintf(stderr,
               "usage: fuzz trace|queries|arrays|roots|readers|trees|scenes|doubles|c_calls|embree "
               "[--runs N] [--seconds T] [--seed S] [--first K] [FILE...]\n");
  return 2;
}

}  // namespace raylanes::testing

int main(int count, char** arguments) {
  return raylanes::testing::main_of_driver(count, arguments);
}

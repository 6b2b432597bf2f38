#include "stages.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "../support/rulers/progress.hpp"
#include "embree/embree_contender.hpp"

namespace raylanes::bench {
namespace {

struct Stages {
  double build = 0, refit = 0, save = 0, load = 0;
  std::uint64_t build_peak = 0, held = 0, load_peak = 0, file_bytes = 0;
};

// Bytes by a line of /proc/self/status: VmRSS are resident, VmHWM were at most.
std::uint64_t memory(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(name + ":")) return 1024 * std::stoull(line.substr(name.size() + 1));
  throw std::runtime_error("/proc/self/status: there is no " + name);
}

// The peak beside what is resident now.
class Peak {
 public:
  std::uint64_t bytes() const { return beside("VmHWM"); }
  std::uint64_t held() const { return beside("VmRSS"); }

 private:
  std::uint64_t beside(const char* name) const {
    const std::uint64_t now = memory(name);
    return now > before_ ? now - before_ : 0;
  }
  std::uint64_t before_ = memory("VmRSS");
};

// Work in a child process, whose peak of memory is its own.
Stages alone(const std::function<void(Stages&)>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("stages: no pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    Stages stages;
    try {
      work(stages);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      _exit(1);
    }
    _exit(write(ends[1], &stages, sizeof stages) == sizeof stages ? 0 : 1);
  }
  close(ends[1]);
  Stages stages;
  const bool has_all = child > 0 && read(ends[0], &stages, sizeof stages) == sizeof stages;
  close(ends[0]);
  int status = 1;
  if (child > 0) waitpid(child, &status, 0);
  if (!has_all || status != 0) throw std::runtime_error("stages: a process of a contender failed");
  return stages;
}

// Vertices that have moved by some thousandth of the mesh.
std::vector<Float3> moved(const Mesh& mesh) {
  const auto step = static_cast<float>(1e-3 * diagonal_of(mesh));
  std::vector<Float3> vertices = mesh.vertices;
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i][i % 3] += i % 2 == 0 ? step : -step;
  return vertices;
}

// A file that goes with it.
class TemporaryFile {
 public:
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("raylanes-stages-" + std::to_string(getpid()));
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

class Runs {
 public:
  Runs(const Scene& scene, const StagesOptions& options)
      : mesh_(scene.mesh), options_(options), moved_(moved(scene.mesh)) {}

  Stages ours(const TreeKind& kind) const {
    Stages all = alone([&](Stages& stages) {
      const Peak peak;
      Bvh bvh;
      stages.build = seconds_of([&] {
        bvh = Bvh(mesh_, {.builder = kind.builder, .threads = options_.threads, .optimize = kind.optimize});
      });
      stages.build_peak = peak.bytes(), stages.held = peak.held();
      stages.save = seconds_of([&] {
        std::ofstream file(file_.path, std::ios::binary);
        bvh.save(file);
      });
      stages.refit = seconds_of([&] { bvh.refit(moved_, mesh_.triangles, options_.threads); });
    });
    all.file_bytes = std::filesystem::file_size(file_.path);
    const Stages loaded = alone([&](Stages& stages) {
      const Peak peak;
      stages.load = seconds_of([&] {
        std::ifstream file(file_.path, std::ios::binary);
        const Bvh bvh = Bvh::load(file);
      });
      stages.load_peak = peak.bytes();
    });
    all.load = loaded.load, all.load_peak = loaded.load_peak;
    return all;
  }

  // Its copy of the mesh counts as the mesh.
  Stages embree(EmbreeBuild build) const {
    return alone([&](Stages& stages) {
      const Peak peak;
      EmbreeContender embree(mesh_.vertices, mesh_.triangles, "", build, options_.threads);
      const std::uint64_t copy =
          mesh_.vertices.size() * sizeof(Float3) + mesh_.triangles.size() * sizeof(Index3);
      stages.build = embree.build_seconds();
      stages.build_peak = peak.bytes() - std::min(peak.bytes(), copy);
      stages.held = peak.held() - std::min(peak.held(), copy);
      if (build == EmbreeBuild::refitted) stages.refit = embree.move(moved_);
    });
  }

 private:
  const Mesh& mesh_;
  const StagesOptions& options_;
  std::vector<Float3> moved_;
  TemporaryFile file_;
};

struct Contestant {
  std::string contender, builder;
  std::function<Stages()> run;
  std::vector<Stages> rounds = {};
};

Quartiles quartiles(const std::vector<Stages>& rounds, double Stages::*stage) {
  std::vector<double> seconds;
  for (const Stages& round : rounds) seconds.push_back(round.*stage);
  return quartiles_of(seconds);
}
Quartiles ratio(const Contestant& ours, const Contestant& theirs, double Stages::*stage) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ours.rounds.size(); ++i)
    ratios.push_back(theirs.rounds[i].*stage / (ours.rounds[i].*stage));
  return quartiles_of(ratios);
}

StageRow row_of(const Contestant& of) {
  StageRow row;
  row.contender = of.contender, row.builder = of.builder;
  const Quartiles build = quartiles(of.rounds, &Stages::build);
  const Stages& last = of.rounds.back();
  row.build_seconds = build.median, row.spread = (build.third - build.first) / build.median;
  row.build_peak = last.build_peak, row.held = last.held;
  if (last.refit > 0) row.refit_seconds = quartiles(of.rounds, &Stages::refit).median;
  if (last.save > 0) row.save_seconds = quartiles(of.rounds, &Stages::save).median;
  if (last.load > 0) row.load_seconds = quartiles(of.rounds, &Stages::load).median;
  row.load_peak = last.load_peak, row.file_bytes = last.file_bytes;
  return row;
}

}  // namespace

std::vector<StageRow> measure_stages(const Scene& scene, const StagesOptions& options) {
  const Runs runs(scene, options);
  std::vector<Contestant> all;
  for (const TreeKind& kind : options.builders)
    all.push_back({"raylanes", name_of(kind), [&runs, kind] { return runs.ours(kind); }});
  const std::size_t ours = all.size();
  if (options.against_embree)
    for (const auto& [name, build] : {std::pair("medium", EmbreeBuild::medium),
                                      {"low", EmbreeBuild::low},
                                      {"refitted", EmbreeBuild::refitted}})
      all.push_back({"embree", name, [&runs, build = build] { return runs.embree(build); }});
  ProgressLine progress(scene.name + ": building, saving, loading");
  for (int round = 0; round < options.rounds; ++round)
    for (Contestant& contestant : all) {
      contestant.rounds.push_back(contestant.run());
      progress.update((round + 0.5) / options.rounds);
    }
  std::vector<StageRow> rows;
  for (std::size_t i = 0; i < all.size(); ++i) {
    rows.push_back(row_of(all[i]));
    if (i >= ours || !options.against_embree) continue;
    const bool is_morton = options.builders[i].builder == TreeBuilder::morton;
    rows[i].build_ratio = ratio(all[i], all[ours + (is_morton ? 1 : 0)], &Stages::build);
    rows[i].refit_ratio = ratio(all[i], all[ours + 2], &Stages::refit);
  }
  return rows;
}

}  // namespace raylanes::bench

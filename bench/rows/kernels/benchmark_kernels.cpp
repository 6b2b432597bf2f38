// Google Benchmark rows of roots, triangles, boxes and spheres: the rows of `raylanes roots` and `raylanes kernels`,
// named kernel/test_grade_form_query/path/size. A row whose decisions exact arithmetic finds wrong is an error, not a
// time. Decisions are judged when the first row runs, so that --help and lists come at once. Rows
// few/KIND/path/size are of one ray among few primitives.
#include <benchmark/benchmark.h>

#include <raylanes/boxes.hpp>
#include <raylanes/prepared_ray.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../roots/benchmark_roots.hpp"
#include "kernel_rows.hpp"

namespace raylanes::bench {
namespace {

// Pairs of rays and primitives that are judged for each test; anywhere, where no test may be wrong.
constexpr std::size_t judged_pairs = 100;
constexpr auto anywhere = static_cast<std::size_t>(Aim::uniform);

class KernelTimes {
 public:
  explicit KernelTimes(const std::vector<const Path*>& paths)
      : paths_(paths),
        judgement_(paths.size()),
        rows_(all_kernel_rows(
            paths, [](std::string_view) { return true; }, inputs_, judgement_)) {
    for (const KernelRow& row : rows_)
      benchmark::RegisterBenchmark(
          (row.kernel + '/' + row.test + '_' + std::string(grade_names[static_cast<std::size_t>(row.grade)]) +
           '_' + row.form + '_' + row.query + '/' + row.path->name + '/' + std::to_string(timed_primitives))
              .c_str(),
          [this, &row](benchmark::State& state) { run(state, row); });
    for (const Path* path : paths) {
      add_few("boxes", path, BoxArrays(), inputs_.boxes());
      add_few("spheres", path, SphereArrays(), inputs_.spheres());
      add_few("triangles", path, TriangleArrays(), inputs_.corners());
    }
  }

 private:
  // The nearest of few primitives, or which boxes are hit and where, by a prepared ray and by a call that checks it.
  template <class Arrays>
  void add_few(const std::string& kind, const Path* path, Arrays few, const ColumnList& columns) {
    std::memcpy(&few, KernelInputs::pointers(columns).data(), columns.size() * sizeof(const float*));
    const Ray ray = inputs_.ray();
    for (const std::size_t n : {4u, 8u, 16u, 32u, 64u}) {
      few.size = n;
      const auto add = [&](const std::string& way, auto ask) {
        benchmark::RegisterBenchmark(
            ("few/" + way + kind + '/' + path->name + '/' + std::to_string(n)).c_str(),
            [=](benchmark::State& state) { time_calls(state, n, [&] { benchmark::DoNotOptimize(ask()); }); });
      };
      const std::span entry(inputs_.output(0), n), exit(inputs_.output(1), n);
      const std::span bits(inputs_.bits(), (n + 7) / 8);
      if constexpr (std::is_same_v<Arrays, BoxArrays>)
        add("", [=] { return intervals(ray, few, bits, entry, exit, {.path = path}), bits[0]; });
      else
        add("", [=] { return closest_hit(ray, few, {.path = path}); });
      if (n > PreparedRay::max_primitives) continue;
      add("prepared_", [=, prepared = PreparedRay(ray, path)] {
        if constexpr (std::is_same_v<Arrays, BoxArrays>)
          return hits(prepared, few, entry);
        else
          return closest_hit(prepared, few);
      });
    }
  }

  void run(benchmark::State& state, const KernelRow& row) {
    if (!is_judged_) judgement_.judge(paths_, judged_pairs, [](double) {});
    is_judged_ = true;
    if (row.accuracy->wrong_per_million[anywhere] != 0.0) return state.SkipWithError("wrong decisions");
    time_calls(state, timed_primitives, [&] { row.work(timed_primitives); });
  }

  std::vector<const Path*> paths_;
  KernelInputs inputs_;
  KernelJudgement judgement_;
  KernelRows rows_;
  bool is_judged_ = false;
};

}  // namespace
}  // namespace raylanes::bench

int main(int argc, char** argv) {
  using namespace raylanes;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  std::vector<const Path*> paths;
  for (const Path& path : raylanes::paths())
    if (supported(path)) paths.push_back(&path);
  bench::register_root_rows(paths);
  bench::register_cliff_rows();
  bench::KernelTimes kernels(paths);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

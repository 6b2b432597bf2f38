// Google Benchmark rows of triangles, boxes and spheres: those of `raylanes kernels`, named
// kernel/test_grade_form_query/path/size. A row whose decisions exact arithmetic finds wrong is an error, not a time.
#include <benchmark/benchmark.h>

#include <string>

#include "benchmark_roots.hpp"
#include "kernel_rows.hpp"

namespace raylanes::bench {
namespace {

// Pairs of rays and primitives that are judged for each test; anywhere, where no test may be wrong.
constexpr std::size_t judged_pairs = 100;
constexpr auto anywhere = static_cast<std::size_t>(Aim::uniform);

struct KernelTimes {
  KernelInputs inputs;
  Accuracies triangles, integers, boxes, spheres;
  KernelRows rows;

  explicit KernelTimes(const std::vector<const Path*>& paths)
      : triangles(survey_triangles(paths, judged_pairs, [](double) {})),
        integers(survey_integers(judged_pairs, [](double) {})),
        boxes(survey_boxes(paths, judged_pairs, [](double) {})),
        spheres(survey_spheres(paths, judged_pairs, [](double) {})) {
    add_integer_rows(rows, *paths.front(), inputs, integers[0][0][0]);
    for (std::size_t p = 0; p < paths.size(); ++p)
      for (const Grade grade : {Grade::reproducible, Grade::fast}) {
        const auto g = static_cast<std::size_t>(grade);
        for (std::size_t i = 0; i < std::size(triangle_tests); ++i)
          add_triangle_rows(rows, *paths[p], triangle_tests[i].test, grade, inputs, triangles[p][i][g], {});
        for (std::size_t i = 0; i < std::size(box_tests); ++i)
          add_box_rows(rows, *paths[p], box_tests[i].test, grade, inputs, boxes[p][i][g]);
        for (std::size_t i = 0; i < std::size(sphere_tests); ++i)
          add_sphere_rows(rows, *paths[p], sphere_tests[i].test, grade, inputs, spheres[p][i][g]);
      }
  }
};

void run_row(benchmark::State& state, const KernelRow& row) {
  if (row.accuracy->wrong_per_million[anywhere] != 0.0) return state.SkipWithError("wrong decisions");
  for (auto _ : state) {
    row.work(timed_primitives);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(timed_primitives));
}

void register_rows(const KernelRows& rows) {
  for (const KernelRow& row : rows)
    benchmark::RegisterBenchmark(
        (row.kernel + '/' + row.test + '_' + std::string(grade_names[static_cast<std::size_t>(row.grade)]) +
         '_' + row.form + '_' + row.query + '/' + row.path->name + '/' + std::to_string(timed_primitives))
            .c_str(),
        [&row](benchmark::State& state) { run_row(state, row); });
}

}  // namespace
}  // namespace raylanes::bench

int main(int argc, char** argv) {
  using namespace raylanes;
  std::vector<const Path*> paths;
  for (const Path& path : raylanes::paths())
    if (supported(path)) paths.push_back(&path);
  for (const Path* path : paths) bench::register_root_rows(*path);
  const bench::KernelTimes kernels(paths);
  bench::register_rows(kernels.rows);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

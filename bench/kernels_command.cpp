#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <new>
#include <optional>

#include "commands.hpp"
#include "kernels_survey.hpp"
#include "measure.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "splitmix.hpp"

namespace raylanes::bench {
namespace {

struct KernelsOptions : CommonOptions {
  std::size_t pairs = 20000;
  std::size_t leak_rays = 300000;
  std::string test;
  int rounds = 15;
};

// Counted in the compiled loops at build time, see instruction_counts.py.
struct InstructionCount {
  std::string_view path, kernel, grade, form;
  int arithmetic, moves, primitives;
  double cycles;  // lower bound of a trip from the ports of Zen 3
};
constexpr InstructionCount instruction_counts[] = {
#include "instruction_counts.inc"
};

const InstructionCount* find_count(const Path& path, const std::string& kernel, Grade grade,
                                   const std::string& form) {
  for (const InstructionCount& c : instruction_counts)
    if (c.path == path.name && c.kernel == kernel && c.form == form &&
        c.grade == grade_names[static_cast<std::size_t>(grade)])
      return &c;
  return nullptr;
}

struct Row {
  std::string kernel, test;
  Grade grade;
  std::string form, query;
  const Path* path;
  std::function<void()> work;  // one call over `timed` primitives
  const KernelAccuracy* accuracy;
  std::optional<double> leaks;
  double nanoseconds = 0, spread = 0;

  const InstructionCount* count() const {
    return find_count(*path, kernel + '/' + test, grade, form + '/' + query);
  }
};

// Few enough for the first-level cache: 13 columns of 512 floats are 26 KB.
constexpr std::size_t timed = 512;
constexpr int calls_per_timing = 200;

// Columns begin at a cache line, as a user in a hurry would have them: no load straddles two lines.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};
using Column = std::vector<float, CacheLineAllocator<float>>;
using ColumnList = std::vector<Column>;

// A soup around a ray; columns serve triangles, boxes, spheres and rays alike.
class Workload {
 public:
  Workload() {
    SplitMix random(5);
    const auto fill = [&](Column& column, double lo, double hi) {
      column.resize(timed);
      for (float& x : column) x = static_cast<float>(lo + (hi - lo) * random.uniform());
    };
    for (auto& column : corners_) fill(column, -1, 1);
    for (auto& column : rays_) fill(column, -0.1, 0.1);
    for (std::size_t i = 0; i < timed; ++i) {
      rays_[2][i] -= 3, rays_[5][i] += 1, rays_[6][i] = 0;
      rays_[7][i] = std::numeric_limits<float>::infinity();
    }
    boxes_ = {corners_[0], corners_[1], corners_[2], corners_[3], corners_[4], corners_[5]};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < timed; ++i)
        if (boxes_[k][i] > boxes_[3 + k][i]) std::swap(boxes_[k][i], boxes_[3 + k][i]);
    spheres_ = {corners_[0], corners_[1], corners_[2], corners_[3]};
    for (float& square : spheres_[3]) square *= square * 0.2f;
    for (auto& output : output_) output.resize(timed);
    flags_.resize(timed);
    bits_.resize(timed / 8);
  }

  Ray ray() const { return {{0.1f, 0.2f, -3}, 0, {0.01f, 0.02f, 1}, std::numeric_limits<float>::infinity()}; }
  RayArrays rays() const {
    return {{rays_[0].data(), rays_[1].data(), rays_[2].data()},
            {rays_[3].data(), rays_[4].data(), rays_[5].data()},
            rays_[6].data(),
            rays_[7].data()};
  }
  TriangleArrays triangles() const {
    TriangleArrays t;
    for (std::size_t k = 0; k < 9; ++k) t.vertex[k / 3][k % 3] = corners_[k].data();
    return t;
  }
  static std::vector<const float*> pointers(const ColumnList& columns) {
    std::vector<const float*> all;
    for (const auto& column : columns) all.push_back(column.data());
    return all;
  }
  const ColumnList& boxes() const { return boxes_; }
  const ColumnList& spheres() const { return spheres_; }
  std::uint8_t* bits() { return bits_.data(); }
  float* output(std::size_t k) { return output_[k].data(); }
  std::uint32_t* flags() { return flags_.data(); }

 private:
  Column corners_[9], rays_[8], output_[3];
  ColumnList boxes_, spheres_;
  std::vector<std::uint32_t> flags_;
  std::vector<std::uint8_t> bits_;
};

// One primitive of columns, as the loops for many rays take it.
std::vector<float> first_of(const ColumnList& columns) {
  std::vector<float> one;
  for (const auto& column : columns) one.push_back(column[0]);
  return one;
}

using Rows = std::vector<Row>;

void add_triangle_rows(Rows& rows, const Path& path, std::size_t form, Grade grade, Workload& w,
                       const KernelAccuracy& accuracy, std::optional<double> leaks) {
  const auto& loops = path.intersections.triangle[form][static_cast<std::size_t>(grade)];
  ColumnList columns(triangle_form_columns[form], Column(timed));
  std::vector<float*> out;
  for (auto& column : columns) out.push_back(column.data());
  const Ray ray = w.ray();
  prepare_triangles(path, static_cast<TriangleForm>(form), grade, w.triangles(), timed, ray.direction,
                    out.data());
  // Shared by the four closures; the pointers are to vectors that move along with it.
  const auto data = std::make_shared<ColumnList>(std::move(columns));
  const auto pointers = std::make_shared<std::vector<const float*>>(Workload::pointers(*data));
  const auto one = std::make_shared<std::vector<float>>(first_of(*data));
  constexpr auto weights = static_cast<std::size_t>(Wanted::weights);
  const HitColumns hits{w.output(0), w.flags(), w.output(1), w.output(2), {}};
  const auto add = [&](const char* shape, const char* query, std::function<void()> work) {
    rows.push_back({"triangle", std::string(triangle_form_names[form]), grade, shape, query, &path,
                    std::move(work), &accuracy, leaks});
  };
  add("1xN", "any",
      [=, &w, f = loops.any_of_triangles] { (void)data, f(ray, pointers->data(), timed, w.bits()); });
  add("1xN", "closest", [=, f = loops.closest_of_triangles[weights]] {
    NearestHit found;
    (void)data, f(ray, pointers->data(), timed, found);
  });
  add("Nx1", "any", [=, &w, f = loops.any_of_rays] { f(w.rays(), timed, one->data(), w.bits()); });
  add("Nx1", "closest",
      [=, &w, f = loops.closest_of_rays[weights]] { f(w.rays(), timed, one->data(), hits); });
}

void add_box_rows(Rows& rows, const Path& path, std::size_t test, Grade grade, Workload& w,
                  const KernelAccuracy& accuracy) {
  const auto& loops = path.intersections.box[test][static_cast<std::size_t>(grade)];
  const Ray ray = w.ray();
  const auto pointers = Workload::pointers(w.boxes());
  const auto one = first_of(w.boxes());
  const BoxHitArrays out{w.output(0), w.output(1), w.flags()};
  const auto add = [&](const char* shape, const char* query, std::function<void()> work) {
    rows.push_back({"box",
                    std::string(box_test_names[test]),
                    grade,
                    shape,
                    query,
                    &path,
                    std::move(work),
                    &accuracy,
                    {}});
  };
  add("1xN", "any", [=, &w, f = loops.any_of_boxes] { f(ray, pointers.data(), timed, w.bits()); });
  add("1xN", "closest", [=, f = loops.interval_of_boxes] { f(ray, pointers.data(), timed, out); });
  add("Nx1", "any", [=, &w, f = loops.any_of_rays] { f(w.rays(), timed, one.data(), w.bits()); });
  add("Nx1", "closest", [=, &w, f = loops.interval_of_rays] { f(w.rays(), timed, one.data(), out); });
}

void add_sphere_rows(Rows& rows, const Path& path, std::size_t test, Grade grade, Workload& w,
                     const KernelAccuracy& accuracy) {
  const auto& loops = path.intersections.sphere[test][static_cast<std::size_t>(grade)];
  const Ray ray = w.ray();
  const auto pointers = Workload::pointers(w.spheres());
  const auto one = first_of(w.spheres());
  const SphereHitArrays out{w.output(0), w.output(1), w.flags()};
  const auto add = [&](const char* name, const char* shape, const char* query, std::function<void()> work) {
    static const KernelAccuracy unmeasured;
    const bool line = std::string_view(name) == "line";
    rows.push_back(
        {"sphere", name, grade, shape, query, &path, std::move(work), line ? &unmeasured : &accuracy, {}});
  };
  const char* const name = sphere_test_names[test].data();
  add(name, "1xN", "any", [=, &w, f = loops.any_of_spheres] { f(ray, pointers.data(), timed, w.bits()); });
  add(name, "1xN", "closest", [=, f = loops.distances_of_spheres] { f(ray, pointers.data(), timed, out); });
  add(name, "Nx1", "any", [=, &w, f = loops.any_of_rays] { f(w.rays(), timed, one.data(), w.bits()); });
  add(name, "Nx1", "closest", [=, &w, f = loops.distances_of_rays] { f(w.rays(), timed, one.data(), out); });
  if (test == 0)
    add("line", "1xN", "any",
        [=, &w, f = path.intersections.line_of_spheres[static_cast<std::size_t>(grade)]] {
          f(ray, pointers.data(), timed, w.bits());
        });
}

void measure_speed(Rows& rows, int rounds) {
  ProgressLine progress("kernels: timing");
  // Interleaved within one test on all paths, so that neighbours in the table are neighbours in time.
  constexpr std::size_t at_once = 24;
  for (std::size_t first = 0; first < rows.size(); first += at_once) {
    const std::size_t end = std::min(rows.size(), first + at_once);
    std::vector<std::function<void()>> contenders;
    for (std::size_t i = first; i < end; ++i)
      contenders.push_back([&work = rows[i].work] {
        for (int call = 0; call < calls_per_timing; ++call) work();
      });
    const std::vector<Timing> timings = take_turns(contenders, rounds);
    for (std::size_t i = first; i < end; ++i) {
      rows[i].nanoseconds = 1e9 * timings[i - first].median_seconds / (timed * calls_per_timing);
      rows[i].spread = timings[i - first].spread;
    }
    progress.update(static_cast<double>(end) / static_cast<double>(rows.size()));
  }
}

// Nanoseconds of one cycle, from a chain of dependent additions of integers: one a cycle on every x86-64.
double nanoseconds_per_cycle() {
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 20; ++round) {
    constexpr int trips = 50000, additions = 8;
    std::uint64_t x = static_cast<std::uint64_t>(round);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < trips; ++i)
      __asm__ volatile(
          "add $1, %0; add $1, %0; add $1, %0; add $1, %0; add $1, %0; add $1, %0; add $1, %0; add $1, %0"
          : "+r"(x));
    const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
    best = std::min(best, elapsed.count() / (trips * additions));
  }
  return best;
}

Json number_or_null(const std::optional<double>& x) {
  return x ? Json(*x) : Json(nullptr);
}

Json to_json(const Row& row, double cycle) {
  Json wrong;
  for (std::size_t set = 0; set < aim_names.size(); ++set)
    wrong[std::string(aim_names[set])] = number_or_null(row.accuracy->wrong_per_million[set]);
  const InstructionCount* c = row.count();
  Json json{{"kernel", row.kernel},
            {"test", row.test},
            {"grade", grade_names[static_cast<std::size_t>(row.grade)]},
            {"form", row.form},
            {"query", row.query},
            {"path", row.path->name},
            {"isa", row.path->isa},
            {"nanoseconds_per_primitive", row.nanoseconds},
            {"spread", row.spread},
            {"instructions_per_primitive", c ? Json(double(c->arithmetic) / c->primitives) : Json(nullptr)},
            {"moves_per_primitive", c ? Json(double(c->moves) / c->primitives) : Json(nullptr)},
            {"port_bound_nanoseconds", c ? Json(c->cycles * cycle / c->primitives) : Json(nullptr)},
            {"wrong_per_million", wrong},
            {"leaks_per_million", number_or_null(row.leaks)},
            {"max_t_ulp", number_or_null(row.accuracy->max_t_ulp)},
            {"max_u_ulp", number_or_null(row.accuracy->max_u_ulp)},
            {"max_v_ulp", number_or_null(row.accuracy->max_v_ulp)}};
  return json;
}

std::string text_or_dash(const std::optional<double>& x, int digits) {
  return x ? significant(*x, digits) : "-";
}

void print_rows(const Rows& rows, double cycle) {
  std::vector<std::vector<std::string>> table{{"kernel", "test", "grade", "form", "query", "path", "ns",
                                               "bound", "instr.", "moves", "uniform", "edges", "vertices",
                                               "far", "leaks", "t ULP", "u ULP", "v ULP"}};
  for (const Row& row : rows) {
    const InstructionCount* c = row.count();
    std::vector<std::string> cells{row.kernel,
                                   row.test,
                                   std::string(grade_names[static_cast<std::size_t>(row.grade)]),
                                   row.form,
                                   row.query,
                                   row.path->name,
                                   significant(row.nanoseconds, 3),
                                   c ? significant(c->cycles * cycle / c->primitives, 3) : "-",
                                   c ? significant(double(c->arithmetic) / c->primitives, 3) : "-",
                                   c ? significant(double(c->moves) / c->primitives, 3) : "-"};
    for (const auto& wrong : row.accuracy->wrong_per_million) cells.push_back(text_or_dash(wrong, 4));
    cells.push_back(text_or_dash(row.leaks, 4));
    for (const auto& worst : {row.accuracy->max_t_ulp, row.accuracy->max_u_ulp, row.accuracy->max_v_ulp})
      cells.push_back(text_or_dash(worst, 3));
    table.push_back(cells);
  }
  print_table(table);
}

void run(const KernelsOptions& options) {
  const std::vector<const Path*> paths = selected_paths(options.path);
  const auto chosen = [&](std::string_view name) { return options.test.empty() || options.test == name; };
  if (!options.test.empty()) {
    std::vector<std::string_view> names{"line"};
    for (const auto name : triangle_form_names) names.push_back(name);
    for (const auto name : box_test_names) names.push_back(name);
    for (const auto name : sphere_test_names) names.push_back(name);
    index_of("--test", options.test, names);
  }
  Accuracies triangles, boxes, spheres;
  Leaks leaks;
  {
    ProgressLine progress("kernels: judging against exact arithmetic");
    const auto part = [&](double from, double to) {
      return [&progress, from, to](double share) { progress.update(from + (to - from) * share); };
    };
    triangles = survey_triangles(paths, options.pairs, part(0, 0.5));
    boxes = survey_boxes(paths, options.pairs, part(0.5, 0.7));
    spheres = survey_spheres(paths, options.pairs, part(0.7, 1));
  }
  {
    ProgressLine progress("kernels: looking for leaks");
    leaks = count_leaks(
        paths, options.leak_rays,
        [&](TriangleForm form) { return chosen(triangle_form_names[static_cast<std::size_t>(form)]); },
        [&](double share) { progress.update(share); });
  }
  Workload workload;
  Rows rows;
  for (std::size_t test = 0; test < triangle_form_names.size(); ++test)
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      for (std::size_t p = 0; p < paths.size(); ++p)
        if (chosen(triangle_form_names[test]))
          add_triangle_rows(rows, *paths[p], test, grade, workload,
                            triangles[p][test][static_cast<std::size_t>(grade)],
                            leaks[p][test][static_cast<std::size_t>(grade)]);
  for (std::size_t test = 0; test < box_test_names.size(); ++test)
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      for (std::size_t p = 0; p < paths.size(); ++p)
        if (chosen(box_test_names[test]))
          add_box_rows(rows, *paths[p], test, grade, workload,
                       boxes[p][test][static_cast<std::size_t>(grade)]);
  for (std::size_t test = 0; test < sphere_test_names.size(); ++test)
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      for (std::size_t p = 0; p < paths.size(); ++p)
        if (chosen(sphere_test_names[test]) || (test == 0 && chosen("line")))
          add_sphere_rows(rows, *paths[p], test, grade, workload,
                          spheres[p][test][static_cast<std::size_t>(grade)]);
  std::erase_if(rows, [&](const Row& row) { return !chosen(row.test); });
  const double cycle = nanoseconds_per_cycle();
  measure_speed(rows, options.rounds);
  std::cout
      << machine_line() << '\n'
      << "ns, instructions and moves a primitive, in the first-level cache; counted in the compiled loop "
         "without loop control;\nbound: from the ports of Zen 3 at "
      << significant(1 / cycle, 3) << " GHz; wrong decisions and leaks a million, " << options.pairs
      << " pairs a set, " << options.leak_rays << " rays at a closed mesh\n";
  print_rows(rows, cycle);
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(to_json(row, cycle));
  if (!options.json.empty()) write_json(options.json, json);
}

}  // namespace

void add_kernels_command(CLI::App& tool) {
  const auto options = std::make_shared<KernelsOptions>();
  CLI::App* command = tool.add_subcommand(
      "kernels", "intersection tests: speed, instructions, wrong decisions, leaks, per path");
  add_common_options(*command, *options);
  command->add_option("--test", options->test, "only the test of this name");
  command->add_option("--pairs", options->pairs, "pairs to judge in each set (default 20000)")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--leak-rays", options->leak_rays, "rays aimed at corners and edges (default 300000)")
      ->check(CLI::Range(1, 1000000000));
  command->add_option("--rounds", options->rounds, "timing rounds")->check(CLI::Range(1, 10000));
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench

#include "kernel_rows.hpp"

#include <raylanes/boxes.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../../dispatch/table/boxes.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/spheres.hpp"
#include "../../../dispatch/table/triangles.hpp"
#include "../../support/rulers/measure.hpp"
#include "../../support/rulers/progress.hpp"
#include "integers.hpp"

namespace raylanes::bench {
namespace {

constexpr int calls_per_timing = 200;
// A call over fewer, to tell what a call costs from what a primitive does.
constexpr std::size_t few_primitives = 128;
constexpr std::size_t counted_primitives = 32;  // some vectors of the widest

template <class Enumeration>
constexpr std::size_t index(Enumeration e) {
  return static_cast<std::size_t>(e);
}

// Adds rows that share all but form, query and work.
class RowAdder {
 public:
  RowAdder(KernelRows& rows, KernelRow common) : rows_(rows), common_(std::move(common)) {}
  void operator()(const char* form, const char* query, std::function<void(std::size_t)> work) const {
    KernelRow row = common_;
    row.form = form, row.query = query, row.work = std::move(work);
    rows_.push_back(std::move(row));
  }

 private:
  KernelRows& rows_;
  KernelRow common_;
};

KernelRow common_row(const char* kernel, std::string_view test, Grade grade, const Path& path,
                     const KernelAccuracy& accuracy, std::optional<double> leaks = {}) {
  KernelRow row{};
  row.kernel = kernel, row.test = test, row.grade = grade, row.path = &path, row.accuracy = &accuracy;
  row.leaks = leaks;
  return row;
}

// The first n of some rays.
struct FirstRays {
  RayArrays rays;
  RayArrays operator()(std::size_t n) const {
    RayArrays some = rays;
    some.size = n;
    return some;
  }
};

void set_times(KernelRow& row, const Timing& few, const Timing& all) {
  row.nanoseconds = 1e9 * all.median_seconds / (timed_primitives * calls_per_timing);
  row.spread = all.spread;
  std::vector<double> differences;
  for (std::size_t round = 0; round < all.seconds.size(); ++round)
    differences.push_back(all.seconds[round] - few.seconds[round]);
  row.loop_nanoseconds = 1e9 * quartiles_of(std::move(differences)).median /
                         ((timed_primitives - few_primitives) * calls_per_timing);
}

// Nothing was measured, or none found.
bool is_none(const std::optional<double>& share) {
  return !share || *share == 0.0;
}

}  // namespace

bool keeps_promise(const KernelRow& row) {
  const bool is_exact = row.test == "exact" || row.test == "integers";
  const bool misses_none = row.kernel == "box" && row.test != "plain";
  const auto& wrong = row.accuracy->wrong_per_million;
  if ((is_exact || misses_none) && !std::all_of(wrong.begin(), wrong.end(), is_none)) return false;
  return !(is_exact || row.test == "watertight") || is_none(row.leaks);
}

void add_triangle_rows(KernelRows& rows, const Path& path, TriangleTest test, Grade grade,
                       KernelInputs& inputs, const KernelAccuracy& accuracy, std::optional<double> leaks) {
  const TriangleTestInfo& info = triangle_tests[index(test)];
  const TriangleRow& kernels = kernels_of(path).triangles.row[index(test)][index(grade)];
  ColumnList columns(static_cast<std::size_t>(info.floats), Column(timed_primitives));
  std::vector<float*> out;
  for (auto& column : columns) out.push_back(column.data());
  const Ray ray = inputs.ray();
  const auto corners = KernelInputs::pointers(inputs.corners());
  kernels.prepare(corners.data(), timed_primitives, nullptr, ray.direction.data(), out.data());
  // Shared by the closures; the pointers are to vectors that move along with it.
  const auto data = std::make_shared<ColumnList>(std::move(columns));
  const auto pointers = std::make_shared<std::vector<const float*>>(KernelInputs::pointers(*data));
  const auto one = std::make_shared<std::vector<float>>(first_of(*data));
  std::uint8_t* const bits = inputs.bits();
  float *const t = inputs.output(0), *const u = inputs.output(1), *const v = inputs.output(2);
  const RowAdder add(rows, common_row("triangle", info.name, grade, path, accuracy, leaks));
  add("1xN", "any", [=, f = kernels.any_of_triangles](std::size_t n) {
    (void)data, f(ray, pointers->data(), n, nullptr, bits);
  });
  add("1xN", "closest", [=, f = kernels.closest_of_triangles](std::size_t n) {
    Hit found;
    (void)data, f(ray, pointers->data(), n, nullptr, found);
  });
  const auto first = FirstRays{inputs.rays()};
  add("Nx1", "any", [=, f = kernels.any_of_rays](std::size_t n) { f(first(n), one->data(), nullptr, bits); });
  add("Nx1", "closest",
      [=, f = kernels.closest_of_rays](std::size_t n) { f(first(n), one->data(), nullptr, bits, t, u, v); });
}

void add_integer_rows(KernelRows& rows, const Path& path, KernelInputs& inputs,
                      const KernelAccuracy& accuracy) {
  const RowAdder add(rows, common_row("triangle", "integers", Grade::reproducible, path, accuracy));
  const RayArrays rays = inputs.rays();
  for (const bool apart : {false, true}) {
    const auto pairs = std::make_shared<std::vector<std::pair<Ray, Triangle>>>(timed_primitives);
    for (std::size_t i = 0; i < timed_primitives; ++i) {
      auto& [ray, triangle] = (*pairs)[i];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ray.origin[axis] = rays.origin[axis][i], ray.direction[axis] = rays.direction[axis][i];
        for (std::size_t c = 0; c < 3; ++c)
          triangle.corner[c][axis] =
              std::ldexp(inputs.corners()[3 * c + axis][i], apart ? 100 * (static_cast<int>(c) - 1) : 0);
      }
    }
    add("1x1", apart ? "apart" : "closest", [pairs, t = inputs.output(0)](std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) t[i] = decide_in_integers((*pairs)[i].first, (*pairs)[i].second).t;
    });
  }
}

namespace {

// Boxes and spheres have the same rows: one ray or one primitive, a bit for each hit or the distances where rays enter
// and leave.
template <class AnyOfPrimitives, class AnyOfRays, class OfPrimitives, class OfRays>
void add_interval_rows(const RowAdder& add, KernelInputs& inputs, const ColumnList& primitives,
                       AnyOfPrimitives any_of_primitives, AnyOfRays any_of_rays, OfPrimitives of_primitives,
                       OfRays of_rays) {
  const Ray ray = inputs.ray();
  const FirstRays first{inputs.rays()};
  const auto all = KernelInputs::pointers(primitives);
  const auto one = first_of(primitives);
  float *const from = inputs.output(0), *const to = inputs.output(1);
  std::uint8_t* const bits = inputs.bits();
  add("1xN", "any", [=](std::size_t n) { any_of_primitives(ray, all.data(), n, nullptr, bits); });
  add("1xN", "closest", [=](std::size_t n) { of_primitives(ray, all.data(), n, nullptr, bits, from, to); });
  add("Nx1", "any", [=](std::size_t n) { any_of_rays(first(n), one.data(), nullptr, bits); });
  add("Nx1", "closest", [=](std::size_t n) { of_rays(first(n), one.data(), nullptr, bits, from, to); });
}

}  // namespace

void add_box_rows(KernelRows& rows, const Path& path, BoxTest test, Grade grade, KernelInputs& inputs,
                  const KernelAccuracy& accuracy) {
  const BoxRow& kernels = kernels_of(path).boxes.row[index(test)][index(grade)];
  add_interval_rows(RowAdder(rows, common_row("box", box_tests[index(test)].name, grade, path, accuracy)),
                    inputs, inputs.boxes(), kernels.any_of_boxes, kernels.any_of_rays,
                    kernels.intervals_of_boxes, kernels.intervals_of_rays);
}

void add_sphere_rows(KernelRows& rows, const Path& path, SphereTest test, Grade grade, KernelInputs& inputs,
                     const KernelAccuracy& accuracy) {
  const SphereRow& kernels = kernels_of(path).spheres.row[index(test)][index(grade)];
  add_interval_rows(
      RowAdder(rows, common_row("sphere", sphere_tests[index(test)].name, grade, path, accuracy)), inputs,
      inputs.spheres(), kernels.any_of_spheres, kernels.any_of_rays, kernels.distances_of_spheres,
      kernels.distances_of_rays);
}

void add_line_row(KernelRows& rows, const Path& path, Grade grade, KernelInputs& inputs,
                  const KernelAccuracy& accuracy) {
  const RowAdder add(rows, common_row("sphere", "line", grade, path, accuracy));
  add("1xN", "any",
      [ray = inputs.ray(), spheres = KernelInputs::pointers(inputs.spheres()), bits = inputs.bits(),
       f = kernels_of(path).spheres.line_of_spheres[index(grade)]](std::size_t n) {
        f(ray, spheres.data(), n, nullptr, bits);
      });
}

KernelRows all_kernel_rows(const std::vector<const Path*>& paths,
                           const std::function<bool(std::string_view)>& chosen, KernelInputs& inputs,
                           const KernelJudgement& judgement, const Leaks& leaks) {
  KernelRows rows;
  // add(path, grade, p, g): the rows of one test on a path; p and g index what was surveyed.
  const auto for_each_path = [&](std::string_view name, const auto& add) {
    if (!chosen(name)) return;
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      for (std::size_t p = 0; p < paths.size(); ++p)
        add(*paths[p], grade, p, static_cast<std::size_t>(grade));
  };
  for (std::size_t i = 0; i < std::size(triangle_tests); ++i)
    for_each_path(triangle_tests[i].name, [&](const Path& path, Grade grade, std::size_t p, std::size_t g) {
      add_triangle_rows(rows, path, triangle_tests[i].test, grade, inputs, judgement.triangles[p][i][g],
                        leaks.empty() ? std::nullopt : leaks[p][i][g]);
    });
  if (chosen("integers"))
    add_integer_rows(rows, raylanes::paths().front(), inputs, judgement.integers[0][0][0]);
  for (std::size_t i = 0; i < std::size(box_tests); ++i)
    for_each_path(box_tests[i].name, [&](const Path& path, Grade grade, std::size_t p, std::size_t g) {
      add_box_rows(rows, path, static_cast<BoxTest>(i), grade, inputs, judgement.boxes[p][i][g]);
    });
  for (std::size_t i = 0; i < std::size(sphere_tests); ++i)
    for_each_path(sphere_tests[i].name, [&](const Path& path, Grade grade, std::size_t p, std::size_t g) {
      add_sphere_rows(rows, path, static_cast<SphereTest>(i), grade, inputs, judgement.spheres[p][i][g]);
    });
  for_each_path("line", [&](const Path& path, Grade grade, std::size_t p, std::size_t g) {
    add_line_row(rows, path, grade, inputs, judgement.spheres[p][std::size(sphere_tests)][g]);
  });
  return rows;
}

void measure_rows(KernelRows& rows, double seconds) {
  ProgressLine progress("kernels: timing");
  // Interleaved within one test on all paths, so that neighbours in the table are neighbours in time.
  constexpr std::size_t at_once = 24;
  for (std::size_t first = 0; first < rows.size(); first += at_once) {
    const std::size_t end = std::min(rows.size(), first + at_once);
    std::vector<std::function<void()>> contenders;
    for (std::size_t i = first; i < end; ++i)
      for (const std::size_t n : {few_primitives, timed_primitives})
        contenders.push_back([&work = rows[i].work, n] {
          for (int call = 0; call < calls_per_timing; ++call) work(n);
        });
    const double share = static_cast<double>(end - first) / static_cast<double>(rows.size());
    const std::vector<Timing> timings = take_turns(contenders, {seconds * share});
    for (std::size_t i = first; i < end; ++i)
      set_times(rows[i], timings[2 * (i - first)], timings[2 * (i - first) + 1]);
    progress.update(static_cast<double>(end) / static_cast<double>(rows.size()));
  }
}

void count_instructions(KernelRows& rows) {
  ProgressLine progress("kernels: counting instructions");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].instructions = instructions_per_primitive(rows[i].work, counted_primitives);
    if (!rows[i].instructions) return;  // not permitted here, or not for long
    progress.update(static_cast<double>(i + 1) / static_cast<double>(rows.size()));
  }
}

}  // namespace raylanes::bench

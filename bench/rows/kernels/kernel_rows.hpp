// The rows of the table of intersection tests: one per test, grade, form, query and path.
#pragma once

#include <raylanes/paths.hpp>

#include "../../support/rulers/instruction_counter.hpp"
#include "kernel_inputs.hpp"
#include "kernel_survey.hpp"

namespace raylanes::bench {

struct KernelRow {
  std::string kernel, test;
  Grade grade;
  std::string form, query;
  const Path* path;
  std::function<void(std::size_t)> work;  // one call over that many primitives, at most timed_primitives
  const KernelAccuracy* accuracy;
  std::optional<double> leaks;
  double nanoseconds = 0;       // a primitive, of a call over timed_primitives
  double loop_nanoseconds = 0;  // what one primitive more costs: without what a call costs once
  double spread = 0;            // of nanoseconds
  std::optional<double>
      instructions;  // executed for one primitive more; nothing where they cannot be counted
};
// Whether the row has no wrong decision and no leak that its test promises not to have. The exact test and the
// decisions in integers have neither, and the watertight one does not leak (<raylanes/triangles.hpp>). No box is missed
// but by the plain test (<raylanes/boxes.hpp>). A NaN breaks a promise.
bool keeps_promise(const KernelRow& row);
using KernelRows = std::vector<KernelRow>;

// The rows of one test. They refer to `inputs` and `accuracy`, which must outlive them.
void add_triangle_rows(KernelRows& rows, const Path& path, TriangleTest test, Grade grade,
                       KernelInputs& inputs, const KernelAccuracy& accuracy, std::optional<double> leaks);
// Adds rows of the decisions in integers behind the exact test, which belong to no path: on ordinary numbers, and
// (apart) on corners multiplied by 2^100 and 2^-100.
void add_integer_rows(KernelRows& rows, const Path& path, KernelInputs& inputs,
                      const KernelAccuracy& accuracy);
void add_box_rows(KernelRows& rows, const Path& path, BoxTest test, Grade grade, KernelInputs& inputs,
                  const KernelAccuracy& accuracy);
void add_sphere_rows(KernelRows& rows, const Path& path, SphereTest test, Grade grade, KernelInputs& inputs,
                     const KernelAccuracy& accuracy);
void add_line_row(KernelRows& rows, const Path& path, Grade grade, KernelInputs& inputs,
                  const KernelAccuracy& accuracy);

// All rows of the chosen tests, in the order of the table. `leaks` is a result of count_leaks() or empty.
KernelRows all_kernel_rows(const std::vector<const Path*>& paths,
                           const std::function<bool(std::string_view)>& chosen, KernelInputs& inputs,
                           const KernelJudgement& judgement, const Leaks& leaks = {});

// Times all rows, neighbours in turn, in so many seconds or a little more.
void measure_rows(KernelRows& rows, double seconds);
void count_instructions(KernelRows& rows);

}  // namespace raylanes::bench

#include <algorithm>
#include <iostream>
#include <memory>

#include <raylanes/bvh.hpp>
#include <raylanes/closed_mesh.hpp>

#include "../contenders/cgal_contender.hpp"
#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../support/oracles/exact_crossings.hpp"
#include "../support/pictures/grid.hpp"
#include "../support/pictures/image.hpp"
#include "../support/pictures/slice.hpp"
#include "../support/readers/printable.hpp"
#include "../support/rulers/measure.hpp"
#include "../support/scenes/mesh_and_camera.hpp"
#include "../support/scenes/splitmix.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct InsideOptions : CommonOptions {
  std::string mesh, grid = "100x100x100", image;
  InsideRule rule = InsideRule::parity;
  int threads = 1;
  double seconds = 2.0;
  bool against_cgal = false;
};

// The slice in the middle of z, from the top left.
void write_slice(const InsideOptions& options, const Bvh& bvh, const Grid& grid,
                 std::span<const Float3> points) {
  std::vector<Float3> slice;
  const std::size_t row_size = grid[0], first = std::size_t{grid[2] / 2} * grid[1] * row_size;
  for (std::size_t y = grid[1]; y-- > 0;) {
    const std::span<const Float3> row = points.subspan(first + y * row_size, row_size);
    slice.insert(slice.end(), row.begin(), row.end());
  }
  std::vector<float> distances(slice.size());
  bvh.signed_distances(slice, distances, {.rule = options.rule, .threads = options.threads});
  write_png(options.image, grid[0], grid[1], slice_colours(distances));
  std::cout << "slice: " << printable(options.image)
            << ": blue inside, orange outside, black on the surface, dark at "
            << significant(double{largest_size(distances)}, 3) << " from it, bands of a tenth of that"
            << std::endl;
}

// What parity and winding numbers need.
std::string holes_of(const Mesh& mesh, InsideRule rule) {
  const ClosedReport report = closed_report(mesh.vertices, mesh.triangles, 0);
  const bool means_something =
      rule == InsideRule::nonzero ? report.has_winding_numbers() : report.has_parity();
  if (means_something) return "";
  return "not closed: " + std::to_string(report.open) + " edges are open, " +
         std::to_string(report.inconsistent) + " inconsistent; inside depends on the direction of rays" +
         (rule == InsideRule::vote ? ", six of them vote\n" : ", --rule vote asks six of them\n");
}

struct InsideRow {
  std::string contender, path;
  bool is_sample = false;  // some of the points
  std::vector<Location> locations = {};
  double seconds = 0.0;
  std::optional<Quartiles> ratio = {};
  std::size_t judged = 0, wrong = 0;
};

// So many of n numbers, at random, in any order.
std::vector<std::size_t> sample(std::size_t n, std::size_t count) {
  SplitMix random(1);
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < std::min(n, count); ++k)
    numbers.push_back(static_cast<std::size_t>(random.uniform() * static_cast<double>(n)));
  return numbers;
}

// The first points of the sample by rational numbers, the same for all contenders.
void judge(std::vector<InsideRow>& rows, const Mesh& mesh, std::span<const Float3> points,
           std::span<const std::size_t> some, InsideRule rule) {
  constexpr std::size_t max_judged = 200;
  for (std::size_t k = 0; k < std::min(some.size(), max_judged); ++k) {
    const Location truth =
        oracle::exact_location(mesh.vertices, mesh.triangles, points[some[k]], {0.31f, -0.73f, 0.59f}, rule);
    for (InsideRow& row : rows)
      ++row.judged, row.wrong += truth == row.locations[row.is_sample ? k : some[k]] ? 0 : 1;
  }
}

std::vector<InsideRow> locate_all(const InsideOptions& options, const Mesh& mesh, const Bvh& bvh,
                                  std::span<const Float3> points) {
  std::vector<InsideRow> rows;
  std::vector<std::function<void()>> calls;
  const std::vector<const Path*> paths = selected_paths(options.path);
  rows.reserve(paths.size() + 2);
  for (const Path* path : paths) {
    InsideRow& row =
        rows.emplace_back(InsideRow{"raylanes", path->name, false, std::vector<Location>(points.size())});
    calls.push_back([&, path] {
      bvh.locate(VertexView(points.data(), points.size()), row.locations,
                 {.rule = options.rule, .path = path, .threads = options.threads});
    });
  }
  // Beside CGAL, which takes a point a call: the same points, a call each, on the last of the paths.
  std::unique_ptr<CgalContender> cgal;
  std::vector<Float3> some;
  constexpr std::size_t points_of_cgal = 5000;
  const std::vector<std::size_t> numbers = sample(points.size(), points_of_cgal);
  if (options.against_cgal) {
    for (const std::size_t i : numbers) some.push_back(points[i]);
    InsideRow& ours = rows.emplace_back(InsideRow{"raylanes", paths.back()->name, true});
    ours.locations.resize(some.size());
    calls.push_back([&, path = paths.back()] {
      for (std::size_t i = 0; i < some.size(); ++i)
        bvh.locate(VertexView(&some[i], 1), {&ours.locations[i], 1}, {.rule = options.rule, .path = path});
    });
    InsideRow& row = rows.emplace_back(InsideRow{"CGAL Side_of_triangle_mesh", "", true});
    row.locations.resize(some.size());
    cgal = std::make_unique<CgalContender>(mesh.vertices, mesh.triangles);
    calls.push_back([&] { cgal->locate(some, row.locations); });
  }
  const std::vector<Timing> timings = take_turns(calls, {options.seconds, 3});
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].seconds = timings[k].median_seconds;
  if (options.against_cgal) rows.back().ratio = speed_ratio(timings[paths.size()], timings.back());
  judge(rows, mesh, points, numbers, options.rule);
  return rows;
}

void run(const InsideOptions& options) {
  if (options.against_cgal && options.threads != 1)
    throw std::invalid_argument("--against cgal: compares single threads, --threads must be 1");
  const Grid grid = parse_grid(options.grid);
  const Scene scene = load_scene(options.mesh);
  const std::vector<Float3> points = points_of(bounds_of(scene.mesh), grid);
  const std::string holes = holes_of(scene.mesh, options.rule);
  std::cout << machine_line() << "\n\n"
            << scene.name << ": " << scene.mesh.triangles.size() << " triangles, " << points.size()
            << " points\n"
            << holes;
  const Bvh bvh(scene.mesh);
  const std::vector<InsideRow> rows = locate_all(options, scene.mesh, bvh, points);
  std::vector<std::vector<std::string>> table{{"contender", "path", "points", "a call", "seconds",
                                               "Mpoints/s", "inside", "on", "ours ×", "judged", "wrong"}};
  Json json = Json::array();
  for (const InsideRow& row : rows) {
    std::size_t count[3]{};
    for (const Location location : row.locations) ++count[static_cast<std::size_t>(location)];
    const double rate = 1e-6 * static_cast<double>(row.locations.size()) / row.seconds;
    table.push_back({row.contender, row.path, std::to_string(row.locations.size()),
                     row.is_sample ? "1" : "all", significant(row.seconds, 3), significant(rate, 3),
                     std::to_string(count[1]), std::to_string(count[2]),
                     row.ratio ? significant(row.ratio->median, 3) : "", std::to_string(row.judged),
                     std::to_string(row.wrong)});
    json.push_back({{"scene", scene.name},
                    {"triangles", scene.mesh.triangles.size()},
                    {"contender", row.contender},
                    {"path", row.path},
                    {"rule", inside_rule_names[static_cast<std::size_t>(options.rule)]},
                    {"points", row.locations.size()},
                    {"points_per_call", row.is_sample ? 1 : row.locations.size()},
                    {"mpoints_per_second", rate},
                    {"inside", count[1]},
                    {"on", count[2]},
                    {"judged", row.judged},
                    {"wrong", row.wrong}});
    if (row.ratio) json.back()["ratio"] = row.ratio->median;
  }
  print_table(table);
  if (!options.image.empty()) write_slice(options, bvh, grid, points);
  if (!options.json.empty()) write_json(options.json, json);
  const auto is_wrong = [](const InsideRow& row) { return row.contender == "raylanes" && row.wrong > 0; };
  if (holes.empty() && std::any_of(rows.begin(), rows.end(), is_wrong))
    throw WrongAnswers("inside: WRONG ANSWERS: locations are not those of rational numbers, see above");
}

}  // namespace

void add_inside_command(CLI::App& tool) {
  const auto options = std::make_shared<InsideOptions>();
  CLI::App* command = tool.add_subcommand("inside", "which points of a grid are inside of a closed mesh");
  command->add_option("MESH", options->mesh, "a mesh file or a built-in scene")->required();
  add_common_options(*command, *options);
  command->add_option("--grid", options->grid, "points along x, y and z (default 100x100x100)");
  command->add_option(
      "--image", options->image,
      "write signed distances of the slice in the middle of z (PNG): blue inside, orange outside, "
      "light to dark with the distance in bands of a tenth of the largest, black on the surface");
  add_choice(*command, "--rule", options->rule, inside_rule_names,
             "parity (default), nonzero, or vote, for meshes with holes");
  command->add_option("--threads", options->threads, "threads (0: one per core; default 1)")
      ->check(CLI::Range(0, 1024));
  command->add_option("--against", "cgal: some of the points by CGAL, which the mesh must be closed for")
      ->check(CLI::IsMember({"cgal"}))
      ->each([options](const std::string&) { options->against_cgal = true; });
  add_seconds_option(*command, options->seconds, "seconds to time all, by turns (default 2)");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench

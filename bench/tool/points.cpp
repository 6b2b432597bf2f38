#include <iostream>

#include <raylanes/bvh.hpp>

#include "../report/row_table.hpp"
#include "../rows/point_rows.hpp"
#include "../support/pictures/image.hpp"
#include "../support/readers/printable.hpp"
#include "../support/scenes/damage.hpp"
#include "commands.hpp"
#include "number_options.hpp"
#include "shared_options.hpp"

namespace raylanes::bench {
namespace {

struct PointsOptions : SharedOptions {
  PointRowsOptions rows;
  std::string grid = "100x100x100";
  std::size_t holes = 0;
};

// Draws signed distances in the middle of z, from the top left.
void write_slice(const PointsOptions& options, const PointRowsOptions& rows, const Scene& scene) {
  const Grid& grid = rows.grid;
  const std::vector<Float3> points = points_of(bounds_of(scene.mesh), grid);
  std::vector<Float3> slice;
  const std::size_t row_size = grid[0], first = std::size_t{grid[2] / 2} * grid[1] * row_size;
  for (std::size_t y = grid[1]; y-- > 0;) {
    const auto row = std::span(points).subspan(first + y * row_size, row_size);
    slice.insert(slice.end(), row.begin(), row.end());
  }
  std::vector<float> distances(slice.size());
  Bvh(scene.mesh).signed_distances(slice, distances, {.rule = rows.rule, .threads = rows.threads});
  const std::filesystem::path file = options.image_of(scene.name);
  write_png(file, grid[0], grid[1], slice_colours(distances));
  std::cout << "slice: " << printable(file.string())
            << ": blue inside, orange outside, black on the surface, dark at "
            << significant(double{largest_size(distances)}, 3) << " from it, bands of a tenth of that"
            << std::endl;
}

void add(RowTable& table, const Scene& scene, const PointsOptions& all, const PointRowsOptions& options,
         const PointRow& row) {
  const bool places = row.query == PointQuery::inside || row.query == PointQuery::signed_distance;
  table.begin(
      {{"scene", scene.name}, {"triangles", scene.mesh.triangles.size()}, {"threads", options.threads}});
  table.add("query", "query", std::string(point_query_names[static_cast<std::size_t>(row.query)]))
      .add("points", "points", std::string(point_kind_names[static_cast<std::size_t>(row.kind)]))
      .add("contender", "contender", row.contender)
      .add("path", "path", row.path)
      .add("a call", "points_per_call", row.points_per_call, row.points_per_call == 1 ? "1" : "all")
      .add("Mpoints/s", "mpoints_per_second", row.mpoints_per_second)
      .add_spread(row.spread)
      .add_ratio("bvh × as fast", "bvh_ratio", row.behind)
      .only_if(row.query != PointQuery::closest)
      .add("wrong", "wrong", row.wrong)
      .only_if(row.query == PointQuery::winding)
      .add("error", "winding_error", row.winding_error, 2)
      .only_if(true)
      .add("off by", "largest_difference", row.largest_difference, 2)
      .add("count", "point_count", row.points)
      .only_if(places)
      .add("inside", "inside", row.inside)
      .add("on", "on", row.on)
      .only_if(row.query != PointQuery::closest)
      .add("judged", "judged", row.judged)
      .only_if(true)
      .add("", "accuracy", options.accuracy)
      .add("", "holes", all.holes)
      .add("", "rule", std::string(inside_rule_names[static_cast<std::size_t>(options.rule)]));
}

void run(const PointsOptions& options) {
  PointRowsOptions parsed = options.rows;
  parsed.paths = options.paths();
  parsed.grid = parse_grid(options.grid);
  parsed.count = options.count, parsed.threads = options.threads, parsed.seconds = options.seconds;
  parsed.against_embree = options.is_against("embree"), parsed.against_cgal = options.is_against("cgal");
  parsed.against_barill = options.is_against("barill");
  const bool needs_closed =
      parsed.rule != InsideRule::winding && std::ranges::any_of(parsed.queries, [](PointQuery query) {
        return query == PointQuery::inside || query == PointQuery::signed_distance;
      });
  bool sound = true;
  RowTable table, example;
  add(example, Scene{}, options, parsed, {});
  options.check_output(example);
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    Scene scene = options.load(name);
    if (options.holes > 0) scene.mesh = with_holes(scene.mesh, options.holes);
    std::cout << '\n' << scene_line(scene) << (needs_closed ? holes_of(scene.mesh, parsed.rule) : "");
    for (const PointRow& row : measure_points(scene, parsed)) {
      add(table, scene, options, parsed, row);
      sound = sound && row.is_sound();
    }
    table.print(options.columns);
    if (!options.image.empty()) write_slice(options, parsed, scene);
  }
  options.finish(table,
                 sound ? ""
                       : "points: WRONG ANSWERS: distances, places or numbers that paths and trees share "
                         "differ, places are not those of rational numbers, or numbers are off by too much");
}

}  // namespace

void add_points_command(CLI::App& tool) {
  const auto options = std::make_shared<PointsOptions>();
  CLI::App* command =
      tool.add_subcommand("points", "query points: inside or outside, closest, distances, winding numbers");
  options->count = 1 << 16;
  options->declare(
      *command, {"SCENE", "--subdivide", "--path", "--count", "--threads", "--seconds", "--image", "--json"});
  options->declare_against(*command, {{"embree", "rtcPointQuery, for closest"},
                                      {"cgal", "AABB_tree for closest, Side_of_triangle_mesh for inside"},
                                      {"barill", "fast winding numbers of 2018, for winding"}});
  add_choices(*command, "--query", options->rows.queries, point_query_names, "queries to measure");
  add_choices(*command, "--points", options->rows.kinds, point_kind_names,
              "places of the points: in the box of the scene, near its surface, or in a grid");
  add_choice(*command, "--rule", options->rows.rule, inside_rule_names,
             "rule by which a point is inside; winding is for meshes with holes");
  add_number(*command, "--holes", options->holes, {0, 1000000},
             "cut so many holes into each scene, at places from a seed");
  add_number(*command, "--accuracy", options->rows.accuracy, {0, 1},
             "error that winding numbers may have; 0: least");
  add_number(*command, "--beta", options->rows.beta, {1, 1000},
             "radii from where on barill takes a node as a whole");
  command
      ->add_option("--grid", options->grid,
                   "points of the grid along x, y and z; --image draws signed distances in the middle of z")
      ->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench

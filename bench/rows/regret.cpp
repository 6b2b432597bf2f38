#include "regret.hpp"

#include "../../accel/builders/mesh_build.hpp"
#include "../../accel/builders/mesh_references.hpp"

namespace raylanes::bench {
namespace {

double waste_of(const Mesh& mesh) {
  const Progress silent;
  ProgressMeter progress(silent);
  MemoryMeter memory;
  return box_waste(references_of(mesh.vertices, mesh.triangles, {1, progress, memory}, 1.0), mesh.vertices,
                   mesh.triangles);
}

bool is_same(const TreeKind& a, const TreeKind& b) {
  return a.builder == b.builder && a.optimize == b.optimize;
}

double mean_seconds_a_ray(const TreeRow& row) {
  double sum = 0.0;
  for (const TreeTrace& trace : row.traces) sum += 1e-6 / trace.mrays_per_second;
  return sum / static_cast<double>(std::max<std::size_t>(1, row.traces.size()));
}

Chosen choose(const Mesh& mesh, const std::vector<TreeCost>& costs, double each) {
  const double rays = each * static_cast<double>(mesh.triangles.size());
  const TreeReport report = Bvh(mesh, {.choose = true, .rays = rays}).report();
  Chosen chosen{.rays_a_triangle = each, .kind = {report.builder, report.optimized}, .why = report.choice};
  const auto cheaper = [&](const TreeCost& a, const TreeCost& b) { return a.with(rays) < b.with(rays); };
  const TreeCost& best = *std::min_element(costs.begin(), costs.end(), cheaper);
  chosen.best = best.kind;
  for (const TreeCost& cost : costs) chosen.fixed_regrets.push_back(cost.with(rays) / best.with(rays) - 1.0);
  const auto taken = std::find_if(costs.begin(), costs.end(),
                                  [&](const TreeCost& cost) { return is_same(cost.kind, chosen.kind); });
  if (taken == costs.end()) throw std::logic_error("choose: " + name_of(chosen.kind) + " was not measured");
  chosen.regret = chosen.fixed_regrets[static_cast<std::size_t>(taken - costs.begin())];
  return chosen;
}

}  // namespace

std::vector<TreeKind> sensible_trees() {
  std::vector<TreeKind> kinds{{BuildOptions{}.builder}};
  for (std::size_t i = 0; i < tree_builder_names.size(); ++i)
    if (const auto builder = static_cast<TreeBuilder>(i); builder != kinds[0].builder)
      kinds.push_back({builder});
  for (const TreeBuilder builder :
       {TreeBuilder::binned_sah, TreeBuilder::spatial_splits, TreeBuilder::morton})
    kinds.push_back({builder, true});
  return kinds;
}

SceneChoices compare_choices(const Scene& scene, SceneTreesOptions options) {
  options.builders = sensible_trees();
  options.counts = false;
  const SceneTrees trees = compare_trees(scene, options);
  SceneChoices choices{.scene = scene.name,
                       .triangles = scene.mesh.triangles.size(),
                       .box_waste = waste_of(scene.mesh),
                       .sound = trees.sound,
                       .verdict = trees.verdict};
  for (std::size_t i = 0; i < options.builders.size(); ++i)
    choices.costs.push_back(
        {options.builders[i], trees.rows[i].build_seconds, mean_seconds_a_ray(trees.rows[i])});
  for (const double each : rays_a_triangle) choices.chosen.push_back(choose(scene.mesh, choices.costs, each));
  return choices;
}

}  // namespace raylanes::bench

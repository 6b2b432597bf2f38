#include <pybind11/stl.h>

#include "mesh_holes.hpp"
#include "module.hpp"
#include "tree_states.hpp"

namespace raylanes::python {
namespace {

// The entries that reports of both trees share. "name"_a = value would lose Python's MemoryError.
template <class Report>
py::dict common_report(const Report& report, std::string_view builder) {
  py::dict all;
  all["builder"] = builder;
  all["nodes"] = report.nodes;
  all["leaves"] = report.leaves;
  all["triangles"] = report.triangles;
  all["left_out"] = report.left_out;
  all["references"] = report.references;
  all["bytes"] = report.bytes;
  all["depth"] = report.depth;
  all["sah_cost"] = report.sah_cost;
  all["boxes_seconds"] = report.boxes_seconds;
  all["tree_seconds"] = report.tree_seconds;
  all["layout_seconds"] = report.layout_seconds;
  all["peak_bytes"] = report.peak_bytes;
  return all;
}

template <class T>
void bind_queries(py::module_& module, const char* name) {
  py::class_<SharedTree<T>> bound(module, name);
  def_ray_calls<TreeOf<T>>(bound);
  bound.def("corners", corners<T>)
      .def("locate", locate<SharedTree<T>>)
      .def("winding_numbers", winding_numbers<SharedTree<T>>)
      .def("closest_points", closest_points<SharedTree<T>>)
      .def("signed_distances", signed_distances<SharedTree<T>>)
      .def("bounds", [](const SharedTree<T>& shared) {
        const auto box = query(shared, [](const TreeOf<T>& tree) { return tree.bounds(); });
        return py::make_tuple(box.lo, box.hi);
      });
}

template <class Tree>
auto bind_tree(py::module_& module, const char* name) {
  using Shared = SharedTreeOf<Tree>;
  auto bound =
      py::class_<Shared, SharedTree<NumberOf<Tree>>>(module, name, py::custom_type_setup(check_new_objects))
          .def("to_bytes", to_bytes<Shared>)
          .def("__reduce_ex__", reduced<Shared>)
          .def("__deepcopy__",
               [](const py::object& self, const py::object&) { return py::type::of(self)(self); })
          .def("left_out", [](const Shared& shared) { return to_python(shared.left_out); })
          .def("found_holes", found_holes<Tree>)
          .def("found_inside_out", found_inside_out<Tree>)
          .def("nbytes", [](const Shared& shared) {
            return to_python(query(shared, [](const Tree& tree) { return tree.bytes(); }));
          });
  def_constructor(bound, made_from<Shared>);
  return bound;
}

template <class Tree>
std::unique_ptr<SharedTreeOf<Tree>> built_bvh(const py::array& vertices, const py::array& faces,
                                              std::string_view builder, int threads, bool optimize,
                                              double rays, const py::object& progress) {
  BuildOptions options;
  options.choose = builder == "auto";
  options.rays = rays;
  if (!options.choose) options.builder = named<TreeBuilder>("builder", tree_builder_names, builder);
  options.threads = usable_threads(threads);
  options.optimize = optimize;
  return built<Tree>(vertices, faces, options, progress);
}

std::unique_ptr<SharedTreeOf<KdTree>> built_kd_tree(const py::array& vertices, const py::array& faces,
                                                    std::string_view builder, int threads,
                                                    const py::object& progress) {
  KdBuildOptions options;
  options.builder = named<KdBuilder>("builder", kd_builder_names, builder);
  options.threads = usable_threads(threads);
  return built<KdTree>(vertices, faces, options, progress);
}

template <class Tree>
py::dict report_of(const SharedTreeOf<Tree>& shared) {
  const TreeReport report = query(shared, [](const Tree& tree) { return tree.report(); });
  py::dict all = common_report(report, tree_builder_names[static_cast<std::size_t>(report.builder)]);
  all["optimized"] = report.optimized;
  all["overlap"] = report.overlap;
  all["optimize_seconds"] = report.optimize_seconds;
  all["choice"] = report.choice;
  return all;
}

py::dict kd_report_of(const SharedTreeOf<KdTree>& shared) {
  const KdReport report = query(shared, [](const KdTree& tree) { return tree.report(); });
  py::dict all = common_report(report, kd_builder_names[static_cast<std::size_t>(report.builder)]);
  all["empty_leaves"] = report.empty_leaves;
  all["wide_nodes"] = report.wide_nodes;
  all["blocks"] = report.blocks;
  return all;
}

template <class Tree>
void bind_bvh(py::module_& module, const char* name) {
  auto bvh = bind_tree<Tree>(module, name);
  def_constructor(bvh, built_bvh<Tree>);
  bvh.def("refit", refit<Tree>)
      .def("sah_cost",
           [](const SharedTreeOf<Tree>& shared) {
             return to_python(query(shared, [](const Tree& tree) { return tree.sah_cost(); }));
           })
      .def("decay",
           [](const SharedTreeOf<Tree>& shared) {
             return to_python(query(shared, [](const Tree& tree) { return tree.decay(); }));
           })
      .def("report", report_of<Tree>);
}

}  // namespace

void bind_trees(py::module_& module) {
  module.attr("how_names") =
      py::tuple(py::cast(std::vector<std::string>(how_names.begin(), how_names.end())));
  bind_queries<float>(module, "TriangleTree");
  bind_queries<double>(module, "TriangleTreeD");
  bind_bvh<Bvh>(module, "Bvh");
  bind_bvh<BvhD>(module, "BvhD");
  auto kd_tree = bind_tree<KdTree>(module, "KdTree");
  def_constructor(kd_tree, built_kd_tree);
  kd_tree.def("report", kd_report_of);
}

}  // namespace raylanes::python

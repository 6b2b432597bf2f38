// The module raylanes._native: what the Python text of the package stands on.
#include "module.hpp"

#include <raylanes/closed_mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/version.hpp>

#include "listener.hpp"
#include "names.hpp"
#include "numpy_arrays.hpp"
#include "without_gil.hpp"

namespace raylanes::python {
namespace {

py::list all_paths() {
  py::list all;
  for (const Path& path : paths())
    all.append(py::make_tuple(path.name, path.isa, path.library, path.lanes, supported(path)));
  return all;
}

py::dict report_on(const py::array& vertices, const py::array& faces, std::size_t max_listed) {
  const VertexView of_vertices = vertices_of<float>(vertices);
  const IndexView of_faces = indices_of(faces);
  ClosedReport report;
  Listener listener(py::none(), of_faces.count);
  listener.without_gil(
      [&] { report = closed_report(of_vertices, of_faces, max_listed, listener.progress()); });
  py::list first;
  for (const FaultyEdge& edge : report.first)
    first.append(py::make_tuple(edge_fault_names[static_cast<std::size_t>(edge.fault)], edge.triangle,
                                edge.from, edge.to));
  py::dict all;
  all["edges"] = report.edges;
  all["open"] = report.open;
  all["inconsistent"] = report.inconsistent;
  all["shared"] = report.shared;
  all["degenerate"] = report.degenerate;
  all["doubled"] = report.doubled;
  all["first"] = first;
  all["is_closed"] = report.is_closed();
  all["has_parity"] = report.has_parity();
  all["has_winding_numbers"] = report.has_winding_numbers();
  return all;
}

// As Python spells versions: "0.2.0.dev0" for "0.2.0-dev".
std::string python_version() {
  std::string text = version();
  if (const auto suffix = text.find("-dev"); suffix != std::string::npos) text.replace(suffix, 4, ".dev0");
  return text;
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  py::register_local_exception_translator(keep_memory_error);
  module.attr("__version__") = python_version();
  module.def("paths", all_paths);
  module.def("active_path", [] { return to_python(active_path().name); });
  module.def("find_path", [](const char* name) { return to_python(find_path(name).name); });
  module.def("closed_report", report_on);
  bind_roots(module);
  bind_trees(module);
  bind_scenes(module);
}

}  // namespace raylanes::python

// The module raylanes._native: what the Python text of the package stands on.
#include "module.hpp"

#include <raylanes/closed_mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/roots.hpp>
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

Accuracy accuracy_named(std::string_view name) {
  std::array<std::string_view, accuracies.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = accuracies[i].name;
  return named<Accuracy>("accuracy", names, name);
}

template <class T>
using Root = void (*)(std::span<const T>, std::span<T>, Accuracy, const Path*);

template <class T>
void take_roots(Root<T> root, const py::array& x, const py::array& y, std::string_view accuracy,
                const char* path) {
  const Rows from = rows_of(x, sizeof(T));
  const std::span<T> to = span_of<T>(y);
  const Accuracy bound = accuracy_named(accuracy);
  const Path* const on = path_named(path);
  if (from.count > 1 && from.stride != sizeof(T)) throw std::invalid_argument("x is not contiguous");
  const WithoutGil others_run;
  root({reinterpret_cast<const T*>(from.first), from.count}, to, bound, on);
}

void bind_root(py::module_& module, const char* name, Root<float> of_floats, Root<double> of_doubles) {
  module.def(name, [=](const py::array& x, const py::array& y, std::string_view accuracy, const char* path) {
    if (item_bytes(x) == sizeof(float))
      take_roots<float>(of_floats, x, y, accuracy, path);
    else
      take_roots<double>(of_doubles, x, y, accuracy, path);
  });
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
  bind_root(module, "sqrt", sqrt, sqrt);
  bind_root(module, "rsqrt", rsqrt, rsqrt);
  bind_root(module, "reciprocal", reciprocal, reciprocal);
  bind_trees(module);
  bind_scenes(module);
}

}  // namespace raylanes::python

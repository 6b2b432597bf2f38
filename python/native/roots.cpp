// Roots of arrays, and their accuracies by name and by number.
#include <pybind11/numpy.h>

#include <algorithm>
#include <optional>
#include <string>

#include <raylanes/roots.hpp>

#include "module.hpp"
#include "names.hpp"
#include "owned.hpp"
#include "without_gil.hpp"

namespace raylanes::python {
namespace {

template <class T>
using Root = void (*)(std::span<const T>, std::span<T>, Accuracy, const Path*);

// The next character of a name from i on that is no space and no underscore; 0 at its end.
char next_of(std::string_view name, std::size_t& i) {
  while (i < name.size() && (name[i] == ' ' || name[i] == '_')) ++i;
  return i < name.size() ? name[i++] : '\0';
}

// "1 ulp", "1ulp" and "within_1_ulp" are one.
std::optional<Accuracy> known_accuracy(std::string_view name) {
  constexpr std::string_view within = "within";
  const auto begin = [&](std::string_view of) { return of.starts_with(within) ? within.size() : 0; };
  for (const AccuracyInfo& info : accuracies) {
    std::size_t i = begin(name), k = begin(info.name);
    char c = next_of(name, i);
    while (c != '\0' && c == next_of(info.name, k)) c = next_of(name, i);
    if (c == '\0' && next_of(info.name, k) == '\0') return info.accuracy;
  }
  return {};
}

// The full name of an accuracy.
std::string_view accuracy_named(std::string_view name) {
  if (const auto known = known_accuracy(name)) return accuracies[static_cast<std::size_t>(*known)].name;
  std::string names;
  for (const AccuracyInfo& info : accuracies) {
    std::string brief(info.name);
    if (brief.starts_with("within_")) brief = brief.substr(7);
    std::replace(brief.begin(), brief.end(), '_', info.max_ulp < 1 ? '_' : ' ');
    names += brief + ", ";
  }
  throw std::invalid_argument(
      "accuracy: there is no \"" + std::string(name) + "\", but " + names +
      "each also with within_ before it, and relative errors as numbers, such as 1e-7");
}

// None: nothing that is known.
template <class T>
std::optional<Accuracy> accuracy_of(PyObject* accuracy) {
  if (PyFloat_Check(accuracy)) return accuracy_within<T>(PyFloat_AS_DOUBLE(accuracy));
  if (!PyUnicode_Check(accuracy) || PyUnicode_READY(accuracy) != 0 || !PyUnicode_IS_ASCII(accuracy))
    return {};
  return known_accuracy({static_cast<const char*>(PyUnicode_DATA(accuracy)),
                         static_cast<std::size_t>(PyUnicode_GET_LENGTH(accuracy))});
}

using Array = py::detail::PyArray_Proxy;
const auto& numpy() {
  return py::detail::npy_api::get();
}

// An array that the library reads as it lies: no subclass, of its own type, aligned, dense.
const Array* dense(PyObject* object, PyObject* type) {
  constexpr int wanted = int{py::array::c_style} | int{py::detail::npy_api::NPY_ARRAY_ALIGNED_};
  if (Py_TYPE(object) != numpy().PyArray_Type_) return nullptr;
  const auto* const array = reinterpret_cast<const Array*>(object);
  return array->descr == type && (array->flags & wanted) == wanted ? array : nullptr;
}

bool may_take(const Array& x, const Array& out, std::size_t bytes) {
  return (out.flags & py::detail::npy_api::NPY_ARRAY_WRITEABLE_) != 0 && out.nd == x.nd &&
         std::equal(x.dimensions, x.dimensions + x.nd, out.dimensions) &&
         (out.data == x.data || out.data + bytes <= x.data || x.data + bytes <= out.data);
}

template <class T>
PyObject* type_of() {
  static PyObject* const type = py::dtype::of<T>().release().ptr();
  return type;
}

// None where Python has to make other arrays, or to say what is wrong.
template <class T>
py::object taken(Root<T> root, py::handle given, py::handle accuracy, const py::object& out,
                 const Path* path) {
  const Array* const x = dense(given.ptr(), type_of<T>());
  if (x == nullptr || x->nd == 0) return py::none();
  const std::optional<Accuracy> bound = accuracy_of<T>(accuracy.ptr());
  if (!bound) return py::none();
  std::size_t n = 1;
  for (int axis = 0; axis < x->nd; ++axis) n *= static_cast<std::size_t>(x->dimensions[axis]);
  py::object to = out;
  if (out.is_none()) {
    Py_INCREF(type_of<T>());
    to = not_null(numpy().PyArray_NewFromDescr_(numpy().PyArray_Type_, type_of<T>(), x->nd, x->dimensions,
                                                nullptr, nullptr, 0, nullptr));
  } else {
    const Array* const array = dense(out.ptr(), type_of<T>());
    if (array == nullptr || !may_take(*x, *array, n * sizeof(T))) return py::none();
  }
  const std::span from(reinterpret_cast<const T*>(x->data), n);
  const std::span into(reinterpret_cast<T*>(reinterpret_cast<const Array*>(to.ptr())->data), n);
  constexpr std::size_t lock_is_dear = 4096;
  if (n < lock_is_dear) {
    root(from, into, *bound, path);
  } else {
    const WithoutGil others_run;
    root(from, into, *bound, path);
  }
  return to;
}

const char* text_of(const py::object& name) {
  const char* const text = PyUnicode_AsUTF8(name.ptr());
  return text != nullptr ? text : throw py::error_already_set();
}

void bind_root(py::module_& module, const char* name, Root<float> of_floats, Root<double> of_doubles) {
  module.def(
      name,
      [=](py::handle x, py::handle accuracy, const py::object& out, const py::object& path) -> py::object {
        const Path* const on = path.is_none() ? nullptr : path_named(text_of(path));
        if (dense(x.ptr(), type_of<double>()) != nullptr)
          return taken<double>(of_doubles, x, accuracy, out, on);
        return taken<float>(of_floats, x, accuracy, out, on);
      });
}

}  // namespace

void bind_roots(py::module_& module) {
  module.def("accuracy", [](std::string_view name) { return to_python(accuracy_named(name)); });
  bind_root(module, "sqrt", sqrt, sqrt);
  bind_root(module, "rsqrt", rsqrt, rsqrt);
  bind_root(module, "reciprocal", reciprocal, reciprocal);
}

}  // namespace raylanes::python

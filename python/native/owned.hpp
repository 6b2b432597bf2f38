// Who owns what Python and C++ hand each other, also if memory runs out on the way.
#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace raylanes::python {

namespace py = pybind11;

// For py::custom_type_setup: pybind11's own tp_new writes to a new object without a check for null.
inline void check_new_objects(PyHeapTypeObject* type) {
  type->ht_type.tp_new = [](PyTypeObject* of, PyObject*, PyObject*) {
    PyObject* const made = of->tp_alloc(of, 0);
    if (made != nullptr) reinterpret_cast<py::detail::instance*>(made)->allocate_layout();
    return made;
  };
}

// Makes a Python object the owner of `object`; def_constructor() has its only call.
// py::init would free it twice if pybind11 has no memory to register it: its address would stay in the Python object.
template <class T>
void give(py::detail::value_and_holder& self, std::unique_ptr<T> object) {
  self.value_ptr() = object.get();
  try {
    self.type->init_instance(self.inst, &object);
  } catch (...) {
    self.value_ptr() = nullptr;
    throw;
  }
}

// Binds a constructor of a class by a function that makes the object.
template <class Class, class Object, class... Arguments>
void def_constructor(Class& of, std::unique_ptr<Object> (*make)(Arguments...)) {
  of.def(
      "__init__",
      [make](py::detail::value_and_holder& self, Arguments... arguments) {
        give(self, make(std::forward<Arguments>(arguments)...));
      },
      py::detail::is_new_style_constructor());
}

// Owns a result of Python's C interface. Throws Python's error if it is null.
inline py::object not_null(PyObject* made) {
  return made != nullptr ? py::reinterpret_steal<py::object>(made) : throw py::error_already_set();
}

// Converts a number or text. If a function returned it unconverted, pybind11 would turn a MemoryError into a TypeError.
template <class T>
py::object to_python(T&& value) {
  return not_null(py::cast(std::forward<T>(value)).release().ptr());
}

// Gives access to the bytes of a Python object. If memory runs out, pybind11's buffer_info would never release them.
class BytesOf {
 public:
  explicit BytesOf(const py::object& object) {
    if (PyObject_GetBuffer(object.ptr(), &view_, PyBUF_SIMPLE) != 0) throw py::error_already_set();
  }
  BytesOf(const BytesOf&) = delete;
  BytesOf& operator=(const BytesOf&) = delete;
  ~BytesOf() { PyBuffer_Release(&view_); }

  std::span<const char> bytes() const {
    return {static_cast<const char*>(view_.buf), static_cast<std::size_t>(view_.len)};
  }

 private:
  Py_buffer view_;
};

// The bytes of what the library has made, without a copy.
template <class T>
py::array bytes_kept(std::vector<T>&& items) {
  auto made = std::make_unique<std::vector<T>>(std::move(items));
  const py::capsule owner(made.get(), [](void* of) { delete static_cast<std::vector<T>*>(of); });
  const std::vector<T>& kept = *made.release();
  return py::array(py::dtype("u1"), {kept.size() * sizeof(T)}, {1}, kept.data(), owner);
}

// An exception translator. If Python has no memory for a new object, pybind11 throws a std::runtime_error and leaves
// Python's MemoryError set.
inline void keep_memory_error(std::exception_ptr thrown) {
  if (PyErr_Occurred() != nullptr && PyErr_ExceptionMatches(PyExc_MemoryError) != 0) return;
  std::rethrow_exception(thrown);
}

}  // namespace raylanes::python

// Rows of NumPy arrays as the library's views take them. Who calls has made dtypes and shapes right; what could reach
// beyond an array is refused here all the same.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "numbers.hpp"
#include "owned.hpp"

namespace raylanes::python {

// Rows of `row_bytes` bytes each: records in one dimension, or numbers side by side in two.
struct Rows {
  std::byte* first;
  std::size_t count, stride;
};

// By Python: array.itemsize() of pybind11 before 2.12 looks where NumPy 1 has it, and NumPy 2 has something else.
inline std::size_t item_bytes(const py::array& array) {
  static PyObject* const name = not_null(PyUnicode_InternFromString("itemsize")).release().ptr();
  return not_null(PyObject_GetAttr(array.ptr(), name)).cast<std::size_t>();
}

// may_overlap: whether rows may lie nearer than they are long, or all in one place.
inline Rows rows_of(const py::array& array, std::size_t row_bytes, bool may_overlap = false) {
  const std::size_t size = item_bytes(array);
  const std::size_t columns = array.ndim() == 2 ? static_cast<std::size_t>(array.shape(1)) : 1;
  if (array.ndim() < 1 || array.ndim() > 2 || columns * size != row_bytes)
    throw std::invalid_argument("an array does not hold rows of " + std::to_string(row_bytes) + " bytes");
  const auto count = static_cast<std::size_t>(array.shape(0));
  const auto at_least = static_cast<py::ssize_t>(row_bytes);
  const py::ssize_t stride = count > 1 ? array.strides(0) : at_least;
  if (stride < (may_overlap ? 0 : at_least) ||
      (count > 0 && columns > 1 && array.strides(1) != static_cast<py::ssize_t>(size)))
    throw std::invalid_argument("the rows of an array lie otherwise than views have them");
  // No byte of it is written but through an array that writable_rows_of has looked at.
  return {const_cast<std::byte*>(static_cast<const std::byte*>(array.data())), count,
          static_cast<std::size_t>(stride)};
}

inline Rows writable_rows_of(const py::array& array, std::size_t row_bytes) {
  if (!array.writeable()) throw std::invalid_argument("out is read-only");
  return rows_of(array, row_bytes);
}

template <class T>
VertexRecords<T> vertices_of(const py::array& array) {
  const Rows rows = rows_of(array, 3 * sizeof(T));
  return {rows.first, rows.count, rows.stride};
}

inline IndexView indices_of(const py::array& array) {
  const Rows rows = rows_of(array, sizeof(Index3));
  IndexView view;
  view.first = rows.first, view.count = rows.count, view.stride = rows.stride;
  view.is_signed = array.dtype().kind() == 'i';
  return view;
}

// Rays, or any other records to read.
template <class Record>
RayRecords<Record> records_of(const py::array& array) {
  const Rows rows = rows_of(array, sizeof(Record));
  return {rows.first, rows.count, rows.stride};
}
// Rays of Python: an array of them, or the tuple (origins, directions, tmin, tmax) of an array each.
template <class T>
class RaysOf : public RayRecords<RayOf<T>> {
  using Records = RayRecords<RayOf<T>>;
  RayParts apart_;

 public:
  explicit RaysOf(const py::object& rays) {
    if (!py::isinstance<py::tuple>(rays)) {
      Records::operator=(records_of<RayOf<T>>(rays.cast<py::array>()));
      return;
    }
    const auto arrays = rays.cast<py::tuple>();
    const auto part = [&](std::size_t i, std::size_t numbers) {
      const Rows rows = rows_of(py::object(arrays[i]).cast<py::array>(), numbers * sizeof(T), true);
      if (i > 0 && rows.count != apart_.count)
        throw std::invalid_argument("the parts of rays have different sizes");
      apart_.count = rows.count;
      return RayParts::Part{rows.first, rows.stride};
    };
    apart_.origin = part(0, 3), apart_.direction = part(1, 3), apart_.tmin = part(2, 1),
    apart_.tmax = part(3, 1);
    Records::operator=(apart_);
  }
  RaysOf(const RaysOf&) = delete;
  RaysOf& operator=(const RaysOf&) = delete;
};

// Hits, or any other records to write.
template <class Record>
HitRecords<Record> writable_records_of(const py::array& array) {
  const Rows rows = writable_rows_of(array, sizeof(Record));
  return {rows.first, rows.count, rows.stride};
}
template <class T>
HitRecords<HitOf<T>> hits_of(const py::array& array) {
  return writable_records_of<HitOf<T>>(array);
}

// Answers that the library wants side by side.
template <class T>
std::span<T> span_of(const py::array& array) {
  const Rows rows = writable_rows_of(array, sizeof(T));
  if (rows.count > 1 && rows.stride != sizeof(T)) throw std::invalid_argument("out is not contiguous");
  if (reinterpret_cast<std::uintptr_t>(rows.first) % alignof(T) != 0)
    throw std::invalid_argument("out is not aligned");
  return {reinterpret_cast<T*>(rows.first), rows.count};
}

// A bit an element, or null for all of them.
inline LaneBits bits_of(const py::object& active, std::size_t elements) {
  if (active.is_none()) return nullptr;
  const std::span<std::uint8_t> bits = span_of<std::uint8_t>(active.cast<py::array>());
  if (bits.size() != (elements + 7) / 8) throw std::invalid_argument("active has another size");
  return bits.data();
}

}  // namespace raylanes::python

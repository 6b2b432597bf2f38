// A Python file object as a stream.
#pragma once

#include <algorithm>
#include <streambuf>
#include <string>

#include "owned.hpp"
#include "without_gil.hpp"

namespace raylanes::python {

// For reading: by the function `read` of the file object, as many bytes as the stream is asked for and none behind.
class FileBuffer : public std::streambuf {
 public:
  FileBuffer(const py::object& read, WithoutGil& released) : read_(read), released_(released) {}

 protected:
  std::streamsize xsgetn(char* to, std::streamsize size) override {
    std::streamsize done = 0;
    released_.with_gil([&] {
      while (done < size) {
        const std::streamsize some = read_some(to + done, size - done);
        if (some == 0) break;
        done += some;
      }
    });
    return done;
  }

 private:
  // The file object makes an array for each of its answers: of a bounded size, whatever a damaged tree asks for.
  static constexpr std::streamsize most_at_once = 1 << 20;

  std::streamsize read_some(char* to, std::streamsize size) const {
    size = std::min(size, most_at_once);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const py::object number = not_null(PyLong_FromSsize_t(size));
    const py::object answer = not_null(PyObject_CallOneArg(read_.ptr(), number.ptr()));
    if (PyObject_CheckBuffer(answer.ptr()) == 0)
      throw py::type_error(std::string("file: bytes are needed, not ") + Py_TYPE(answer.ptr())->tp_name);
    const BytesOf bytes(answer);
    const auto count = static_cast<std::streamsize>(bytes.bytes().size());
    if (count > size) throw py::value_error("file: read() returned more bytes than it was asked for");
    std::copy_n(bytes.bytes().data(), count, to);
    return count;
  }

  const py::object& read_;
  WithoutGil& released_;
};

}  // namespace raylanes::python

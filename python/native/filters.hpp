// Filters of hits that are functions of Python.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <stdexcept>

#include "listener.hpp"
#include "owned.hpp"

namespace raylanes::python {

// A filter by a function of indices and hits, as bytes of its own, which returns a byte for each. The library calls
// filters on the thread that asks.
template <class AnyHit>
auto filter_by(const py::object& function, Listener& listener) {
  const auto copied = [](const auto& span) {
    return py::array(py::dtype("u1"), {span.size_bytes()}, {1}, span.data());
  };
  return [&function, &listener, copied](std::span<const std::size_t> rays, std::span<const AnyHit> hits,
                                        std::span<std::uint8_t> rejected) {
    listener.with_gil([&] {
      const py::array indices = copied(rays), of_hits = copied(hits);
      const BytesOf answer(
          not_null(PyObject_CallFunctionObjArgs(function.ptr(), indices.ptr(), of_hits.ptr(), nullptr)));
      if (answer.bytes().size() != rejected.size()) throw std::invalid_argument("filter: another size");
      std::copy(answer.bytes().begin(), answer.bytes().end(), rejected.begin());
    });
  };
}

}  // namespace raylanes::python

// Makes states of trees, and writes them: builds, refits. Copies and bytes are those of scenes, too.
#pragma once

#include <istream>

#include "file_stream.hpp"
#include "memory_stream.hpp"
#include "tree_binding.hpp"

namespace raylanes::python {

// How many triangles a build leaves out; a report would visit all nodes.
template <class T>
std::size_t with_equal_corners(const VertexRecords<T>& vertices, const IndexView& faces) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < faces.count; ++i) {
    const Index3 face = faces[i];
    const std::array<T, 3> a = vertices[face[0]], b = vertices[face[1]], c = vertices[face[2]];
    count += a == b || b == c || c == a ? 1u : 0u;
  }
  return count;
}

template <class Tree, class Options>
std::unique_ptr<SharedTreeOf<Tree>> built(const py::array& vertices, const py::array& faces, Options options,
                                          const py::object& progress) {
  const auto of_vertices = vertices_of<NumberOf<Tree>>(vertices);
  const IndexView of_faces = indices_of(faces);
  Listener listener(progress, of_faces.count);
  if (listener.progress() != nullptr) options.progress = *listener.progress();
  return listener.without_gil([&] {
    auto made = std::make_unique<SharedTreeOf<Tree>>(Tree(of_vertices, of_faces, options));
    made->left_out = with_equal_corners(of_vertices, of_faces);
    return made;
  });
}

// Whether no other thread of Python is there that could ask a tree while this one keeps the GIL.
inline bool is_only_thread() {
  PyThreadState* const first =
      PyInterpreterState_ThreadHead(PyThreadState_GetInterpreter(PyThreadState_Get()));
  return PyThreadState_Next(first) == nullptr;
}

// Refits in place if nobody else has the state or can come to have it. Otherwise it makes a new state and swaps it in.
template <class Tree>
void refit(SharedTreeOf<Tree>& shared, const py::array& vertices, const py::array& faces, int threads) {
  const auto of_vertices = vertices_of<NumberOf<Tree>>(vertices);
  const IndexView of_faces = indices_of(faces);
  threads = usable_threads(threads);
  if (shared.state.use_count() == 1 && is_only_thread()) {
    static_cast<Tree&>(*shared.state).refit(of_vertices, of_faces, threads);
    return;
  }
  using State = std::shared_ptr<TreeOf<NumberOf<Tree>>>;
  shared.state = query(shared, [&](const Tree& tree) -> State {
    return std::make_shared<Tree>(tree.refitted(of_vertices, of_faces, threads));
  });
}

template <class Shared>
py::object to_bytes(const Shared& shared) {
  std::ostringstream file;
  file.exceptions(std::ios_base::badbit);  // memory that runs out is a std::bad_alloc, not a bad file
  query(shared, [&](const typename Shared::Object& tree) { tree.save(file); });
  const std::string_view bytes = file.view();
  return not_null(PyBytes_FromStringAndSize(bytes.data(), static_cast<py::ssize_t>(bytes.size())));
}

template <class Shared>
std::unique_ptr<Shared> loaded_from(std::streambuf& buffer) {
  std::istream file(&buffer);
  file.exceptions(std::ios_base::badbit);  // Python's errors pass
  try {
    return std::make_unique<Shared>(Shared::Object::load(file));
  } catch (const py::error_already_set&) {
    throw;
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());  // a ValueError
  }
}

// From another object, whose state it shares; from bytes; or from a file object's function that reads. This is one
// constructor: if memory runs out while pybind11 chooses among several, some stays allocated.
template <class Shared>
std::unique_ptr<Shared> made_from(const py::object& from) {
  if (py::isinstance<Shared>(from)) return std::make_unique<Shared>(from.cast<const Shared&>());
  if (PyCallable_Check(from.ptr()) != 0) {
    WithoutGil others_run;
    FileBuffer buffer(from, others_run);
    return loaded_from<Shared>(buffer);
  }
  const BytesOf of_tree(from);
  const WithoutGil others_run;
  MemoryBuffer buffer(of_tree.bytes());
  return loaded_from<Shared>(buffer);
}

// For copyreg: a function that makes the object again, and its arguments; from protocol 5 on with bytes out of band.
template <class Shared>
py::tuple reduced(const py::object& self, int protocol) {
  py::object bytes = to_bytes(self.cast<const Shared&>());
  if (protocol >= 5) bytes = not_null(PyPickleBuffer_FromObject(bytes.ptr()));
  return py::make_tuple(py::type::of(self), py::make_tuple(bytes));
}

}  // namespace raylanes::python

// Enumerators by their names.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <raylanes/paths.hpp>

namespace raylanes::python {

// Throws std::invalid_argument that names all of them.
template <class Enumerator, class Names>
Enumerator named(const char* what, const Names& names, std::string_view name) {
  std::string known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<Enumerator>(i);
    known += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  throw std::invalid_argument(std::string(what) + ": there is no \"" + std::string(name) + "\", but " +
                              known);
}

// Null for the one in use.
inline const Path* path_named(const char* name) {
  return name == nullptr ? nullptr : &find_path(name);
}

}  // namespace raylanes::python

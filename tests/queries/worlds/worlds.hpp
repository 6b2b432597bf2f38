// Meshes of floats and of doubles, each with rays where queries are hardest.
#pragma once

#include "../../doubles/both_numbers.hpp"
#include "../query_trees.hpp"

namespace raylanes::testing {

template <class T>
struct World {
  std::string name;
  MeshOf<T> mesh;
  std::vector<RayOf<T>> rays;
  bool may_flush = true;  // whether results are the same where subnormal numbers count as zeros
};

// A cube from -2 to 2 whose side up z has a dent: a pyramid with its tip at the origin, its edges along diagonals.
Mesh dented_cube();

// Each has at least so many rays. Doubles have the worlds of floats, and others that no floats have.
template <class T>
std::vector<World<T>> worlds(std::size_t rays);

}  // namespace raylanes::testing

// The types of calls of trees by the number of the trees, beside the plain data of <raylanes/numbers.hpp>.
#pragma once

#include <type_traits>

#include <raylanes/doubles.hpp>
#include <raylanes/kdtree.hpp>
#include <raylanes/numbers.hpp>

namespace raylanes::python {

// The base of all trees with these numbers.
template <class T>
using TreeOf = std::conditional_t<std::is_same_v<T, double>, BvhD, TriangleTree>;
// The types of its calls.
template <class T>
using CallTypesOf = raylanes::detail::QueryTypes<TreeOf<T>>;

// The numbers of a kind of trees.
template <class Tree>
using NumberOf = std::conditional_t<std::is_same_v<Tree, BvhD>, double, float>;

}  // namespace raylanes::python

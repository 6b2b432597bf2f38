// How rows of a table find their places: by the id of a test's type, not by the order of a list.
#pragma once

#include <cstddef>
#include <type_traits>

#include <raylanes/types.hpp>

#include "vocabulary.hpp"

namespace raylanes {
namespace {

template <template <Grade> class... Test>
struct TestList {};

// Whether each enumerator that `infos` describes, in order, is the id of exactly one test of the list, which reads
// as many numbers as described.
template <template <Grade> class... Test, class Info, std::size_t count>
constexpr bool is_complete(TestList<Test...>, const Info (&infos)[count]) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto fits = [&]<class T>(T) {
      return T::id == infos[i].test && T::floats == infos[i].floats ? 1 : 0;
    };
    if (static_cast<std::size_t>(infos[i].test) != i || (fits(Test<Grade::fast>()) + ...) != 1) return false;
  }
  return sizeof...(Test) == count;
}

// Whether the fast grade of a test is other code than the reproducible one: where operations can be fused, unless the
// test has one arithmetic; a row may know more.
template <class Make, class Fast>
constexpr bool has_fast_code() {
  if constexpr (requires { Make::template has_fast_code<Fast>; })
    return Make::template has_fast_code<Fast>;
  else
    return has_fma && !requires {
      Fast::has_one_arithmetic;
    };
}

// The rows of a grade that make.operator()<T>() gives for each test. Grades of one code share a row.
template <Grade grade, class Table, template <Grade> class... Test, class Make>
constexpr void put_rows(Table& all, TestList<Test...>, Make make) {
  const auto put = [&]<class Reproducible, class Fast>(Reproducible, Fast) {
    using T = std::conditional_t<grade == Grade::fast && has_fast_code<Make, Fast>(), Fast, Reproducible>;
    all.row[static_cast<std::size_t>(T::id)][static_cast<std::size_t>(grade)] = make.template operator()<T>();
  };
  (put(Test<Grade::reproducible>(), Test<Grade::fast>()), ...);
}

// The table with the rows of both grades.
template <class Table, class List, class Make>
constexpr Table rows_of(List tests, Make make) {
  Table all{};
  put_rows<Grade::reproducible>(all, tests, make);
  put_rows<Grade::fast>(all, tests, make);
  return all;
}

}  // namespace
}  // namespace raylanes

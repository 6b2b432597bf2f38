// How rows of a table find their places: by the id of a test's type, not by the order of a list.
#pragma once

#include <cstddef>

#include <raylanes/types.hpp>

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

// The rows of a grade that make.operator()<T>() gives for each test.
template <Grade grade, class Table, template <Grade> class... Test, class Make>
constexpr void put_rows(Table& all, TestList<Test...>, Make make) {
  const auto put = [&]<class T>(T) {
    all.row[static_cast<std::size_t>(T::id)][static_cast<std::size_t>(grade)] = make.template operator()<T>();
  };
  (put(Test<grade>()), ...);
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

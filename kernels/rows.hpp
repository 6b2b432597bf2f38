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

// The table whose rows make.operator()<T>() gives for each test and grade.
template <class Table, template <Grade> class... Test, class Make>
constexpr Table rows_of(TestList<Test...>, Make make) {
  Table all{};
  const auto put = [&]<class T>(T, Grade grade) {
    all.row[static_cast<std::size_t>(T::id)][static_cast<std::size_t>(grade)] = make.template operator()<T>();
  };
  (put(Test<Grade::reproducible>(), Grade::reproducible), ...);
  (put(Test<Grade::fast>(), Grade::fast), ...);
  return all;
}

}  // namespace
}  // namespace raylanes

// Calls every row of trees in the kernel table of each path that this machine supports, on small inputs. Rows are held
// to the path scalar: byte for byte in the reproducible grade, within margins.hpp in the fast one. It takes a second,
// so that each emulated processor can meet the instructions of all rows; tests/reproducible calls the rows of arrays.
#pragma once

#include <raylanes/paths.hpp>

#include "../support/same_bytes.hpp"
#include "emulated_inputs.hpp"
#include "margins.hpp"

namespace raylanes::testing {

inline void expect_near(float mine, float scalar, double margin, const std::string& name) {
  if (!same_bytes(mine, scalar)) {
    EXPECT_LE(std::abs(double{mine} - double{scalar}), margin) << name;
  }
}

// margins: of each primitive that may be the nearest.
inline void compare_nearest(const Hit& mine, const Hit& scalar, const std::vector<double>& margins,
                            const std::string& name) {
  if (std::ranges::count(margins, doubtful) == 0) {
    EXPECT_EQ(mine.primitive, scalar.primitive) << name;
  }
  if (mine.primitive != scalar.primitive || !mine) return;
  const double margin = margins[mine.primitive];
  expect_near(mine.t, scalar.t, margin, name);
  expect_near(mine.u, scalar.u, margin, name);
  expect_near(mine.v, scalar.v, margin, name);
}

// pair(i) of each; zeros where the bits must be the same.
template <class Pair>
std::vector<double> margins_of(bool same_bits, std::size_t count, Pair pair) {
  std::vector<double> margins(count);
  for (std::size_t i = 0; i < count && !same_bits; ++i) margins[i] = pair(i);
  return margins;
}

using Function = void (*)();

// The functions of a table, which has nothing else, each once and without nulls.
template <class Table>
std::set<Function> functions_of(const Table& table) {
  static_assert(sizeof(Table) % sizeof(Function) == 0);
  std::vector<Function> all(sizeof(Table) / sizeof(Function));
  std::memcpy(all.data(), &table, sizeof(Table));
  std::set<Function> functions(all.begin(), all.end());
  functions.erase(nullptr);
  return functions;
}

// Calls the rows of the given path, and returns their number.
class EveryRow : public ::testing::TestWithParam<const Path*> {
 public:
  const Path& path() const { return *GetParam(); }
  const Path& scalar() const { return paths().front(); }
  // Null on one path is null on all.
  template <class Row>
  bool offers(Row mine, Row of_scalar) {
    EXPECT_EQ(mine == nullptr, of_scalar == nullptr);
    if (mine != nullptr) called_.insert(reinterpret_cast<Function>(mine));
    return mine != nullptr && of_scalar != nullptr;
  }
  // Fails if the table has a function that was not called.
  template <class Table>
  void expect_all_called(const Table& table) const {
    for (const Function function : functions_of(table)) EXPECT_TRUE(called_.contains(function));
  }

 protected:
  void TearDown() override {
    std::printf("%s: %zu rows\n", path().name, called_.size());
    EXPECT_TRUE(!called_.empty() || IsSkipped());
  }

 private:
  std::set<Function> called_;
};

}  // namespace raylanes::testing

// Calls every row of trees in the kernel table of each path that this machine supports, on small inputs. Results are
// held to recorded hashes. It takes a second, so that each emulated processor can meet the instructions of all rows;
// tests/reproducible calls the rows of arrays.
#pragma once

#include <raylanes/paths.hpp>

#include "../../bench/support/reproducible/hash.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../support/supported_paths.hpp"
#include "emulated_inputs.hpp"

namespace raylanes::testing {

using bench::Hash;
using Function = void (*)();

// The functions of a table, which has nothing else; null where the path does not offer one.
template <class Table>
std::vector<Function> functions_of(const Table& table) {
  static_assert(sizeof(Table) % sizeof(Function) == 0);
  std::vector<Function> all(sizeof(Table) / sizeof(Function));
  std::memcpy(all.data(), &table, sizeof(Table));
  return all;
}

// Calls the rows of the given path, and prints their number.
class EveryRow : public ::testing::TestWithParam<const Path*> {
 public:
  const KernelTable& kernels() const { return kernels_of(*GetParam()); }
  static const KernelTable& scalar() { return kernels_of(paths().front()); }
  // Whether the path has the row, which is then called.
  template <class Row>
  bool offers(Row row) {
    if (row != nullptr) called_.insert(reinterpret_cast<Function>(row));
    return row != nullptr;
  }
  // Fails unless all functions of the table were called. Null on one path is null on scalar, too.
  template <class Table>
  void expect_all_called(const Table& table, const Table& of_scalar) const {
    const std::vector<Function> mine = functions_of(table), others = functions_of(of_scalar);
    for (std::size_t i = 0; i < mine.size(); ++i) {
      EXPECT_EQ(mine[i] == nullptr, others[i] == nullptr) << "row " << i;
      EXPECT_TRUE(mine[i] == nullptr || called_.contains(mine[i])) << "row " << i;
    }
  }

 protected:
  void TearDown() override {
    std::printf("%s: %zu rows\n", GetParam()->name, called_.size());
    EXPECT_TRUE(!called_.empty() || IsSkipped());
  }

 private:
  std::set<Function> called_;
};

// Ways to ask the same share a hash. A change that is meant to move bits writes the hash that its test prints.
inline constexpr std::pair<std::string_view, std::uint64_t> recorded_rows[] = {
    {"doubles behind", 0x19ea20f2b0bcc409},
    {"doubles boundaries", 0xcb7de0367cefcc6f},
    {"doubles chosen", 0xefb5e0dab5a72974},
    {"doubles kept", 0x374ab1bfe5d6846a},
    {"doubles lists", 0xf5ab87911fa38e0d},
    {"doubles lists that stop", 0x8830be61d6a69c6d},
    {"doubles nearest", 0xe5d2479ba7f49d3d},
    {"doubles points", 0xef6720476a339f98},
    {"doubles points, some", 0x5a515b1ea1d99766},
    {"floats behind", 0x1b06b5c92b314f47},
    {"floats boundaries", 0x9b37d2a8960b2427},
    {"floats chosen", 0x21758c2fd3d42140},
    {"floats counts", 0xa23221d806cb2f17},
    {"floats kept", 0x4d7480dfd6e42889},
    {"floats lists", 0x9f0ffc6b207189bf},
    {"floats lists along axes", 0xce74c34666b28a92},
    {"floats lists that stop", 0xd06ca14801c827f9},
    {"floats nearest, exact", 0x13f408108816c6d4},
    {"floats nearest, moller_trumbore", 0x9c1e2cee0e6d0fc0},
    {"floats nearest, watertight", 0x0486360f64bbe8f2},
    {"floats points", 0x19644852284f6076},
    {"floats points, some", 0xa3ff0baec5d14875},
    {"instances", 0x411117580493a2cb},
    {"mapped rays", 0x8c99e8a65a594aa5},
};

inline void expect_recorded(const std::string& name, const Hash& hash, const std::string& way) {
  const auto* const row =
      std::ranges::find(recorded_rows, name, &std::pair<std::string_view, std::uint64_t>::first);
  if (row != std::end(recorded_rows) && row->second == hash.value()) return;
  ADD_FAILURE() << way << ": other bits than recorded, or none recorded: " << name;
  std::printf("    {\"%s\", 0x%016llx},\n", name.c_str(), static_cast<unsigned long long>(hash.value()));
}

}  // namespace raylanes::testing

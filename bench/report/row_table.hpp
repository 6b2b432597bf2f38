// Rows for people and for programs: each value is named once, with its column and its key.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../support/rulers/measure.hpp"
#include "output.hpp"

namespace raylanes::bench {

// All rows add the same columns in the same order; a value without a column is for programs alone, one without a key
// for people.
class RowTable {
 public:
  // Begins a row with some keys that have no column; if it is not shown, programs alone read all of it.
  void begin(Json keys = Json::object(), bool is_shown = true);

  // Whether the row has the values that follow: if not, their cells are empty and their keys are left out.
  RowTable& only_if(bool has);

  RowTable& add(const std::string& column, const std::string& key, const Json& value,
                const std::string& cell);
  RowTable& add(const std::string& column, const std::string& key, const std::string& text);
  RowTable& add(const std::string& column, const std::string& key, double number, int digits = 3);
  RowTable& add(const std::string& column, const std::string& key, std::size_t count);
  RowTable& add(const std::string& column, const std::string& key, int count);
  // People read milliseconds, programs seconds.
  RowTable& add_seconds(const std::string& column, const std::string& key, double seconds);
  // Half of the spread, in percent, in the column "± %".
  RowTable& add_spread(double spread);
  // The median, and the quartiles in a column "half within" and under KEY_quartiles. Nothing: empty cells, no keys.
  RowTable& add_ratio(const std::string& column, const std::string& key,
                      const std::optional<Quartiles>& ratio);
  // The same without the quartiles' column.
  RowTable& add_median(const std::string& column, const std::string& key,
                       const std::optional<Quartiles>& ratio);
  // What only programs read.
  Json& keys() { return rows_.back(); }

  // Prints aligned columns, but those whose cells are all empty, and nothing without rows.
  void print() const;
  const Json& rows() const { return rows_; }

 private:
  std::vector<std::vector<std::string>> table_{{}};  // the columns first
  std::vector<bool> is_shown_{true};
  bool has_ = true;
  Json rows_ = Json::array();
};

// The median.
std::string ratio_cell(const std::optional<Quartiles>& ratio);
// "0.69…0.73": half of the rounds.
std::string spread_cell(const std::optional<Quartiles>& ratio);

// Adds rows to others.
void append(Json& rows, const Json& more);

}  // namespace raylanes::bench

// Rows for people and for programs: each value is named once, with its column and its key.
#pragma once

#include "../support/rulers/measure.hpp"
#include "output.hpp"

namespace raylanes::bench {

// All rows add the same columns in the same order: the more important ones first. A value without a column has no
// place in the default table, a value without a key is not in JSON.
class RowTable {
 public:
  // Begins a row with some keys that have no column. A row that is not shown is in CSV and JSON only.
  void begin(const Json& keys = Json::object(), bool is_shown = true);

  // Whether the row has the values that follow. If not, their cells are empty and their keys are left out.
  RowTable& only_if(bool has);

  RowTable& add(const std::string& column, const std::string& key, const Json& value,
                const std::string& cell);
  RowTable& add(const std::string& column, const std::string& key, const std::string& text);
  RowTable& add(const std::string& column, const std::string& key, double number, int digits = 3);
  RowTable& add(const std::string& column, const std::string& key, std::size_t count);
  RowTable& add(const std::string& column, const std::string& key, int count);
  // Tables have milliseconds, JSON has seconds.
  RowTable& add_seconds(const std::string& column, const std::string& key, double seconds);
  // Half of the spread, in percent, in the column "± %".
  RowTable& add_spread(double spread);
  // The median, and the quartiles in a column "half within" under KEY_quartiles. Nothing: empty cells, no keys.
  RowTable& add_ratio(const std::string& column, const std::string& key,
                      const std::optional<Quartiles>& ratio);
  // The median with its column, the quartiles in JSON only.
  RowTable& add_median(const std::string& column, const std::string& key,
                       const std::optional<Quartiles>& ratio);
  // The keys of the current row. Values added here have no column.
  Json& keys() { return rows_.back(); }

  // Names that --columns takes: keys, and unless keys_only the titles of columns without a key, in lower case with
  // underscores.
  std::vector<std::string> names(bool keys_only) const;
  // The rows as lines of cells, the titles first; empty without rows. Shows the columns that `columns` names, in its
  // order, or all columns if it is {"all"}. If it names none of this table, shows the first columns that have values,
  // as many as fit max_table_width. The scene is a column only if shows_scene: a line above the table may name it.
  using Cells = std::vector<std::vector<std::string>>;
  Cells cells(const std::vector<std::string>& columns, bool shows_scene, std::size_t first_row = 0) const;
  // Prints the rows that were not printed before, aligned. The arguments mean the same as in cells().
  void print(const std::vector<std::string>& columns, bool shows_scene = false);
  const Json& rows() const { return rows_; }

 private:
  struct Column {
    std::string title, name;
    bool has_key;
  };
  std::vector<std::size_t> chosen(const std::vector<std::string>& columns, bool shows_scene,
                                  std::size_t first_row) const;
  bool has_values(std::size_t column, std::size_t first_row) const;

  std::vector<Column> columns_;
  Cells cells_;  // a line a row, of all columns
  std::vector<bool> is_shown_;
  bool has_ = true;
  std::size_t printed_ = 0;
  Json rows_ = Json::array();
};

// The median.
std::string ratio_cell(const std::optional<Quartiles>& ratio);
// "0.69…0.73": half of the rounds.
std::string spread_cell(const std::optional<Quartiles>& ratio);

// Adds rows to others.
void append(Json& rows, const Json& more);

}  // namespace raylanes::bench

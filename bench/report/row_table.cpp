#include "row_table.hpp"

#include <algorithm>
#include <iostream>

namespace raylanes::bench {
namespace {

bool looks_numeric(const std::string& cell) {
  return !cell.empty() && (cell[0] == '-' || (cell[0] >= '0' && cell[0] <= '9'));
}

// Bytes that begin a character, so that a column of "×" lines up.
std::size_t width_of(const std::string& cell) {
  return static_cast<std::size_t>(std::count_if(
      cell.begin(), cell.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

// With aligned columns, the first row as a header, numbers to the right; without columns whose cells are empty.
void print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  std::vector<bool> has_cells;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size())), has_cells.resize(widths.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], width_of(row[i]));
      if (&row != &rows[0] && !row[i].empty()) has_cells[i] = true;
    }
  }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!has_cells[i]) continue;
      const std::string space(widths[i] - width_of(row[i]), ' ');
      line += (line.empty() ? "" : "  ") + (looks_numeric(row[i]) ? space + row[i] : row[i] + space);
    }
    std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  }
}

}  // namespace

void RowTable::begin(Json keys, bool is_shown) {
  rows_.push_back(std::move(keys));
  table_.emplace_back(), is_shown_.push_back(is_shown), has_ = true;
}

RowTable& RowTable::only_if(bool has) {
  has_ = has;
  return *this;
}

RowTable& RowTable::add(const std::string& column, const std::string& key, const Json& value,
                        const std::string& cell) {
  if (!key.empty() && has_) rows_.back()[key] = value;
  if (column.empty()) return *this;
  if (table_.size() == 2) table_[0].push_back(column);
  table_.back().push_back(has_ ? cell : "");
  return *this;
}
RowTable& RowTable::add(const std::string& column, const std::string& key, const std::string& text) {
  return add(column, key, text, text);
}
RowTable& RowTable::add(const std::string& column, const std::string& key, double number, int digits) {
  return add(column, key, number, significant(number, digits));
}
RowTable& RowTable::add(const std::string& column, const std::string& key, std::size_t count) {
  return add(column, key, count, std::to_string(count));
}
RowTable& RowTable::add(const std::string& column, const std::string& key, int count) {
  return add(column, key, count, std::to_string(count));
}
RowTable& RowTable::add_seconds(const std::string& column, const std::string& key, double seconds) {
  return add(column, key, seconds, milliseconds(seconds));
}
RowTable& RowTable::add_spread(double spread) {
  return add("± %", "spread", spread, significant(50.0 * spread, 2));
}
RowTable& RowTable::add_ratio(const std::string& column, const std::string& key,
                              const std::optional<Quartiles>& ratio) {
  return add_median(column, key, ratio).add("half within", "", {}, spread_cell(ratio));
}
RowTable& RowTable::add_median(const std::string& column, const std::string& key,
                               const std::optional<Quartiles>& ratio) {
  if (ratio) keys()[key] = ratio->median, keys()[key + "_quartiles"] = {ratio->first, ratio->third};
  return add(column, "", {}, ratio_cell(ratio));
}

void RowTable::print() const {
  std::vector<std::vector<std::string>> shown;
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (is_shown_[i]) shown.push_back(table_[i]);
  if (shown.size() > 1) print_table(shown);
}

std::string ratio_cell(const std::optional<Quartiles>& ratio) {
  return ratio ? significant(ratio->median, 3) : "";
}
std::string spread_cell(const std::optional<Quartiles>& ratio) {
  return ratio ? significant(ratio->first, 2) + "…" + significant(ratio->third, 2) : "";
}

void append(Json& rows, const Json& more) {
  for (const Json& row : more) rows.push_back(row);
}

}  // namespace raylanes::bench

#include "row_table.hpp"

#include <cctype>
#include <iostream>

#include "../support/readers/printable.hpp"
#include "table_format.hpp"

namespace raylanes::bench {
namespace {

// "primary Mrays/s" becomes "primary_mrays_s".
std::string name_of_title(const std::string& title) {
  std::string name;
  for (const char c : title)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!name.empty() && name.back() != '_')
      name += '_';
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>()
                           : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void RowTable::begin(const Json& keys, bool is_shown) {
  rows_.push_back(Json::object());
  cells_.emplace_back(), is_shown_.push_back(is_shown), has_ = true;
  for (const auto& [key, value] : keys.items()) add(key == "scene" ? key : "", key, value, text_of(value));
}

RowTable& RowTable::only_if(bool has) {
  has_ = has;
  return *this;
}

RowTable& RowTable::add(const std::string& column, const std::string& key, const Json& value,
                        const std::string& cell) {
  if (!key.empty() && has_) rows_.back()[key] = value;
  if (cells_.size() == 1)
    columns_.push_back({column, key.empty() ? name_of_title(column) : key, !key.empty()});
  cells_.back().push_back(has_ ? printable(cell, max_table_width) : "");
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
  add_median(column, key, ratio);
  columns_.back().title = "half within";
  return *this;
}
RowTable& RowTable::add_median(const std::string& column, const std::string& key,
                               const std::optional<Quartiles>& ratio) {
  const bool had = std::exchange(has_, has_ && ratio.has_value());
  const Quartiles given = ratio.value_or(Quartiles{});
  add(column, key, given.median, ratio_cell(ratio));
  add("", key + "_quartiles", {given.first, given.third}, spread_cell(ratio));
  return only_if(had);
}

std::vector<std::string> RowTable::names(bool keys_only) const {
  std::vector<std::string> names;
  const auto take = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const Column& column : columns_)
    if (column.has_key || !keys_only) take(column.name);
  for (const Json& row : rows_)
    for (const auto& [key, value] : row.items()) take(key);
  return names;
}

bool RowTable::has_values(std::size_t column, std::size_t first_row) const {
  for (std::size_t row = first_row; row < cells_.size(); ++row)
    if (is_shown_[row] && !cells_[row][column].empty()) return true;
  return false;
}

std::vector<std::size_t> RowTable::chosen(const std::vector<std::string>& columns, bool shows_scene,
                                          std::size_t first_row) const {
  std::vector<std::size_t> named;
  for (const std::string& name : columns)
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i].name == name) named.push_back(i);
  if (!named.empty()) return named;
  const bool all = columns == std::vector<std::string>{"all"};
  std::size_t used = 0;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].title.empty() || !has_values(i, first_row)) continue;
    if (columns_[i].name == "scene" && !shows_scene) continue;
    std::size_t width = width_of(columns_[i].title);
    for (std::size_t row = first_row; row < cells_.size(); ++row)
      if (is_shown_[row]) width = std::max(width, width_of(cells_[row][i]));
    used += width + (named.empty() ? 0 : column_gap.size());
    if (used > max_table_width && !all && !named.empty()) break;
    named.push_back(i);
  }
  return named;
}

RowTable::Cells RowTable::cells(const std::vector<std::string>& columns, bool shows_scene,
                                std::size_t first_row) const {
  const std::vector<std::size_t> shown = chosen(columns, shows_scene, first_row);
  Cells lines(1);
  for (const std::size_t i : shown)
    lines[0].push_back(columns_[i].title.empty() ? columns_[i].name : columns_[i].title);
  for (std::size_t row = first_row; row < cells_.size(); ++row) {
    if (!is_shown_[row]) continue;
    lines.emplace_back();
    for (const std::size_t i : shown) lines.back().push_back(cells_[row][i]);
  }
  return lines.size() > 1 ? lines : Cells{};
}

void RowTable::print(const std::vector<std::string>& columns, bool shows_scene) {
  std::cout << aligned(cells(columns, shows_scene, std::exchange(printed_, cells_.size())));
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

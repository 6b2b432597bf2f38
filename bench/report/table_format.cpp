#include "table_format.hpp"

#include "../support/readers/printable.hpp"

namespace raylanes::bench {
namespace {

constexpr std::size_t max_cell = 4096;

bool looks_numeric(const std::string& cell) {
  return !cell.empty() && (cell[0] == '-' || (cell[0] >= '0' && cell[0] <= '9'));
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

// Adds the parts of `value` to `cells`, each by its name.
void flatten(const std::string& name, const Json& value, Json& cells) {
  const auto is_structured = [](const Json& part) { return part.is_structured(); };
  if (!value.is_object() && std::none_of(value.begin(), value.end(), is_structured)) {
    cells[name] = value;
    return;
  }
  for (const auto& [key, part] : value.items()) flatten(name.empty() ? key : name + '/' + key, part, cells);
}

std::string cell_of(const Json& value) {
  if (value.is_null()) return "";
  return quoted(value.is_string() ? printable(value.get_ref<const std::string&>(), max_cell)
                                  : value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

std::size_t width_of(std::string_view text) {
  // Counts the bytes that begin a character.
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths;
  for (const auto& line : lines) {
    widths.resize(line.size());
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], width_of(line[i]));
  }
  std::string text;
  for (const auto& line : lines) {
    std::string shown;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string space(widths[i] - width_of(line[i]), ' ');
      shown += (i == 0 ? "" : std::string(column_gap)) +
               (looks_numeric(line[i]) ? space + line[i] : line[i] + space);
    }
    text += shown.substr(0, shown.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string markdown(const std::vector<std::vector<std::string>>& lines) {
  std::string text;
  for (const auto& line : lines) {
    text += '|';
    for (const std::string& cell : line) {
      text += ' ';
      for (const char c : cell) text += c == '|' ? "\\|" : std::string(1, c);
      text += " |";
    }
    text += '\n';
    if (&line != &lines.front()) continue;
    text += '|';
    for (std::size_t i = 0; i < line.size(); ++i) text += "---|";
    text += '\n';
  }
  return text;
}

std::string csv(const Json& rows, const std::vector<std::string>& columns) {
  const bool all = columns.empty() || columns == std::vector<std::string>{"all"};
  std::vector<Json> lines;
  Json names = Json::object();
  for (const Json& row : rows) {
    Json chosen = all ? row : Json::object(), cells = Json::object();
    for (const std::string& column : columns)
      if (!all && row.contains(column)) chosen[column] = row[column];
    flatten("", chosen, cells);
    names.update(cells);
    lines.push_back(cells);
  }
  std::string text;
  for (const auto& [name, value] : names.items()) text += (text.empty() ? "" : ",") + quoted(name);
  for (const Json& line : lines) {
    text += '\n';
    bool is_first = true;
    for (const auto& [name, value] : names.items()) {
      text += (is_first ? "" : ",") + (line.contains(name) ? cell_of(line[name]) : "");
      is_first = false;
    }
  }
  return text + '\n';
}

}  // namespace raylanes::bench

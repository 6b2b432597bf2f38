#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <raylanes/root_methods.hpp>

#include "../report/output.hpp"
#include "../support/readers/printable.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

using Table = std::vector<std::vector<std::string>>;

std::string text_of(const Json& row, const char* key) {
  return printable(row.at(key).get<std::string>());
}

void print_paths(const Json& rows) {
  std::string here, active;
  for (const Json& row : rows) {
    if (row.at("supported").get<bool>()) here += (here.empty() ? "" : " ") + text_of(row, "path");
    if (row.at("active").get<bool>()) active = text_of(row, "path");
  }
  std::cout << "paths on this machine: " << here << "; active is " << active << '\n';
}

// One row an accuracy, one column a path: the fastest method that keeps it.
void print_roots(const Json& rows) {
  Table table{{"square roots"}};
  for (const AccuracyInfo& info : accuracies) table.push_back({std::string(info.name)});
  for (const Json& row : rows) {
    if (row.at("function") != "sqrt" || row.at("serves").empty()) continue;
    const std::string path = text_of(row, "path");
    const auto found = std::find(table[0].begin(), table[0].end(), path);
    const auto column = static_cast<std::size_t>(found - table[0].begin());
    if (found == table[0].end())
      for (auto& cells : table) cells.push_back(&cells == &table[0] ? path : "");
    for (auto& cells : table) {
      if (std::find(row.at("serves").begin(), row.at("serves").end(), cells[0]) == row.at("serves").end())
        continue;
      cells[column] = significant(1e9 / row.at("elements_per_second").get<double>(), 3) + " " +
                      significant(row.at("ratio_to_hardware").get<double>(), 2) + "×";
    }
  }
  std::cout
      << "\nns a value in the first-level cache, and how many times as fast as the path's hardware root\n";
  print_table(table);
}

std::string ratio_of(const Json& row) {
  if (!row.contains("ratio")) return "";
  const Json& quartiles = row.at("ratio_quartiles");
  return significant(row.at("ratio").get<double>(), 2) + " (" +
         significant(quartiles.at(0).get<double>(), 2) + "…" + significant(quartiles.at(1).get<double>(), 2) +
         ")";
}

// Of each scene and ray set our fastest path and mode.
void print_traces(const Json& rows) {
  std::vector<const Json*> best;
  std::string note;
  for (const Json& row : rows) {
    if (row.contains("embree_note")) note = printable(row.at("embree_note").get<std::string>(), 400);
    if (row.at("contender") != "raylanes") continue;
    const auto same = std::find_if(best.begin(), best.end(), [&](const Json* other) {
      return other->at("scene") == row.at("scene") && other->at("rays") == row.at("rays");
    });
    if (same == best.end())
      best.push_back(&row);
    else if (row.at("mrays_per_second") > (*same)->at("mrays_per_second"))
      *same = &row;
  }
  Table table{
      {"scene", "rays", "path", "mode", "Mrays/s", "× Embree (half of the rounds)", "Embree's best mode"}};
  for (const Json* row : best)
    table.push_back({text_of(*row, "scene"), text_of(*row, "rays"), text_of(*row, "path"),
                     text_of(*row, "mode"), significant(row->at("mrays_per_second").get<double>(), 3),
                     ratio_of(*row), row->contains("ratio_to") ? text_of(*row, "ratio_to") : ""});
  std::cout
      << "\nour fastest path and mode on one thread, beside Embree's best on the same instruction set\n";
  print_table(table);
  if (!note.empty()) std::cout << note << '\n';
}

void run(const std::filesystem::path& folder) {
  std::cout << machine_line() << '\n';
  print_paths(read_rows(folder / "isa.json"));
  print_roots(read_rows(folder / "sqrt.json"));
  print_traces(read_rows(folder / "trace.json"));
}

}  // namespace

void add_summary_command(CLI::App& tool) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* command =
      tool.add_subcommand("summary", "one screen of what isa, sqrt and trace wrote as JSON into a folder");
  command->add_option("DIR", *folder, "with isa.json, sqrt.json and trace.json")->required();
  command->callback([folder] { run(*folder); });
}

}  // namespace raylanes::bench

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "sqrt_rows.hpp"

namespace raylanes::bench {
namespace {

std::string terminal_for(const std::string& file) {
  if (file.ends_with(".svg")) return "svg size 1200,800 background 'white'";
  if (file.ends_with(".png")) return "pngcairo size 1200,800";
  throw std::invalid_argument("--plot " + file + ": allowed are names that end in .png or .svg");
}

// A string for gnuplot between single quotes, which it takes literally.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

// "ns ULP name" of the square roots of one path; `front` chooses between the front and the rest.
std::string points(const std::vector<RootResult>& results, const Path* path, bool front) {
  std::ostringstream out;
  for (const RootResult& r : results)
    if (r.row.function == RootFunction::sqrt && r.row.path == path && r.pareto == front)
      out << r.nanoseconds() << ' ' << r.accuracy.max_ulp << " \"" << r.row.promise().name << "\"\n";
  return out.str();
}

std::string script(const std::vector<RootResult>& results, const std::string& file) {
  std::vector<const Path*> paths;
  for (const RootResult& r : results)
    if (std::find(paths.begin(), paths.end(), r.row.path) == paths.end()) paths.push_back(r.row.path);
  std::ostringstream out, plots;
  out << "set terminal " << terminal_for(file) << "\nset output " << quoted(file)
      << "\nset logscale xy\nset grid\nset key outside right noenhanced\nset xlabel 'ns a value'\n"
         "set ylabel 'largest error in ULP'\nset title "
      << quoted("Square roots of floats: filled is the front, " + machine_line()) << " noenhanced\n";
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string number = std::to_string(i), color = " lc " + std::to_string(i + 1);
    for (const bool front : {true, false}) {
      const std::string data = points(results, paths[i], front);
      if (data.empty()) continue;
      const std::string block = (front ? "$front" : "$rest") + number;
      out << block << " << EOD\n" << data << "EOD\n";
      plots << (plots.tellp() == 0 ? "plot " : ", ") << block << " using 1:2 with points pt "
            << (front ? 7 : 6) << color << (front ? " title " + quoted(paths[i]->name) : " notitle");
      if (front)
        plots << ", " << block << " using 1:2:3 with labels noenhanced left offset 0.6,0.3 font ',8' tc lt "
              << i + 1 << " notitle";
    }
  }
  return out.str() + plots.str() + "\n";
}

}  // namespace

void plot_roots(const std::vector<RootResult>& results, const std::string& file) {
  const std::string text = script(results, file);
  std::FILE* const pipe = popen("gnuplot", "w");
  if (pipe == nullptr) throw std::runtime_error("--plot " + file + ": cannot start a process for gnuplot");
  const bool written = std::fwrite(text.data(), 1, text.size(), pipe) == text.size();
  if (pclose(pipe) != 0 || !written)
    throw std::runtime_error("--plot " + file + ": gnuplot is missing (Debian: gnuplot-nox) or failed");
}

}  // namespace raylanes::bench

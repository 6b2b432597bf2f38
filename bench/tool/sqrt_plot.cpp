#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "../report/exits.hpp"
#include "../survey/roots/root_rows.hpp"

namespace raylanes::bench {
namespace {

// A string for gnuplot between single quotes, which it takes literally.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

// A panel per path, all with the same axes. The names of the methods on the front stand below the points,
// where no point can be: nothing is faster than the front.
constexpr int panel_width = 640, panel_height = 430, title_height = 60;
constexpr double label_row = 0.052;  // height of a line of text, in heights of a panel's graph

struct Panel {
  const Path* path;
  std::vector<const RootResult*> front, rest;  // the front from the largest error to the smallest

  // Those with names that begin so.
  std::vector<const RootResult*> named(std::string_view prefix) const {
    std::vector<const RootResult*> list;
    for (const auto* part : {&front, &rest})
      for (const RootResult* r : *part) {
        if (r->row.promise().name.starts_with(prefix)) list.push_back(r);
      }
    return list;
  }
};

std::vector<Panel> panels_of(const std::vector<RootResult>& results) {
  std::vector<Panel> panels;
  for (const RootResult& r : results) {
    if (r.row.function != RootFunction::sqrt) continue;
    auto panel =
        std::find_if(panels.begin(), panels.end(), [&](const Panel& p) { return p.path == r.row.path; });
    if (panel == panels.end()) panel = panels.insert(panel, {r.row.path, {}, {}});
    (r.pareto ? panel->front : panel->rest).push_back(&r);
  }
  for (Panel& panel : panels)
    std::sort(panel.front.begin(), panel.front.end(), [](const RootResult* a, const RootResult* b) {
      return a->accuracy.max_ulp > b->accuracy.max_ulp ||
             (a->accuracy.max_ulp == b->accuracy.max_ulp && a->nanoseconds() < b->nanoseconds());
    });
  return panels;
}

// The axis of time, logarithmic: all points, and below them room for the names of the longest front.
struct TimeAxis {
  double least, greatest;

  explicit TimeAxis(const std::vector<Panel>& panels) : least(1e300), greatest(0) {
    std::size_t rows = 0;
    for (const Panel& panel : panels) {
      rows = std::max(rows, panel.front.size());
      for (const auto* list : {&panel.front, &panel.rest})
        for (const RootResult* r : *list) {
          least = std::min(least, r->nanoseconds());
          greatest = std::max(greatest, r->nanoseconds());
        }
    }
    greatest *= 1.4;
    const double room = std::min(0.7, label_row * static_cast<double>(rows + 2));
    least *= std::pow(least / greatest, room / (1 - room));
  }
  // As a share of the graph's height.
  double height_of(double nanoseconds) const {
    return std::log(nanoseconds / least) / std::log(greatest / least);
  }
};

std::string terminal_for(const std::string& file, std::size_t panels) {
  const std::size_t columns = std::min<std::size_t>(panels, 2), rows = (panels + 1) / 2;
  const std::string size = " size " + std::to_string(columns * panel_width) + ',' +
                           std::to_string(rows * panel_height + title_height);
  const std::string layout = "\nset multiplot layout " + std::to_string(rows) + ',' + std::to_string(columns);
  const std::string output = "\nset output " + quoted(file) + layout;
  if (file.ends_with(".svg")) return "svg font 'Helvetica,12' background 'white'" + size + output;
  if (file.ends_with(".png")) return "pngcairo font 'Sans,10'" + size + output;
  throw std::invalid_argument("--plot " + file + ": allowed are names that end in .png or .svg");
}

// "ULP ns" per line, as a block of data with a name.
std::string data_block(const std::string& name, const std::vector<const RootResult*>& list) {
  std::ostringstream out;
  out << '$' << name << " << EOD\n";
  for (const RootResult* r : list) out << r->accuracy.max_ulp << ' ' << r->nanoseconds() << '\n';
  return out.str() + "EOD\n";
}

// Each name has a line of its own and begins at its point's error, the largest error on top: then no line
// that leads down from a point crosses a name.
std::string labels(const Panel& panel, const TimeAxis& axis) {
  std::ostringstream out;
  double height = 1.0;
  for (const RootResult* r : panel.front) height = std::min(height, axis.height_of(r->nanoseconds()));
  for (const RootResult* r : panel.front) {
    height -= label_row;
    const double ulp = r->accuracy.max_ulp;
    out << "set arrow from first " << ulp << ", first " << r->nanoseconds() << " to first " << ulp
        << ", graph " << height << " nohead lc rgb '#999999' lw 0.7\nset label "
        << quoted(std::string(r->row.promise().name)) << " at first " << ulp << ", graph " << height
        << " left offset character 0.3,0 noenhanced\n";
  }
  return out.str();
}

std::string plot_of(const Panel& panel, const TimeAxis& axis) {
  const auto hardware = panel.named("hardware"), classic = panel.named("classic_");
  std::ostringstream out;
  out << "unset arrow\nunset label\nset title " << quoted(panel.path->name) << " noenhanced\n"
      << labels(panel, axis) << data_block("front", panel.front) << data_block("rest", panel.rest)
      << data_block("hardware", hardware) << data_block("classic", classic);
  // Steps: the time of a bound is that of the fastest method that keeps it.
  out << "plot $front with fsteps lw 1.5 lc rgb '#88aadd' notitle, "
         "$front with points pt 7 ps 1 lc rgb '#1144aa' title 'on the front'";
  if (!panel.rest.empty()) out << ", $rest with points pt 6 ps 0.8 lc rgb '#888888' title 'other methods'";
  if (!classic.empty())
    out << ", $classic with points pt 8 ps 1.2 lc rgb '#117733' title 'bit trick + 0 … 3 Newton steps'";
  if (!hardware.empty())
    out << ", $hardware with points pt 4 ps 1.8 lc rgb '#cc2200' title 'hardware instruction'";
  return out.str() + "\n";
}

std::string script(const std::vector<RootResult>& results, const std::string& file) {
  const std::vector<Panel> panels = panels_of(results);
  const TimeAxis axis(panels);
  std::ostringstream out;
  out << "set terminal " << terminal_for(file, panels.size()) << " title "
      << quoted("Square roots of floats: largest error against time in the first-level cache") << ".\"\\n\"."
      << quoted(machine_line() + "; " + inputs_judged(results))
      << " noenhanced\nset logscale xy\nset grid lc rgb '#dddddd'\nset key top right\n"
         "set xlabel 'largest error [ULP]'\nset ylabel 'time [ns a value]'\n"
         "set format x '10^{%T}'\nset ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)\nset xrange "
         "[0.3:3e7]\nset yrange ["
      << axis.least << ':' << axis.greatest << "]\n";
  for (const Panel& panel : panels) out << plot_of(panel, axis);
  return out.str() + "unset multiplot\n";
}

}  // namespace

void plot_roots(const std::vector<RootResult>& results, const std::string& file) {
  const std::string text = script(results, file);
  // gnuplot says in several lines what it cannot open, and goes on to standard output.
  if (!std::ofstream(file, std::ios::app)) throw OutputError("--plot " + file + ": cannot be written");
  std::FILE* const pipe = popen("gnuplot 2>/dev/null", "w");
  if (pipe == nullptr) throw OutputError("--plot " + file + ": cannot start a process for gnuplot");
  const bool written = std::fwrite(text.data(), 1, text.size(), pipe) == text.size();
  if (pclose(pipe) != 0 || !written)
    throw OutputError("--plot " + file + ": gnuplot is missing (Debian: gnuplot-nox) or failed");
}

}  // namespace raylanes::bench

// Means over several scenes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "../contenders/trace/trace_scene.hpp"

namespace raylanes::bench {

// Ratios to Embree, by what names a row of ours, over the scenes.
class TraceMeans {
 public:
  void add(const std::vector<TraceRow>& rows);
  // Prints geometric means and the smallest of the ratios, in the columns that are shown by name; nothing unless two
  // scenes have ratios.
  void print(const std::vector<std::string>& shown) const;

 private:
  struct Ratios {
    std::vector<double> to_best, to_single, to_robust;
  };
  // By the cells that name the row.
  std::map<std::vector<std::string>, Ratios> ratios_;
};

}  // namespace raylanes::bench

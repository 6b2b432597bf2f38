// What several scenes say together.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "../contenders/trace/trace_scene.hpp"

namespace raylanes::bench {

// Of each kind of row of ours that was compared with Embree, over the scenes.
class TraceMeans {
 public:
  void add(const std::vector<TraceRow>& rows);
  // Geometric means and the least of the ratios; nothing if there are none or of one scene alone.
  void print() const;

 private:
  struct Ratios {
    std::vector<double> to_best, to_single, to_robust;
  };
  // By the cells that name the row: of equal ray sets in a row.
  std::map<std::vector<std::string>, Ratios> ratios_;
};

}  // namespace raylanes::bench

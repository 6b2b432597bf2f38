// Rows of raylanes_bench for what is hardest: cliff/CASE/… Each is named in the table of benchmark_cliffs.cpp.
#pragma once

namespace raylanes::bench {

// On the active ISA path, on one thread.
void register_cliff_rows();

}  // namespace raylanes::bench

// Compiled once for all units of the library but kernels: a quarter of their time went to these. No file counts on it,
// and builds with sanitizers are without.
#include <raylanes/raylanes.hpp>

#include "standard.hpp"

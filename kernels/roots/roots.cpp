// The roots of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "root_table.hpp"

namespace raylanes {
namespace detail::RAYLANES_PATH_NAME {

extern constinit const SquareRootKernels roots;
constinit const SquareRootKernels roots = square_root_kernels();

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes

// Compiled once per path with the flags and the back end of its kernels.
#include "root_contenders.hpp"

#include "../../../kernels/roots/array_loop.hpp"
#include "contender_methods.hpp"

namespace raylanes {
namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_CONTENDERS_OF(path) RAYLANES_JOIN(path, _root_contenders)

extern constinit const bench::RootContenders RAYLANES_CONTENDERS_OF(RAYLANES_PATH_NAME);
constinit const bench::RootContenders RAYLANES_CONTENDERS_OF(RAYLANES_PATH_NAME) = {
    {array_of<Weighted<1>, float, Mix{1, 0, 8}>, array_of<Weighted<2>, float, Mix{1, 0, 8}>,
     array_of<Halley, float, Mix{4, 0, 2}>,
     array_of<OtherPolynomial<linear_coefficients>, float, Mix{3, 0, 2}>,
     array_of<OtherPolynomial<cubic_coefficients>, float, Mix{4, 0, 2}>,
     array_of<PolynomialResidual, float, Mix{3, 0, 2}>, array_of<EstimateNewton, float, Mix{2, 0, 4}>},
    {array_of<Quake<1>, float, Mix{3, 0, 2}>}};

}  // namespace detail
}  // namespace raylanes

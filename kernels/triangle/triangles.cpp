// The ray–triangle tests of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "triangle_loops.hpp"

namespace raylanes {
namespace {

template <class Form>
constexpr TriangleLoops triangle_loops() {
  return {any_of_triangles<Form>,
          any_of_rays<Form>,
          {closest_of_triangles<Form, Wanted::distance>, closest_of_triangles<Form, Wanted::weights>,
           closest_of_triangles<Form, Wanted::weights_and_normal>},
          {closest_of_rays<Form, Wanted::distance>, closest_of_rays<Form, Wanted::weights>,
           closest_of_rays<Form, Wanted::weights_and_normal>}};
}

constexpr Grade reproducible = Grade::reproducible, fast = Grade::fast;

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const TriangleTable triangles;
constinit const TriangleTable triangles = {
    {{triangle_loops<PlaneEdgesPlainForm<reproducible>>(), triangle_loops<PlaneEdgesPlainForm<fast>>()},
     {triangle_loops<PlaneEdgesForm<reproducible>>(), triangle_loops<PlaneEdgesForm<fast>>()},
     {triangle_loops<MollerTrumboreForm<reproducible>>(), triangle_loops<MollerTrumboreForm<fast>>()},
     {triangle_loops<MollerTrumboreEdgesForm<reproducible>>(),
      triangle_loops<MollerTrumboreEdgesForm<fast>>()},
     {triangle_loops<WatertightForm<reproducible>>(), triangle_loops<WatertightForm<fast>>()},
     {triangle_loops<PrecomputedForm<reproducible>>(), triangle_loops<PrecomputedForm<fast>>()},
     {triangle_loops<DirectionalForm<reproducible>>(), triangle_loops<DirectionalForm<fast>>()}},
    {prepare_directional<reproducible>, prepare_directional<fast>}};

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes

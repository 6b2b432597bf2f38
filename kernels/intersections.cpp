// The intersection tests of one path, compiled like path.cpp: once per path, with one symbol that leaves.
#include "box/box_loops.hpp"
#include "sphere/sphere_loops.hpp"
#include "triangle/triangle_loops.hpp"

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

template <BoxTest test, Grade grade>
constexpr BoxLoops box_loops() {
  using Form = BoxForm<test, grade>;
  return {any_of_boxes<ManyBoxesForm<test, grade>>, box_any_of_rays<Form>, interval_of_boxes<Form>,
          box_interval_of_rays<Form>};
}

template <SphereTest test, Grade grade>
constexpr SphereLoops sphere_loops() {
  using Form = SphereForm<test, grade>;
  return {any_of_spheres<Form>, sphere_any_of_rays<Form>, distances_of_spheres<Form>,
          sphere_distances_of_rays<Form>};
}

constexpr Grade reproducible = Grade::reproducible, fast = Grade::fast;

}  // namespace

namespace detail {

#define RAYLANES_JOIN(a, b) a##b
#define RAYLANES_INTERSECTIONS_OF(path) RAYLANES_JOIN(path, _intersections)

// Rows in the order of the enumerations, columns in that of Grade.
extern constinit const IntersectionTable RAYLANES_INTERSECTIONS_OF(RAYLANES_PATH_NAME);
constinit const IntersectionTable RAYLANES_INTERSECTIONS_OF(RAYLANES_PATH_NAME) = {
    {{triangle_loops<PlaneEdgesPlainForm<reproducible>>(), triangle_loops<PlaneEdgesPlainForm<fast>>()},
     {triangle_loops<PlaneEdgesForm<reproducible>>(), triangle_loops<PlaneEdgesForm<fast>>()},
     {triangle_loops<MollerTrumboreForm<reproducible>>(), triangle_loops<MollerTrumboreForm<fast>>()},
     {triangle_loops<MollerTrumboreEdgesForm<reproducible>>(),
      triangle_loops<MollerTrumboreEdgesForm<fast>>()},
     {triangle_loops<WatertightForm<reproducible>>(), triangle_loops<WatertightForm<fast>>()},
     {triangle_loops<PrecomputedForm<reproducible>>(), triangle_loops<PrecomputedForm<fast>>()},
     {triangle_loops<DirectionalForm<reproducible>>(), triangle_loops<DirectionalForm<fast>>()}},
    {prepare_directional<reproducible>, prepare_directional<fast>},
    {{box_loops<BoxTest::conservative, reproducible>(), box_loops<BoxTest::conservative, fast>()},
     {box_loops<BoxTest::plain, reproducible>(), box_loops<BoxTest::plain, fast>()},
     {box_loops<BoxTest::directional, reproducible>(), box_loops<BoxTest::directional, fast>()}},
    {{sphere_loops<SphereTest::perpendicular, reproducible>(),
      sphere_loops<SphereTest::perpendicular, fast>()},
     {sphere_loops<SphereTest::textbook, reproducible>(), sphere_loops<SphereTest::textbook, fast>()}},
    {line_of_spheres<reproducible>, line_of_spheres<fast>}};

}  // namespace detail
}  // namespace raylanes

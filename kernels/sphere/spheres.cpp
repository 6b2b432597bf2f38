// The ray–sphere tests of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "sphere_loops.hpp"

namespace raylanes {
namespace {

template <SphereTest test, Grade grade>
constexpr SphereLoops sphere_loops() {
  using Form = SphereForm<test, grade>;
  return {any_of_spheres<Form>, sphere_any_of_rays<Form>, distances_of_spheres<Form>,
          sphere_distances_of_rays<Form>};
}

constexpr Grade reproducible = Grade::reproducible, fast = Grade::fast;

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const SphereTable spheres;
constinit const SphereTable spheres = {
    {{sphere_loops<SphereTest::perpendicular, reproducible>(),
      sphere_loops<SphereTest::perpendicular, fast>()},
     {sphere_loops<SphereTest::textbook, reproducible>(), sphere_loops<SphereTest::textbook, fast>()}},
    {line_of_spheres<reproducible>, line_of_spheres<fast>}};

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes

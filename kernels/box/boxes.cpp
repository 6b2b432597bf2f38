// The ray–box tests of one path: compiled once per path with its flags and back end; the table is the only symbol that
// leaves the object.
#include "box_loops.hpp"

namespace raylanes {
namespace {

template <BoxTest test, Grade grade>
constexpr BoxLoops box_loops() {
  using Form = BoxForm<test, grade>;
  return {any_of_boxes<ManyBoxesForm<test, grade>>, box_any_of_rays<Form>, interval_of_boxes<Form>,
          box_interval_of_rays<Form>};
}

constexpr Grade reproducible = Grade::reproducible, fast = Grade::fast;

}  // namespace

namespace detail::RAYLANES_PATH_NAME {

extern constinit const BoxTable boxes;
constinit const BoxTable boxes = {
    {{box_loops<BoxTest::conservative, reproducible>(), box_loops<BoxTest::conservative, fast>()},
     {box_loops<BoxTest::plain, reproducible>(), box_loops<BoxTest::plain, fast>()},
     {box_loops<BoxTest::directional, reproducible>(), box_loops<BoxTest::directional, fast>()}}};

}  // namespace detail::RAYLANES_PATH_NAME
}  // namespace raylanes

// Boxes over arrays, and the calls on them.
#include "../intervals/arrays.hpp"
#include "../intervals/calls.hpp"
#include "box_answers.hpp"

namespace raylanes::testing {

template <>
BoxScene scene_of_many<BoxTest>(std::size_t count) {
  Random random(203);
  return scene_around_one_box(count, random);
}

template <>
struct Door<BoxTest> {
  using Options = BoxOptions;
  static BoxScene scene() { return scene_of_many<BoxTest>(2); }
  static const Box& one(const Box& box) { return box; }
  template <class... Arguments>
  static void ends(Arguments&&... arguments) {
    intervals(arguments...);
  }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Boxes, IntervalArrays, BoxTest);
INSTANTIATE_TYPED_TEST_SUITE_P(Boxes, IntervalCalls, BoxTest);

}  // namespace raylanes::testing

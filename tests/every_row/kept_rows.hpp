// The rows of a ray whose caller rejects hits, for floats and doubles.
#pragma once

#include "../../dispatch/table/queries.hpp"
#include "../support/same_bytes.hpp"
#include "every_row.hpp"

namespace raylanes::testing {

// A caller that rejects primitives by a rule, and counts what it is asked.
template <class T>
struct SomeFilter {
  std::uint32_t divisor;
  std::size_t asked = 0;

  bool rejects(const HitOf<T>& hit) const { return divisor != 0 && hit.primitive % divisor == 0; }
  AskedOf<T> of(Facing facing, std::uint32_t skipped, const HitOf<T>* after) {
    const auto ask = [](void* filter, const HitOf<T>& hit) {
      auto& self = *static_cast<SomeFilter*>(filter);
      ++self.asked;
      return self.rejects(hit);
    };
    return {ask, this, facing, skipped, after};
  }
};

// Against the hits of a ray in order: next(ray, facing, skipped, last) is the one behind `last`; null: the first one.
template <class T, class Tree, class Next>
void compare_kept(EveryRow& every, const KeptRow<Tree, T>& mine, const KeptRow<Tree, T>& of_scalar,
                  const Tree& tree, const std::vector<RayOf<T>>& rays, const Next& next) {
  if (!every.offers(mine.closest, of_scalar.closest) || !every.offers(mine.any, of_scalar.any)) return;
  std::size_t found = 0, rejected = 0;
  for (const Facing facing : {Facing::any, Facing::front, Facing::back})
    for (const std::uint32_t divisor : {0u, 1u, 2u, 3u})
      for (const RayOf<T>& ray : rays) {
        const HitOf<T> first = next(ray, facing, no_primitive, nullptr);
        SomeFilter<T> filter{divisor};
        for (const std::uint32_t skipped : {no_primitive, first.primitive})
          for (const HitOf<T>* after : {static_cast<const HitOf<T>*>(nullptr), &first}) {
            HitOf<T> wanted = next(ray, facing, skipped, after);
            while (wanted && filter.rejects(wanted)) {
              const HitOf<T> last = wanted;
              wanted = next(ray, facing, skipped, &last), ++rejected;
            }
            found += wanted ? 1 : 0;
            const AskedOf<T> asked = filter.of(facing, skipped, after);
            filter.asked = 0;
            EXPECT_TRUE(same_bytes(mine.closest(tree, ray, asked), wanted));
            EXPECT_GE(filter.asked, wanted ? 1u : 0u);
            EXPECT_TRUE(same_bytes(of_scalar.closest(tree, ray, asked), wanted));
            EXPECT_EQ(mine.any(tree, ray, asked), static_cast<bool>(wanted));
            EXPECT_EQ(of_scalar.any(tree, ray, asked), static_cast<bool>(wanted));
            AskedOf<T> nobody = asked;
            nobody.rejects = nullptr;
            EXPECT_TRUE(same_bytes(mine.closest(tree, ray, nobody), next(ray, facing, skipped, after)));
          }
      }
  EXPECT_GT(found, 100u);
  EXPECT_GT(rejected, 100u);
}

}  // namespace raylanes::testing

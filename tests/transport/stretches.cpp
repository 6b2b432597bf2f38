// Stretches of rays within solids that touch, share faces and overlap, aimed at their edges: lengths by rational
// numbers.
#include <gmpxx.h>

#include <raylanes/numbers.hpp>
#include <raylanes/stretches.hpp>

#include "../doubles/double_cases.hpp"
#include "../kdtree/kd_trees.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

struct IntegerBox {
  int lo[3], hi[3];
};
// The second and the fourth share faces with the first, the third overlaps three of them.
constexpr IntegerBox boxes[] = {{{0, 0, 0}, {4, 4, 4}},
                                {{4, 0, 0}, {8, 4, 4}},
                                {{2, 2, 2}, {6, 6, 6}},
                                {{0, 0, 4}, {4, 4, 5}},
                                {{10, 10, 10}, {12, 12, 12}}};
// Boxes are sheared, so that sides are not along the axes; its inverse, times three, finds a ray's way through them.
constexpr int shear[3][3] = {{1, 1, 0}, {0, 1, 2}, {1, 0, 1}};
constexpr int inverse[3][3] = {{1, -1, 2}, {2, 1, -2}, {-1, 1, 1}};

template <class T>
PointOf<T> sheared(const std::array<T, 3>& p) {
  PointOf<T> at;
  for (std::size_t i = 0; i < 3; ++i)
    at[i] = T(shear[i][0]) * p[0] + T(shear[i][1]) * p[1] + T(shear[i][2]) * p[2];
  return at;
}

template <class T>
auto mesh_of_boxes() {
  std::conditional_t<std::is_same_v<T, float>, Mesh, DoubleMesh> mesh;
  const Mesh one = cube(0, 1);
  for (const IntegerBox& box : boxes) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Float3& corner : one.vertices) {
      std::array<T, 3> at;
      for (std::size_t k = 0; k < 3; ++k) at[k] = T(corner[k] == 0 ? box.lo[k] : box.hi[k]);
      mesh.vertices.push_back(sheared(at));
    }
    for (const Index3& t : one.triangles)
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

// From anywhere to points of edges, on which some of them are exactly.
template <class T>
RayOf<T> ray_to_edge(Random& random) {
  const IntegerBox& box = boxes[random.integer(0, 4)];
  std::array<T, 3> target;
  RayOf<T> ray;
  const auto along = static_cast<std::size_t>(random.integer(0, 2));
  const bool is_rounded = random.chance(0.5);
  for (std::size_t k = 0; k < 3; ++k) {
    target[k] = T(random.chance(0.5) ? box.lo[k] : box.hi[k]);
    if (k == along)
      target[k] = T(box.lo[k]) + T(box.hi[k] - box.lo[k]) *
                                     (is_rounded ? T(random.number(0, 1)) : T(random.integer(0, 16)) / 16);
    ray.origin[k] = is_rounded ? T(random.number(-9, 25)) : T(random.integer(-18, 50)) / 2;
  }
  const PointOf<T> at = sheared(target);
  for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = at[k] - ray.origin[k];
  const int kind = random.integer(0, 7);
  if (kind == 1) ray.tmin = T(0.25);
  if (kind == 2) ray.tmin = -3;
  if (kind == 3) ray.tmax = 1;
  return ray;
}

struct Lengths {
  mpq_class by_winding = 0, of_union = 0;
  mpq_class farthest = 0;      // |t| where the ray's line enters or leaves a box
  bool is_along_side = false;  // the ray's line lies in a side: inside or outside is a matter of definition
  bool passes_at_origin = false;  // crossings() does not decide that if the origin lies on an edge
};

template <class T>
Lengths lengths_of(const RayOf<T>& ray) {
  Lengths lengths;
  std::vector<std::pair<mpq_class, mpq_class>> within;
  mpq_class o[3], d[3];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      o[i] += inverse[i][j] * mpq_class(ray.origin[j]), d[i] += inverse[i][j] * mpq_class(ray.direction[j]);
  for (const IntegerBox& box : boxes) {
    bool misses = false, has_ends = false;
    mpq_class begin, end;
    for (std::size_t k = 0; k < 3; ++k) {
      const mpq_class lo = 3 * box.lo[k], hi = 3 * box.hi[k];
      if (d[k] == 0) {
        lengths.is_along_side |= o[k] == lo || o[k] == hi;
        misses |= o[k] < lo || o[k] > hi;
        continue;
      }
      mpq_class t0 = (lo - o[k]) / d[k], t1 = (hi - o[k]) / d[k];
      if (t0 > t1) std::swap(t0, t1);
      begin = has_ends ? std::max(begin, t0) : t0, end = has_ends ? std::min(end, t1) : t1;
      has_ends = true;
    }
    if (misses || begin > end) continue;
    lengths.farthest = std::max({lengths.farthest, mpq_class(abs(begin)), mpq_class(abs(end))});
    lengths.passes_at_origin |= begin == 0 || end == 0;
    begin = std::max(begin, mpq_class(ray.tmin));
    if (ray.tmax < std::numeric_limits<T>::infinity()) end = std::min(end, mpq_class(ray.tmax));
    if (begin < end) within.emplace_back(begin, end), lengths.by_winding += end - begin;
  }
  std::sort(within.begin(), within.end());
  for (std::size_t i = 0, next; i < within.size(); i = next) {
    mpq_class end = within[i].second;
    for (next = i + 1; next < within.size() && within[next].first <= end; ++next)
      end = std::max(end, within[next].second);
    lengths.of_union += end - within[i].first;
  }
  return lengths;
}

template <class T>
class Stretches : public ::testing::Test {
 public:
  using Record = StretchRecord<T>;
  Stretches() {
    Random random(221);
    for (std::size_t i = 0; i < by_level(20000); ++i) {
      const RayOf<T> ray = ray_to_edge<T>(random);
      Lengths lengths = lengths_of<T>(ray);
      if (lengths.is_along_side || (ray.tmin < 0 && lengths.passes_at_origin)) continue;
      rays.push_back(ray), expected.push_back(std::move(lengths));
    }
  }
  void expect_right(const RayLists<Record>& lists) const {
    // Each crossing's t is rounded once, and there are two of each box.
    const mpq_class share = 2 * std::size(boxes) * mpq_class(std::numeric_limits<T>::epsilon()) / 2;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rays.size() && wrong < 3; ++i) {
      mpq_class by_winding = 0, of_union = 0;
      for (const Record& stretch : lists[i]) {
        const mpq_class length = mpq_class(stretch.exit) - mpq_class(stretch.entry);
        by_winding += stretch.winding * length, of_union += length;
      }
      const mpq_class bound = share * expected[i].farthest;
      const bool is_good = abs(by_winding - expected[i].by_winding) <= bound &&
                           abs(of_union - expected[i].of_union) <= bound && are_in_order(i, lists[i]);
      EXPECT_TRUE(is_good) << "ray " << i << ": " << by_winding.get_d() << ", not "
                           << expected[i].by_winding.get_d() << "; " << of_union.get_d() << ", not "
                           << expected[i].of_union.get_d();
      wrong += is_good ? 0 : 1;
    }
  }
  bool are_in_order(std::size_t i, std::span<const Record> list) const {
    const Record* before = nullptr;
    bool is_good = true;
    for (const Record& stretch : list) {
      is_good = is_good && stretch.winding != 0 && stretch.entry < stretch.exit &&
                stretch.entry >= rays[i].tmin && stretch.exit <= rays[i].tmax &&
                (stretch.entered_by != no_primitive || stretch.entry == rays[i].tmin) &&
                (stretch.left_by != no_primitive || stretch.exit == rays[i].tmax) &&
                (before == nullptr || before->exit < stretch.entry ||
                 (before->exit == stretch.entry && before->winding != stretch.winding));
      before = &stretch;
    }
    return is_good;
  }

  std::vector<RayOf<T>> rays;
  std::vector<Lengths> expected;
};
using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Stretches, Numbers);

template <class T, class Check>
void each_tree_of_boxes(const Check& check) {
  const auto mesh = mesh_of_boxes<T>();
  if constexpr (std::is_same_v<T, float>)
    check(Bvh(mesh)), check(Bvh(mesh, {.builder = TreeBuilder::spatial_splits})), check(KdTree(mesh));
  else
    check(BvhD(mesh.vertices, mesh.triangles));
}

TYPED_TEST(Stretches, have_the_lengths_of_exact_arithmetic) {
  each_tree_of_boxes<TypeParam>([&](const auto& tree) {
    for (const Path* path : paths_with_own_queries())
      this->expect_right(stretches(tree, this->rays, {.path = path, .threads = 2}));
    // Rays with crossings of one rounded t, whose order is that of primitives.
    const auto crossings = tree.crossings(this->rays);
    std::size_t with_equal = 0;
    for (std::size_t i = 0; i < this->rays.size(); ++i)
      with_equal += std::ranges::adjacent_find(crossings[i], {}, [](const auto& c) { return c.t; }) !=
                            crossings[i].end()
                        ? 1
                        : 0;
    EXPECT_GT(with_equal, this->rays.size() / 10);
  });
}

// The ray crosses the triangles that ends name, outwards where the winding number falls.
TYPED_TEST(Stretches, name_the_triangles_that_are_crossed) {
  each_tree_of_boxes<TypeParam>([&](const auto& tree) {
    const auto lists = stretches(tree, this->rays);
    auto whole = this->rays;  // an end may be rounded to tmax from behind it
    for (auto& ray : whole) ray.tmax = std::numeric_limits<TypeParam>::infinity();
    const auto crossings = tree.crossings(whole);
    for (std::size_t i = 0; i < this->rays.size(); ++i) {
      const auto crosses = [&](TypeParam t, std::uint32_t primitive, int side) {
        return primitive == no_primitive || std::ranges::any_of(crossings[i], [&](const auto& c) {
                 return c.t == t && c.primitive == primitive && (side == 0 || c.side == side);
               });
      };
      const StretchRecord<TypeParam>* before = nullptr;
      for (const auto& stretch : lists[i]) {
        const bool goes_on = before != nullptr && before->exit == stretch.entry;
        // At tmin a ray may leave one of two solids that it begins in.
        const int entered = goes_on ? (before->winding > stretch.winding ? 1 : -1)
                            : stretch.entry == this->rays[i].tmin ? 0
                                                                  : -1;
        ASSERT_TRUE(crosses(stretch.entry, stretch.entered_by, entered)) << "ray " << i;
        ASSERT_TRUE(crosses(stretch.exit, stretch.left_by, 0)) << "ray " << i;
        before = &stretch;
      }
    }
  });
}

TYPED_TEST(Stretches, take_the_options_of_lists) {
  each_tree_of_boxes<TypeParam>([&](const auto& tree) {
    const auto whole = stretches(tree, this->rays);
    const auto two = stretches(tree, this->rays, {.max_count = 2});
    std::vector<std::uint8_t> active(this->rays.size() / 8 + 1, 0x5a);
    const auto some = stretches(tree, this->rays, {.active = active.data()});
    for (std::size_t i = 0; i < this->rays.size(); ++i) {
      ASSERT_TRUE(std::ranges::equal(two[i], whole[i].first(std::min<std::size_t>(2, whole[i].size()))));
      const bool is_active = (active[i / 8] >> i % 8 & 1) != 0;
      ASSERT_TRUE(std::ranges::equal(some[i], is_active ? whole[i] : whole[i].first(0)));
    }
    EXPECT_THROW(stretches(tree, this->rays, {.facing = Facing::back}), std::invalid_argument);
    EXPECT_THROW(stretches(tree, RayRecords<RayOf<TypeParam>>(nullptr, 3)), std::invalid_argument);
    EXPECT_THROW(stretches(tree, this->rays, {.threads = -1}), std::invalid_argument);
  });
  using Tree = std::conditional_t<std::is_same_v<TypeParam, float>, Bvh, BvhD>;
  EXPECT_EQ(stretches(Tree(), this->rays).items.size(), 0u);
  EXPECT_EQ(stretches(Tree(), std::vector<RayOf<TypeParam>>()).size(), 0u);
}

// A ray from within begins a stretch, one that ends within ends it; a NaN ends nothing.
TYPED_TEST(Stretches, begin_and_end_with_the_ray) {
  each_tree_of_boxes<TypeParam>([&](const auto& tree) {
    using T = TypeParam;
    RayOf<T> ray{sheared<T>({1, 1, 1}), 0, sheared<T>({1, 0, 0}), 20};
    const auto one = stretches(tree, std::vector{ray});
    ASSERT_EQ(one.items.size(), 1u);
    EXPECT_EQ(one.items[0].entry, 0);
    EXPECT_EQ(one.items[0].exit, 7);
    EXPECT_EQ(one.items[0].entered_by, no_primitive);
    EXPECT_EQ(one.items[0].winding, 1);
    ray.tmax = 2;
    EXPECT_EQ(stretches(tree, std::vector{ray}).items.at(0).exit, 2);
    EXPECT_EQ(stretches(tree, std::vector{ray}).items.at(0).left_by, no_primitive);
    ray.tmax = std::numeric_limits<T>::quiet_NaN();
    EXPECT_EQ(stretches(tree, std::vector{ray}).items.size(), 0u);
    ray.tmax = 2, ray.tmin = 3;
    EXPECT_EQ(stretches(tree, std::vector{ray}).items.size(), 0u);
  });
}

}  // namespace
}  // namespace raylanes::testing

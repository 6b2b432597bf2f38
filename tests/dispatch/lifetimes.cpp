// Views of temporaries: refused where they would show free memory, taken where they live as long as the call.
#include <raylanes/raylanes.hpp>

#include "../support/testing.hpp"

namespace raylanes {
namespace {

template <class T>
concept HasView = requires(T&& tree) {
  std::forward<T>(tree).view();
};
template <class T>
concept HasOrder = requires(T&& tree) {
  std::forward<T>(tree).order();
};
template <class T>
concept HasTree = requires(T&& scene) {
  std::forward<T>(scene).tree(0);
};
template <class T>
concept HasItems = requires(T&& lists) {
  std::forward<T>(lists)[0];
};
template <class Rays, class Triangles>
concept Masks = requires(Rays&& rays, Triangles&& triangles) {
  mask_filter(std::forward<Rays>(rays), std::forward<Triangles>(triangles));
};
template <class Tree, class Hits>
concept WritesTo = requires(const Tree& tree, std::vector<Ray> rays, Hits&& hits) {
  tree.closest(rays, std::forward<Hits>(hits));
};
template <class Test>
concept IsTestOfScene = requires(Scene& scene, BoundedTree tree, Test&& test) {
  scene.add(std::move(tree), std::forward<Test>(test));
};
template <class Hits>
concept IsAfter = requires(Hits&& hits) {
  TraceOptions{.after = std::forward<Hits>(hits)};
};

// --- Objects show their memory if they have a name.
static_assert(HasView<Bvh&> && HasView<const Bvh&> && HasView<KdTree&> && HasView<const KdTree&>);
static_assert(!HasView<Bvh> && !HasView<const Bvh> && !HasView<KdTree> && !HasView<const KdTree>);
static_assert(HasOrder<BoundedTree&> && HasOrder<const BoundedTree&>);
static_assert(!HasOrder<BoundedTree> && !HasOrder<const BoundedTree>);
static_assert(HasTree<Scene&> && HasTree<const Scene&> && !HasTree<Scene> && !HasTree<const Scene>);
template <class Item>
constexpr bool has_items_only_by_name = HasItems<RayLists<Item>&>&& HasItems<const RayLists<Item>&> &&
                                        !HasItems<RayLists<Item>> && !HasItems<const RayLists<Item>>;
static_assert(has_items_only_by_name<Hit> && has_items_only_by_name<Crossing>);
static_assert(has_items_only_by_name<HitD> && has_items_only_by_name<CrossingD>);
static_assert(!std::is_reference_v<decltype(std::declval<PreparedTriangles>().options())>);

// --- A temporary that owns its elements serves neither for hits to write nor for views that something keeps.
template <class View, class Record>
constexpr bool writes_only_to_what_stays =
    std::is_constructible_v<View, std::vector<Record>&>&& std::is_constructible_v<View, std::span<Record>>&&
        std::is_constructible_v<View, std::array<Record, 2>&> &&
    !std::is_constructible_v<View, std::vector<Record>> &&
    !std::is_constructible_v<View, std::array<Record, 2>> &&
    !std::is_constructible_v<View, const std::vector<Record>>;
static_assert(writes_only_to_what_stays<HitView, Hit> && writes_only_to_what_stays<HitViewD, HitD>);
static_assert(writes_only_to_what_stays<SceneHitView, SceneHit>);
static_assert(WritesTo<Bvh, std::vector<Hit>&> && WritesTo<Bvh, std::span<Hit>> &&
              !WritesTo<Bvh, std::vector<Hit>>);
static_assert(WritesTo<Scene, std::vector<SceneHit>&> && !WritesTo<Scene, std::vector<SceneHit>>);
static_assert(IsAfter<std::vector<Hit>&> && IsAfter<std::span<Hit>> && !IsAfter<std::vector<Hit>>);
static_assert(IsAfter<Hit> && IsAfter<std::vector<SceneHit>&> && IsAfter<SceneHitView>);
using Test = bool (*)(std::uint32_t, const Ray&, Hit&);
static_assert(IsTestOfScene<Test&> && !IsTestOfScene<Test>);
using Numbers = std::vector<std::uint32_t>;
static_assert(Masks<Numbers&, const Numbers&> &&
              Masks<std::span<std::uint32_t>, std::span<const std::uint32_t>>);
static_assert(!Masks<Numbers, Numbers&> && !Masks<Numbers&, Numbers> && !Masks<Numbers, Numbers>);

// --- A call may read a temporary.
static_assert(std::is_convertible_v<std::vector<Ray>, RayView> &&
              std::is_convertible_v<std::vector<RayD>, RayViewD>);
static_assert(std::is_convertible_v<std::vector<float>, VertexView> &&
              std::is_convertible_v<std::vector<Float3>, VertexView>);
static_assert(std::is_convertible_v<std::vector<int>, IndexView> &&
              std::is_convertible_v<const std::vector<Index3>, IndexView>);

}  // namespace
}  // namespace raylanes

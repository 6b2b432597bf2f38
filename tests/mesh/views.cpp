// Batches as users have them: records of any size and alignment, runs of rays, more rays than streams take.
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

struct Named {
  int name = 5;
};
struct Photon : Named, Ray {
  int bounces = 0;
};
struct Found : Named, Hit {
  float colour[3] = {7, 8, 9};
};
static_assert(!std::is_constructible_v<HitView, const std::vector<Hit>&>);

class BatchViews : public ::testing::Test {
 protected:
  const Mesh mesh = triangle_soup(300, 0.4f, 50);
  const std::vector<Ray> rays = mixed_rays(mesh, 3000, 2, {0, 0, 0}, 51);  // enough for any mode
  const Bvh bvh{mesh};
  const std::vector<Hit> expected = trace(bvh, rays, {.mode = TraversalMode::single});

  void expect(std::size_t i, const Hit& hit, const TraceOptions& options) const {
    ASSERT_TRUE(same_bytes(hit, expected[i])) << name_of(options) << " ray " << i;
  }
};

TEST_F(BatchViews, records_derived_from_rays_and_hits) {
  std::vector<Photon> photons;
  for (const Ray& ray : rays) photons.push_back({{}, ray, 3});
  for (const TraceOptions& options : ways_to_trace()) {
    std::vector<Found> found(rays.size());
    bvh.closest(photons, found, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      expect(i, found[i], options);
      ASSERT_EQ(found[i].colour[0] + found[i].colour[1] + found[i].colour[2], 24) << "written beside a hit";
      ASSERT_EQ(found[i].name, 5) << "written before a hit";
    }
    std::vector<std::uint8_t> occluded(rays.size(), 9);
    bvh.occluded(photons, occluded, options);
    for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(occluded[i], expected[i] ? 1 : 0) << i;
  }
  const std::vector<Photon> no_photons;
  bvh.closest(no_photons, std::span<Found>());
  EXPECT_EQ(RayView(no_photons).first, nullptr);
}

TEST_F(BatchViews, records_of_any_alignment) {
  constexpr std::size_t ray_stride = 37, hit_stride = 19;
  std::vector<std::byte> rays_there(ray_stride * rays.size() + 1), hits_there(hit_stride * rays.size() + 1);
  for (std::size_t i = 0; i < rays.size(); ++i)
    std::memcpy(rays_there.data() + 1 + i * ray_stride, &rays[i], sizeof(Ray));
  for (const TraceOptions& options : ways_to_trace()) {
    bvh.closest(RayView(rays_there.data() + 1, rays.size(), ray_stride),
                HitView(hits_there.data() + 1, rays.size(), hit_stride), options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Hit hit;
      std::memcpy(&hit, hits_there.data() + 1 + i * hit_stride, sizeof hit);
      expect(i, hit, options);
    }
  }
}

TEST_F(BatchViews, what_cannot_be_written_is_refused) {
  std::vector<Hit> hits(rays.size());
  const auto message = [&](RayView from, HitView to) {
    return message_of<std::invalid_argument>([&] { bvh.closest(from, to); });
  };
  expect_words(message(RayView(nullptr, 3), HitView(hits.data(), 3)), {"rays", "nothing"});
  expect_words(message(RayView(rays.data(), 3), HitView(nullptr, 3)), {"hits", "nothing"});
  expect_words(message(RayView(rays.data(), 3), HitView(hits.data(), 2)), {"2", "3"});
  expect_words(message(RayView(rays.data(), 3), HitView(hits.data(), 3, 12)), {"12", "16"});
  bvh.closest(RayView(), HitView());
  std::vector<std::uint8_t> two(2);
  const auto message_of_points = [&](VertexView points) {
    return message_of<std::invalid_argument>([&] { bvh.occluded_from({}, points, two); });
  };
  expect_words(message_of_points(mesh.vertices), {"2", "points"});
  expect_words(message_of_points(VertexView(nullptr, 2)), {"points", "nothing"});
  bvh.occluded_from({}, VertexView(), {});
}

// Some from one point, some from any, by turns: fewer and more than are traced together.
TEST_F(BatchViews, runs_of_rays_that_share_an_origin) {
  Random random(53);
  std::vector<Ray> many;
  for (const int run : {200, 1, 63, 64, 65, 127, 128, 129, quick() ? 300 : 16'390, 500, 66}) {
    for (int i = random.integer(0, 90); i > 0; --i) many.push_back(rays[random.index(3000)]);
    const Float3 origin = random.point(2);
    for (int i = 0; i < run; ++i) {
      many.push_back(rays[random.index(3000)]);
      many.back().origin = origin;
    }
  }
  for (Ray& ray : std::span(many).first(3)) ray.origin[1] = nan;
  const std::vector<Hit> one_by_one = trace(bvh, many, {.mode = TraversalMode::single});
  for (const Path* path : supported_paths())
    for (const std::size_t left_out : {0, 1, 100, 270}) {
      const std::span<const Ray> some = std::span<const Ray>(many).subspan(left_out);
      const std::vector<Hit> hits = trace(bvh, some, {.path = path});
      ASSERT_TRUE(same_bytes(hits, std::span(one_by_one).subspan(left_out)))
          << path->name << " from " << left_out;
    }
}

// More rays of one octant than a stream holds, and more than a call takes.
TEST_F(BatchViews, batches_larger_than_streams) {
  std::vector<Ray> many;
  Random random(52);
  const int count = static_cast<int>(by_level(150'000));
  for (int i = 0; i < count; ++i) {
    Ray ray = rays[random.index(3000)];
    if (i < count / 5 * 2)
      for (float& x : ray.direction) x = x < 0 ? -x : x;
    many.push_back(ray);
  }
  const std::vector<Hit> one_by_one = trace(bvh, many, {.mode = TraversalMode::single});
  for (const TraversalMode mode : {TraversalMode::stream, TraversalMode::automatic})
    for (const int threads : {1, 2, 0}) {
      const std::vector<Hit> hits = trace(bvh, many, {.mode = mode, .threads = threads});
      ASSERT_TRUE(same_bytes(hits, one_by_one)) << threads;
    }
}

}  // namespace
}  // namespace raylanes::testing

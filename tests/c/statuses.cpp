// Statuses of exceptions, of memory that runs out, and options that end early.
#include <new>
#include <random>
#include <system_error>
#include <thread>

#include "../../accel/c/call.hpp"
#include "../doubles/double_cases.hpp"
#include "../support/guarded_array.hpp"
#include "../support/limited_memory.hpp"
#include "../support/random_input.hpp"
#include "calls.hpp"
#include "in_c/check.h"

namespace raylanes::testing {
namespace {

template <class Error>
raylanes_status status_of_a(const Error& error) {
  return c::status_of([&] { throw error; });
}

TEST(CStatus, tells_exceptions_apart) {
  EXPECT_EQ(c::status_of([] {}), RAYLANES_OK);
  EXPECT_EQ(status_of_a(std::invalid_argument("one")), RAYLANES_INVALID_ARGUMENT);
  EXPECT_STREQ(raylanes_last_message(), "one");
  EXPECT_EQ(status_of_a(std::bad_alloc()), RAYLANES_OUT_OF_MEMORY);
  EXPECT_STREQ(raylanes_last_message(), "there is not enough memory");
  EXPECT_EQ(status_of_a(std::length_error("two")), RAYLANES_TOO_LARGE);
  EXPECT_STREQ(raylanes_last_message(), "two");
  EXPECT_EQ(status_of_a(std::runtime_error("three")), RAYLANES_BAD_FILE);
  EXPECT_STREQ(raylanes_last_message(), "three");
  EXPECT_EQ(status_of_a(std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again))),
            RAYLANES_FAILED);
  EXPECT_EQ(status_of_a(std::out_of_range("four")), RAYLANES_INVALID_ARGUMENT);
  EXPECT_STREQ(raylanes_last_message(), "four");
  EXPECT_EQ(status_of_a(std::logic_error("five")), RAYLANES_INVALID_ARGUMENT);
  EXPECT_EQ(status_of_a(std::bad_function_call()), RAYLANES_FAILED);
  EXPECT_EQ(status_of_a(c::Cancelled()), RAYLANES_CANCELLED);
  EXPECT_STREQ(raylanes_last_message(), "a function of the caller ended the call");
  EXPECT_EQ(status_of_a(5), RAYLANES_FAILED);
  EXPECT_EQ(status_of_a(c::SmallBuffer{6, 7}), RAYLANES_SMALL_BUFFER);
  EXPECT_STREQ(raylanes_last_message(), "the buffer has 6 bytes, 7 are needed");
  EXPECT_EQ(c::status_of([] {}), RAYLANES_OK);
  EXPECT_STREQ(raylanes_last_message(), "the buffer has 6 bytes, 7 are needed");
}

TEST(CMessages, belong_to_threads) {
  EXPECT_EQ(raylanes_force_path("nowhere"), RAYLANES_INVALID_ARGUMENT);
  std::thread([] { EXPECT_STREQ(raylanes_last_message(), ""); }).join();
  std::thread([] { EXPECT_EQ(raylanes_active_path(nullptr), RAYLANES_INVALID_ARGUMENT); }).join();
  EXPECT_NE(std::string(raylanes_last_message()).find("nowhere"), std::string::npos);
}

TEST(CMessages, end_where_their_memory_does) {
  const std::string name(5000, 'x');
  EXPECT_EQ(raylanes_force_path(name.c_str()), RAYLANES_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(raylanes_last_message()).size(), 511u);
  EXPECT_EQ(raylanes_force_path("two\nlines"), RAYLANES_INVALID_ARGUMENT);
  EXPECT_EQ(std::string(raylanes_last_message()).find('\n'), std::string::npos);
}

TEST(CInterface, does_in_c_what_it_says) {
  int failures = -1;
  const int number = static_cast<int>(std::random_device()() >> 1);
  const std::string files = "c_calls_" + std::to_string(number) + '_';
  std::thread([&] { failures = check_c_interface(files.c_str()); }).join();
  EXPECT_EQ(failures, 0);
}

// Throws std::bad_alloc if memory ran out, as runs_out() expects it; every other failure is a wrong one.
void expect_good_or_out(raylanes_status status) {
  if (status == RAYLANES_OUT_OF_MEMORY) throw std::bad_alloc();
  EXPECT_EQ(status, RAYLANES_OK) << raylanes_last_message();
}

int32_t never_hit(void*, std::uint32_t, const raylanes_ray*, raylanes_hit*) {
  return 0;
}

// Repeats a call with ever more memory, until it has enough.
void run_out(const std::function<void()>& call) {
  std::size_t allocations = 0;
  while (allocations < 10'000 && runs_out(allocations, unlimited, call)) ++allocations;
  EXPECT_GT(allocations, 0u);
  EXPECT_LT(allocations, 10'000u);
}

TEST(CMemory, that_runs_out_is_a_status) {
  const Mesh mesh = ellipsoid(2, {0, 0, 0});
  const std::vector<Ray> rays = mixed_rays(mesh, 200, 4, {0, 0, 0}, 15);
  raylanes_bvh* tree = nullptr;
  run_out([&] {
    raylanes_bvh* made = reinterpret_cast<raylanes_bvh*>(&tree);  // anything
    const raylanes_status status =
        raylanes_bvh_create(&made, mesh.vertices.data(), mesh.vertices.size(), 0, mesh.triangles.data(),
                            mesh.triangles.size(), 0, nullptr);
    EXPECT_EQ(made != nullptr, status == RAYLANES_OK);
    expect_good_or_out(status);
    tree = made;
  });
  run_out([&] {
    raylanes_lists* lists = nullptr;
    const raylanes_status status = raylanes_bvh_all_hits(tree, rays.data(), rays.size(), 0, &lists, nullptr);
    EXPECT_EQ(lists != nullptr, status == RAYLANES_OK);
    raylanes_lists_destroy(lists);
    expect_good_or_out(status);
  });
  std::vector<Hit> hits(rays.size());
  run_out([&] {
    expect_good_or_out(raylanes_bvh_closest(tree, rays.data(), rays.size(), 0, hits.data(), 0, nullptr));
  });
  raylanes_bvh_destroy(tree);
}

template <class Kind, class AnyMesh, class AnyRay>
void run_out_in_scenes(const AnyMesh& mesh, const std::vector<AnyRay>& rays) {
  using C = CallsOf<Kind>;
  const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
  const auto tree = made<TreeOfC<typename C::Number>>([&](auto** address) {
    CallsOf<typename C::Number>::create(address, mesh.vertices.data(), vertices, 0, mesh.triangles.data(),
                                        triangles, 0, nullptr);
  });
  TreeOfC<Kind> scene;
  run_out([&] {
    std::uint32_t part = 0;
    std::vector<raylanes_status> statuses;
    const auto call = [&](raylanes_status status) { statuses.push_back(status); };
    auto whole = made<TreeOfC<Kind>>([&](auto** address) { call(C::create(address)); });
    if (whole != nullptr) {
      call(C::add_tree(whole.get(), tree.get(), &part));
      call(C::add_mesh(whole.get(), mesh.vertices.data(), vertices, 0, mesh.triangles.data(), triangles, 0,
                       nullptr, &part));
      if constexpr (std::is_same_v<Kind, Scene>)
        call(raylanes_scene_add_primitives(whole.get(), rays.data(), 5, 0, never_hit, nullptr, nullptr,
                                           &part));
      call(C::add_scene(whole.get(), whole.get(), &part));
      const std::uint32_t parts = part + 1;
      for (std::uint32_t i = 0; i < parts; ++i) call(C::place(whole.get(), i, nullptr, 1, &part));
      call(C::update(whole.get(), 1));
    }
    for (const raylanes_status status : statuses) expect_good_or_out(status);
    scene = std::move(whole);
  });
  run_out([&] {
    raylanes_status status = RAYLANES_OK;
    const auto copy = made<TreeOfC<Kind>>([&](auto** address) { status = C::copy(address, scene.get()); });
    EXPECT_EQ(copy != nullptr, status == RAYLANES_OK);
    expect_good_or_out(status);
  });
  run_out([&] {
    raylanes_status status = RAYLANES_OK;
    const auto lists = made<ListsOfC>([&](auto** address) {
      status = C::all_hits(scene.get(), rays.data(), rays.size(), 0, address, nullptr);
    });
    EXPECT_EQ(lists != nullptr, status == RAYLANES_OK);
    expect_good_or_out(status);
  });
}
TEST(CMemory, that_runs_out_in_scenes_is_a_status) {
  const Mesh mesh = ellipsoid(2, {0, 0, 0});
  run_out_in_scenes<Scene>(mesh, mixed_rays(mesh, 200, 4, {0, 0, 0}, 15));
  const DoubleMesh of_doubles = moved(mesh, 1.1, {0, 0.1, 0});
  run_out_in_scenes<SceneD>(of_doubles, aimed_rays(of_doubles, 200, 15));
}

// Loads files with a large number in the place of each of their first ones.
template <class Kind>
void expect_little_memory(const typename CallsOf<Kind>::Tree& object, std::size_t end) {
  std::ostringstream saved;
  object.save(saved);
  for (std::size_t at = 32; at < end; at += 4) {
    std::string file = saved.str();
    const std::uint32_t many = 0x0fffffff;
    std::memcpy(file.data() + at, &many, sizeof many);
    EXPECT_FALSE(runs_out(unlimited, std::size_t{1} << 20, [&] {
      typename CallsOf<Kind>::Handle* loaded = nullptr;
      const raylanes_status status = CallsOf<Kind>::load(&loaded, file.data(), file.size());
      EXPECT_EQ(loaded, nullptr);
      if (status == RAYLANES_OUT_OF_MEMORY) throw std::bad_alloc();
      EXPECT_EQ(status, RAYLANES_BAD_FILE);
    })) << at;
  }
}
TEST(CMemory, is_not_taken_for_what_a_damaged_file_says) {
  const DoubleMesh mesh = moved(ellipsoid(2, {0, 0, 0}), 1, {});
  expect_little_memory<float>(Bvh(ellipsoid(2, {0, 0, 0})), 160);
  SceneD scene;
  scene.place(scene.add(mesh.vertices, mesh.triangles));
  expect_little_memory<SceneD>(scene, 72);
}

// Options of an earlier version that end at a forbidden page.
TEST(COptions, are_read_as_far_as_they_go) {
  const Mesh mesh = tetrahedron();
  const auto tree = made<TreeOfC<float>>([&](raylanes_bvh** address) {
    raylanes_bvh_create(address, mesh.vertices.data(), mesh.vertices.size(), 0, mesh.triangles.data(),
                        mesh.triangles.size(), 0, nullptr);
  });
  const Ray ray = make_ray({0.25f, 0.25f, 2}, {0, 0, -1});
  Hit hit;
  for (std::size_t size = 8; size <= sizeof(raylanes_ray_options); size += 8) {
    GuardedArray<unsigned char> memory(size, Place::before_guard);
    auto* const options = reinterpret_cast<raylanes_ray_options*>(memory.data());
    ASSERT_EQ(raylanes_init_ray_options(options, size), RAYLANES_OK);
    EXPECT_TRUE(memory.is_intact());
    if (size > 8) options->facing = RAYLANES_FACING_BACK;
    ASSERT_EQ(raylanes_bvh_closest(tree.get(), &ray, 1, 0, &hit, 0, options), RAYLANES_OK);
    EXPECT_EQ(hit.t, size > 8 ? 2.0f : 1.5f) << size;
  }
}

}  // namespace
}  // namespace raylanes::testing

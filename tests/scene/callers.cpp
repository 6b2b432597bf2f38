// Situations around calls: many threads of their own, their own task arenas, fork(), other roundings, and too
// little memory.
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <raylanes/scene.hpp>

#include "../../accel/batch/in_parallel.hpp"
#include "../support/level.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

struct Questions {
  Mesh mesh = triangle_soup(2000, 0.3f, 501);
  std::vector<Ray> rays = mixed_rays(mesh, by_level(20000), 2, {0, 0, 0}, 502);
  Bvh tree{mesh};
  Scene scene;
  std::vector<Hit> hits;
  std::vector<SceneHit> scene_hits;

  Questions() : hits(rays.size()), scene_hits(rays.size()) {
    const std::uint32_t part = scene.add(Bvh(mesh));
    scene.place(part);
    scene.place(part, {{{0, -1, 0, 3}, {1, 0, 0, 0}, {0, 0, 1, 0}}});
    scene.update();
    tree.closest(rays, hits);
    scene.closest(rays, scene_hits);
  }
  // Whether all results equal the results of one thread.
  bool are_right(int threads) const {
    std::vector<Hit> found(rays.size());
    std::vector<SceneHit> in_scene(rays.size());
    tree.closest(rays, found, {.threads = threads});
    scene.closest(rays, in_scene, {.threads = threads});
    bool right = same_bytes(found, hits) && same_bytes(in_scene, scene_hits);
    for (std::size_t i = 0; i < rays.size(); i += 97)
      right = right && tree.occluded(rays[i]) == static_cast<bool>(hits[i]);
    return right;
  }
};

TEST(Callers, ask_one_tree_from_many_threads) {
  const Questions questions;
  std::vector<std::uint8_t> right(8, 0);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < right.size(); ++i)
    threads.emplace_back([&, i] { right[i] = questions.are_right(i % 2 == 0 ? 1 : 2) ? 1 : 0; });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::ranges::count(right, 1), 8);
}

// threads = 0 takes the threads of the arena; other numbers make an arena of their own in it.
TEST(Callers, ask_within_an_arena_of_their_own) {
  const Questions questions;
  for (const int size : {1, 2}) {
    tbb::task_arena arena(size);
    for (const int threads : {0, 1, 2})
      arena.execute([&] { EXPECT_TRUE(questions.are_right(threads)) << size << ", " << threads; });
  }
}

TEST(Callers, get_the_threads_of_their_arena_or_as_many_as_they_ask_for_and_there_are) {
  const int cores = tbb::info::default_concurrency();
  EXPECT_EQ(thread_count(1), 1);
  EXPECT_EQ(thread_count(cores + 1), cores);
  EXPECT_EQ(thread_count(0), cores);
  tbb::task_arena(1).execute([&] {
    EXPECT_EQ(thread_count(0), 1);
    EXPECT_EQ(thread_count(cores + 1), cores);
  });
}

// The second of two places that are both for callers: an arena of the call's own would have the caller in its first.
TEST(Callers, keep_work_within_their_arena) {
  constexpr auto place = tbb::this_task_arena::current_thread_index;
  std::atomic<int> parts{0}, elsewhere{0};
  const auto ask = [&] {
    ASSERT_EQ(place(), 1);
    in_parallel(200, 1, 0, [&](std::size_t, std::size_t) {
      ++parts;
      if (place() != 1) ++elsewhere;
    });
  };
  tbb::task_arena arena(2, 2);
  arena.execute([&] {
    if (place() == 1)
      ask();
    else
      std::thread([&] { arena.execute(ask); }).join();
  });
  EXPECT_GT(parts, 1);
  EXPECT_EQ(elsewhere, 0);
}

// The exit status of a child process; negative: the signal that ended it.
int status_of_child(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

// A child has none of the threads of its parent: it asks with one thread.
TEST(Callers, fork_before_and_after_threads) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "ThreadSanitizer does not follow children of processes with threads";
#endif
  const Questions questions;
  EXPECT_EQ(status_of_child([&] { return questions.are_right(1) ? 0 : 1; }), 0);
  EXPECT_TRUE(questions.are_right(2));
  EXPECT_EQ(status_of_child([&] { return questions.are_right(1) ? 0 : 1; }), 0);
}

// Decisions are exact for round to nearest only. In other roundings calls end, hits are of triangles that exist, and
// nearly all are the same.
TEST(Callers, round_otherwise) {
  const Questions questions;
  for (const Path* path : supported_paths())
    for (const int rounding : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
      std::vector<Hit> found(questions.rays.size());
      std::fesetround(rounding);
      questions.tree.closest(questions.rays, found, {.path = path});
      std::fesetround(FE_TONEAREST);
      std::size_t others = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_TRUE(!found[i] || found[i].primitive < questions.mesh.triangles.size());
        others += found[i].primitive != questions.hits[i].primitive ? 1 : 0;
      }
      EXPECT_LE(others, found.size() / 100) << path->name << ", rounding " << rounding;
    }
}

// Address space in use, after what the heap holds for later has been given back.
std::size_t address_space() {
  malloc_trim(0);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// In children with more and more memory: a clean std::bad_alloc, after which is_unchanged() holds, until it suffices.
void expect_clean(
    const char* name, const std::function<void()>& work,
    const std::function<bool()>& is_unchanged = [] { return true; }) {
  SCOPED_TRACE(name);
  int refused = 0, status = 2;
  for (std::size_t more = 0; more < std::size_t{1} << 29 && status == 2; more = more * 5 / 4 + (1 << 18)) {
    status = status_of_child([&] {
      const rlimit usual{RLIM_INFINITY, RLIM_INFINITY}, limit{address_space() + more, RLIM_INFINITY};
      setrlimit(RLIMIT_AS, &limit);
      try {
        work();
        return 0;
      } catch (const std::bad_alloc&) {
        setrlimit(RLIMIT_AS, &usual);
        return is_unchanged() ? 2 : 1;
      }
    });
    refused += status == 2 ? 1 : 0;
  }
  EXPECT_EQ(status, 0);
  EXPECT_GT(refused, 3);
}

// In a process of its own, where nothing has left room in the heap or in arenas of threads.
[[noreturn]] void run_out_of_memory() {
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, 1 << 16);  // freed arrays leave the address space
  const Mesh mesh = triangle_soup(30000, 0.05f, 503), moved = triangle_soup(30000, 0.06f, 504);
  for (const TreeBuilder builder : {TreeBuilder::binned_sah, TreeBuilder::spatial_splits})
    expect_clean("build", [&] { Bvh(mesh, {.builder = builder}); });
  Bvh tree(mesh);
  std::ostringstream file;
  tree.save(file);
  expect_clean("load", [&] {
    std::istringstream again(file.str());
    Bvh::load(again);
  });
  // A stream that runs out of memory sets its badbit, which save() reports.
  expect_clean("save", [&] {
    std::ostringstream another;
    try {
      tree.save(another);
    } catch (const std::runtime_error&) {
      throw std::bad_alloc();
    }
  });
  // A triangle that comes to life makes a build of the refit.
  Mesh dead = mesh;
  dead.triangles[5][1] = dead.triangles[5][0];
  tree = Bvh(dead);
  const std::vector<Ray> rays = mixed_rays(mesh, 100, 2, {0, 0, 0}, 505);
  std::vector<Hit> before(rays.size());
  tree.closest(rays, before);
  const auto is_unchanged = [&] {
    std::vector<Hit> hits(rays.size());
    tree.closest(rays, hits);
    return same_bytes(hits, before);
  };
  expect_clean(
      "refit", [&] { tree.refit(moved.vertices, moved.triangles); }, is_unchanged);
  std::exit(::testing::Test::HasFailure() ? 1 : 0);
}
TEST(Callers, run_out_of_memory_in_builds_refits_and_files) {
#ifdef RAYLANES_SANITIZED
  GTEST_SKIP() << "sanitizers reserve address space";
#endif
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(run_out_of_memory(), ::testing::ExitedWithCode(0), "");
  ::testing::FLAGS_gtest_death_test_style = "fast";
}

}  // namespace
}  // namespace raylanes::testing

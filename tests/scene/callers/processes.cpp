// Calls in child processes: after fork(), and with too little memory.
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <new>

#include "questions.hpp"

namespace raylanes::testing {
namespace {

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

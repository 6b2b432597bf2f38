// The path in use: resolved before main and by threads that race, forced, and by environment.
#include <atomic>
#include <thread>

#include <raylanes/paths.hpp>

#include "../support/message_of.hpp"
#include "../support/system/environment.hpp"

namespace raylanes {
namespace {

// Runs before any other dynamic initialisation of the program, that of the library included, and is the first
// to ask for the active path: from several threads at once.
struct BeforeMain {
  std::array<const Path*, 8> seen{};
  std::array<std::string, 8> error;

  BeforeMain() {
    std::atomic<int> waiting{8};
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      threads.emplace_back([this, i, &waiting] {
        --waiting;
        while (waiting != 0) std::this_thread::yield();
        try {
          seen[i] = &active_path();
        } catch (const std::invalid_argument& e) {
          error[i] = e.what();
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
};
const BeforeMain before_main __attribute__((init_priority(101)));

// Sets RAYLANES_PATH, or unsets it for null, and puts the old value back.
class ScopedEnvironment {
 public:
  explicit ScopedEnvironment(const char* value) {
    if (const char* old = std::getenv("RAYLANES_PATH")) old_ = old;
    set(value);
  }
  ~ScopedEnvironment() { set(old_ ? old_->c_str() : nullptr); }
  ScopedEnvironment(const ScopedEnvironment&) = delete;
  ScopedEnvironment& operator=(const ScopedEnvironment&) = delete;

 private:
  static void set(const char* value) { set_environment("RAYLANES_PATH", value); }
  std::optional<std::string> old_;
};

TEST(ActivePath, is_resolved_before_main_by_threads_that_race) {
  for (const std::string& error : before_main.error) EXPECT_EQ(error, "");
  const Path& expected = choose_path(machine_features(), std::getenv("RAYLANES_PATH"));
  for (const Path* path : before_main.seen) EXPECT_EQ(path, &expected);
  EXPECT_EQ(&active_path(), &expected);
}

TEST(ActivePath, can_be_forced_to_every_supported_path_and_no_other) {
  const Path& resolved = active_path();
  for (const Path& path : paths()) {
    SCOPED_TRACE(path.name);
    force_path("scalar");
    if (supported(path)) {
      force_path(path.name);
      EXPECT_EQ(&active_path(), &path);
      EXPECT_EQ(&find_path(path.name), &path);
    } else {
      EXPECT_NE(message_of<std::invalid_argument>([&] { force_path(path.name); }).find("force_path: path \""),
                std::string::npos);
      EXPECT_STREQ(active_path().name, "scalar") << "a refused name must change nothing";
    }
  }
  EXPECT_THROW(force_path("sse3"), std::invalid_argument);
  EXPECT_THROW(force_path(""), std::invalid_argument);
  unforce_path();
  EXPECT_EQ(&active_path(), &resolved);
  unforce_path();
  EXPECT_EQ(&active_path(), &resolved);
}

// The "threadsafe" style starts this program afresh for the statement, so that the child meets the
// environment set here before its own main; the child's standard error is matched.
class ActivePathInChild : public testing::Test {
 protected:
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
  void TearDown() override { testing::FLAGS_gtest_death_test_style = "fast"; }

  [[noreturn]] static void report_and_exit() {
    const auto print = [](const Path* path) { std::fprintf(stderr, "<%s>", path ? path->name : "none"); };
    print(before_main.seen[0]);
    set_environment("RAYLANES_PATH", "neither-read-nor-valid");
    print(&active_path());
    force_path("scalar");
    print(&active_path());
    unforce_path();
    print(&active_path());
    std::exit(0);
  }
};

TEST_F(ActivePathInChild, is_that_of_the_environment_kept_after_the_first_resolution) {
  for (const Path& path : paths()) {
    if (!supported(path)) continue;
    const ScopedEnvironment environment(path.name);
    const std::string name = "<" + std::string(path.name) + ">";
    EXPECT_EXIT(report_and_exit(), testing::ExitedWithCode(0), name + name + "<scalar>" + name);
  }
}

TEST_F(ActivePathInChild, is_the_best_one_without_or_with_an_empty_environment) {
  const std::string best = "<" + std::string(best_path(machine_features()).name) + ">";
  for (const char* value : {static_cast<const char*>(nullptr), ""}) {
    const ScopedEnvironment environment(value);
    EXPECT_EXIT(report_and_exit(), testing::ExitedWithCode(0), best + best + "<scalar>" + best);
  }
}

TEST_F(ActivePathInChild, an_invalid_environment_throws_every_time_unless_forced) {
  const ScopedEnvironment environment("sse3");
  EXPECT_EXIT(
      {
        std::fprintf(stderr, "<%s>", before_main.error[0].c_str());
        std::fprintf(stderr, "<%s>", message_of<std::invalid_argument>([] { active_path(); }).c_str());
        force_path("scalar");
        std::fprintf(stderr, "<%s>", active_path().name);
        std::exit(0);
      },
      testing::ExitedWithCode(0),
      "<RAYLANES_PATH: there is no path \"sse3\"; paths: scalar.*>"
      "<RAYLANES_PATH: there is no path \"sse3\"; paths: scalar.*><scalar>");
}

TEST(ActivePath, threads_that_force_and_read_see_only_valid_paths) {
  const Path& resolved = active_path();
  const Path& best = best_path(machine_features());
  constexpr int rounds = 2000;
  std::atomic<int> invalid{0};
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 8; ++thread) {
    threads.emplace_back([&, thread] {
      for (int round = 0; round < rounds; ++round) {
        if (thread == 0) force_path("scalar");
        if (thread == 1) force_path(best.name);
        if (thread == 2) unforce_path();
        const Path* seen = &active_path();
        if (seen != &resolved && seen != &best && seen != &paths().front()) ++invalid;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  unforce_path();
  EXPECT_EQ(invalid, 0);
  EXPECT_EQ(&active_path(), &resolved);
}

}  // namespace
}  // namespace raylanes

// Runs the programs it is given one after another and says how each ended: what the emulated machine runs, since
// starting it costs more than most suites. Exit status: 0 if all ended with 0, else 1.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace {

int status_of(char* program) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    char brief[] = "--gtest_brief=1";
    char* arguments[] = {program, brief, nullptr};
    execv(program, arguments);
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

int main(int count, char** arguments) {
  int failures = 0;
  for (int i = 1; i < count; ++i) {
    std::printf("suite %s\n", arguments[i]);
    const auto start = std::chrono::steady_clock::now();
    const int status = status_of(arguments[i]);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("suite %s: status %d after %.0f emulated s\n", arguments[i], status, seconds.count());
    failures += status != 0 ? 1 : 0;
  }
  return failures == 0 ? 0 : 1;
}

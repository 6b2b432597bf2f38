// First process (/init) of the emulated machine that run_avx512 boots.
//
// Contract: the initramfs holds /guest/argv, /guest/environ and /guest/cwd, each a list of
// NUL-terminated strings. argv[0] is the absolute path of the program, the rest of the list is its
// argument vector (so the list is one longer than argc). The program runs with standard output on
// the second and standard error on the third serial port. When it ends, one line goes to the first
// port, `guest-status exit N` (N = 128 + signal number when a signal ended it), or
// `guest-status error TEXT` when the program could not be started; then the emulator is stopped.
// No C++ run-time facility that can throw is used: an exception in /init is a kernel panic.

#include <fcntl.h>
#include <sys/io.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr std::size_t max_list_bytes = 1 << 20;
constexpr std::size_t max_list_entries = 4096;

// A list of C strings with the null pointer at its end, as execve wants it.
struct StringList {
  char bytes[max_list_bytes + 1];
  char* entries[max_list_entries + 1];
};

StringList arguments;
StringList environment;
StringList directory;
int status_port = -1;

// Writing to Bochs' port 0x8900 the word "Shutdown" ends the emulator at once, without ACPI.
[[noreturn]] void stop_machine() {
  constexpr unsigned short shutdown_port = 0x8900;
  tcdrain(status_port);
  // The driver counts a byte as sent when the port takes it; give the last one time to leave.
  usleep(20000);
  if (ioperm(shutdown_port, 1, 1) == 0) {
    for (const char* letter = "Shutdown"; *letter != '\0'; ++letter) {
      outb(static_cast<unsigned char>(*letter), shutdown_port);
    }
  }
  for (;;) {
    pause();
  }
}

[[noreturn]] void fail(const char* what, const char* which) {
  dprintf(status_port, "guest-status error %s %s: %s\n", what, which, std::strerror(errno));
  stop_machine();
}

// Opens a serial port without any translation of the bytes (no LF to CR LF, no echo).
int open_serial(const char* path) {
  const int port = open(path, O_RDWR | O_NOCTTY);
  termios mode{};
  if (port < 0 || tcgetattr(port, &mode) != 0) {
    fail("cannot open", path);
  }
  cfmakeraw(&mode);
  cfsetspeed(&mode, B115200);
  mode.c_cflag |= CLOCAL;
  tcsetattr(port, TCSANOW, &mode);
  return port;
}

// Fills `list` from a file of NUL-terminated strings.
void read_list(const char* path, StringList& list) {
  const int file = open(path, O_RDONLY);
  if (file < 0) {
    fail("cannot open", path);
  }
  std::size_t size = 0;
  ssize_t got = 0;
  while (size < max_list_bytes && (got = read(file, list.bytes + size, max_list_bytes - size)) > 0) {
    size += static_cast<std::size_t>(got);
  }
  close(file);
  std::size_t count = 0;
  for (std::size_t at = 0; at < size; at += std::strlen(list.bytes + at) + 1) {
    if (count == max_list_entries || size == max_list_bytes) {
      errno = E2BIG;
      fail("cannot read", path);
    }
    list.entries[count++] = list.bytes + at;
  }
  list.entries[count] = nullptr;
}

[[noreturn]] void run_program(int output, int errors) {
  const int input = open("/dev/null", O_RDONLY);
  setsid();
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  if (chdir(directory.entries[0]) != 0) {
    fail("cannot enter", directory.entries[0]);
  }
  execve(arguments.entries[0], arguments.entries + 1, environment.entries);
  fail("cannot execute", arguments.entries[0]);
}

}  // namespace

int main() {
  mount("devtmpfs", "/dev", "devtmpfs", 0, "");
  mount("proc", "/proc", "proc", 0, "");
  mount("sysfs", "/sys", "sysfs", 0, "");
  status_port = open_serial("/dev/ttyS0");
  const int output = open_serial("/dev/ttyS1");
  const int errors = open_serial("/dev/ttyS2");
  read_list("/guest/argv", arguments);
  read_list("/guest/environ", environment);
  read_list("/guest/cwd", directory);

  const pid_t program = fork();
  if (program == 0) {
    run_program(output, errors);
  }
  int status = 0;
  if (program < 0 || waitpid(program, &status, 0) != program) {
    fail("cannot run", arguments.entries[0]);
  }
  tcdrain(output);
  tcdrain(errors);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  dprintf(status_port, "guest-status exit %d\n", code);
  stop_machine();
}

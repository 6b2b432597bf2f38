#include "whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>

#include "../support/std.hpp"
#include "exits.hpp"

namespace raylanes::bench {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw OutputError(file.string() + ": cannot be written: " + why);
}
[[noreturn]] void refuse(const fs::path& file, int error) {
  refuse(file, std::strerror(error));
}

// An open file, closed at the latest when it goes out of scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  // Returns whether everything was written.
  bool write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(number_, bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) return false;
      if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  bool close() {
    const int number = number_;
    number_ = -1;
    return number < 0 || ::close(number) == 0;
  }

 private:
  int number_;
};

// The file behind all symbolic links, which need not exist. Links of /proc name open descriptors: they stay.
fs::path resolved(const fs::path& file) {
  constexpr int max_links = 40;
  fs::path at = file;
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(at, error)); ++links) {
    if (links == max_links) refuse(file, ELOOP);
    const fs::path directory = fs::canonical(at.has_parent_path() ? at.parent_path() : ".", error);
    if (directory.string().starts_with("/proc/")) return at;
    const fs::path target = fs::read_symlink(at, error);
    if (error) refuse(file, error.value());
    at = directory / target;
  }
  return at;
}

// Text that was printed before stays before these bytes, also if standard output is a plain file.
void write_in_place(const fs::path& file, std::string_view bytes) {
  std::cout.flush(), std::fflush(stdout);
  Descriptor out(open(file.c_str(), O_WRONLY | O_CLOEXEC | O_APPEND | O_NOCTTY));
  if (out.number() < 0 || !out.write(bytes) || !out.close()) refuse(file, errno);
}

mode_t mode_of_new_files() {
  const mode_t masked = umask(0);
  umask(masked);
  return 0666 & ~masked;
}

// Owner and permissions of the old file, if there is one and as far as the system allows.
void take_over(int part, const struct stat* old) {
  [[maybe_unused]] const bool is_owned = old == nullptr || fchown(part, old->st_uid, old->st_gid) == 0;
  fchmod(part, old == nullptr ? mode_of_new_files() : old->st_mode & 0777u);
}

// Replaces `target`, which is what `file` leads to.
void replace(const fs::path& file, const fs::path& target, const struct stat* old, std::string_view bytes) {
  constexpr std::string_view end = ".part";
  std::string part = (target.parent_path() / ".raylanes.XXXXXX").string().append(end);
  Descriptor out(mkostemps(part.data(), static_cast<int>(end.size()), O_CLOEXEC));
  if (out.number() < 0) refuse(file, errno);
  take_over(out.number(), old);
  const bool done = out.write(bytes) && fsync(out.number()) == 0 && out.close() &&
                    std::rename(part.c_str(), target.c_str()) == 0;
  if (done) return;
  const int error = errno;
  unlink(part.c_str());
  refuse(file, error);
}

}  // namespace

void write_whole_file(const fs::path& file, std::string_view bytes) {
  const fs::path target = resolved(file);
  struct stat old {};
  if (stat(target.c_str(), &old) != 0) {
    if (errno != ENOENT) refuse(file, errno);
    return replace(file, target, nullptr, bytes);
  }
  const bool is_descriptor = fs::is_symlink(target);
  if (is_descriptor || S_ISCHR(old.st_mode) || S_ISFIFO(old.st_mode)) return write_in_place(target, bytes);
  if (S_ISDIR(old.st_mode)) refuse(file, EISDIR);
  if (!S_ISREG(old.st_mode)) refuse(file, "it is not a plain file");
  if (access(target.c_str(), W_OK) != 0) refuse(file, errno);
  replace(file, target, &old, bytes);
}

}  // namespace raylanes::bench

// Files of the tool: replaced when they are complete, and left alone if that fails.
#include "../report/whole_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "../../tests/support/message_of.hpp"
#include "../report/exits.hpp"
#include "../support/pictures/image.hpp"
#include "temporary_folder.hpp"

namespace raylanes::bench {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), {});
}

// Files of this process may not grow beyond so many bytes, for root neither.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : old_signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_signal_);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit old_{};
  void (*old_signal_)(int);
};

// All that writes a file of more than 16 bytes.
const std::vector<std::function<void(const fs::path&)>> writers{
    [](const fs::path& file) { write_whole_file(file, std::string(1000, 'n')); },
    [](const fs::path& file) { write_png(file, 40, 30, std::vector<std::uint8_t>(3600)); }};

void expect_refused(const std::function<void()>& write, const fs::path& file) {
  const std::string message = message_of<OutputError>(write);
  EXPECT_TRUE(message.starts_with(file.string() + ": cannot be written: ")) << message;
}

TEST(WholeFile, appears_and_replaces_and_keeps_permissions) {
  const TemporaryFolder folder;
  const fs::path file = folder / "file";
  write_whole_file(file, "first");
  EXPECT_EQ(content_of(file), "first");
  EXPECT_EQ(fs::status(file).permissions(), fs::status(folder.write("other", "")).permissions());
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write | fs::perms::others_read);
  const fs::perms before = fs::status(file).permissions();
  write_whole_file(file, "");
  EXPECT_EQ(content_of(file), "");
  EXPECT_EQ(fs::status(file).permissions(), before);
  EXPECT_EQ(files_in(folder / ""), 2);
}

TEST(WholeFile, that_fails_leaves_the_old_one_and_nothing_else) {
  for (const auto& write : writers) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("file", "old"), link = folder / "link";
    fs::create_symlink("file", link);
    {
      const FileLimit limit(16);
      expect_refused([&] { write(file); }, file);
      expect_refused([&] { write(link); }, link);
      expect_refused([&] { write(folder / "new"); }, folder / "new");
    }
    EXPECT_EQ(content_of(file), "old");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(files_in(folder / ""), 2);
    write(file);
    EXPECT_NE(content_of(file), "old");
  }
}

TEST(WholeFile, follows_links_also_to_nothing_but_not_in_circles) {
  for (const auto& write : writers) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    fs::create_symlink("sub/file", folder / "link");
    fs::create_symlink("link", folder / "second");
    for (int again = 0; again < 2; ++again) {
      write(folder / "second");
      EXPECT_GT(content_of(folder / "sub" / "file").size(), 16u);
      EXPECT_TRUE(fs::is_symlink(folder / "link") && fs::is_symlink(folder / "second"));
      EXPECT_EQ(files_in(folder / "sub"), 1);
    }
    fs::create_symlink("circle", folder / "circle");
    expect_refused([&] { write(folder / "circle"); }, folder / "circle");
    EXPECT_TRUE(fs::is_symlink(folder / "circle"));
  }
}

TEST(WholeFile, refuses_folders_and_sockets) {
  for (const auto& write : writers) {
    const TemporaryFolder folder;
    const fs::path sub = folder / "sub", nowhere = folder / "missing" / "file",
                   socket_file = folder / "socket";
    fs::create_directory(sub);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::ranges::copy(socket_file.string(), address.sun_path);
    const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    for (const fs::path& file : {sub, nowhere, socket_file}) expect_refused([&] { write(file); }, file);
    close(listener);
    EXPECT_TRUE(fs::is_directory(sub));
    EXPECT_TRUE(fs::is_socket(socket_file));
    EXPECT_EQ(files_in(folder / ""), 2);
  }
}

TEST(WholeFile, is_written_into_pipes_and_descriptors) {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe", file = folder.write("file", "before ");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  write_whole_file(pipe, "through");
  char text[16]{};
  EXPECT_EQ(read(reader, text, sizeof text), 7);
  EXPECT_STREQ(text, "through");
  close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
  const int opened = open(file.c_str(), O_RDWR);
  const std::string descriptor = "/proc/self/fd/" + std::to_string(opened);
  write_whole_file(descriptor, "after");
  close(opened);
  EXPECT_EQ(content_of(file), "before after");
}

// The numbers of /dev/null and /dev/full, in a folder where they may be lost.
TEST(WholeFile, never_replaces_devices) {
  const TemporaryFolder folder;
  const fs::path null = folder / "null", full = folder / "full";
  if (mknod(null.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0 ||
      mknod(full.c_str(), S_IFCHR | 0666, makedev(1, 7)) != 0 || access(null.c_str(), W_OK) != 0)
    GTEST_SKIP() << "SKIPPED: devices cannot be made here";
  const int opened = open(null.c_str(), O_WRONLY);
  if (opened < 0) GTEST_SKIP() << "SKIPPED: devices cannot be used here";
  close(opened);
  for (const auto& write : writers) {
    write(null);
    expect_refused([&] { write(full); }, full);
    EXPECT_TRUE(fs::is_character_file(null) && fs::is_character_file(full));
  }
}

}  // namespace
}  // namespace raylanes::bench

// Files of the tool: replaced when they are complete, and left alone if that fails.
#include "../report/whole_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>

#include "../../tests/support/message_of.hpp"
#include "../report/exits.hpp"
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

void expect_refused(const fs::path& file) {
  const std::string message = message_of<OutputError>([&] { write_whole_file(file, "new"); });
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

TEST(WholeFile, follows_links_also_to_nothing_but_not_in_circles) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  fs::create_symlink("sub/file", folder / "link");
  fs::create_symlink("link", folder / "second");
  for (const std::string content : {"first", "second"}) {
    write_whole_file(folder / "second", content);
    EXPECT_EQ(content_of(folder / "sub" / "file"), content);
    EXPECT_TRUE(fs::is_symlink(folder / "link") && fs::is_symlink(folder / "second"));
    EXPECT_EQ(files_in(folder / "sub"), 1);
  }
  fs::create_symlink("circle", folder / "circle");
  expect_refused(folder / "circle");
  EXPECT_TRUE(fs::is_symlink(folder / "circle"));
}

TEST(WholeFile, refuses_folders_and_sockets) {
  const TemporaryFolder folder;
  const fs::path sub = folder / "sub", socket_file = folder / "socket";
  fs::create_directory(sub);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(socket_file.string(), address.sun_path);
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  for (const fs::path& file : {sub, folder / "missing" / "file", socket_file}) expect_refused(file);
  close(listener);
  EXPECT_TRUE(fs::is_directory(sub) && fs::is_socket(socket_file));
  EXPECT_EQ(files_in(folder / ""), 2);
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
  write_whole_file(null, "new");
  expect_refused(full);
  EXPECT_TRUE(fs::is_character_file(null) && fs::is_character_file(full));
}

}  // namespace
}  // namespace raylanes::bench

// The text of strangers on a terminal, and files of the tool: replaced when complete, and left alone if that fails.
#include "../report/whole_file.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include "../../tests/support/message_of.hpp"
#include "../report/exits.hpp"
#include "../support/readers/printable.hpp"
#include "temporary_folder.hpp"

namespace raylanes::bench {
namespace {

TEST(Printable, text_stays_and_control_characters_do_not) {
  const std::pair<std::string, std::string> cases[] = {
      {"teapot.ply × ≤ 😀", "teapot.ply × ≤ 😀"},
      {"\x1b[31mred\x1b]0;title\x07", "\\x1b[31mred\\x1b]0;title\\x07"},
      {std::string("a\0b\n\r\t\x7f", 7), "a\\x00b\\x0a\\x0d\\x09\\x7f"},
      {std::string("\xc2\x9b") + "31m", "\\xc2\\x9b31m"},     // an 8-bit escape sequence
      {"\xff\xc3", "\\xff\\xc3"},                             // no UTF-8, cut
      {"\xc0\xaf\xe0\x80\xaf", "\\xc0\\xaf\\xe0\\x80\\xaf"},  // longer than need be
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},                    // a surrogate
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"}};          // beyond the last character
  for (const auto& [given, shown] : cases) EXPECT_EQ(printable(given), shown);
  EXPECT_EQ(printable(std::string(1000, 'a') + std::string(1000, 'b'), 9), "aaaaaa…bbb");
  EXPECT_LE(printable(std::string(1 << 20, '\x1b')).size(), 4 * excerpt_length + 3);
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), {});
}

void expect_refused(const fs::path& file) {
  const fs::file_type type = fs::symlink_status(file).type();
  const std::string message = message_of<OutputError>([&] { write_whole_file(file, "new"); });
  EXPECT_TRUE(message.starts_with(file.string() + ": cannot be written: ")) << message;
  EXPECT_EQ(fs::symlink_status(file).type(), type) << file;
}

TEST(WholeFile, appears_and_replaces_behind_links_and_keeps_permissions) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  fs::create_symlink("sub/file", folder / "link");
  fs::create_symlink("link", folder / "second");
  fs::perms permissions = fs::status(folder.write("other", "")).permissions();
  for (const std::string content : {"first", ""}) {
    write_whole_file(folder / "second", content);
    EXPECT_EQ(content_of(folder / "sub/file"), content);
    EXPECT_EQ(fs::status(folder / "sub/file").permissions(), permissions);
    EXPECT_TRUE(fs::is_symlink(folder / "link") && fs::is_symlink(folder / "second"));
    EXPECT_EQ(files_in(folder / "sub"), 1);
    permissions = fs::perms::owner_read | fs::perms::owner_write | fs::perms::others_read;
    fs::permissions(folder / "sub/file", permissions);
  }
}

TEST(WholeFile, refuses_folders_sockets_and_circles) {
  const TemporaryFolder folder;
  const fs::path socket_file = folder / "socket";
  fs::create_directory(folder / "sub");
  fs::create_symlink("circle", folder / "circle");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(socket_file.string(), address.sun_path);
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  for (const char* name : {"sub", "missing/file", "socket", "circle"}) expect_refused(folder / name);
  close(listener);
  EXPECT_EQ(files_in(folder / ""), 3);
}

TEST(WholeFile, is_written_into_pipes_and_descriptors) {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe", file = folder.write("file", "before ");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK), opened = open(file.c_str(), O_RDWR);
  write_whole_file(pipe, "through");
  char text[16]{};
  EXPECT_EQ(read(reader, text, sizeof text), 7);
  EXPECT_STREQ(text, "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
  write_whole_file("/proc/self/fd/" + std::to_string(opened), "after");
  close(reader), close(opened);
  EXPECT_EQ(content_of(file), "before after");
}

// The numbers of /dev/null and /dev/full, in a folder where they may be lost.
TEST(WholeFile, never_replaces_devices) {
  const TemporaryFolder folder;
  const fs::path null = folder / "null", full = folder / "full";
  if (mknod(null.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0 ||
      mknod(full.c_str(), S_IFCHR | 0666, makedev(1, 7)) != 0 || !std::ofstream(null))
    GTEST_SKIP() << "SKIPPED: devices cannot be made or used here";
  write_whole_file(null, "new");
  expect_refused(full);
  EXPECT_TRUE(fs::is_character_file(null));
}

}  // namespace
}  // namespace raylanes::bench

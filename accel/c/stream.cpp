#include "stream.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "call.hpp"

namespace raylanes::c {

std::streamsize BufferOutput::xsputn(const char* bytes, std::streamsize count) {
  const auto n = static_cast<std::size_t>(count);
  if (size_ < capacity_ && n > 0) std::memcpy(buffer_ + size_, bytes, std::min(n, capacity_ - size_));
  size_ += n;
  return count;
}

BufferOutput::int_type BufferOutput::overflow(int_type byte) {
  const char c = traits_type::to_char_type(byte);
  if (!traits_type::eq_int_type(byte, traits_type::eof())) xsputn(&c, 1);
  return traits_type::not_eof(byte);
}

BufferInput::BufferInput(const void* bytes, std::size_t size) {
  // The buffer is never written to: there is no put area.
  char* const first = static_cast<char*>(const_cast<void*>(bytes));
  setg(first, first, first + size);
}

BufferInput::pos_type BufferInput::seekoff(off_type offset, std::ios_base::seekdir from,
                                           std::ios_base::openmode) {
  const off_type size = egptr() - eback();
  const off_type to = offset + (from == std::ios_base::beg   ? 0
                                : from == std::ios_base::end ? size
                                                             : gptr() - eback());
  if (to < 0 || to > size) return pos_type(off_type(-1));
  setg(eback(), eback() + to, egptr());
  return to;
}

BufferInput::pos_type BufferInput::seekpos(pos_type position, std::ios_base::openmode mode) {
  return seekoff(position, std::ios_base::beg, mode);
}

template <class Stream>
Stream opened(const char* name) {
  require_pointer("file", name);
  try {
    errno = 0;
    Stream stream(std::filesystem::path(reinterpret_cast<const char8_t*>(name)), std::ios::binary);
    if (stream) return stream;
  } catch (const std::system_error&) {  // Windows converts names
    refuse_named(name, "the name is not UTF-8");
  }
  refuse_named(name, errno == 0 ? "it cannot be opened" : std::generic_category().message(errno).c_str());
}
template std::ifstream opened(const char*);
template std::ofstream opened(const char*);

void refuse_named(const char* name, const char* cause) {
  std::string shown = name;
  if (shown.size() > 255) shown.replace(120, shown.size() - 240, "...");
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
  throw std::runtime_error("tree file \"" + shown + "\": " + cause);
}

}  // namespace raylanes::c

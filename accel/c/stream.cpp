#include "stream.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <streambuf>
#include <system_error>

#include "call.hpp"

namespace raylanes::c {
namespace {

// Keeps what fits into a buffer, and counts all that is written.
class BufferOutput : public std::streambuf {
 public:
  BufferOutput(void* buffer, std::size_t capacity)
      : buffer_(static_cast<char*>(buffer)), capacity_(capacity) {}
  std::size_t size() const { return size_; }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    const auto n = static_cast<std::size_t>(count);
    if (size_ < capacity_ && n > 0) std::memcpy(buffer_ + size_, bytes, std::min(n, capacity_ - size_));
    size_ += n;
    return count;
  }
  int_type overflow(int_type byte) override {
    const char c = traits_type::to_char_type(byte);
    if (!traits_type::eq_int_type(byte, traits_type::eof())) xsputn(&c, 1);
    return traits_type::not_eof(byte);
  }

 private:
  char* buffer_;
  std::size_t capacity_, size_ = 0;
};

// Reads bytes, and knows where they end.
class BufferInput : public std::streambuf {
 public:
  BufferInput(const void* bytes, std::size_t size) {
    // The buffer is never written to: there is no put area.
    char* const first = static_cast<char*>(const_cast<void*>(bytes));
    setg(first, first, first + size);
  }

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type size = egptr() - eback();
    const off_type to = offset + (from == std::ios_base::beg   ? 0
                                  : from == std::ios_base::end ? size
                                                               : gptr() - eback());
    if (to < 0 || to > size) return pos_type(off_type(-1));
    setg(eback(), eback() + to, egptr());
    return to;
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
    return seekoff(position, std::ios_base::beg, mode);
  }
};

[[noreturn]] void refuse_named(const char* name, const char* cause) {
  std::string shown = name;
  if (shown.size() > 255) shown.replace(120, shown.size() - 240, "...");
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
  throw std::runtime_error("tree file \"" + shown + "\": " + cause);
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
// Calls use(stream) of a file. Its std::runtime_error gets the name of the file.
template <class Stream, class Use>
void with_file(const char* name, const Use& use) {
  Stream stream = opened<Stream>(name);
  try {
    use(stream);
  } catch (const std::system_error&) {  // also a std::runtime_error
    throw;
  } catch (const std::runtime_error& error) {
    refuse_named(name, error.what());
  }
}

}  // namespace

void save_to_buffer(const void* object, Save save, void* buffer, std::size_t capacity, std::size_t* size) {
  require_pointer("size", size);
  checked_stride("buffer", buffer, capacity, 1, 1);
  BufferOutput output(buffer, capacity);
  std::ostream stream(&output);
  save(object, stream);
  *size = output.size();
  if (*size > capacity) throw SmallBuffer{capacity, *size};
}
void load_from_buffer(void* object, Load load, const void* bytes, std::size_t size) {
  checked_stride("bytes", bytes, size, 1, 1);
  BufferInput input(bytes, size);
  std::istream stream(&input);
  load(object, stream);
}
void save_to_file(const void* object, Save save, const char* file) {
  with_file<std::ofstream>(file, [&](std::ostream& stream) { save(object, stream); });
}
void load_from_file(void* object, Load load, const char* file) {
  with_file<std::ifstream>(file, [&](std::istream& stream) { load(object, stream); });
}

}  // namespace raylanes::c

// Streams over the caller's memory and files, for trees that are saved and loaded.
#pragma once

#include <streambuf>
#include <system_error>

#include "../standard.hpp"

namespace raylanes::c {

// Keeps what fits into a buffer, and counts all that is written.
class BufferOutput : public std::streambuf {
 public:
  BufferOutput(void* buffer, std::size_t capacity)
      : buffer_(static_cast<char*>(buffer)), capacity_(capacity) {}
  std::size_t size() const { return size_; }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override;
  int_type overflow(int_type byte) override;

 private:
  char* buffer_;
  std::size_t capacity_, size_ = 0;
};

// Reads bytes, and knows where they end.
class BufferInput : public std::streambuf {
 public:
  BufferInput(const void* bytes, std::size_t size);

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode mode) override;
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override;
};

// Opens a file, whose name is UTF-8 on every system. Throws std::runtime_error that names the file and the cause.
template <class Stream>
Stream opened(const char* name);
// Throws std::runtime_error: what is wrong with a file.
[[noreturn]] void refuse_named(const char* name, const char* cause);

// Returns use(stream) of a file. Its std::runtime_error gets the name of the file.
template <class Stream, class Use>
auto with_file(const char* name, const Use& use) {
  Stream stream = opened<Stream>(name);
  try {
    return use(stream);
  } catch (const std::system_error&) {  // also a std::runtime_error
    throw;
  } catch (const std::runtime_error& error) {
    refuse_named(name, error.what());
  }
}

}  // namespace raylanes::c

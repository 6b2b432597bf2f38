// Streams over the caller's memory, for trees that are saved and loaded.
#pragma once

#include <cstddef>
#include <streambuf>

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

}  // namespace raylanes::c

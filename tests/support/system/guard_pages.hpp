// Pages from the system, and pages that may not be touched.
#pragma once

#include <cstddef>

namespace raylanes::testing {

std::size_t page_size();

// Whole pages, readable and writable.
class Pages {
 public:
  explicit Pages(std::size_t bytes);
  ~Pages();
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  unsigned char* data() const { return first_; }
  // From now on a read or a write of these whole pages is a fault.
  void forbid(std::size_t begin, std::size_t bytes);

 private:
  [[maybe_unused]] std::size_t bytes_;
  unsigned char* first_;
};

}  // namespace raylanes::testing

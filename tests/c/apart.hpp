// Arrays with a stride that notice what a call reads or writes beside their elements.
#pragma once

#include "../support/guarded_array.hpp"

namespace raylanes::testing {

// Records `gap` bytes apart that end at a forbidden page, where C may neither read nor write more.
template <class T>
class Apart {
 public:
  explicit Apart(std::size_t n, std::size_t gap = 0)
      : size_(n),
        stride_(sizeof(T) + gap),
        bytes_(n > 0 ? n * stride_ - gap : 0, Place::before_guard),
        before_(bytes_.data(), bytes_.data() + bytes_.size()) {}
  Apart(const std::vector<T>& values, std::size_t gap) : Apart(values.size(), gap) {
    for (std::size_t i = 0; i < size_; ++i) std::memcpy(bytes_.data() + i * stride_, &values[i], sizeof(T));
  }
  void* data() { return bytes_.data(); }
  std::size_t stride() const { return stride_; }
  // The records, which are all that was written.
  std::vector<T> values() {
    std::vector<T> all(size_);
    EXPECT_TRUE(bytes_.is_intact());
    for (std::size_t i = 0; i < size_; ++i) {
      std::memcpy(static_cast<void*>(&all[i]), bytes_.data() + i * stride_, sizeof(T));
      for (std::size_t k = i * stride_ + sizeof(T); k < std::min((i + 1) * stride_, bytes_.size()); ++k)
        EXPECT_EQ(bytes_[k], before_[k]) << "byte " << k;
    }
    return all;
  }

 private:
  std::size_t size_, stride_;
  GuardedArray<unsigned char> bytes_;
  std::vector<unsigned char> before_;
};

}  // namespace raylanes::testing

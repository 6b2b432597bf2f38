// Memory of the calling thread for what lasts as long as a scope: kept for the next one, so that a batch touches no new
// pages. Scopes may lie within each other, also where a thread takes up other work meanwhile. All that threads keep is
// kept here: of a batch of trees one scope, at most 30 MB; of scenes four within each other, at most 40 MB.
#pragma once

#include "../standard.hpp"

namespace raylanes {

class Scratch {
 public:
  explicit Scratch(std::size_t bytes) {
    std::vector<Block>& blocks = blocks_of_thread();
    if (blocks.size() <= depth()) blocks.emplace_back();
    Block& block = blocks[depth()];
    const std::size_t wanted = (bytes + sizeof(Line) - 1) / sizeof(Line);
    if (block.count < wanted) {
      block.count = 0;
      block.lines.reset();  // not both at once
      block.lines.reset(new Line[wanted]);
      block.count = wanted;
    }
    next_ = reinterpret_cast<std::byte*>(block.lines.get());
    ++depth();
  }
  ~Scratch() { --depth(); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  // The next `count` elements, aligned to 64.
  template <class T>
  T* take(std::size_t count) {
    T* const here = reinterpret_cast<T*>(next_);
    next_ += bytes_of<T>(count);
    return here;
  }
  template <class T>
  static constexpr std::size_t bytes_of(std::size_t count) {
    return (count * sizeof(T) + sizeof(Line) - 1) / sizeof(Line) * sizeof(Line);
  }

 private:
  struct alignas(64) Line {
    std::byte byte[64];
  };
  struct Block {
    std::unique_ptr<Line[]> lines;
    std::size_t count = 0;
  };
  static std::vector<Block>& blocks_of_thread() {
    thread_local std::vector<Block> blocks;
    return blocks;
  }
  static std::size_t& depth() {
    thread_local std::size_t depth = 0;
    return depth;
  }

  std::byte* next_;
};

}  // namespace raylanes

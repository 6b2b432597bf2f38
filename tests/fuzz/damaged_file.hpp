// Files of trees that are damaged at random, with a checksum that covers it up.
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "bytes.hpp"

namespace raylanes::testing {

inline constexpr std::size_t checksum_at = 24, checked_from = 32;

// A file has one for each of its parts, which begin with their names.
inline void put_right_checksums(std::string& file) {
  for (std::size_t at = 0, end; at < file.size(); at = end) {
    end = std::min(file.find("raylanes ", at + 1), file.size());
    if (end - at < checked_from) continue;
    const std::uint64_t sum = XXH3_64bits(file.data() + at + checked_from, end - at - checked_from);
    std::memcpy(file.data() + at + checksum_at, &sum, sizeof sum);
  }
}

// Words of a file are counts, references, names, floats, halves of doubles.
inline void damage(Bytes& bytes, std::string& file) {
  const std::size_t at = bytes.below(std::min<std::size_t>(file.size() / 4, 65536)) * 4;
  const auto other = [&] { return bytes.below(std::min<std::size_t>(file.size() / 4, 65536)) * 4; };
  switch (bytes.below(6)) {
    case 0:
      file[at] = static_cast<char>(file[at] ^ 1 << bytes.below(8));
      break;
    case 1: {
      const auto word = bytes.chance(128) ? std::bit_cast<std::uint32_t>(bytes.number<float>())
                                          : static_cast<std::uint32_t>(bytes.below(9)) - 4;
      std::memcpy(file.data() + at, &word, sizeof word);
      break;
    }
    case 2:  // another word of the file
      std::memmove(file.data() + at, file.data() + other(), 4);
      break;
    case 3: {  // a little more, or less
      std::uint32_t word;
      std::memcpy(&word, file.data() + at, sizeof word);
      word += static_cast<std::uint32_t>(bytes.below(5)) - 2;
      std::memcpy(file.data() + at, &word, sizeof word);
      break;
    }
    case 4: {  // a node or a block again
      const std::size_t size = bytes.chance(128) ? 256 : 320, from = other();
      if (std::max(at, from) + size <= file.size()) std::memmove(file.data() + at, file.data() + from, size);
      break;
    }
    default:
      file.resize(at);
      file.append(bytes.below(400), static_cast<char>(bytes.byte()));
  }
  if (file.size() < 4) file.resize(4);
}

}  // namespace raylanes::testing

#include "printable.hpp"

namespace raylanes::bench {
namespace {

// Bytes of the character that `text` begins with, 0 if it is no UTF-8 (RFC 3629: no surrogates, no detours) or a
// control character (below 32, 127 to 159).
std::size_t character_size(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xc0u) != 0x80u) return 0;
  const std::uint8_t second = byte(1);
  const bool is_detour = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool is_beyond = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
  const bool is_control = first == 0xc2 && second < 0xa0;
  return is_detour || is_beyond || is_control ? 0 : size;
}

std::string escape(char c) {
  constexpr char digits[] = "0123456789abcdef";
  const auto byte = static_cast<std::uint8_t>(c);
  return {'\\', 'x', digits[byte >> 4], digits[byte & 15u]};
}

// The next piece to show, cut off `text`.
std::string take_piece(std::string_view& text) {
  const std::size_t size = character_size(text);
  const std::string piece = size == 0 ? escape(text[0]) : std::string(text.substr(0, size));
  text.remove_prefix(size == 0 ? 1 : size);
  return piece;
}

std::string all_pieces(std::string_view text) {
  std::string out;
  while (!text.empty()) out += take_piece(text);
  return out;
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit) {
  if (text.size() <= limit) return all_pieces(text);
  const std::size_t tail = limit / 3, head = limit - tail;
  return all_pieces(text.substr(0, head)) + "…" + all_pieces(text.substr(text.size() - tail));
}

}  // namespace raylanes::bench

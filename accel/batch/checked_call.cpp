#include "checked_call.hpp"

namespace raylanes {
namespace {

struct Addresses {
  std::uintptr_t begin, end;
};
Addresses element(const Extent& view, std::size_t i) {
  const std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(view.first) + i * view.stride;
  return {begin, begin + view.size};
}

// Whether the elements are different fields of the same records.
bool are_fields_apart(const Extent& a, const Extent& b) {
  if (a.stride != b.stride || a.stride == 0) return false;
  const std::uintptr_t of_a = element(a, 0).begin, of_b = element(b, 0).begin;
  const std::size_t behind =
      of_b >= of_a ? (of_b - of_a) % a.stride : a.stride - 1 - (of_a - of_b - 1) % a.stride;
  return behind >= a.size && behind + b.size <= a.stride;
}

}  // namespace

bool overlap(const Extent& a, const Extent& b) {
  if (a.count == 0 || b.count == 0) return false;
  if (element(a, a.count - 1).end <= element(b, 0).begin ||
      element(b, b.count - 1).end <= element(a, 0).begin)
    return false;
  if (are_fields_apart(a, b)) return false;
  for (std::size_t i = 0, j = 0; i < a.count && j < b.count;) {
    const Addresses of_a = element(a, i), of_b = element(b, j);
    if (of_a.begin < of_b.end && of_b.begin < of_a.end) return true;
    (of_a.end <= of_b.begin ? i : j) += 1;
  }
  return false;
}

void require_apart(const char* call, const char* what, const Extent& read, const Extent& results) {
  if (overlap(read, results))
    throw std::invalid_argument(std::string(call) + ": " + what +
                                " and results overlap; results need memory of their own");
}

PrimitiveView KeptApart::primitives(const PrimitiveView& given, LaneBits active, const Extent& results) {
  if (!meet(given, sizeof(std::uint32_t), 0, results)) return given;
  primitives_.resize(given.count);
  for (std::size_t i = 0; i < given.count; ++i)
    if (takes_part(active, i)) primitives_[i] = skipped_at(given, i);
  PrimitiveView copy = primitives_;
  if (given.to_instance == 0) copy.to_instance = 0;
  return copy;
}

LaneBits KeptApart::active(LaneBits given, std::size_t count, const Extent& results) {
  const std::span bits(given, given != nullptr ? (count + 7) / 8 : 0);
  if (!overlap(Extent(bits), results)) return given;
  bits_.assign(bits.begin(), bits.end());
  return bits_.data();
}

}  // namespace raylanes

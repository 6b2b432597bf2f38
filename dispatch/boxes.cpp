#include "table/boxes.hpp"

#include <raylanes/boxes.hpp>

#include "quiet_floats.hpp"
#include "selected_row.hpp"
#include "table/kernel_table.hpp"

namespace raylanes {
namespace {

const BoxRow& row_of(const char* call, const BoxOptions& options) {
  return selected_row(
      call, options, [](const KernelTable& table) -> const auto& { return table.boxes; });
}

struct Pointers {
  const float* array[6];
  explicit Pointers(const BoxArrays& b) : array{b.lo[0], b.lo[1], b.lo[2], b.hi[0], b.hi[1], b.hi[2]} {}
};

struct Numbers {
  float number[6];
  explicit Numbers(const Box& b) : number{b.lo[0], b.lo[1], b.lo[2], b.hi[0], b.hi[1], b.hi[2]} {}
};

}  // namespace

void hit_mask(const Ray& ray, const BoxArrays& boxes, std::span<std::uint8_t> bits,
              const BoxOptions& options) {
  const BoxRow& row = row_of("hit_mask", options);
  require_bits("hit_mask", bits.size(), boxes.size);
  const QuietFloats quiet;
  row.any_of_boxes(ray, Pointers(boxes).array, boxes.size, options.active, bits.data());
}

void hit_mask(const RayArrays& rays, const Box& box, std::span<std::uint8_t> bits,
              const BoxOptions& options) {
  const BoxRow& row = row_of("hit_mask", options);
  require_bits("hit_mask", bits.size(), rays.size);
  const QuietFloats quiet;
  row.any_of_rays(rays, Numbers(box).number, options.active, bits.data());
}

void intervals(const Ray& ray, const BoxArrays& boxes, std::span<std::uint8_t> bits, std::span<float> entry,
               std::span<float> exit, const BoxOptions& options) {
  const BoxRow& row = row_of("intervals", options);
  require_pairs("intervals", boxes.size, bits.size(), "entry", entry.size(), "exit", exit.size());
  const QuietFloats quiet;
  row.intervals_of_boxes(ray, Pointers(boxes).array, boxes.size, options.active, bits.data(), entry.data(),
                         exit.data());
}

void intervals(const RayArrays& rays, const Box& box, std::span<std::uint8_t> bits, std::span<float> entry,
               std::span<float> exit, const BoxOptions& options) {
  const BoxRow& row = row_of("intervals", options);
  require_pairs("intervals", rays.size, bits.size(), "entry", entry.size(), "exit", exit.size());
  const QuietFloats quiet;
  row.intervals_of_rays(rays, Numbers(box).number, options.active, bits.data(), entry.data(), exit.data());
}

}  // namespace raylanes

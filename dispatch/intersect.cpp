#include <algorithm>
#include <array>
#include <limits>

#include <raylanes/intersect.hpp>

#include "table.hpp"

namespace raylanes {
namespace {

constexpr std::size_t block = intersection_block;
constexpr float padding = std::numeric_limits<float>::quiet_NaN();  // nothing hits a NaN

bool is_active(const std::uint8_t* active, std::size_t i) {
  return active == nullptr || (active[i / 8] >> (i % 8) & 1u) != 0;
}

bool all_active(const std::uint8_t* active, std::size_t first, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    if (!is_active(active, first + i)) return false;
  return true;
}

// Elements [first, first + count) of some columns as a block of their own; what takes no part is padding.
template <std::size_t Most>
class PaddedBlock {
 public:
  PaddedBlock(Columns columns, std::size_t how_many, std::size_t first, std::size_t count,
              const std::uint8_t* active) {
    for (std::size_t c = 0; c < how_many; ++c) {
      pointers_[c] = values_[c].data();
      for (std::size_t i = 0; i < block; ++i)
        values_[c][i] = i < count && is_active(active, first + i) ? columns[c][first + i] : padding;
    }
  }
  Columns columns() const { return pointers_.data(); }

 private:
  std::array<std::array<float, block>, Most> values_;
  std::array<const float*, Most> pointers_;
};

constexpr std::size_t ray_columns = 8;
std::array<const float*, ray_columns> columns_of(const RayArrays& r) {
  return {r.origin[0],    r.origin[1],    r.origin[2], r.direction[0],
          r.direction[1], r.direction[2], r.tmin,      r.tmax};
}
RayArrays rays_of(Columns c, std::size_t size) {
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, c[6], c[7], size};
}
RayArrays rays_from(const RayArrays& rays, std::size_t first) {
  std::array<const float*, ray_columns> c = columns_of(rays);
  for (const float*& p : c) p += first;
  return rays_of(c.data(), rays.size - first);
}

// whole(first, count) for the longest runs of full and fully active blocks, part(first, count) for each other
// block.
template <class Whole, class Part>
void for_runs(std::size_t n, const std::uint8_t* active, Whole whole, Part part) {
  std::size_t first = 0;
  while (first < n) {
    std::size_t end = first;
    if (active == nullptr)
      end = n / block * block;
    else
      while (end + block <= n && all_active(active, end, block)) end += block;
    if (end > first) {
      whole(first, end - first);
      first = end;
    } else {
      part(first, std::min(block, n - first));
      first += block;
    }
  }
}

void merge_bits(const std::uint8_t* from, std::size_t first, std::size_t count, const std::uint8_t* active,
                std::uint8_t* to) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_active(active, first + i)) continue;
    const auto bit = static_cast<std::uint8_t>(1u << ((first + i) % 8));
    const bool hit = (from[i / 8] >> (i % 8) & 1u) != 0;
    std::uint8_t& byte = to[(first + i) / 8];
    byte = static_cast<std::uint8_t>(hit ? byte | bit : byte & ~bit);
  }
}

template <class T>
void merge(const T* from, std::size_t first, std::size_t count, const std::uint8_t* active, T* to) {
  for (std::size_t i = 0; i < count; ++i)
    if (is_active(active, first + i)) to[first + i] = from[i];
}

}  // namespace

void any_hits(void (*loop)(const Ray&, Columns, std::size_t, std::uint8_t*), const Ray& ray,
              Columns primitives, std::size_t columns, std::size_t n, std::uint8_t* bits,
              const std::uint8_t* active) {
  for_runs(
      n, active,
      [&](std::size_t first, std::size_t count) {
        std::array<const float*, 6> from{};
        for (std::size_t c = 0; c < columns; ++c) from[c] = primitives[c] + first;
        loop(ray, from.data(), count, bits + first / 8);
      },
      [&](std::size_t first, std::size_t count) {
        const PaddedBlock<6> padded(primitives, columns, first, count, active);
        std::uint8_t decided[block / 8];
        loop(ray, padded.columns(), block, decided);
        merge_bits(decided, first, count, active, bits);
      });
}

void any_hits(void (*loop)(const RayArrays&, std::size_t, const float*, std::uint8_t*), const RayArrays& rays,
              std::size_t n, const float* primitive, std::uint8_t* bits, const std::uint8_t* active) {
  for_runs(
      n, active,
      [&](std::size_t first, std::size_t count) {
        loop(rays_from(rays, first), count, primitive, bits + first / 8);
      },
      [&](std::size_t first, std::size_t count) {
        const PaddedBlock<ray_columns> padded(columns_of(rays).data(), ray_columns, first, count, active);
        std::uint8_t decided[block / 8];
        loop(rays_of(padded.columns(), block), block, primitive, decided);
        merge_bits(decided, first, count, active, bits);
      });
}

namespace {

// Kernels with two floats and a flag per element: boxes and spheres alike. run(first or −, …) is called with
// whole arrays or with a padded block.
template <class Out, class Loop>
void two_numbers(Loop loop, const Ray& ray, Columns primitives, std::size_t columns, std::size_t n, float* a,
                 float* b, std::uint32_t* hit, const std::uint8_t* active) {
  for_runs(
      n, active,
      [&](std::size_t first, std::size_t count) {
        std::array<const float*, 6> from{};
        for (std::size_t c = 0; c < columns; ++c) from[c] = primitives[c] + first;
        loop(ray, from.data(), count, Out{a + first, b + first, hit + first});
      },
      [&](std::size_t first, std::size_t count) {
        const PaddedBlock<6> padded(primitives, columns, first, count, active);
        float x[block], y[block];
        std::uint32_t flags[block];
        loop(ray, padded.columns(), block, Out{x, y, flags});
        merge(x, first, count, active, a);
        merge(y, first, count, active, b);
        merge(flags, first, count, active, hit);
      });
}

template <class Out, class Loop>
void two_numbers(Loop loop, const RayArrays& rays, std::size_t n, const float* primitive, float* a, float* b,
                 std::uint32_t* hit, const std::uint8_t* active) {
  for_runs(
      n, active,
      [&](std::size_t first, std::size_t count) {
        loop(rays_from(rays, first), count, primitive, Out{a + first, b + first, hit + first});
      },
      [&](std::size_t first, std::size_t count) {
        const PaddedBlock<ray_columns> padded(columns_of(rays).data(), ray_columns, first, count, active);
        float x[block], y[block];
        std::uint32_t flags[block];
        loop(rays_of(padded.columns(), block), block, primitive, Out{x, y, flags});
        merge(x, first, count, active, a);
        merge(y, first, count, active, b);
        merge(flags, first, count, active, hit);
      });
}

}  // namespace

void intervals(const BoxLoops& loops, const Ray& ray, Columns boxes, std::size_t n, const BoxHitArrays& out,
               const std::uint8_t* active) {
  two_numbers<BoxHitArrays>(loops.interval_of_boxes, ray, boxes, 6, n, out.entry, out.exit, out.hit, active);
}
void intervals(const BoxLoops& loops, const RayArrays& rays, std::size_t n, const float* box,
               const BoxHitArrays& out, const std::uint8_t* active) {
  two_numbers<BoxHitArrays>(loops.interval_of_rays, rays, n, box, out.entry, out.exit, out.hit, active);
}
void distances(const SphereLoops& loops, const Ray& ray, Columns spheres, std::size_t n,
               const SphereHitArrays& out, const std::uint8_t* active) {
  two_numbers<SphereHitArrays>(loops.distances_of_spheres, ray, spheres, 4, n, out.near, out.far, out.hit,
                               active);
}
void distances(const SphereLoops& loops, const RayArrays& rays, std::size_t n, const float* sphere,
               const SphereHitArrays& out, const std::uint8_t* active) {
  two_numbers<SphereHitArrays>(loops.distances_of_rays, rays, n, sphere, out.near, out.far, out.hit, active);
}

}  // namespace raylanes

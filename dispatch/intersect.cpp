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

void copy_corner(const TriangleArrays& t, std::size_t n, float* const* columns) {
  for (std::size_t axis = 0; axis < 3; ++axis) std::copy_n(t.corner[0][axis], n, columns[axis]);
}

void subtract_edges(const TriangleArrays& t, std::size_t n, float* const* columns) {
  for (std::size_t corner = 1; corner < 3; ++corner)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < n; ++i)
        columns[3 * corner + axis][i] = t.corner[corner][axis][i] - t.corner[0][axis][i];
}

using Double3 = std::array<double, 3>;

Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// n = e1 × e2, a = (e2 × n) / n², b = (n × e1) / n²: a·e1 = b·e2 = 1, a·e2 = b·e1 = 0. In double: the edges
// are exact there but for extreme ratios.
void barycentric_rows(const TriangleArrays& t, std::size_t n, float* const* columns) {
  for (std::size_t i = 0; i < n; ++i) {
    Double3 e1, e2;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double v0 = static_cast<double>(t.corner[0][axis][i]);
      e1[axis] = static_cast<double>(t.corner[1][axis][i]) - v0;
      e2[axis] = static_cast<double>(t.corner[2][axis][i]) - v0;
    }
    const Double3 normal = cross(e1, e2);
    const double square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
    const double inverse = square > 0.0 ? 1.0 / square : std::numeric_limits<double>::quiet_NaN();
    const Double3 a = cross(e2, normal), b = cross(normal, e1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns[3 + axis][i] = static_cast<float>(normal[axis]);
      columns[6 + axis][i] = static_cast<float>(a[axis] * inverse);
      columns[9 + axis][i] = static_cast<float>(b[axis] * inverse);
    }
  }
}

}  // namespace

void prepare_triangles(const Path& path, TriangleForm form, Grade grade, const TriangleArrays& triangles,
                       std::size_t n, const float* direction, float* const* columns) {
  copy_corner(triangles, n, columns);
  switch (form) {
    case TriangleForm::plane_edges_plain:
    case TriangleForm::plane_edges:
    case TriangleForm::moller_trumbore:
    case TriangleForm::watertight:
      for (std::size_t k = 3; k < 9; ++k) std::copy_n(triangles.corner[k / 3][k % 3], n, columns[k]);
      return;
    case TriangleForm::moller_trumbore_edges:
      return subtract_edges(triangles, n, columns);
    case TriangleForm::precomputed:
      return barycentric_rows(triangles, n, columns);
    case TriangleForm::directional: {
      subtract_edges(triangles, n, columns);
      float* const out[7] = {columns[3],  columns[4],  columns[5], columns[9],
                             columns[10], columns[11], columns[12]};
      path.kernels.triangles.prepare_directional[static_cast<std::size_t>(grade)](columns, n, direction, out);
    }
  }
}

void any_hits(void (*loop)(const Ray&, Columns, std::size_t, std::uint8_t*), const Ray& ray,
              Columns primitives, std::size_t columns, std::size_t n, std::uint8_t* bits,
              const std::uint8_t* active) {
  for_runs(
      n, active,
      [&](std::size_t first, std::size_t count) {
        std::array<const float*, max_triangle_columns> from{};
        for (std::size_t c = 0; c < columns; ++c) from[c] = primitives[c] + first;
        loop(ray, from.data(), count, bits + first / 8);
      },
      [&](std::size_t first, std::size_t count) {
        const PaddedBlock<max_triangle_columns> padded(primitives, columns, first, count, active);
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

NearestHit closest_hit(const TriangleLoops& loops, Wanted wanted, const Ray& ray, Columns triangles,
                       std::size_t columns, std::size_t n, const std::uint8_t* active) {
  const auto loop = loops.closest_of_triangles[static_cast<std::size_t>(wanted)];
  NearestHit best{{std::numeric_limits<float>::infinity(), 0, 0, no_primitive}, {0, 0, 0}};
  // Runs come in order of their primitives: an equal t later on does not win.
  const auto keep = [&](NearestHit found, std::size_t first) {
    if (found.hit.primitive == no_primitive) return;
    if (best.hit.primitive != no_primitive && !(found.hit.t < best.hit.t)) return;
    best = found;
    best.hit.primitive += static_cast<std::uint32_t>(first);
  };
  for_runs(
      n, active,
      [&](std::size_t first, std::size_t count) {
        std::array<const float*, max_triangle_columns> from{};
        for (std::size_t c = 0; c < columns; ++c) from[c] = triangles[c] + first;
        NearestHit found;
        loop(ray, from.data(), count, found);
        keep(found, first);
      },
      [&](std::size_t first, std::size_t count) {
        const PaddedBlock<max_triangle_columns> padded(triangles, columns, first, count, active);
        NearestHit found;
        loop(ray, padded.columns(), block, found);
        keep(found, first);
      });
  return best;
}

void closest_hits(const TriangleLoops& loops, Wanted wanted, const RayArrays& rays, std::size_t n,
                  const float* triangle, const HitColumns& out, const std::uint8_t* active) {
  const auto loop = loops.closest_of_rays[static_cast<std::size_t>(wanted)];
  const auto moved = [](float* p, std::size_t first) { return p == nullptr ? p : p + first; };
  for_runs(
      n, active,
      [&](std::size_t first, std::size_t count) {
        HitColumns to = out;
        for (float** p : {&to.t, &to.u, &to.v, &to.normal[0], &to.normal[1], &to.normal[2]})
          *p = moved(*p, first);
        to.hit += first;
        loop(rays_from(rays, first), count, triangle, to);
      },
      [&](std::size_t first, std::size_t count) {
        const PaddedBlock<ray_columns> padded(columns_of(rays).data(), ray_columns, first, count, active);
        float values[6][block];
        std::uint32_t hit[block];
        loop(rays_of(padded.columns(), block), block, triangle,
             {values[0], hit, values[1], values[2], {values[3], values[4], values[5]}});
        merge(values[0], first, count, active, out.t);
        merge(hit, first, count, active, out.hit);
        float* const rest[] = {out.u, out.v, out.normal[0], out.normal[1], out.normal[2]};
        const std::size_t written[] = {0, 2, 5};
        for (std::size_t k = 0; k < written[static_cast<std::size_t>(wanted)]; ++k)
          merge(values[1 + k], first, count, active, rest[k]);
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

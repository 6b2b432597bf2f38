// Any number of rays and primitives: the tables' loops with the rest padded by what nothing hits, with rays
// or primitives left out by a mask, and the preparation of triangles. Baseline code, thread-safe.
//
// `active`: null for all, else bit i % 8 of byte i / 8 says whether element i takes part. Those that do not
// may hold anything, and their outputs are left untouched; bits of an output behind the last element too.
#pragma once

#include <span>

#include <raylanes/intersections.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/triangles.hpp>

namespace raylanes {

// Yes or no, bit i % 8 of bits[i / 8] for primitive or ray i. `loop` is one of a table's any_of_…; `columns`
// the number of columns.
void any_hits(void (*loop)(const Ray&, Columns, std::size_t, std::uint8_t*), const Ray& ray,
              Columns primitives, std::size_t columns, std::size_t n, std::uint8_t* bits,
              const std::uint8_t* active = nullptr);
void any_hits(void (*loop)(const RayArrays&, std::size_t, const float*, std::uint8_t*), const RayArrays& rays,
              std::size_t n, const float* primitive, std::uint8_t* bits,
              const std::uint8_t* active = nullptr);

// Intervals of boxes, distances of spheres.
void intervals(const BoxLoops& loops, const Ray& ray, Columns boxes, std::size_t n, const BoxHitArrays& out,
               const std::uint8_t* active = nullptr);
void intervals(const BoxLoops& loops, const RayArrays& rays, std::size_t n, const float* box,
               const BoxHitArrays& out, const std::uint8_t* active = nullptr);
void distances(const SphereLoops& loops, const Ray& ray, Columns spheres, std::size_t n,
               const SphereHitArrays& out, const std::uint8_t* active = nullptr);
void distances(const SphereLoops& loops, const RayArrays& rays, std::size_t n, const float* sphere,
               const SphereHitArrays& out, const std::uint8_t* active = nullptr);

}  // namespace raylanes

// The hits that exact arithmetic gives, as fast as an oracle needs them: doubles decide what certainly misses, rational
// numbers the rest. Independent of the library.
#pragma once

#include <gmpxx.h>

#include <span>
#include <vector>

#include <raylanes/mesh.hpp>
#include <raylanes/types.hpp>

namespace raylanes::oracle {

// x rounded to nearest, of two to the even one; zero is positive.
float nearest_float(const mpq_class& x);

// Whether two weights certainly are of opposite sign, by doubles: the line misses the triangle, and so does any line
// close enough to it.
bool certainly_misses(const Ray& ray, const Triangle& triangle);

// The hit of exact_triangle, rounded once, as primitive 0; a t beyond the largest float is a miss.
Hit exact_hit(const Ray& ray, const Triangle& triangle);

// The nearest of these, of equal rounded t the smallest primitive; one for each ray.
std::vector<Hit> exact_hits(std::span<const Float3> vertices, std::span<const Index3> triangles,
                            std::span<const Ray> rays);

}  // namespace raylanes::oracle

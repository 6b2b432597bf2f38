// Built in place of embree_points.cpp where Embree is not installed: asking for it is an error.
#include <stdexcept>

#include "../rivals.hpp"

namespace raylanes::bench {

struct EmbreePoints::Scene {};

EmbreePoints::EmbreePoints(const Mesh&) {
  throw std::runtime_error("embree: this build has none (Debian: libembree-dev, then configure anew)");
}
EmbreePoints::~EmbreePoints() = default;
void EmbreePoints::closest(std::span<const Float3>, std::span<double>) const {}

}  // namespace raylanes::bench

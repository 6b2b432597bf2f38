// Built in place of embree_contender.cpp where Embree is not installed: asking for it is an error.
#include "../rivals.hpp"
#include "embree_contender.hpp"

namespace raylanes::bench {
namespace {

[[noreturn]] void refuse() {
  throw std::runtime_error("embree: this build has none (Debian: libembree-dev, then configure anew)");
}

}  // namespace

std::string embree_note() {
  refuse();
}

struct EmbreeContender::Scene {};

EmbreeContender::EmbreeContender(std::span<const Float3>, std::span<const Index3>, std::string_view,
                                 EmbreeBuild, int) {
  refuse();
}
EmbreeContender::EmbreeContender(const Parts&, bool, std::string_view, EmbreeBuild) {
  refuse();
}
EmbreeContender::~EmbreeContender() = default;
double EmbreeContender::build_seconds() const {
  refuse();
}
double EmbreeContender::move(std::span<const Float3>) {
  refuse();
}
bool EmbreeContender::native(EmbreeMode) const {
  refuse();
}
void EmbreeContender::trace(EmbreeMode, bool, const RaySet&, Answers&, std::size_t) const {
  refuse();
}
double EmbreeContender::trace_packed(EmbreeMode, bool, const RaySet&, Answers&) const {
  refuse();
}

struct EmbreeDoubles::Scene {};

EmbreeDoubles::EmbreeDoubles(const oracle::DoubleMesh&) {
  refuse();
}
EmbreeDoubles::~EmbreeDoubles() = default;
void EmbreeDoubles::closest(std::span<const RayD>, std::span<HitD>) const {
  refuse();
}
void EmbreeDoubles::occluded(std::span<const RayD>, std::span<std::uint8_t>) const {
  refuse();
}

struct EmbreePoints::Scene {};

EmbreePoints::EmbreePoints(const Mesh&) {
  refuse();
}
EmbreePoints::~EmbreePoints() = default;
void EmbreePoints::closest(std::span<const Float3>, std::span<double>) const {
  refuse();
}

struct EmbreeSpheres::Scene {};

EmbreeSpheres::EmbreeSpheres(std::span<const Sphere>, bool) {
  refuse();
}
EmbreeSpheres::~EmbreeSpheres() = default;
void EmbreeSpheres::closest(std::span<const Ray>, std::span<Hit>, bool) const {
  refuse();
}
void EmbreeSpheres::occluded(std::span<const Ray>, std::span<std::uint8_t>, bool) const {
  refuse();
}

struct EmbreeFilters::Scene {};

EmbreeFilters::EmbreeFilters(const Mesh&, bool) {
  refuse();
}
EmbreeFilters::~EmbreeFilters() = default;
void EmbreeFilters::all_hits(std::span<const Ray>, RayLists<Hit>&) const {
  refuse();
}
void EmbreeFilters::keep(std::span<const Ray>, bool, unsigned, std::span<std::uint8_t>) const {
  refuse();
}

}  // namespace raylanes::bench

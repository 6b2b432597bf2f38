// Built in place of embree_contender.cpp where Embree is not installed: asking for it is an error.
#include <stdexcept>

#include "../double_contenders.hpp"
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
EmbreeContender::~EmbreeContender() = default;
EmbreeContender::EmbreeContender(EmbreeContender&&) noexcept = default;
EmbreeContender& EmbreeContender::operator=(EmbreeContender&&) noexcept = default;
double EmbreeContender::build_seconds() const {
  refuse();
}
double EmbreeContender::move(std::span<const Float3>) {
  refuse();
}
bool EmbreeContender::native(EmbreeMode) const {
  refuse();
}
void EmbreeContender::closest(EmbreeMode, bool, std::span<const Ray>, std::span<Hit>) const {
  refuse();
}
void EmbreeContender::any(EmbreeMode, bool, std::span<const Ray>, std::span<std::uint8_t>) const {
  refuse();
}
double EmbreeContender::closest_packed(EmbreeMode, bool, std::span<const Ray>, std::span<Hit>) const {
  refuse();
}
double EmbreeContender::any_packed(EmbreeMode, bool, std::span<const Ray>, std::span<std::uint8_t>) const {
  refuse();
}
void EmbreeContender::all_hits(std::span<const Ray>, RayLists<Hit>&) const {
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

}  // namespace raylanes::bench

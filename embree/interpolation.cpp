// rtcInterpolate: values at the vertices of a primitive, and their derivatives.
#include <algorithm>
#include <cmath>

#include "geometry.hpp"

namespace embree {
namespace {

// The corners of the triangle at (u, v), and the weights of a value and its derivatives.
struct Weights {
  std::size_t vertex[3];
  float value[3], along_u[3], along_v[3];
};
Weights of_triangle(std::size_t a, std::size_t b, std::size_t c, float u, float v, float du, float dv) {
  return {{a, b, c}, {1 - u - v, u, v}, {-du, du, 0}, {-dv, 0, dv}};
}
// For the quad a, b, c, d, which is `columns` · `rows` times as small as the range of u and v.
Weights of_quad(std::size_t a, std::size_t b, std::size_t c, std::size_t d, float u, float v, float columns,
                float rows) {
  if (u + v <= 1) return of_triangle(a, b, d, u, v, columns, rows);
  return of_triangle(c, d, b, 1 - u, 1 - v, -columns, -rows);
}

Weights weights_at(const Geometry& geometry, std::uint32_t primitive, float u, float v) {
  require(primitive < geometry.primitive_count(), "invalid primitive");
  if (geometry.is_points()) return {{primitive, primitive, primitive}, {1, 0, 0}, {}, {}};
  if (geometry.type == RTC_GEOMETRY_TYPE_GRID) {
    const RTCGrid& grid = *geometry.find(RTC_BUFFER_TYPE_GRID)->at<RTCGrid>(primitive);
    require(grid.width > 1 && grid.height > 1, "invalid primitive");
    const auto columns = static_cast<float>(grid.width - 1), rows = static_cast<float>(grid.height - 1);
    // NaN becomes 0.
    const float x = std::min(std::fmax(std::floor(u * columns), 0.0f), columns - 1);
    const float y = std::min(std::fmax(std::floor(v * rows), 0.0f), rows - 1);
    const std::size_t a =
        grid.startVertexID + static_cast<std::size_t>(y) * grid.stride + static_cast<std::size_t>(x);
    return of_quad(a, a + 1, a + grid.stride + 1, a + grid.stride, u * columns - x, v * rows - y, columns,
                   rows);
  }
  const auto* corner = geometry.find(RTC_BUFFER_TYPE_INDEX)->at<std::uint32_t>(primitive);
  if (geometry.type == RTC_GEOMETRY_TYPE_TRIANGLE)
    return of_triangle(corner[0], corner[1], corner[2], u, v, 1, 1);
  return of_quad(corner[0], corner[1], corner[2], corner[3], u, v, 1, 1);
}

// `stride` floats from one value to the next in all arrays, from `first` on.
template <class Arguments>
void interpolate(const Geometry& geometry, const Arguments& out, std::uint32_t primitive, float u, float v,
                 std::size_t stride, std::size_t first) {
  require_allowed(geometry.is_mesh() || geometry.is_points(), "operation not supported for this geometry");
  const BufferView* values = geometry.find(out.bufferType, out.bufferSlot);
  require(values != nullptr, "invalid buffer");
  // Formats of floats are numbered by their sizes.
  const int floats = values->format - RTC_FORMAT_FLOAT + 1;
  require(
      out.valueCount <= std::max<std::size_t>(values->stride / 4, floats > 0 && floats <= 16 ? floats : 0),
      "too many values");
  const Weights weights = weights_at(geometry, primitive, u, v);
  const float* corner[3];
  for (int k = 0; k < 3; ++k) {
    require(weights.vertex[k] < values->count, "invalid vertex");
    corner[k] = values->at<float>(weights.vertex[k]);
  }
  const auto write = [&](float* to, const float(&weight)[3]) {
    if (to == nullptr) return;
    for (std::size_t i = 0; i < out.valueCount; ++i)
      to[i * stride + first] = weight[0] * corner[0][i] + weight[1] * corner[1][i] + weight[2] * corner[2][i];
  };
  write(out.P, weights.value), write(out.dPdu, weights.along_u), write(out.dPdv, weights.along_v);
  for (float* second : {out.ddPdudu, out.ddPdvdv, out.ddPdudv}) write(second, {0, 0, 0});
}

}  // namespace
}  // namespace embree

using namespace embree;

RTC_API void rtcInterpolate(const RTCInterpolateArguments* arguments) {
  on(arguments == nullptr ? nullptr : arguments->geometry, [&](Geometry& geometry) {
    interpolate(geometry, *arguments, arguments->primID, arguments->u, arguments->v, 1, 0);
  });
}
RTC_API void rtcInterpolateN(const RTCInterpolateNArguments* arguments) {
  on(arguments == nullptr ? nullptr : arguments->geometry, [&](Geometry& geometry) {
    const RTCInterpolateNArguments& all = *arguments;
    require_some(all.primIDs, all.u, all.v);
    const auto* valid = static_cast<const int*>(all.valid);
    for (unsigned i = 0; i < all.N; ++i)
      if (valid == nullptr || valid[i] != 0)
        interpolate(geometry, all, all.primIDs[i], all.u[i], all.v[i], all.N, i);
  });
}

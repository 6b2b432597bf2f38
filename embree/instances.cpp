// Instances: the scene that one shows, and where.
#include <cmath>

#include "scene.hpp"

namespace embree {

// A singular matrix gets rows that are not finite, where rays miss.
Matrix Matrix::inverse() const {
  double cofactor[3][3], determinant = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      cofactor[i][j] = row[a][c] * row[b][d] - row[a][d] * row[b][c];
    }
  for (int j = 0; j < 3; ++j) determinant += row[0][j] * cofactor[0][j];
  Matrix result;
  for (int i = 0; i < 3; ++i) {
    double(&r)[4] = result.row[i];
    for (int j = 0; j < 3; ++j) r[j] = cofactor[j][i] / determinant;
    r[3] = -(r[0] * row[0][3] + r[1] * row[1][3] + r[2] * row[2][3]);
  }
  return result;
}

namespace {

// The index of the number in row i, column j; three rows.
std::size_t index_in(RTCFormat format, int i, int j) {
  switch (format) {
    case RTC_FORMAT_FLOAT3X4_ROW_MAJOR:
    case RTC_FORMAT_FLOAT4X4_ROW_MAJOR:
      return static_cast<std::size_t>(i * 4 + j);
    case RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR:
      return static_cast<std::size_t>(j * 3 + i);
    case RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR:
      return static_cast<std::size_t>(j * 4 + i);
    default:
      refuse(RTC_ERROR_INVALID_OPERATION, "invalid matrix format");
  }
}

// Rounds a matrix to floats, as callers see it, and keeps it. Later time steps are ignored: a commit refuses them.
void set_matrix(Geometry& geometry, unsigned step, const Matrix& matrix) {
  require(step < RTC_MAX_TIME_STEP_COUNT, "invalid time step");
  if (step != 0) return;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j)
      geometry.to_scene.row[i][j] = static_cast<double>(static_cast<float>(matrix.row[i][j]));
  geometry.to_local = geometry.to_scene.inverse();
  geometry.is_dirty = true;
}

// Translation · rotation · scale and skew.
Matrix matrix_of(const RTCQuaternionDecomposition& q) {
  const double length =
      std::hypot(std::hypot(q.quaternion_r, q.quaternion_i), std::hypot(q.quaternion_j, q.quaternion_k));
  const double r = q.quaternion_r / length, x = q.quaternion_i / length, y = q.quaternion_j / length,
               z = q.quaternion_k / length;
  const double rotation[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - r * z), 2 * (x * z + r * y)},
                                 {2 * (x * y + r * z), 1 - 2 * (x * x + z * z), 2 * (y * z - r * x)},
                                 {2 * (x * z - r * y), 2 * (y * z + r * x), 1 - 2 * (x * x + y * y)}};
  const double scale[3][4] = {{q.scale_x, q.skew_xy, q.skew_xz, q.shift_x},
                              {0, q.scale_y, q.skew_yz, q.shift_y},
                              {0, 0, q.scale_z, q.shift_z}};
  const double translation[3] = {q.translation_x, q.translation_y, q.translation_z};
  Matrix matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      matrix.row[i][j] = j == 3 ? translation[i] : 0;
      for (int k = 0; k < 3; ++k) matrix.row[i][j] += rotation[i][k] * scale[k][j];
    }
  return matrix;
}

template <class F>
void on_instance(RTCGeometry handle, F&& f) {
  on(handle, [&](Geometry& geometry) {
    require_allowed(geometry.is_instance(), "operation only allowed for instances");
    f(geometry);
  });
}

}  // namespace
}  // namespace embree

using namespace embree;

RTC_API void rtcSetGeometryInstancedScene(RTCGeometry handle, RTCScene scene_handle) {
  on_instance(handle, [&](Geometry& geometry) {
    Scene& scene = object_of(scene_handle);
    require_same_device(geometry, scene);
    geometry.instanced = Ref<Scene>(&scene), geometry.is_dirty = true;
  });
}
RTC_API void rtcSetGeometryTransform(RTCGeometry handle, unsigned step, RTCFormat format,
                                     const void* numbers) {
  on_instance(handle, [&](Geometry& geometry) {
    require_some(numbers);
    Matrix matrix;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j)
        matrix.row[i][j] = static_cast<double>(static_cast<const float*>(numbers)[index_in(format, i, j)]);
    set_matrix(geometry, step, matrix);
  });
}
RTC_API void rtcSetGeometryTransformQuaternion(RTCGeometry handle, unsigned step,
                                               const RTCQuaternionDecomposition* parts) {
  on_instance(handle, [&](Geometry& geometry) {
    require_some(parts);
    set_matrix(geometry, step, matrix_of(*parts));
  });
}
RTC_API void rtcGetGeometryTransform(RTCGeometry handle, float, RTCFormat format, void* numbers) {
  on_instance(handle, [&](Geometry& geometry) {
    require_some(numbers);
    auto* out = static_cast<float*>(numbers);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j)
        out[index_in(format, i, j)] = static_cast<float>(geometry.to_scene.row[i][j]);
    const bool by_rows = format == RTC_FORMAT_FLOAT4X4_ROW_MAJOR;
    if (by_rows || format == RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR)
      for (int j = 0; j < 4; ++j) out[by_rows ? 12 + j : 4 * j + 3] = j == 3 ? 1.0f : 0.0f;
  });
}

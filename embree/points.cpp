// Spheres and discs, in doubles.
#include "points.hpp"

#include <cmath>

namespace embree {
namespace {

double dot(const double (&a)[3], const double (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

PointHits hits_of_point(const Geometry& geometry, std::uint32_t primitive, const RTCRay& ray) {
  PointHits hits{};
  const BufferView& vertices = *geometry.find(RTC_BUFFER_TYPE_VERTEX);
  if (primitive >= vertices.count) return hits;  // a smaller buffer since the commit
  const auto* ball = vertices.at<float>(primitive);
  const double to_centre[3] = {static_cast<double>(ball[0]) - static_cast<double>(ray.org_x),
                               static_cast<double>(ball[1]) - static_cast<double>(ray.org_y),
                               static_cast<double>(ball[2]) - static_cast<double>(ray.org_z)};
  const double direction[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
  const double squared_radius = static_cast<double>(ball[3]) * static_cast<double>(ball[3]);
  const auto add = [&](double t, double x, double y, double z) {
    if (!(t >= static_cast<double>(ray.tnear) && t <= static_cast<double>(ray.tfar))) return;
    hits.hit[hits.count++] = {static_cast<float>(t),
                              {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}};
  };
  // From the centre to the ray at t.
  const auto squared_distance = [&](double t) {
    const double way[3] = {t * direction[0] - to_centre[0], t * direction[1] - to_centre[1],
                           t * direction[2] - to_centre[2]};
    return dot(way, way);
  };
  if (geometry.type == RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT) {
    const BufferView* normals = geometry.find(RTC_BUFFER_TYPE_NORMAL);
    if (normals == nullptr || primitive >= normals->count) return hits;
    const auto* n = normals->at<float>(primitive);
    const double normal[3] = {n[0], n[1], n[2]}, t = dot(to_centre, normal) / dot(direction, normal);
    if (squared_distance(t) <= squared_radius) add(t, normal[0], normal[1], normal[2]);
    return hits;
  }
  const double length = dot(direction, direction), middle = dot(to_centre, direction) / length;
  const double nearest = squared_distance(middle);
  if (!(nearest <= squared_radius)) return hits;
  if (geometry.type == RTC_GEOMETRY_TYPE_DISC_POINT) {
    // As in Embree, a ray that begins within the ball misses.
    if (dot(to_centre, to_centre) > squared_radius) add(middle, -direction[0], -direction[1], -direction[2]);
    return hits;
  }
  const double half = std::sqrt((squared_radius - nearest) / length);
  for (const double t : {middle - half, middle + half})
    add(t, t * direction[0] - to_centre[0], t * direction[1] - to_centre[1], t * direction[2] - to_centre[2]);
  return hits;
}

}  // namespace embree

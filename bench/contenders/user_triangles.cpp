#include <raylanes/cpu_features.hpp>

#include "../../accel/mesh/bounding_boxes.hpp"
#include "scene_contenders.hpp"

namespace raylanes::bench {
namespace {

std::vector<Box> boxes_of(const Mesh& mesh) {
  std::vector<Box> boxes;
  for (const Index3& triangle : mesh.triangles) boxes.push_back(triangle_box(mesh.vertices, triangle));
  return boxes;
}

struct TriangleHit {
  float t, u, v;
  unsigned is_hit;  // 1 or 0; as wide as the others
};

// A corner and the edges from there. Without branches and without arrays, so that eight calls become one of vectors.
struct TriangleAndEdges {
  float x, y, z, e1x, e1y, e1z, e2x, e2y, e2z;
};
[[gnu::always_inline]] inline TriangleHit hit_of(const Ray& ray, const TriangleAndEdges& a) {
  const auto& [ox, oy, oz] = ray.origin;
  const auto& [dx, dy, dz] = ray.direction;
  const float px = dy * a.e2z - dz * a.e2y, py = dz * a.e2x - dx * a.e2z, pz = dx * a.e2y - dy * a.e2x;
  const float sx = ox - a.x, sy = oy - a.y, sz = oz - a.z;
  const float qx = sy * a.e1z - sz * a.e1y, qy = sz * a.e1x - sx * a.e1z, qz = sx * a.e1y - sy * a.e1x;
  const float inverse = 1.0f / (a.e1x * px + a.e1y * py + a.e1z * pz);
  const float u = (sx * px + sy * py + sz * pz) * inverse, v = (dx * qx + dy * qy + dz * qz) * inverse,
              t = (a.e2x * qx + a.e2y * qy + a.e2z * qz) * inverse;
  const unsigned is_hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= ray.tmin) & (t <= ray.tmax);
  return {t, u, v, is_hit};
}

// Some rays at a time: first all their tests, then what these found, so that no branch on a hit waits for a test.
[[gnu::always_inline]] inline void test_leaf(const std::vector<float> (&rows)[9], const LeafVisit& leaf) {
  static constexpr unsigned bit_of[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  constexpr std::size_t most = 16;
  const auto row = [&](std::size_t n) { return rows[n].data() + leaf.first; };
  const float *x = row(0), *y = row(1), *z = row(2), *e1x = row(3), *e1y = row(4), *e1z = row(5),
              *e2x = row(6), *e2y = row(7), *e2z = row(8);
  float t[most][8], u[most][8], v[most][8];
  unsigned found[most];
  for (std::size_t first = 0; first < leaf.rays.size(); first += most) {
    const auto rays = leaf.rays.subspan(first, std::min(most, leaf.rays.size() - first));
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const Ray& ray = leaf.ray[rays[r]];
      unsigned bits[8], all = 0;
      for (std::size_t k = 0; k < 8; ++k) {
        const TriangleHit hit =
            hit_of(ray, {x[k], y[k], z[k], e1x[k], e1y[k], e1z[k], e2x[k], e2y[k], e2z[k]});
        t[r][k] = hit.t, u[r][k] = hit.u, v[r][k] = hit.v, bits[k] = bit_of[k] & (0u - hit.is_hit);
      }
      for (std::size_t k = 0; k < 8; ++k) all |= bits[k];
      found[r] = all & ((1u << leaf.primitives.size()) - 1);
    }
    for (std::size_t r = 0; r < rays.size(); ++r)
      for (unsigned left = found[r]; left != 0; left &= left - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(left));
        leaf.keep(rays[r], {t[r][k], u[r][k], v[r][k], leaf.primitives[k]});
      }
  }
}
[[gnu::target("avx2")]] void test_leaf_by_avx2(const std::vector<float> (&rows)[9], const LeafVisit& leaf) {
  test_leaf(rows, leaf);
}
void test_leaf_by_baseline(const std::vector<float> (&rows)[9], const LeafVisit& leaf) {
  test_leaf(rows, leaf);
}

}  // namespace

UserTriangles::UserTriangles(const Mesh& mesh)
    : mesh_(mesh), ones_(boxes_of(mesh)), eights_(boxes_of(mesh), {.max_in_leaf = 8}) {
  for (const std::uint32_t triangle : eights_.order())
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Index3& corners = mesh.triangles[triangle];
        const float first = mesh.vertices[corners[0]][axis], at = mesh.vertices[corners[corner]][axis];
        rows_[3 * corner + axis].push_back(corner == 0 ? at : at - first);
      }
  for (std::vector<float>& row : rows_) row.resize(row.size() + 7);  // the last leaf reads eight, too
}

void UserTriangles::closest_by_rays(std::span<const Ray> rays, std::span<Hit> hits,
                                    const VisitOptions& options) const {
  const auto test = [this](std::uint32_t primitive, const Ray& ray, Hit& hit) {
    const Index3& corners = mesh_.triangles[primitive];
    const Float3 &a = mesh_.vertices[corners[0]], &b = mesh_.vertices[corners[1]],
                 &c = mesh_.vertices[corners[2]];
    const TriangleHit found = hit_of(ray, {a[0], a[1], a[2], b[0] - a[0], b[1] - a[1], b[2] - a[2],
                                           c[0] - a[0], c[1] - a[1], c[2] - a[2]});
    hit.t = found.t, hit.u = found.u, hit.v = found.v;
    return found.is_hit != 0;
  };
  ones_.closest(rays, hits, test, options);
}

void UserTriangles::closest_by_leaves(std::span<const Ray> rays, std::span<Hit> hits,
                                      const VisitOptions& options) const {
  if (machine_features().contains({CpuFeature::avx2}))
    eights_.closest(
        rays, hits, [this](const LeafVisit& leaf) { test_leaf_by_avx2(rows_, leaf); }, options);
  else
    eights_.closest(
        rays, hits, [this](const LeafVisit& leaf) { test_leaf_by_baseline(rows_, leaf); }, options);
}

void UserTriangles::visit_leaves(std::span<const Ray> rays, std::span<Hit> hits,
                                 const VisitOptions& options) const {
  eights_.closest(
      rays, hits, [](const LeafVisit&) {}, options);
}

}  // namespace raylanes::bench

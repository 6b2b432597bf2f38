// Shows how an offset changes shadows, and that triangles known by name need none: docs/crossings.md. Prints how many
// pixels change with the unit of length; with the name of a file draws both, and the shadows by name (PGM).
#include <cmath>
#include <cstdio>
#include <vector>

#include <raylanes/bvh.hpp>

using raylanes::Float3, raylanes::Hit, raylanes::Ray;
constexpr std::size_t pixels = 400;

// A box on a slope; of no height it is the slope itself, two triangles a face.
void add_box(raylanes::Mesh& mesh, float x, float y, float half, float height, float turn) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  const float c = half * std::cos(turn), s = half * std::sin(turn);
  for (const float z : {0.0f, height})
    for (const auto& [px, py] : {std::pair{x + c, y + s}, {x - s, y + c}, {x - c, y - s}, {x + s, y - c}})
      mesh.vertices.push_back({px, py, z + 0.3f * px - 0.2f * py});
  mesh.triangles.insert(mesh.triangles.end(), {{n + 4, n + 5, n + 6}, {n + 4, n + 6, n + 7}});
  for (std::uint32_t i = 0, k = 1; i < 4 && height > 0; ++i, k = (i + 1) % 4)
    mesh.triangles.insert(mesh.triangles.end(), {{n + i, n + k, n + k + 4}, {n + i, n + k + 4, n + i + 4}});
}

// Boxes in the light of a lamp, in some unit of length. Shadow rays begin so far from their surface; 0: on it, and they
// know its triangle by name.
std::vector<unsigned char> picture(float unit, float offset) {
  raylanes::Mesh mesh;
  add_box(mesh, 0, 0, 6, 0, 0.1f), add_box(mesh, 0.1f, 0.1f, 0.35f, 0.5f, 0.3f);
  add_box(mesh, -0.45f, -0.35f, 0.2f, 0.25f, 1.1f);
  for (Float3& vertex : mesh.vertices)
    for (float& x : vertex) x *= unit;
  const raylanes::Bvh bvh(mesh);
  const Float3 eye{-0.9f * unit, -1.7f * unit, 1.5f * unit}, lamp{2 * unit, 0.6f * unit, 1.7f * unit};
  std::vector<Ray> rays(pixels * pixels), shadows(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float x = static_cast<float>(i % pixels) / pixels - 0.5f,
                y = 0.5f - static_cast<float>(i / pixels) / pixels;
    rays[i] = {eye, 0, {0.9f + x + 0.3f * y, 1.6f - 0.6f * x + 0.6f * y, -1.35f + y}};
  }
  std::vector<Hit> hits(rays.size());
  bvh.closest(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    float squares = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      shadows[i].origin[axis] = eye[axis] + hits[i].t * rays[i].direction[axis];
      shadows[i].direction[axis] = lamp[axis] - shadows[i].origin[axis];
      squares += shadows[i].direction[axis] * shadows[i].direction[axis];
    }
    shadows[i].tmin = offset / std::sqrt(squares), shadows[i].tmax = 1;
  }
  raylanes::TraceOptions options;
  if (offset == 0) options.skip = hits;
  std::vector<std::uint8_t> dark(rays.size());
  bvh.occluded(shadows, dark, options);
  std::vector<unsigned char> light;
  for (std::size_t i = 0; i < rays.size(); ++i)
    light.push_back(static_cast<unsigned char>((dark[i] ? 50 : 200) + hits[i].primitive / 2 % 5 * 12));
  return light;
}

int main(int count, char** names) {
  const float small = 0x1p-6f, large = 0x1p16f, usual = 1e-3f;
  const auto leaks = picture(small, usual), acne = picture(large, usual), by_name = picture(small, 0);
  const auto differ = [](const auto& a, const auto& b) {
    std::size_t pixel = 0;
    for (std::size_t i = 0; i < a.size(); ++i) pixel += a[i] != b[i];
    return pixel;
  };
  std::printf("another unit changes %zu pixels by an offset, %zu by name\n", differ(leaks, acne),
              differ(by_name, picture(large, 0)));
  if (count < 2) return 0;
  std::FILE* const file = std::fopen(names[1], "wb");  // PGM
  std::fprintf(file, "P5 %zu %zu 255\n", 3 * pixels, pixels);
  for (std::size_t row = 0; row < pixels; ++row)
    for (const auto* one : {&leaks, &acne, &by_name})
      std::fwrite(one->data() + row * pixels, 1, pixels, file);
  return std::fclose(file);
}

// A ball that swells and shrinks: its tree follows in place, and is built anew when it has decayed.
#include "common.hpp"

using namespace example;

int main(int, char** arguments) {
  constexpr std::size_t width = 160, height = 100, frames = 4;
  const std::vector<raylanes::Ray> rays = camera_rays(width, height);
  std::vector<raylanes::Hit> hits(rays.size());
  std::vector<float> strip(frames * width * height);
  raylanes::Bvh bvh;
  int builds = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    raylanes::Mesh mesh;  // as many triangles in each frame, at other places
    append_ball(mesh, {0, 0, 0.2f}, 0.9f, 0.2f * static_cast<float>(frame), 32);
    append_floor(mesh, 4, -0.8f);
    if (frame > 0) bvh.refit(mesh.vertices, mesh.triangles);
    if (frame == 0 || bvh.decay() > 1.5) bvh = raylanes::Bvh(mesh), ++builds;
    bvh.closest(rays, hits);

    const Float3 light = unit({1, -1, 2});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::size_t column = frame * width + i % width, row = i / width;
      float& level = strip[row * frames * width + column];
      level = 0.9f;
      if (hits[i]) level = 0.2f + 0.6f * dot(normal_seen(mesh, hits[i].primitive, rays[i].direction), light);
    }
  }
  std::printf("%zu frames, %d build\n", frames, builds);
  write_png(std::string(arguments[1]) + "/motion.png", frames * width, strip);
}

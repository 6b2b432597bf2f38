// A ball that grows bumps: its tree follows in place, and is built again when it has decayed.
#include "common.hpp"

using namespace example;

int main(int, char** arguments) {
  constexpr std::size_t width = 800, height = 500;  // twice the size of a frame
  const std::vector<raylanes::Ray> rays = camera_rays(width, height);
  std::vector<raylanes::Hit> hits(rays.size());
  std::vector<float> frames[4];
  char titles[4][40];
  raylanes::Bvh bvh;
  int builds = 0;
  for (std::size_t frame = 0; frame < 4; ++frame) {
    raylanes::Mesh mesh;  // as many triangles in each frame, at other places
    append_ball(mesh, {0, 0, 0.2f}, 0.9f, 0.2f * static_cast<float>(frame), 96);
    append_floor(mesh, 4, -0.8f);
    if (frame > 0) bvh.refit(mesh.vertices, mesh.triangles);
    std::snprintf(titles[frame], sizeof titles[frame], "frame %zu, decay %.2f", frame + 1, bvh.decay());
    if (frame == 0 || bvh.decay() > 1.5) bvh = raylanes::Bvh(mesh), ++builds;
    bvh.closest(rays, hits);

    const Float3 light = unit({1, -1, 2});
    std::vector<float> levels(rays.size(), 0.9f);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (hits[i])
        levels[i] = 0.2f + 0.6f * dot(normal_seen(mesh, hits[i].primitive, rays[i].direction), light);
    frames[frame] = halved(levels, width);
  }
  std::printf("4 frames, %d builds\n", builds);
  std::vector<float> picture;  // two frames beside two
  for (std::size_t i = 0; i < width * height; ++i)
    picture.push_back(frames[2 * (i / width / (height / 2)) + i % width / (width / 2)]
                            [i / width % (height / 2) * (width / 2) + i % (width / 2)]);
  picture = in_colour(picture);
  for (std::size_t k = 0; k < 4; ++k)
    write_text(picture, width, 12 + k % 2 * width / 2, 12 + k / 2 * height / 2, 3, titles[k]);
  write_png(std::string(arguments[1]) + "/motion.png", width, picture, 3);
}

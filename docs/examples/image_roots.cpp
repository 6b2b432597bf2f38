// The square roots of a picture, which is what brightens linear light for a screen, by the bit trick and no, one and
// two Newton steps. Below each is how many of 24 bits are right.
#include "common.hpp"

using namespace example;

int main(int, char** arguments) {
  constexpr std::size_t width = 266, height = 160;
  std::vector<float> light;  // a lamp that fades, in rings
  for (std::size_t i = 0; i < width * height; ++i) {
    const float x = (static_cast<float>(i % width) - 133) / 133,
                y = (static_cast<float>(i / width) - 80) / 133;
    const float r = x * x + y * y, ring = r * 9 - std::floor(r * 9);
    light.push_back((0.75f + 0.25f * ring) / (1 + 12 * r));
  }
  std::vector<float> roots[3], rounded(light.size());
  for (std::vector<float>& root : roots) root.resize(light.size());
  raylanes::sqrt(light, roots[0], raylanes::SqrtMethod::classic_0);
  raylanes::sqrt(light, roots[1], raylanes::SqrtMethod::classic_1);
  raylanes::sqrt(light, roots[2], raylanes::SqrtMethod::classic_2);
  raylanes::sqrt(light, rounded, raylanes::Accuracy::correctly_rounded);

  std::vector<float> picture(3 * width * 2 * height);
  for (std::size_t k = 0; k < 3; ++k) {
    float most = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const float exact = rounded[i], off = std::abs(roots[k][i] - exact);
      most = std::max(most, off / exact);
      const std::size_t at = i / width * 3 * width + k * width + i % width;
      picture[at] = roots[k][i];
      picture[at + 3 * width * height] = off > 0 ? std::min(1.0f, -std::log2(off / exact) / 24) : 1;
    }
    std::printf("relative error at most %g\n", most);
  }
  write_png(std::string(arguments[1]) + "/image_roots.png", 3 * width, picture);
}

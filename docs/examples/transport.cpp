// Particles through nested solids: fuel in rods, rods in a vessel, the vessel in a box. A particle flies to the next
// crossing, whose instance and side name its new cell, or collides before. The same walk with an offset loses some.
//
// usage: transport FOLDER [STEPS]     writes transport.png, prints how many particles are lost
#include <raylanes/surface.hpp>

#include "common.hpp"

using namespace example;

// A closed prism around the z axis, from z = -1 to 1. It is convex: a ray enters it once at most.
raylanes::Mesh prism(std::uint32_t sides) {
  raylanes::Mesh mesh;
  for (std::uint32_t k = 0; k < 2 * sides; ++k) {
    const double turn = (k % sides + 0.5) * 2 * 3.141592653589793 / sides;
    const auto x = static_cast<float>(std::cos(turn)), y = static_cast<float>(std::sin(turn));
    mesh.vertices.push_back({x, y, k < sides ? -1.0f : 1.0f});
  }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = (k + 1) % sides;
    mesh.triangles.push_back({k, next, sides + next}), mesh.triangles.push_back({k, sides + next, sides + k});
    if (k > 0 && next > 0)
      mesh.triangles.push_back({0, next, k}), mesh.triangles.push_back({sides, sides + k, sides + next});
  }
  return mesh;
}

// Each instance is a cell within the cell of its parent; no two surfaces touch.
struct Model {
  static constexpr std::uint32_t none = raylanes::no_part;
  raylanes::Scene scene;
  std::vector<std::uint32_t> parent;
  std::vector<double> collisions;  // per centimetre

  Model() {
    const std::uint32_t box = scene.add(prism(4)), round = scene.add(prism(48));
    const auto add_cell = [&](std::uint32_t part, std::uint32_t around, float radius, float height, float x,
                              float y, double per_centimetre) {
      parent.push_back(around), collisions.push_back(per_centimetre);
      return scene.place(part, {{{radius, 0, 0, x}, {0, radius, 0, y}, {0, 0, height, 0}}});
    };
    const std::uint32_t world = add_cell(box, none, 12, 9, 0, 0, 0.01);
    const std::uint32_t vessel = add_cell(round, world, 7.5f, 8, 0, 0, 0.5);
    for (int row = -2; row <= 2; ++row)
      for (int column = -2; column <= 2; ++column) {
        if (std::abs(row + column) > 2) continue;  // a hexagon of 19 rods
        const float x = 2.6f * (static_cast<float>(column) + 0.5f * static_cast<float>(row));
        const float y = 2.25f * static_cast<float>(row);
        const std::uint32_t rod = add_cell(round, vessel, 0.95f, 7, x, y, 0.2);
        add_cell(round, rod, 0.8f, 6.5f, x, y, 1);
      }
    scene.update();
  }
};

class Walk {
 public:
  // offset: how far particles are put behind a crossing; 0: they keep their ray, and the triangle is skipped.
  Walk(const Model& model, std::size_t particles, float offset)
      : model_(model),
        offset_(offset),
        rays_(particles),
        last_(particles),
        cells_(particles),
        drawn_(particles) {
    for (std::size_t i = 0; i < particles; ++i) begin(i);
  }

  void step() {
    std::vector<raylanes::SceneHit> exits(rays_.size()), entries(rays_.size());
    model_.scene.closest_crossing(rays_, exits,
                                  {.threads = 0, .facing = raylanes::Facing::back, .skip = last_});
    model_.scene.closest_crossing(rays_, entries,
                                  {.threads = 0, .facing = raylanes::Facing::front, .skip = last_});
    std::vector<std::size_t> collided;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      ++steps;
      const bool leaves = exits[i] && exits[i].instance == cells_[i];
      const bool enters = entries[i] && model_.parent[entries[i].instance] == cells_[i];
      if (!leaves && !enters) {
        lost.push_back(rays_[i].origin), begin(i);
        continue;
      }
      const bool is_entry = enters && !(leaves && exits[i].t < entries[i].t);
      const raylanes::SceneHit& crossing = is_entry ? entries[i] : exits[i];
      const float flight =
          rays_[i].tmin + static_cast<float>(-std::log(random(i)) / model_.collisions[cells_[i]]);
      const Float3 here = raylanes::position(rays_[i], std::min(flight, crossing.t));
      visited.push_back(here);
      if (flight < crossing.t) {
        collided.push_back(i), set_out(i, here);
      } else {
        cells_[i] = is_entry ? crossing.instance : model_.parent[crossing.instance];
        if (cells_[i] == Model::none)
          begin(i);
        else
          go_on(i, crossing, is_entry);
      }
    }
    ask_cells(collided);
  }

  std::size_t steps = 0;
  std::vector<Float3> lost, visited;

 private:
  // Numbers in (0, 1), the same in Python: bits of a counter and the particle, mixed (Steele, Lea, Flood 2014).
  double random(std::size_t i) {
    std::uint64_t z = (i << 32 | drawn_[i]++) * 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9, z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return (static_cast<double>((z ^ z >> 31) >> 12) + 0.5) * 0x1p-52;
  }

  // In a direction of length 1: the first of eight points that lies in the unit ball, or else the last.
  void set_out(std::size_t i, const Float3& from) {
    double d[3] = {}, square = 0;
    bool is_found = false;
    for (int tried = 0; tried < 8; ++tried) {
      double p[3], of_p = 0;
      for (double& x : p) x = 2 * random(i) - 1, of_p += x * x;
      if (!is_found) std::copy(p, p + 3, d), square = of_p;
      is_found = is_found || of_p <= 1;
    }
    const double length = std::sqrt(square);
    rays_[i] = {.origin = from,
                .direction = {static_cast<float>(d[0] / length), static_cast<float>(d[1] / length),
                              static_cast<float>(d[2] / length)}};
    last_[i] = {};
  }

  // A new particle, in the fuel of some rod.
  void begin(std::size_t i) {
    const auto rods = static_cast<double>(model_.parent.size() / 2 - 1);
    cells_[i] = 3 + 2 * static_cast<std::uint32_t>(rods * random(i));
    const raylanes::Transform at = model_.scene.transform_of(cells_[i]);
    const auto between = [&](double size) { return static_cast<float>(size * (random(i) - 0.5)); };
    set_out(i, {at.row[0][3] + between(1), at.row[1][3] + between(1), between(12)});
  }

  // t of a crossing is rounded, tmin is not. Behind an entry the exit may follow at once; behind an exit nothing does.
  void go_on(std::size_t i, const raylanes::SceneHit& crossing, bool is_entry) {
    if (offset_ > 0) {
      rays_[i].origin = raylanes::position(rays_[i], crossing.t + offset_), rays_[i].tmin = 0;
    } else {
      constexpr float infinity = std::numeric_limits<float>::infinity();
      rays_[i].tmin = std::nextafter(crossing.t, is_entry ? -infinity : infinity), last_[i] = crossing;
    }
  }

  // The cells of particles that turned: where they turned was rounded, perhaps into another cell.
  void ask_cells(const std::vector<std::size_t>& turned) {
    std::vector<Float3> points;
    for (const std::size_t i : turned) points.push_back(rays_[i].origin);
    std::vector<raylanes::ContainingPart> parts(turned.size());
    model_.scene.innermost_parts(points, parts, {.threads = 0});
    for (std::size_t k = 0; k < turned.size(); ++k) {
      cells_[turned[k]] = parts[k].instance;
      if (!parts[k]) begin(turned[k]);
    }
  }

  const Model& model_;
  float offset_;
  std::vector<raylanes::Ray> rays_;
  std::vector<raylanes::SceneHit> last_;
  std::vector<std::uint32_t> cells_;
  std::vector<std::uint32_t> drawn_;
};

int main(int count, char** arguments) {
  const std::size_t wanted = count > 2 ? std::stoul(arguments[2]) : 500'000;
  constexpr std::size_t particles = 20'000, size = 320;
  const Model model;
  std::vector<float> levels(2 * size * size, 1);
  const auto pixel = [&](const Float3& p, std::size_t panel) {
    const auto at = [](float x) { return static_cast<std::size_t>((x + 9) * (size / 18.0f)); };
    return (size - 1 - at(p[1])) * 2 * size + panel * size + at(p[0]);
  };
  for (const float offset : {0.0f, 2e-3f}) {
    Walk walk(model, particles, offset);
    std::vector<std::size_t> visits(2 * size * size);
    while (walk.steps < wanted) {
      walk.step();
      for (const Float3& p : walk.visited) ++visits[pixel(p, offset > 0)];
      walk.visited.clear();
    }
    std::printf("%s: %zu steps, %zu particles lost\n", offset > 0 ? "by an offset of 0.002" : "by crossings",
                walk.steps, walk.lost.size());
    const double scale = 0.15 / static_cast<double>(wanted) * size * size;
    for (std::size_t k = 0; k < levels.size(); ++k)
      if (visits[k] > 0) {
        const double dark = 1 - 1 / (1 + scale * static_cast<double>(visits[k]));
        levels[k] = static_cast<float>(1 - (offset > 0 ? 0.3 : 1) * dark);
      }
    for (const Float3& p : walk.lost)
      for (std::size_t k = 0; k < 25; ++k) levels[pixel(p, 1) + (k / 5 - 2) * 2 * size + k % 5 - 2] = 0;
  }
  write_png(std::string(arguments[1]) + "/transport.png", 2 * size, levels);
}

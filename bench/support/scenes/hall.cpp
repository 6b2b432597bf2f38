#include "procedural.hpp"
#include "shapes.hpp"

namespace raylanes::bench {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int bays = 8;                // between columns, along z
constexpr double bay_length = 4;       // from column to column
constexpr double nave_half_width = 4;  // x of the columns
constexpr double aisle_x = 7.5;        // x of the outer walls
constexpr double niche_depth = 0.8;
constexpr double outer_x = aisle_x + niche_depth;  // floor and end walls reach behind the niches
constexpr double column_height = 5;
constexpr double column_radius = 0.45;
constexpr double arcade_top = 8;  // where the vault springs
constexpr double wall_thickness = 0.6;
constexpr double hall_length = bays * bay_length;

// Rounded alike by C libraries whose pow of doubles differ in the last bits.
double power(double x, int exponent) {
  return static_cast<double>(std::pow(static_cast<long double>(x), exponent));
}

// Near its zero, too, where C libraries that use the x87's cosine have 66 bits of pi.
double cosine(double x) {
  const double before_zero = (pi / 2 - x) + 6.123233995736766e-17;  // pi/2 has more bits
  return std::abs(before_zero) < 1e-3 ? std::sin(before_zero) : std::cos(x);
}

// A fluted shaft that swells and tapers, between a round base and a capital.
void append_column(Mesh& mesh, double x, double z) {
  append_grid(mesh, 64, 12, [=](double u, double v) {
    const double angle = 2 * pi * u;
    const double ends = std::exp(-30 * v) + std::exp(-30 * (1 - v));
    const double flute = 0.05 * std::abs(std::sin(8 * angle)) * (1 - ends);
    const double radius = column_radius * (1 - 0.15 * v * v + 0.4 * ends - flute);
    return Double3{x + radius * std::cos(angle), column_height * v, z - radius * std::sin(angle)};
  });
  const double half = 0.75;
  append_box(mesh, {x - half, 0, z - half}, {x + half, 0.2, z + half});
  append_box(mesh, {x - half, column_height - 0.25, z - half}, {x + half, column_height, z + half});
}

// The wall above one opening: two faces with a round arch cut out, and the underside of the arch.
void append_arch(Mesh& mesh, double x, double z_begin) {
  const double radius = bay_length / 2 - 0.5;
  const double middle = z_begin + bay_length / 2;
  const auto arch_z = [=](double u) { return middle - radius * std::cos(pi * u); };
  const auto arch_y = [=](double u) { return column_height + radius * std::sin(pi * u); };
  const double sides[] = {x - wall_thickness / 2, x + wall_thickness / 2};
  for (const double side : sides) {
    append_grid(mesh, 32, 6, [=](double u, double v) {
      return Double3{side, std::lerp(arch_y(u), arcade_top, v), arch_z(u)};
    });
    for (const double z : {z_begin, middle + radius})
      append_grid(mesh, 1, 6, [=](double u, double v) {
        return Double3{side, std::lerp(column_height, arcade_top, v), z + 0.5 * u};
      });
  }
  append_grid(mesh, 32, 4, [=](double u, double v) {
    return Double3{std::lerp(sides[0], sides[1], v), arch_y(u), arch_z(u)};
  });
  append_box(mesh, {x - 0.4, arcade_top - 0.2, z_begin}, {x + 0.4, arcade_top, z_begin + bay_length});
}

// A barrel vault over the nave with a rib above each column, and flat aisle ceilings.
void append_ceilings(Mesh& mesh) {
  append_grid(mesh, 36, 16 * bays, [](double u, double v) {
    const double phase = std::abs(v * bays - std::round(v * bays));
    const double radius = nave_half_width - 0.25 * std::exp(-power(phase * 16, 4));
    return Double3{-radius * cosine(pi * u), arcade_top + radius * std::sin(pi * u), hall_length * v};
  });
  for (const double side : {-1.0, 1.0})
    append_grid(mesh, 4, 4 * bays, [=](double u, double v) {
      return Double3{side * std::lerp(nave_half_width, outer_x, u), arcade_top - 0.5, hall_length * v};
    });
}

void append_floor_and_walls(Mesh& mesh) {
  append_grid(mesh, 30, 64, [](double u, double v) {
    return Double3{std::lerp(-outer_x, outer_x, u), 0, hall_length * v};
  });
  for (const double side : {-1.0, 1.0})
    append_grid(mesh, 16 * bays, 12, [=](double u, double v) {
      // A niche in each bay: the wall steps back smoothly.
      const double across = 2 * std::abs(u * bays - std::floor(u * bays) - 0.5);
      const double depth =
          niche_depth / (1 + power(across / 0.6, 12)) / (1 + power(std::abs(2 * v - 0.9) / 0.7, 12));
      return Double3{side * (aisle_x + depth), arcade_top * v, hall_length * u};
    });
  const double top = arcade_top + nave_half_width;
  for (const double z : {0.0, hall_length})
    append_grid(mesh, 24, 18, [=](double u, double v) {
      return Double3{std::lerp(-outer_x, outer_x, u), top * v, z};
    });
}

// Stairs up to a platform with an altar stone at the far end.
void append_stairs(Mesh& mesh) {
  constexpr int steps = 9;
  constexpr double rise = 0.17, tread = 0.35;
  const double foot = hall_length - 7;
  for (int i = 0; i < steps; ++i)
    append_box(mesh, {-3 + 0.1 * i, rise * i, foot + tread * i}, {3 - 0.1 * i, rise * (i + 1), hall_length});
  const double top = rise * steps;
  append_box(mesh, {-0.9, top, hall_length - 2.6}, {0.9, top + 0.9, hall_length - 1.6});
  append_icosphere(mesh, {0, top + 1.6, hall_length - 2.1}, 0.7, 3);
}

}  // namespace

Scene make_hall_scene() {
  Scene scene{"hall", {}, {{-1.6f, 2.4f, 1.5f}, {0.8f, 3.6f, 20}, {0, 1, 0}, 65}};
  Mesh& mesh = scene.mesh;
  append_floor_and_walls(mesh);
  append_ceilings(mesh);
  append_stairs(mesh);
  for (const double x : {-nave_half_width, nave_half_width}) {
    for (int i = 1; i < bays; ++i) append_column(mesh, x, i * bay_length);
    for (int i = 0; i < bays; ++i) append_arch(mesh, x, i * bay_length);
  }
  return scene;
}

}  // namespace raylanes::bench

// Particles through cells that share their faces, aimed at corners and edges: none is lost, and none goes in circles,
// if exits are taken from crossings(), as docs/crossings.md says.
#include <raylanes/doubles.hpp>
#include <raylanes/numbers.hpp>

#include "../support/level.hpp"
#include "../support/meshes.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

constexpr int side = 4;           // cubes along an axis
constexpr std::size_t none = 64;  // the cell outside

// Cubes of a lattice, each of a cell. Cells have the triangles between their cubes and others, the same numbers from
// both sides.
template <class T>
class Cells {
 public:
  using Tree = std::conditional_t<std::is_same_v<T, float>, Bvh, BvhD>;
  struct Side {
    std::size_t triangle, neighbour;
  };
  struct Cell {
    std::vector<Index3> triangles;
    std::vector<Side> sides;  // of each triangle
    Tree tree;
  };

  explicit Cells(const std::vector<std::size_t>& cell_of_cube) : cells_(none), cell_of_(cell_of_cube) {
    for (int z = 0; z <= side; ++z)
      for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x) vertices_.push_back({T(x), T(y), T(z)});
    for (int axis = 0; axis < 3; ++axis)
      for (int at = 0; at < side * side * (side + 1); ++at) add_face(axis, at);
    for (Cell& cell : cells_) cell.tree = Tree(vertices_, cell.triangles);
  }
  const Cell& operator[](std::size_t cell) const { return cells_[cell]; }
  std::size_t cell_of(int x, int y, int z) const {
    if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= side) return none;
    return cell_of_[static_cast<std::size_t>((z * side + y) * side + x)];
  }

 private:
  void add_face(int axis, int number) {
    int at[3], before[3];
    at[axis] = number % (side + 1);
    at[(axis + 1) % 3] = number / (side + 1) % side, at[(axis + 2) % 3] = number / (side + 1) / side;
    std::copy(at, at + 3, before), --before[axis];
    const std::size_t low = cell_of(before[0], before[1], before[2]), high = cell_of(at[0], at[1], at[2]);
    if (low == high) return;
    const auto corner = [&](int u, int v) {
      int c[3] = {at[0], at[1], at[2]};
      c[(axis + 1) % 3] += u, c[(axis + 2) % 3] += v;
      return static_cast<std::uint32_t>((c[2] * (side + 1) + c[1]) * (side + 1) + c[0]);
    };
    for (const Index3& t : {Index3{corner(0, 0), corner(1, 0), corner(1, 1)},
                            Index3{corner(0, 0), corner(1, 1), corner(0, 1)}}) {
      if (low != none) add(cells_[low], t, high);
      if (high != none) add(cells_[high], {t[0], t[2], t[1]}, low);
      ++count_;
    }
  }
  void add(Cell& cell, const Index3& t, std::size_t neighbour) {
    cell.triangles.push_back(t), cell.sides.push_back({count_, neighbour});
  }

  std::vector<PointOf<T>> vertices_;
  std::vector<Cell> cells_;
  std::vector<std::size_t> cell_of_;
  std::size_t count_ = 0;
};

// The place of a particle on its ray.
template <class T>
struct Place {
  std::size_t cell;
  T t;
  std::vector<std::size_t> crossed;  // triangles at this t
};

// Takes a particle to its next cell; false if there is no exit. Exits at one t come in any order, but each once: these
// lead from where the ray is before that t to where it is behind it.
template <class T>
bool leave(const Cells<T>& cells, RayOf<T> ray, Place<T>& place) {
  if (place.t > ray.tmin) ray.tmin = std::nextafter(place.t, -std::numeric_limits<T>::infinity());
  const auto exits =
      cells[place.cell].tree.crossings(RayRecords<RayOf<T>>(&ray, 1), {.facing = Facing::back});
  for (const auto& exit : exits[0]) {
    const auto& [triangle, neighbour] = cells[place.cell].sides[exit.primitive];
    if (exit.t < place.t || std::ranges::find(place.crossed, triangle) != place.crossed.end()) continue;
    if (exit.t > place.t) place.crossed.clear();
    place.crossed.push_back(triangle);
    place.cell = neighbour, place.t = exit.t;
    return true;
  }
  return false;
}

// From the middle of a cube, or a point in it, to a corner, a point of an edge, or any point of the lattice.
template <class T>
RayOf<T> aimed(const int (&cube)[3], Random& random) {
  RayOf<T> ray;
  const bool is_rounded = random.chance(0.3);
  const int kind = random.integer(0, 3);
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    ray.origin[axis] = T(cube[k]) + (is_rounded ? T(random.number(0.01f, 0.99f)) : T(0.5));
    T target = T(random.integer(0, side));
    if (kind == 1 && k == 0) target = T(random.integer(0, 8 * side)) / 8;
    if (kind == 2) target = T(random.number(0, side));
    ray.direction[axis] = target - ray.origin[axis];
  }
  return ray;
}

template <class T>
class CellsOf : public ::testing::Test {};
using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CellsOf, Numbers);

// Counts particles that do not leave the lattice where its sides are.
template <class T>
void expect_all_through(const std::vector<std::size_t>& cell_of_cube, std::uint64_t seed) {
  const Cells<T> cells(cell_of_cube);
  Random random(seed);
  std::size_t lost = 0, at_one_t = 0;
  for (std::size_t i = 0; i < by_level(200000); ++i) {
    const int cube[3] = {random.integer(0, side - 1), random.integer(0, side - 1),
                         random.integer(0, side - 1)};
    const RayOf<T> ray = aimed<T>(cube, random);
    if (ray.direction == PointOf<T>{}) continue;
    Place<T> place{cells.cell_of(cube[0], cube[1], cube[2]), 0, {}};
    for (int steps = 0; place.cell != none && steps < 400; ++steps) {
      if (!leave<T>(cells, ray, place)) break;
      at_one_t += place.crossed.size() > 1 ? 1 : 0;
    }
    // The exit of the whole lattice, in doubles.
    double end = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto o = static_cast<double>(ray.origin[k]), d = static_cast<double>(ray.direction[k]);
      if (d != 0) end = std::min(end, ((d > 0 ? side : 0) - o) / d);
    }
    const bool is_through = place.cell == none && std::abs(static_cast<double>(place.t) - end) <= 1e-6 * end;
    lost += is_through ? 0 : 1;
  }
  EXPECT_EQ(lost, 0u);
  EXPECT_GT(at_one_t, by_level(200000) / 10);
}

TYPED_TEST(CellsOf, one_cube_each_lose_no_particle) {
  std::vector<std::size_t> each(64);
  for (std::size_t i = 0; i < each.size(); ++i) each[i] = i;
  expect_all_through<TypeParam>(each, 231);
}

// Cells of cubes anywhere: not convex, in several pieces, touching themselves along edges.
TYPED_TEST(CellsOf, any_cubes_lose_no_particle) {
  for (const int count : {2, 5, 20}) {
    Random random(232 + static_cast<std::uint64_t>(count));
    std::vector<std::size_t> any(64);
    for (std::size_t& cell : any) cell = static_cast<std::size_t>(random.integer(0, count - 1));
    expect_all_through<TypeParam>(any, 233);
  }
}

}  // namespace
}  // namespace raylanes::testing

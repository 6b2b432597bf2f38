// A tree of one's own: eight boxes a node and up to eight triangles a leaf, which a prepared ray walks.
#include <bit>
#include <numeric>

#include "../common.hpp"
using namespace example;
struct alignas(64) Node {
  float lo[3][8], hi[3][8];
  std::uint32_t child[8];  // a node times 16, or a leaf times 16 and the number of its triangles
  raylanes::BoxArrays boxes() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}, 8}; }
};
struct alignas(64) Leaf {
  float corner[9][8];
  std::uint32_t primitive[8];
  raylanes::TriangleArrays triangles(std::size_t size) const {
    const auto& c = corner;
    return {{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}}, size};
  }
};
struct Part {  // of the triangles in their order
  std::size_t begin, end;
  Bounds box;
  bool fits_leaf() const { return end - begin <= 8; }
};

class Tree {
 public:
  explicit Tree(const raylanes::Mesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    for (const auto& corners : mesh.triangles) {
      boxes_.emplace_back();
      for (const std::uint32_t v : corners) boxes_.back().add({mesh.vertices[v], mesh.vertices[v]});
    }
    make_node(part_of(0, order_.size()));
  }
  raylanes::Hit closest(const raylanes::Ray& ray) const {
    raylanes::PreparedRay prepared(ray);
    raylanes::Hit best;
    float entry_of[256];  // of those that wait
    std::uint32_t waiting[256];
    std::size_t size = 0;
    for (std::uint32_t next = 0;;) {
      if (const std::uint32_t triangles = next % 16; triangles == 0) {
        const Node& node = nodes_[next / 16];
        float entry[8];
        const std::size_t first = size;
        for (auto met = hits(prepared, node.boxes(), entry); met != 0; met &= met - 1) {
          const auto i = static_cast<std::size_t>(std::countr_zero(met));
          std::size_t at = size++;  // the nearest last
          for (; at > first && entry_of[at - 1] < entry[i]; --at)
            entry_of[at] = entry_of[at - 1], waiting[at] = waiting[at - 1];
          entry_of[at] = entry[i], waiting[at] = node.child[i];
        }
      } else {
        const Leaf& leaf = leaves_[next / 16];
        raylanes::Hit hit = closest_hit(prepared, leaf.triangles(triangles));
        if (hit) hit.primitive = leaf.primitive[hit.primitive];
        if (hit.t < best.t || (hit.t == best.t && hit.primitive < best.primitive))
          best = hit, prepared.set_tmax(hit.t);
      }
      do {
        if (size == 0) return best;
      } while (entry_of[--size] > best.t);
      next = waiting[size];
    }
  }

 private:
  Part part_of(std::size_t begin, std::size_t end) const {
    Part part{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) part.box.add(boxes_[order_[i]]);
    return part;
  }
  // Sorts a part along one of the axes, and returns where the sum of area · triangles of both sides is least.
  std::size_t place_of_cut(const Part& part) {
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::size_t best = 0, best_axis = 0;
    float least = 1e30f;
    for (const int step : {0, 1, 2, 3}) {  // the last along the best axis again
      const std::size_t axis = step < 3 ? static_cast<std::size_t>(step) : best_axis;
      const auto middle = [&](std::uint32_t i) { return boxes_[i].lo[axis] + boxes_[i].hi[axis]; };
      std::sort(at(part.begin), at(part.end), [&](auto a, auto b) { return middle(a) < middle(b); });
      std::vector<float> cost(part.end - part.begin);
      Bounds below, above;
      for (std::size_t i = 1; i < cost.size(); ++i)
        below.add(boxes_[*at(part.begin + i - 1)]), cost[i] = below.area() * static_cast<float>(i);
      for (std::size_t i = cost.size(); --i > 0;) {
        above.add(boxes_[*at(part.begin + i)]), cost[i] += above.area() * static_cast<float>(cost.size() - i);
        if (cost[i] < least) least = cost[i], best = part.begin + i, best_axis = axis;
      }
    }
    return best;
  }
  // Cuts the part with the largest box until there are eight, or all fit into leaves.
  std::uint32_t make_node(const Part& whole) {
    std::vector<Part> parts{whole};
    const auto size = [](const Part& part) { return part.fits_leaf() ? 0 : part.box.area(); };
    while (parts.size() < 8) {
      Part& largest = *std::ranges::max_element(parts, {}, size);
      if (largest.fits_leaf()) break;
      const std::size_t cut = place_of_cut(largest), end = largest.end;
      largest = part_of(largest.begin, cut), parts.push_back(part_of(cut, end));
    }
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    parts.resize(8);  // empty boxes are never hit
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        nodes_[index].lo[k][i] = parts[i].box.lo[k], nodes_[index].hi[k][i] = parts[i].box.hi[k];
      const std::uint32_t child = parts[i].fits_leaf() ? make_leaf(parts[i]) : make_node(parts[i]);
      nodes_[index].child[i] = child;
    }
    return static_cast<std::uint32_t>(16 * index);
  }
  std::uint32_t make_leaf(const Part& part) {
    Leaf& leaf = leaves_.emplace_back();
    const std::size_t size = part.end - part.begin;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t triangle = leaf.primitive[i] = order_[part.begin + i];
      for (std::size_t k = 0; k < 9; ++k)
        leaf.corner[k][i] = mesh_.vertices[mesh_.triangles[triangle][k / 3]][k % 3];
    }
    return static_cast<std::uint32_t>(16 * (leaves_.size() - 1) + size);
  }

  const raylanes::Mesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Bounds> boxes_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

int main(int, char** arguments) {
  raylanes::Mesh mesh;
  append_floor(mesh, 3, -1);
  for (const float k : {0.0f, 1.0f, 2.0f, 3.0f, 4.0f})
    append_ball(mesh, {0.9f * k - 1.8f, 0, -0.6f}, 0.4f, 0.05f * k, 32);
  const Tree tree(mesh);
  std::vector<float> levels;
  for (const raylanes::Ray& ray : camera_rays(1600, 1000)) {
    const raylanes::Hit hit = tree.closest(ray);
    levels.push_back(hit ? -dot(normal_seen(mesh, hit.primitive, ray.direction), unit(ray.direction))
                         : 0.95f);
  }
  write_png(std::string(arguments[1]) + "/own_tree.png", 800, halved(levels, 1600));
}

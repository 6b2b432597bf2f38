// rtcPointQuery: a callback for each primitive near a point, which may shrink the radius.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scene.hpp"

namespace embree {
namespace {

using raylanes::Float3;

// The space of a tree as seen by a query in the scene.
struct Space {
  double point[3];  // the query's point in this space
  float scale = 1;  // lengths here of 1 in the scene, for similarities; 0 otherwise
  Matrix to_scene;
};
Space scene_space(const RTCPointQuery& query) {
  return {{query.x, query.y, query.z}, 1, {}};
}
Space instance_space(const Geometry& instance, const RTCPointQuery& query) {
  Space space{{}, 0, instance.to_scene};
  const double at[3] = {query.x, query.y, query.z};
  instance.to_local.move_point(at, space.point);
  double length[3], product[3];
  for (int c = 0; c < 3; ++c) {
    length[c] = product[c] = 0;
    for (const auto& row : instance.to_local.row)
      length[c] += row[c] * row[c], product[c] += row[c] * row[(c + 1) % 3];
  }
  const auto is_about = [&](double a, double b) { return std::abs(a - b) < 1e-5 * length[0]; };
  bool is_similar = true;
  for (int c = 0; c < 3; ++c)
    is_similar = is_similar && is_about(length[c], length[0]) && is_about(product[c], 0);
  if (is_similar) space.scale = static_cast<float>(std::sqrt(length[0]));
  return space;
}

// Triangle i spans box i, enlarged so that it has an area. Boxes that no ray visits are left out as points.
bool is_visited(const raylanes::Box& box) {
  const auto is_finite = [](float x) { return std::isfinite(x); };
  return !is_empty(box) && std::ranges::all_of(box.lo, is_finite) && std::ranges::all_of(box.hi, is_finite);
}
raylanes::Bvh tree_of_boxes(const std::vector<raylanes::Box>& boxes) {
  std::vector<Float3> corners;
  std::vector<raylanes::Index3> triangles;
  for (const raylanes::Box& box : boxes) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    triangles.push_back({first, first + 1, first + 2});
    Float3 lo{}, hi{};
    for (std::size_t k = 0; k < 3 && is_visited(box); ++k) {
      const float margin = 0x1p-20f * std::max(std::abs(box.lo[k]), std::abs(box.hi[k])) + 0x1p-100f;
      constexpr float end = std::numeric_limits<float>::max();
      lo[k] = std::max(box.lo[k] - margin, -end), hi[k] = std::min(box.hi[k] + margin, end);
    }
    corners.insert(corners.end(), {lo, hi, {hi[0], lo[1], lo[2]}});
  }
  return raylanes::Bvh(corners, triangles);
}

class Search {
 public:
  Search(RTCPointQuery& query, RTCPointQueryContext& context, RTCPointQueryFunction function, void* user)
      : query_(query), context_(context), function_(function), user_(user) {}

  bool has_changed() const { return has_changed_; }
  void visit(const Built& built, const Space& space) {
    visit_triangles(built, space);
    visit_things(built, space);
  }

 private:
  static constexpr std::size_t width = raylanes::tree_width;
  using Bounds = float[3][width];

  // Squared distances to eight boxes. In a space that is no similarity, to the boxes around them in the scene.
  void find_distances(const Space& space, const Bounds& lo, const Bounds& hi, double (&sum)[width]) const {
    std::fill(sum, sum + width, 0.0);
    const auto add = [](double& all, double low, double high, double at) {
      const double below = low - at, above = at - high, way = below > above ? below : above;
      all += way > 0 ? way * way : 0;
    };
    const double at[3] = {query_.x, query_.y, query_.z}, scale = static_cast<double>(space.scale);
    for (std::size_t i = 0; i < 3; ++i) {
      if (scale != 0) {
        for (std::size_t k = 0; k < width; ++k)
          add(sum[k], static_cast<double>(lo[i][k]), static_cast<double>(hi[i][k]), space.point[i]);
        continue;
      }
      const double(&row)[4] = space.to_scene.row[i];
      for (std::size_t k = 0; k < width; ++k) {
        double low = row[3], high = row[3];
        for (std::size_t j = 0; j < 3; ++j) {
          const double a = row[j] * static_cast<double>(lo[j][k]), b = row[j] * static_cast<double>(hi[j][k]);
          low += std::min(a, b), high += std::max(a, b);
        }
        add(sum[k], low, high, at[i]);
      }
    }
    if (scale != 0)
      for (double& all : sum) all /= scale * scale;
  }
  // For the roundings of boxes, points and radii. A primitive too many does no harm.
  bool is_near(double squared_distance) const {
    const double radius = static_cast<double>(query_.radius);
    return radius >= 0 && squared_distance <= radius * radius * (1 + 1e-6);
  }

  void ask(const Part& part, std::uint32_t primitive, float scale) {
    RTCPointQueryFunctionArguments arguments{};
    arguments.query = &query_, arguments.userPtr = user_, arguments.context = &context_;
    arguments.primID = primitive, arguments.geomID = part.id, arguments.similarityScale = scale;
    for (const RTCPointQueryFunction function : {part.geometry->point_query, function_})
      if (function != nullptr && function(&arguments)) has_changed_ = true;
  }

  // Calls visit(primitive) for the near primitives of a tree, nearer ones first.
  template <class Visit>
  void walk(const raylanes::BvhView& tree, const Space& space, Visit&& visit) {
    struct Child {
      double distance;
      raylanes::TreeReference reference;
    };
    std::vector<Child> stack;
    stack.reserve(64);
    if (tree.root != raylanes::empty_reference) stack.push_back({0, tree.root});
    double distance[width];
    while (!stack.empty()) {
      const Child child = stack.back();
      stack.pop_back();
      if (!is_near(child.distance)) continue;
      if (raylanes::refers_to_leaf(child.reference)) {
        visit_leaf(space, tree.leaves[raylanes::leaf_of(child.reference).block], visit);
        continue;
      }
      const raylanes::WideNode& node = tree.nodes[child.reference];
      find_distances(space, node.lo, node.hi, distance);
      const auto begin = static_cast<std::ptrdiff_t>(stack.size());
      for (std::size_t k = 0; k < width; ++k)
        if ((node.occupied >> k & 1) != 0 && is_near(distance[k]))
          stack.push_back({distance[k], node.child[k]});
      std::sort(stack.begin() + begin, stack.end(),
                [](const Child& a, const Child& b) { return a.distance > b.distance; });
    }
  }
  template <class Visit>
  void visit_leaf(const Space& space, const raylanes::LeafBlock<9>& leaf, Visit&& visit) {
    Bounds lo, hi;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < width; ++k) {
        const float a = leaf.number[i][k], b = leaf.number[3 + i][k], c = leaf.number[6 + i][k];
        lo[i][k] = std::min(std::min(a, b), c), hi[i][k] = std::max(std::max(a, b), c);
      }
    double distance[width];
    find_distances(space, lo, hi, distance);
    for (std::size_t k = 0; k < width; ++k)
      if (leaf.primitive[k] != raylanes::no_primitive && is_near(distance[k])) visit(leaf.primitive[k]);
  }

  void visit_triangles(const Built& built, const Space& space) {
    const Face* last = nullptr;
    walk(std::as_const(*built.mesh).view(), space, [&](std::uint32_t triangle) {
      const Face& face = built.faces[triangle];
      // A quad or a grid is asked about once if its triangles follow one another.
      const bool is_again = last != nullptr && last->part == face.part && last->primitive == face.primitive;
      last = &face;
      if (!is_again) ask(built.parts[face.part], face.primitive, space.scale);
    });
  }
  void visit_things(const Built& built, const Space& space) {
    if (built.things.empty()) return;
    std::call_once(built.is_box_tree_made, [&] { built.box_tree = tree_of_boxes(built.boxes); });
    walk(std::as_const(built.box_tree).view(), space, [&](std::uint32_t i) {
      const Thing& thing = built.things[i];
      const Part& part = built.parts[thing.part];
      if (part.geometry->is_user()) ask(part, thing.primitive, space.scale);
      if (thing.instanced != nullptr && context_.instStackSize == 0) visit_instance(part, *thing.instanced);
    });
  }
  void visit_instance(const Part& part, const Built& of) {
    const Geometry& instance = *part.geometry;
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) {
        const double last = c == 3 ? 1 : 0;
        context_.world2inst[0][c * 4 + r] = static_cast<float>(r == 3 ? last : instance.to_local.row[r][c]);
        context_.inst2world[0][c * 4 + r] = static_cast<float>(r == 3 ? last : instance.to_scene.row[r][c]);
      }
    context_.instID[0] = part.id, context_.instStackSize = 1;
    visit(of, instance_space(instance, query_));
    context_.instID[0] = RTC_INVALID_GEOMETRY_ID, context_.instStackSize = 0;
  }

  RTCPointQuery& query_;
  RTCPointQueryContext& context_;
  RTCPointQueryFunction function_;
  void* user_;
  bool has_changed_ = false;
};

bool query_one(RTCScene handle, RTCPointQuery* query, RTCPointQueryContext* context,
               RTCPointQueryFunction function, void* user) {
  return on(handle, [&](Scene& scene) {
    require_some(query, context);
    Search search(*query, *context, function, user);
    search.visit(*scene.built, scene_space(*query));
    return search.has_changed();
  });
}

template <int lanes, class Packet>
bool query_packet(const int* valid, RTCScene handle, Packet* points, RTCPointQueryContext* context,
                  RTCPointQueryFunction function, void** user) {
  return on(handle, [&](Scene&) {
    require_some(valid, points);
    bool has_changed = false;
    for (int i = 0; i < lanes; ++i) {
      if (valid[i] == 0) continue;
      RTCPointQuery one{points->x[i], points->y[i], points->z[i], points->time[i], points->radius[i]};
      has_changed |= query_one(handle, &one, context, function, user == nullptr ? nullptr : user[i]);
      points->radius[i] = one.radius;
    }
    return has_changed;
  });
}

}  // namespace
}  // namespace embree

using namespace embree;

RTC_API bool rtcPointQuery(RTCScene scene, RTCPointQuery* query, RTCPointQueryContext* context,
                           RTCPointQueryFunction function, void* user) {
  return query_one(scene, query, context, function, user);
}
RTC_API bool rtcPointQuery4(const int* valid, RTCScene scene, RTCPointQuery4* query,
                            RTCPointQueryContext* context, RTCPointQueryFunction function, void** user) {
  return query_packet<4>(valid, scene, query, context, function, user);
}
RTC_API bool rtcPointQuery8(const int* valid, RTCScene scene, RTCPointQuery8* query,
                            RTCPointQueryContext* context, RTCPointQueryFunction function, void** user) {
  return query_packet<8>(valid, scene, query, context, function, user);
}
RTC_API bool rtcPointQuery16(const int* valid, RTCScene scene, RTCPointQuery16* query,
                             RTCPointQueryContext* context, RTCPointQueryFunction function, void** user) {
  return query_packet<16>(valid, scene, query, context, function, user);
}

// Which parts of a scene contain a point, innermost first.
#include "../../batch/checked_call.hpp"
#include "part_places.hpp"

namespace raylanes {
namespace {

template <class AnyTransform>
double determinant_of(const AnyTransform& transform) {
  double a[3][3];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) a[i][j] = double{transform.row[i][j]};
  return (a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) +
          a[0][1] * (a[1][2] * a[2][0] - a[1][0] * a[2][2])) +
         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

// The order of instances from inside out.
template <class Parts>
class Nesting {
 public:
  explicit Nesting(const Parts& scene) : scene_(scene), volumes_(scene.instances.size(), -1.0) {}
  bool is_before(std::uint32_t a, std::uint32_t b) {
    const double of_a = volume(a), of_b = volume(b);
    return of_a < of_b || (of_a == of_b && a < b);
  }
  ContainingPart part(const PartPlace& place) const {
    return {scene_.instances[place.instance].geometry, place.instance,
            place.is_on ? Location::on : Location::inside};
  }

 private:
  double volume(std::uint32_t number) {
    double& volume = volumes_[number];
    const auto& instance = scene_.instances[number];
    if (volume < 0.0) {
      volume = scene_.geometries[instance.geometry]->volume() * std::abs(determinant_of(instance.transform));
      if (std::isnan(volume)) volume = std::numeric_limits<double>::infinity();
    }
    return volume;
  }

  const Parts& scene_;
  std::vector<double> volumes_;  // of instances; negative: not known yet
};

template <class Parts, class T>
void find_innermost(const Parts& scene, const VertexRecords<T>& points, std::span<ContainingPart> parts,
                    const LocateOptions& options) {
  const CheckedPoints<T> call("innermost_parts", points, "parts", parts, options.active);
  PartPlaces places("innermost_parts", scene, options);
  Nesting nesting(scene);
  places.each(points, call.active, [&](std::size_t begin, std::size_t end, std::span<const PartPlace> found) {
    for (std::size_t i = begin; i < end; ++i)
      if (takes_part(call.active, i)) parts[i] = {};
    for (const PartPlace& place : found) {
      ContainingPart& part = parts[begin + place.point];
      if (!part || nesting.is_before(place.instance, part.instance)) part = nesting.part(place);
    }
  });
}

template <class Parts, class T>
RayLists<ContainingPart> find_containing(const Parts& scene, const VertexRecords<T>& points,
                                         const LocateOptions& options) {
  const QuietFloats quiet;
  require_points("containing_parts", points);
  PartPlaces places("containing_parts", scene, options);
  Nesting nesting(scene);
  RayLists<ContainingPart> lists;
  lists.offsets.reserve(points.count + 1);
  std::vector<PartPlace> sorted;
  places.each(points, options.active,
              [&](std::size_t begin, std::size_t end, std::span<const PartPlace> found) {
                sorted.assign(found.begin(), found.end());
                std::ranges::sort(sorted, [&](const PartPlace& a, const PartPlace& b) {
                  return a.point != b.point ? a.point < b.point : nesting.is_before(a.instance, b.instance);
                });
                for (std::size_t i = begin, at = 0; i < end; ++i) {
                  for (; at < sorted.size() && sorted[at].point == i - begin; ++at)
                    lists.items.push_back(nesting.part(sorted[at]));
                  lists.offsets.push_back(lists.items.size());
                }
              });
  return lists;
}

}  // namespace

void Scene::innermost_parts(Points points, std::span<ContainingPart> parts,
                            const LocateOptions& options) const {
  find_innermost(this->parts(), points, parts, options);
}
RayLists<ContainingPart> Scene::containing_parts(Points points, const LocateOptions& options) const {
  return find_containing(parts(), points, options);
}
void SceneD::innermost_parts(Points points, std::span<ContainingPart> parts,
                             const LocateOptions& options) const {
  find_innermost(this->parts(), points, parts, options);
}
RayLists<ContainingPart> SceneD::containing_parts(Points points, const LocateOptions& options) const {
  return find_containing(parts(), points, options);
}

}  // namespace raylanes

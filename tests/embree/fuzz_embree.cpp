// Embree's interface with any calls: geometries of any numbers in memory that ends at a forbidden page, scenes that
// change, rays of any bits. Single rays, packets and streams return the same bytes. A robust scene of one mesh returns
// the hits of a Bvh, and a device gives back all memory that it took.
#include <embree3/rtcore.h>

#include <deque>

#include <raylanes/bvh.hpp>

#include "../fuzz/any_mesh.hpp"
#include "../fuzz/strided.hpp"

namespace raylanes::testing {
namespace {

constexpr std::size_t max_rays = 40, max_elements = 16, max_calls = 60;
constexpr std::size_t words = 20;  // of RTCRayHit
using Words = std::array<std::uint32_t, words>;

Words words_of(const RTCRayHit& ray) {
  Words all;
  std::memcpy(all.data(), &ray, sizeof all);
  return all;
}

struct Kind {
  RTCGeometryType type;
  struct {
    RTCBufferType type;
    RTCFormat format;
    std::size_t size;
  } buffers[2];
};
constexpr Kind kinds[] = {
    {RTC_GEOMETRY_TYPE_TRIANGLE,
     {{RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 12}, {RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 12}}},
    {RTC_GEOMETRY_TYPE_QUAD,
     {{RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 12}, {RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT4, 16}}},
    {RTC_GEOMETRY_TYPE_GRID,
     {{RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 12}, {RTC_BUFFER_TYPE_GRID, RTC_FORMAT_GRID, 12}}},
    {RTC_GEOMETRY_TYPE_SPHERE_POINT, {{RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 16}, {}}},
    {RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT,
     {{RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 16}, {RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 12}}},
    {RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE,  // not supported
     {{RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 16}, {RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, 4}}},
    {RTC_GEOMETRY_TYPE_USER, {}},
    {RTC_GEOMETRY_TYPE_INSTANCE, {}}};

// User primitives: squares across z.
void bounds_of_square(const RTCBoundsFunctionArguments* a) {
  const auto z = static_cast<float>(a->primID);
  *a->bounds_o = {-1, -1, z, 0, 1, 1, z, 0};
}
bool is_on_square(const RTCRay& ray, unsigned primitive, float& t) {
  t = (static_cast<float>(primitive) - ray.org_z) / ray.dir_z;
  const float x = ray.org_x + t * ray.dir_x, y = ray.org_y + t * ray.dir_y;
  return t >= ray.tnear && t <= ray.tfar && std::fabs(x) < 1 && std::fabs(y) < 1;
}
void intersect_square(const RTCIntersectFunctionNArguments* a) {
  auto& both = *reinterpret_cast<RTCRayHit*>(a->rayhit);
  float t;
  if (!is_on_square(both.ray, a->primID, t)) return;
  both.ray.tfar = t;
  both.hit = {0, 0, 1, 0, 0, a->primID, a->geomID, {a->context->instID[0]}};
}
void occlude_square(const RTCOccludedFunctionNArguments* a) {
  auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
  float t;
  if (is_on_square(ray, a->primID, t)) ray.tfar = -infinity;
}
void reject_odd(const RTCFilterFunctionNArguments* a) {
  if (RTCHitN_primID(a->hit, a->N, 0) % 2 == 1) a->valid[0] = 0;
}

class Program {
 public:
  explicit Program(Bytes& bytes) : bytes_(bytes), coordinates_(bytes) {
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* to, ssize_t more, bool) {
          *static_cast<ssize_t*>(to) += more;
          return true;
        },
        &taken_);
    for (RTCScene& scene : scenes_) scene = rtcNewScene(device_);
  }
  ~Program() {
    for (RTCScene scene : scenes_) {  // which may show itself
      for (unsigned id = 0; id < max_calls; ++id) rtcDetachGeometry(scene, id);
      rtcCommitScene(scene);
    }
    for (RTCGeometry geometry : geometries_) rtcReleaseGeometry(geometry);
    for (RTCScene scene : scenes_) rtcReleaseScene(scene);
    rtcReleaseDevice(device_);
    if (taken_ != 0) fail("the memory monitor did not hear of all that was freed");
  }

  void call_something() {
    if (geometries_.empty() || bytes_.chance(40)) make_geometry();
    RTCGeometry g = bytes_.pick(geometries_);
    RTCScene s = bytes_.pick(scenes_);
    switch (bytes_.below(9)) {
      case 0:
        return rtcSetGeometryMask(g, bytes_.byte());
      case 1:
        return rtcSetGeometryBuildQuality(g, static_cast<RTCBuildQuality>(bytes_.below(4)));
      case 2:
        return bytes_.chance(128) ? rtcEnableGeometry(g) : rtcDisableGeometry(g);
      case 3:
        return rtcSetGeometryTimeStepCount(g, static_cast<unsigned>(bytes_.below(3)));
      case 4:
        return rtcDetachGeometry(s, static_cast<unsigned>(bytes_.below(8)));
      case 5:
        return rtcSetSceneFlags(s, static_cast<RTCSceneFlags>(bytes_.below(16)));
      case 6:
        rtcSetGeometryIntersectFilterFunction(g, bytes_.chance(128) ? reject_odd : nullptr);
        return rtcSetGeometryOccludedFilterFunction(g, bytes_.chance(128) ? reject_odd : nullptr);
      case 7:
        put(g, kinds[bytes_.below(std::size(kinds))]);  // perhaps not of its kind
        put_anything(g);
        return rtcCommitGeometry(g);
      default:
        rtcCommitGeometry(g);
        rtcAttachGeometry(s, g);
    }
  }

  void ask() {
    RTCScene scene = bytes_.pick(scenes_);
    rtcCommitScene(scene);
    rtcInitIntersectContext(&context_);
    if (bytes_.chance(32)) context_.filter = reject_odd;
    if (bytes_.chance(64)) context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    const Mesh none;
    const std::size_t n = bytes_.below(max_rays + 1);
    const unsigned mask = bytes_.chance(128) ? ~0u : bytes_.byte();
    for (const bool with_hits : {true, false}) {
      before_.clear(), after_.clear();
      for (std::size_t i = 0; i < n; ++i) {
        RTCRayHit both =
            ray_hit_of(any_ray(bytes_, coordinates_, none), bytes_.chance(250) ? mask : bytes_.byte());
        before_.push_back(words_of(both));
        with_hits ? rtcIntersect1(scene, &context_, &both) : rtcOccluded1(scene, &context_, &both.ray);
        after_.push_back(words_of(both));
      }
      expect_stream(scene, with_hits);
      expect_packets<4>(scene, with_hits ? rtcIntersect4 : nullptr, rtcOccluded4);
      expect_packets<8>(scene, with_hits ? rtcIntersect8 : nullptr, rtcOccluded8);
      expect_packets<16>(scene, with_hits ? rtcIntersect16 : nullptr, rtcOccluded16);
    }
    ask_others(scene);
  }

  // A robust scene of a mesh beside the tree of the triangles that Embree takes.
  void expect_hits_of_tree() {
    const Mesh mesh = any_mesh(bytes_);
    Mesh fit{mesh.vertices, {}};
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const Index3& t = mesh.triangles[i];
      const auto is_fit = [&](std::uint32_t corner) {
        return std::ranges::all_of(mesh.vertices[corner], [](float x) { return std::fabs(x) < 1.844e18f; });
      };
      if (std::ranges::all_of(t, is_fit)) fit.triangles.push_back(t), numbers.push_back(i);
    }
    const Bvh tree(fit);
    RTCScene scene = rtcNewScene(device_);
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    share(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
    share(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(scene, g, 3);
    rtcReleaseGeometry(g);
    rtcCommitScene(scene);
    rtcInitIntersectContext(&context_);
    for (std::size_t i = 0; i < max_rays; ++i) {
      const Ray ray = any_ray(bytes_, coordinates_, mesh);
      RTCRayHit both = ray_hit_of(ray, ~0u), shadow = both;
      rtcIntersect1(scene, &context_, &both);
      rtcOccluded1(scene, &context_, &shadow.ray);
      const Hit hit = tree.closest(ray);
      const bool is_same =
          hit ? both.hit.geomID == 3 && both.hit.primID == numbers[hit.primitive] &&
                    same(both.ray.tfar, hit.t) && same(both.hit.u, hit.u) && same(both.hit.v, hit.v) &&
                    shadow.ray.tfar == -infinity
              : words_of(both) == words_of(ray_hit_of(ray, ~0u)) && same(shadow.ray.tfar, ray.tmax);
      if (!is_same) fail("a mesh has other hits than its tree");
    }
    rtcReleaseScene(scene);
  }

 private:
  RTCRayHit ray_hit_of(const Ray& r, unsigned mask) const {
    const unsigned none = RTC_INVALID_GEOMETRY_ID;
    return {{r.origin[0], r.origin[1], r.origin[2], r.tmin, r.direction[0], r.direction[1], r.direction[2], 0,
             r.tmax, mask, 7, 0},
            {1, 2, 3, 4, 5, none, none, {none}}};
  }

  template <class T>
  void share(RTCGeometry g, RTCBufferType type, RTCFormat format, const std::vector<T>& values,
             std::size_t gap = 0) {
    Fence& fence = fences_.emplace_back(values.size() * (sizeof(T) + gap));
    const std::size_t stride = sizeof(T) + gap;
    auto* first = fence.last<unsigned char>(values.empty() ? 0 : values.size() * stride - gap);
    for (std::size_t i = 0; i < values.size(); ++i) std::memcpy(first + i * stride, &values[i], sizeof(T));
    rtcSetSharedGeometryBuffer(g, type, 0, format, first, 0, stride, values.size());
  }

  void put(RTCGeometry g, const Kind& kind) {
    for (const auto& buffer : kind.buffers) {
      if (buffer.size == 0) continue;
      std::vector<std::uint32_t> numbers(bytes_.below(max_elements + 1) * buffer.size / 4);
      const bool is_index = buffer.format < RTC_FORMAT_FLOAT || buffer.format == RTC_FORMAT_GRID;
      for (std::uint32_t& x : numbers) {
        x = std::bit_cast<std::uint32_t>(coordinates_());
        if (is_index && bytes_.chance(250)) x = bytes_.chance(250) ? bytes_.byte() % 8u : 0x30003u;
      }
      const std::size_t count = numbers.size() * 4 / buffer.size;
      if (bytes_.chance(128)) {
        void* to = rtcSetNewGeometryBuffer(g, buffer.type, 0, buffer.format, buffer.size, count);
        if (to != nullptr && count > 0) std::memcpy(to, numbers.data(), numbers.size() * 4);
        continue;
      }
      const std::size_t gap = 4 * bytes_.below(3);
      if (buffer.size == 12)
        share(g, buffer.type, buffer.format, cut<3>(numbers), gap);
      else if (buffer.size == 16)
        share(g, buffer.type, buffer.format, cut<4>(numbers), gap);
    }
    rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(bytes_.below(5)));
    rtcSetGeometryBoundsFunction(g, bounds_of_square, nullptr);
    rtcSetGeometryIntersectFunction(g, intersect_square);
    rtcSetGeometryOccludedFunction(g, occlude_square);
    rtcSetGeometryInstancedScene(g, scenes_[0]);
    float matrix[12];
    for (float& x : matrix) x = coordinates_();
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix);
  }
  void put_anything(RTCGeometry g) {
    const auto type = static_cast<RTCBufferType>(bytes_.below(9));
    const RTCFormat format = bytes_.pick({RTC_FORMAT_UINT, RTC_FORMAT_UINT3, RTC_FORMAT_UINT4,
                                          RTC_FORMAT_FLOAT, RTC_FORMAT_FLOAT3, RTC_FORMAT_GRID});
    const std::size_t stride = 4 * bytes_.below(6), count = bytes_.below(9);
    void* to = rtcSetNewGeometryBuffer(g, type, bytes_.chance(32) ? 1 : 0, format, stride, count);
    if (to != nullptr) std::memset(to, bytes_.chance(128) ? 0 : 0x41, stride * count);
    const float matrix[16] = {coordinates_(), coordinates_(), coordinates_()};
    rtcSetGeometryTransform(g, 0, static_cast<RTCFormat>(RTC_FORMAT_FLOAT3X4_ROW_MAJOR + bytes_.below(20)),
                            matrix);
  }
  template <std::size_t size>
  static std::vector<std::array<std::uint32_t, size>> cut(const std::vector<std::uint32_t>& numbers) {
    std::vector<std::array<std::uint32_t, size>> all(numbers.size() / size);
    if (!all.empty()) std::memcpy(all.data(), numbers.data(), all.size() * size * 4);
    return all;
  }
  void make_geometry() {
    const Kind& kind = kinds[bytes_.below(std::size(kinds))];
    geometries_.push_back(rtcNewGeometry(device_, kind.type));
    put(geometries_.back(), kind);
    rtcCommitGeometry(geometries_.back());
    rtcAttachGeometry(bytes_.pick(scenes_), geometries_.back());
  }

  static void expect(const char* call, const Words& expected, const void* found, bool with_hits) {
    const std::size_t size = (with_hits ? words : sizeof(RTCRay) / 4) * 4;
    if (std::memcmp(expected.data(), found, size) != 0) fail(std::string("a ray ends otherwise in ") + call);
  }

  void expect_stream(RTCScene scene, bool with_hits) {
    const auto n = static_cast<unsigned>(before_.size());
    const auto fill = [&] {
      for (unsigned i = 0; i < n; ++i) std::memcpy(&records_[i], before_[i].data(), sizeof before_[i]);
    };
    const auto check = [&](const char* call) {
      for (unsigned i = 0; i < n; ++i) expect(call, after_[i], &records_[i], with_hits);
    };
    std::array<RTCRayHit*, max_rays> pointers;
    std::array<RTCRay*, max_rays> ray_pointers;
    for (std::size_t i = 0; i < max_rays; ++i) pointers[i] = &records_[i], ray_pointers[i] = &records_[i].ray;
    fill();
    with_hits ? rtcIntersect1M(scene, &context_, records_.data(), n, sizeof(RTCRayHit))
              : rtcOccluded1M(scene, &context_, &records_[0].ray, n, sizeof(RTCRayHit));
    check("a stream");
    fill();
    with_hits ? rtcIntersect1Mp(scene, &context_, pointers.data(), n)
              : rtcOccluded1Mp(scene, &context_, ray_pointers.data(), n);
    check("a stream of pointers");
  }

  template <std::size_t lanes, class Both, class One>
  void expect_packets(RTCScene scene, void (*intersect)(const int*, RTCScene, RTCIntersectContext*, Both*),
                      void (*occluded)(const int*, RTCScene, RTCIntersectContext*, One*)) {
    alignas(64) std::uint32_t packet[words][lanes];
    alignas(64) int valid[lanes];
    for (std::size_t begin = 0; begin + lanes <= before_.size(); begin += lanes) {
      for (std::size_t i = 0; i < lanes; ++i) {
        valid[i] = bytes_.chance(200) ? -1 : 0;
        for (std::size_t k = 0; k < words; ++k) packet[k][i] = before_[begin + i][k];
      }
      if (intersect != nullptr)
        intersect(valid, scene, &context_, reinterpret_cast<Both*>(packet));
      else
        occluded(valid, scene, &context_, reinterpret_cast<One*>(packet));
      for (std::size_t i = 0; i < lanes; ++i) {
        Words one;
        for (std::size_t k = 0; k < words; ++k) one[k] = packet[k][i];
        const Words& expected = (valid[i] != 0 ? after_ : before_)[begin + i];
        expect("a packet", expected, one.data(), intersect != nullptr);
      }
    }
  }

  // Calls whose answers rows.cpp compares with Embree's: nothing here but that they end.
  void ask_others(RTCScene scene) {
    RTCPointQuery query{coordinates_(), coordinates_(), coordinates_(), 0, coordinates_()};
    RTCPointQueryContext of_query;
    rtcInitPointQueryContext(&of_query);
    const auto shrink = [](RTCPointQueryFunctionArguments* a) {
      a->query->radius *= .5f;
      return true;
    };
    rtcPointQuery(scene, &query, &of_query, shrink, nullptr);
    RTCBounds bounds;
    rtcGetSceneBounds(scene, &bounds);
    if (geometries_.empty()) return;
    const auto count = static_cast<unsigned>(bytes_.below(4));
    Fence fence(48);
    rtcInterpolate1(bytes_.pick(geometries_), static_cast<unsigned>(bytes_.below(max_elements + 2)),
                    coordinates_(), coordinates_(), RTC_BUFFER_TYPE_VERTEX, 0, fence.last<float>(count),
                    nullptr, nullptr, count);
    fence.expect_intact("an interpolated vertex");
  }

  Bytes& bytes_;
  Coordinates coordinates_;
  ssize_t taken_ = 0;
  RTCDevice device_ = rtcNewDevice("threads=1");
  std::array<RTCScene, 2> scenes_{};
  std::vector<RTCGeometry> geometries_;
  std::deque<Fence> fences_;
  RTCIntersectContext context_{};
  std::vector<Words> before_, after_;
  std::vector<RTCRayHit> records_ = std::vector<RTCRayHit>(max_rays);
};

}  // namespace
}  // namespace raylanes::testing

int fuzz_embree(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  Program program(bytes);
  const std::size_t calls = bytes.below(max_calls / 2);
  for (std::size_t i = 0; i < calls; ++i) bytes.chance(64) ? program.ask() : program.call_something();
  program.ask();
  program.expect_hits_of_tree();
  return 0;
}

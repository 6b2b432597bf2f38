// Times calls of Embree's interface. The library is the one that the dynamic linker finds: Debian's, or raylanes' own
// by LD_LIBRARY_PATH. `compare_libraries` runs the program with both.
//
// usage: embree_calls SCENE calls|others PARTS ISA
//   calls: rays of a picture through the mesh as PARTS geometries; others: instances, filters, spheres, user
//   geometries; both: commits. ISA: of Embree, such as avx2; empty: the best one. Standard output has the file of the
//   library, a line "scene|rays|call|mode|count" for each case and an empty line. Then for each index of a case on
//   standard input it has a line with the seconds of one run and the number of rays that hit.
#include <dlfcn.h>
#include <xmmintrin.h>

#include <chrono>
#include <iostream>

#include <raylanes/bvh.hpp>

#include "../support/rays/ray_sets.hpp"
#include "embree_scenes.hpp"

namespace raylanes::bench {
namespace {

struct Timed {
  double seconds;
  std::size_t hits;
};
struct Case {
  std::string name;
  std::function<Timed()> run;
};

// The time of this thread: other programs may run on the core meanwhile.
double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Rays in Embree's layout, and the hint that they are coherent.
struct Rays {
  std::string name;
  std::vector<RTCRayHit> rays;
  bool are_coherent;

  Rays(std::string given_name, std::span<const Ray> given, bool coherent)
      : name(std::move(given_name)), are_coherent(coherent) {
    for (const Ray& ray : given) {
      RTCRayHit& both = rays.emplace_back();
      both.ray = {ray.origin[0],
                  ray.origin[1],
                  ray.origin[2],
                  ray.tmin,
                  ray.direction[0],
                  ray.direction[1],
                  ray.direction[2],
                  0,
                  ray.tmax,
                  ~0u,
                  0,
                  0};
      both.hit.geomID = both.hit.primID = both.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  RTCIntersectContext context() const {
    RTCIntersectContext made;
    rtcInitIntersectContext(&made);
    made.flags = are_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return made;
  }
};

Timed closest_each(RTCScene scene, const Rays& rays) {
  RTCIntersectContext context = rays.context();
  std::vector<RTCRayHit> all = rays.rays;
  const double begin = now();
  for (RTCRayHit& ray : all) rtcIntersect1(scene, &context, &ray);
  const double seconds = now() - begin;
  return {seconds, static_cast<std::size_t>(std::ranges::count_if(
                       all, [](const RTCRayHit& r) { return r.hit.geomID != RTC_INVALID_GEOMETRY_ID; }))};
}
Timed any_each(RTCScene scene, const Rays& rays) {
  RTCIntersectContext context = rays.context();
  std::vector<RTCRay> all;
  for (const RTCRayHit& both : rays.rays) all.push_back(both.ray);
  const double begin = now();
  for (RTCRay& ray : all) rtcOccluded1(scene, &context, &ray);
  const double seconds = now() - begin;
  return {seconds,
          static_cast<std::size_t>(std::ranges::count_if(all, [](const RTCRay& r) { return r.tfar < 0; }))};
}
Timed closest_stream(RTCScene scene, const Rays& rays) {
  RTCIntersectContext context = rays.context();
  std::vector<RTCRayHit> all = rays.rays;
  const double begin = now();
  rtcIntersect1M(scene, &context, all.data(), static_cast<unsigned>(all.size()), sizeof(RTCRayHit));
  const double seconds = now() - begin;
  return {seconds, static_cast<std::size_t>(std::ranges::count_if(
                       all, [](const RTCRayHit& r) { return r.hit.geomID != RTC_INVALID_GEOMETRY_ID; }))};
}

// Whole packets: the rays behind them are left out.
template <std::size_t lanes, class Packet, auto intersect>
Timed closest_packets(RTCScene scene, const Rays& rays) {
  constexpr std::size_t words = sizeof(Packet) / lanes / 4, geometry = offsetof(RTCRayHit, hit.geomID) / 4;
  struct alignas(64) Words {
    std::uint32_t word[words][lanes];
  };
  RTCIntersectContext context = rays.context();
  std::vector<Words> packets(rays.rays.size() / lanes);
  for (std::size_t i = 0; i < packets.size() * lanes; ++i) {
    std::uint32_t words_of_ray[words];
    std::memcpy(words_of_ray, &rays.rays[i], sizeof words_of_ray);
    for (std::size_t k = 0; k < words; ++k) packets[i / lanes].word[k][i % lanes] = words_of_ray[k];
  }
  alignas(64) int valid[lanes];
  std::ranges::fill(valid, -1);
  const double begin = now();
  for (Words& packet : packets) intersect(valid, scene, &context, reinterpret_cast<Packet*>(&packet));
  Timed timed{now() - begin, 0};
  for (const Words& packet : packets)
    for (const std::uint32_t hit : packet.word[geometry]) timed.hits += hit != RTC_INVALID_GEOMETRY_ID;
  return timed;
}

// Everything that cases refer to.
class Cases {
 public:
  Cases(Scene scene, const std::string& isa)
      : scene_(std::move(scene)),
        mesh_(scene_.mesh),
        device_(rtcNewDevice(("threads=1" + (isa.empty() ? "" : ",isa=" + isa)).c_str()), rtcReleaseDevice) {}

  // Nearest hits and occlusion of rays of a picture.
  void add_calls(std::size_t parts) {
    const std::vector<Ray> primary = primary_rays(scene_.camera, 512, 512);
    std::vector<Hit> hits(primary.size());
    Bvh(scene_.mesh).closest(primary, hits);
    const std::vector<Ray> diffuse = diffuse_rays(primary, hits, scene_.mesh, 1);
    for (const bool is_robust : {false, true}) {
      const RTCScene scene = keep(scene_of_meshes(device_.get(), mesh_, parts,
                                                  is_robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE));
      const char* const mode = is_robust ? "robust" : "fast";
      for (const Rays* rays : {&keep({"camera", primary, true}), &keep({"diffuse", diffuse, false})}) {
        add(rays, "rtcIntersect1", mode, closest_each, scene);
        add(rays, "rtcOccluded1", mode, any_each, scene);
        add(rays, "rtcIntersect1M", mode, closest_stream, scene);
        if (is_robust) continue;
        add(rays, "rtcIntersect4", mode, closest_packets<4, RTCRayHit4, rtcIntersect4>, scene);
        add(rays, "rtcIntersect8", mode, closest_packets<8, RTCRayHit8, rtcIntersect8>, scene);
        add(rays, "rtcIntersect16", mode, closest_packets<16, RTCRayHit16, rtcIntersect16>, scene);
      }
    }
  }

  // Random rays at whatever else a scene may have.
  void add_others() {
    constexpr std::size_t ray_count = 100000, ball_count = 10000, side = 10;
    const Rays& rays = keep({"random", random_rays(scene_.mesh, ray_count, 1), false});
    const Box bounds = bounds_of(scene_.mesh);
    const RTCDevice device = device_.get();
    balls_ = balls_in(bounds, ball_count);
    const RTCScene inner = keep(scene_of_meshes(device, mesh_, 1, RTC_SCENE_FLAG_NONE));
    const std::pair<const char*, RTCScene> scenes[] = {
        {"1,000 instances", keep(scene_of_instances(device, inner, bounds, side))},
        {"a filter that keeps all hits", keep(scene_of_filter(device, mesh_, keep_all))},
        {"a filter that rejects half", keep(scene_of_filter(device, mesh_, reject_odd))},
        {"10,000 user geometries", keep(scene_of_user_balls(device, balls_))},
        {"10,000 spheres", keep(scene_of_spheres(device, balls_))}};
    for (const auto& [name, scene] : scenes) {
      add(&rays, "rtcIntersect1", name, closest_each, scene);
      add(&rays, "rtcOccluded1", name, any_each, scene);
    }
  }

  // The build of a scene, and refits of one geometry of many.
  void add_commits(std::size_t parts) {
    const auto name = [&](const char* mode) {
      return scene_.name + "|none|rtcCommitScene|" + mode + '|' + std::to_string(parts);
    };
    cases.push_back({name("build"), [this, parts] {
                       const double begin = now();
                       scene_of_meshes(device_.get(), mesh_, parts, RTC_SCENE_FLAG_NONE);
                       return Timed{now() - begin, 0};
                     }});
    const RTCScene moving = keep(scene_of_meshes(device_.get(), mesh_, parts, RTC_SCENE_FLAG_DYNAMIC, true));
    cases.push_back({name("refit of one geometry"), [moving] {
                       const RTCGeometry first = rtcGetGeometry(moving, 0);
                       rtcUpdateGeometryBuffer(first, RTC_BUFFER_TYPE_VERTEX, 0);
                       rtcCommitGeometry(first);
                       const double begin = now();
                       rtcCommitScene(moving);
                       return Timed{now() - begin, 0};
                     }});
  }

  std::vector<Case> cases;

 private:
  RTCScene keep(EmbreeScene scene) { return scenes_.emplace_back(std::move(scene)).get(); }
  const Rays& keep(Rays rays) { return *rays_.emplace_back(std::make_unique<Rays>(std::move(rays))); }
  void add(const Rays* rays, const char* call, const char* mode, Timed (*run)(RTCScene, const Rays&),
           RTCScene scene) {
    cases.push_back(
        {scene_.name + '|' + rays->name + '|' + call + '|' + mode + '|' + std::to_string(rays->rays.size()),
         [=] { return run(scene, *rays); }});
  }

  Scene scene_;
  SharedMesh mesh_;
  Balls balls_;
  std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device_;
  std::vector<EmbreeScene> scenes_;
  std::vector<std::unique_ptr<const Rays>> rays_;
};

int run(const std::string& file, const std::string& what, std::size_t parts, const std::string& isa) {
  // As Embree's manual asks: subnormal numbers count as zero.
  _mm_setcsr(_mm_getcsr() | 0x8040);
  Dl_info library{};
  dladdr(reinterpret_cast<void*>(&rtcNewDevice), &library);
  Cases cases(load_scene(file), isa);
  if (what == "others") cases.add_others();
  if (what == "calls") cases.add_calls(parts);
  cases.add_commits(parts);
  std::cout << library.dli_fname << '\n';
  for (const Case& one : cases.cases) std::cout << one.name << '\n';
  std::cout << std::endl;
  for (std::size_t index; std::cin >> index;) {
    const Timed timed = cases.cases.at(index).run();
    std::cout << timed.seconds << ' ' << timed.hits << std::endl;
  }
  return 0;
}

}  // namespace
}  // namespace raylanes::bench

int main(int argc, char** argv) try {
  if (argc == 5) return raylanes::bench::run(argv[1], argv[2], std::stoul(argv[3]), argv[4]);
  std::cerr << "usage: embree_calls SCENE calls|others PARTS ISA\n";
  return 2;
} catch (const std::exception& error) {
  std::cerr << "embree_calls: " << error.what() << '\n';
  return 1;
}

#include "embree_contender.hpp"

#include <dlfcn.h>
#include <embree3/rtcore.h>

#include <chrono>
#include <filesystem>

#include "../contenders.hpp"
#include "embree_layouts.hpp"
#include "plain_scene.hpp"

namespace raylanes::bench {
namespace {

// Embree takes any unknown name for its baseline without a word, hence the list of our own.
std::string device_config(std::string_view isa, int threads) {
  constexpr std::array<std::string_view, 5> known = {"sse2", "sse4.2", "avx", "avx2", "avx512"};
  const std::string config = "threads=" + std::to_string(threads);
  if (isa.empty()) return config;
  if (std::find(known.begin(), known.end(), isa) == known.end())
    throw std::invalid_argument("Embree: unknown instruction set '" + std::string(isa) +
                                "', allowed are sse2, sse4.2, avx, avx2, avx512 and the empty string");
  return config + ",isa=" + std::string(isa);
}

// Embree reports errors through a callback that must not throw through its frames: keep the first one.
void keep_first_error(void* user, RTCError code, const char* text) {
  auto& message = *static_cast<std::string*>(user);
  if (message.empty())
    message = "Embree: error " + std::to_string(code) + ": " + (text == nullptr ? "" : text);
}

RTCDevice open_device(std::string_view isa, int threads) {
  const RTCDevice device = rtcNewDevice(device_config(isa, threads).c_str());
  if (device != nullptr) return device;
  const RTCError code = rtcGetDeviceError(nullptr);
  if (code == RTC_ERROR_UNSUPPORTED_CPU)
    throw std::runtime_error("Embree: this CPU does not have the instruction set '" + std::string(isa) + "'");
  throw std::runtime_error("Embree: no device, error " + std::to_string(code));
}

template <typename T>
void fill_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::span<const T> items) {
  // Embree allocates this buffer itself, padded so that 16-byte loads of the last item stay inside.
  void* const buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), items.size());
  if (buffer != nullptr) std::memcpy(buffer, items.data(), items.size_bytes());
}

RTCSceneFlags flags_of(EmbreeBuild build) {
  if (build == EmbreeBuild::refitted) return RTC_SCENE_FLAG_DYNAMIC;
  return build == EmbreeBuild::robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
}
RTCBuildQuality quality_of(EmbreeBuild build) {
  if (build == EmbreeBuild::low || build == EmbreeBuild::refitted) return RTC_BUILD_QUALITY_LOW;
  return build == EmbreeBuild::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
}

// The file that the dynamic linker chose; "" if it does not say.
std::string library_file() {
  Dl_info info{};
  void* const function = dlsym(RTLD_DEFAULT, "rtcNewDevice");
  if (function == nullptr || dladdr(function, &info) == 0 || info.dli_fname == nullptr) return "";
  std::error_code error;
  return std::filesystem::weakly_canonical(info.dli_fname, error).string();
}

RTCIntersectContext make_context(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

// The differences between the two queries.
struct Closest {
  using Result = Hit;
  using Single = ClosestRay;
  template <typename W>
  using Packet = ClosestPacket<W>;
};
struct Any {
  using Result = std::uint8_t;
  using Single = AnyRay;
  template <typename W>
  using Packet = AnyPacket<W>;
};

template <typename Trace>
auto by_query(const RaySet& set, Answers& answers, const Trace& trace) {
  return set.query == Query::closest ? trace(Closest{}, std::span(answers.hits))
                                     : trace(Any{}, std::span(answers.occluded));
}

// Calls with the packet of the mode and its lanes: `with.template operator()<Packet, lanes>()`.
template <typename Query, typename With>
void with_packet(EmbreeMode mode, const With& with) {
  switch (mode) {
    case EmbreeMode::single:
    case EmbreeMode::stream:  // of single rays
      return with.template operator()<typename Query::Single, 1>();
    case EmbreeMode::packet4:
      return with.template operator()<typename Query::template Packet<Width4>, 4>();
    case EmbreeMode::packet8:
      return with.template operator()<typename Query::template Packet<Width8>, 8>();
    case EmbreeMode::packet16:
    case EmbreeMode::packet_stream:
      return with.template operator()<typename Query::template Packet<Width16>, 16>();
  }
}

// Parts of one mesh, whose hits are numbered as its triangles.
struct Numbering {
  std::vector<std::uint32_t> first;  // of each part's triangles; empty: there is one mesh
  bool are_instances = false;

  // Writes what a packet has found.
  template <typename Packet, typename Result>
  void write(const Packet& packet, std::span<Result> results) const {
    packet.write(results.data());
    if constexpr (std::is_same_v<Result, Hit>)
      for (std::size_t lane = 0; !first.empty() && lane < results.size(); ++lane)
        if (results[lane]) results[lane].primitive += first[packet.part(lane, are_instances)];
  }
};

template <typename Query>
void trace(RTCScene scene, const Numbering& numbering, EmbreeMode mode, bool coherent,
           std::span<const Ray> rays, std::span<typename Query::Result> results) {
  RTCIntersectContext context = make_context(coherent);
  with_packet<Query>(mode, [&]<typename Packet, std::size_t lanes>() {
    for_each_packet<lanes>(rays, results, [&](const Ray* in, typename Query::Result* out) {
      Packet packet;
      packet.lay_out(in);
      packet.trace(scene, context);
      numbering.write(packet, std::span(out, lanes));
    });
  });
}

// Whole packets: `size` rays of a call are rounded up to them.
template <typename Query>
void trace_stream(RTCScene scene, const Numbering& numbering, EmbreeMode mode, bool coherent,
                  std::size_t size, std::span<const Ray> rays, std::span<typename Query::Result> results) {
  RTCIntersectContext context = make_context(coherent);
  with_packet<Query>(mode, [&]<typename Packet, std::size_t lanes>() {
    using Result = typename Query::Result;
    const std::size_t most = std::min({size, rays.size(), max_embree_stream});
    std::vector<Packet> stream((most + lanes - 1) / lanes);
    for (std::size_t begin = 0, count; begin < rays.size(); begin += count) {
      count = std::min(stream.size() * lanes, rays.size() - begin);
      const std::span<const Ray> in = rays.subspan(begin, count);
      const std::span<Result> out = results.subspan(begin, count);
      std::size_t at = 0;
      for_each_packet<lanes>(in, out, [&](const Ray* ray, Result*) { stream[at++].lay_out(ray); });
      Packet::trace_stream(scene, context, std::span(stream).first(at));
      at = 0;
      for_each_packet<lanes>(in, out, [&](const Ray*, Result* result) {
        numbering.write(stream[at++], std::span(result, lanes));
      });
    }
  });
}

template <typename Query>
double trace_packed(RTCScene scene, const Numbering& numbering, EmbreeMode mode, bool coherent,
                    std::span<const Ray> rays, std::span<typename Query::Result> results) {
  using Clock = std::chrono::steady_clock;
  using Result = typename Query::Result;
  RTCIntersectContext context = make_context(coherent);
  double seconds = 0.0;
  with_packet<Query>(mode, [&]<typename Packet, std::size_t lanes>() {
    std::vector<Packet> packets((rays.size() + lanes - 1) / lanes);
    std::size_t at = 0;
    for_each_packet<lanes>(rays, results, [&](const Ray* in, Result*) { packets[at++].lay_out(in); });
    const Clock::time_point start = Clock::now();
    for (Packet& packet : packets) packet.trace(scene, context);
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
    at = 0;
    for_each_packet<lanes>(rays, results, [&](const Ray*, Result* out) {
      numbering.write(packets[at++], std::span(out, lanes));
    });
  });
  return seconds;
}

}  // namespace

std::string embree_note() {
  const std::string file = library_file();
  const bool is_packaged = file.starts_with("/usr/lib/");
  return "Embree of " + file +
         (is_packaged ? ": Debian compiles its assertions in, which costs it 0 to 13 %; LD_LIBRARY_PATH puts "
                        "a build of "
                        "your own in its place"
                      : ": a build of your own");
}

struct EmbreeContender::Scene {
  std::string error;  // the device holds its address: declared first, so that it dies last
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  double build_seconds = 0;
  std::size_t vertex_count = 0;
  std::vector<RTCScene> parts;  // of instances
  Numbering numbering;

  Scene(std::string_view isa, int threads) : device(open_device(isa, threads)) {
    rtcSetDeviceErrorFunction(device, keep_first_error, &error);
  }
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    for (const RTCScene part : parts) rtcReleaseScene(part);
    rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void check() const {
    if (!error.empty()) throw std::runtime_error(error);
  }

  RTCScene new_scene(EmbreeBuild build) const {
    const RTCScene made = rtcNewScene(device);
    check();
    rtcSetSceneFlags(made, flags_of(build));
    rtcSetSceneBuildQuality(made, quality_of(build));
    return made;
  }

  void add_part(const Mesh& part, EmbreeBuild build) {
    parts.push_back(new_scene(build));
    add(parts.back(), part.vertices, part.triangles, build);
    rtcCommitScene(parts.back());
  }
  void add_instance(const PlacedMeshes::Place& place) const {
    const RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, parts[place.mesh]);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, place.transform.row);
    rtcCommitGeometry(instance);
    rtcAttachGeometry(scene, instance);
    rtcReleaseGeometry(instance);
  }

  void add(RTCScene to, std::span<const Float3> vertices, std::span<const Index3> triangles,
           EmbreeBuild build) const {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (geometry == nullptr) return;
    // A scene of low quality has a tree for each geometry, by the geometry's quality: medium unless it says low.
    if (build == EmbreeBuild::refitted) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    if (build == EmbreeBuild::low) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    fill_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices);
    fill_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(to, geometry);
    rtcReleaseGeometry(geometry);
  }

  // Makes the scene: fill() adds what is in it.
  template <typename Fill>
  void build(EmbreeBuild build, const Fill& fill) {
    const SubnormalsAreZero subnormals;
    const auto begin = std::chrono::steady_clock::now();
    scene = new_scene(build);
    fill();
    rtcCommitScene(scene);
    build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    check();
  }
};

EmbreeContender::EmbreeContender(std::span<const Float3> vertices, std::span<const Index3> triangles,
                                 std::string_view isa, EmbreeBuild build, int threads) {
  validate_mesh(vertices, triangles);
  scene_ = std::make_unique<Scene>(isa, threads);
  scene_->vertex_count = vertices.size();
  scene_->build(build, [&] {
    if (!triangles.empty()) scene_->add(scene_->scene, vertices, triangles, build);
  });
}

EmbreeContender::EmbreeContender(const Parts& parts, bool are_instances, std::string_view isa,
                                 EmbreeBuild build)
    : scene_(std::make_unique<Scene>(isa, 1)) {
  scene_->numbering = {parts.first, are_instances};
  scene_->build(build, [&] {
    if (!are_instances)
      for (const Mesh& part : parts.meshes) scene_->add(scene_->scene, part.vertices, part.triangles, build);
    else
      for (const Mesh& mesh : parts.shared_meshes()) scene_->add_part(mesh, build);
    for (std::uint32_t i = 0; are_instances && i < parts.first.size(); ++i)
      scene_->add_instance(parts.place(i));
  });
}

EmbreeContender::~EmbreeContender() = default;

double EmbreeContender::build_seconds() const {
  return scene_->build_seconds;
}

double EmbreeContender::move(std::span<const Float3> vertices) {
  const RTCGeometry geometry = rtcGetGeometry(scene_->scene, 0);
  if (vertices.size() != scene_->vertex_count)
    throw std::invalid_argument("Embree: " + std::to_string(vertices.size()) + " vertices, there were " +
                                std::to_string(scene_->vertex_count));
  if (geometry == nullptr) return 0;  // no triangles
  const SubnormalsAreZero subnormals;
  std::memcpy(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0), vertices.data(),
              vertices.size_bytes());
  const auto begin = std::chrono::steady_clock::now();
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry);
  rtcCommitScene(scene_->scene);
  const auto end = std::chrono::steady_clock::now();
  scene_->check();
  return std::chrono::duration<double>(end - begin).count();
}

bool EmbreeContender::native(EmbreeMode mode) const {
  constexpr RTCDeviceProperty of_modes[] = {
      RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED,
      RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED, RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED,
      RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED};
  return mode == EmbreeMode::single ||
         rtcGetDeviceProperty(scene_->device, of_modes[static_cast<std::size_t>(mode) - 1]) != 0;
}

void EmbreeContender::trace(EmbreeMode mode, bool coherent, const RaySet& set, Answers& answers,
                            std::size_t batch) const {
  const SubnormalsAreZero subnormals;
  by_query(set, answers, [&]<typename Query>(Query, std::span<typename Query::Result> results) {
    if (mode == EmbreeMode::stream || mode == EmbreeMode::packet_stream)
      trace_stream<Query>(scene_->scene, scene_->numbering, mode, coherent, batch, set.rays, results);
    else
      bench::trace<Query>(scene_->scene, scene_->numbering, mode, coherent, set.rays, results);
  });
  scene_->check();
}

double EmbreeContender::trace_packed(EmbreeMode mode, bool coherent, const RaySet& set,
                                     Answers& answers) const {
  const SubnormalsAreZero subnormals;
  const double seconds =
      by_query(set, answers, [&]<typename Query>(Query, std::span<typename Query::Result> results) {
        return bench::trace_packed<Query>(scene_->scene, scene_->numbering, mode, coherent, set.rays,
                                          results);
      });
  scene_->check();
  return seconds;
}

}  // namespace raylanes::bench

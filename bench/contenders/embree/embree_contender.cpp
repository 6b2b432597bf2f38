#include "embree_contender.hpp"

#include <dlfcn.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "embree_queries.hpp"
#include "subnormals_are_zero.hpp"

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

void check_sizes(std::size_t rays, std::size_t results) {
  if (rays != results)
    throw std::invalid_argument("Embree: " + std::to_string(rays) + " rays but room for " +
                                std::to_string(results) + " results, both must be equal");
}

template <typename T>
void fill_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::span<const T> items) {
  // Embree allocates this buffer itself, padded so that 16-byte loads of the last item stay inside.
  void* const buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), items.size());
  if (buffer != nullptr) std::memcpy(buffer, items.data(), items.size_bytes());
}

RTCSceneFlags flags_of(EmbreeBuild build) {
  if (build == EmbreeBuild::refitted) return RTC_SCENE_FLAG_DYNAMIC;
  if (build == EmbreeBuild::filtered)
    return static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
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

  Scene(std::string_view isa, int threads) : device(open_device(isa, threads)) {
    rtcSetDeviceErrorFunction(device, keep_first_error, &error);
  }
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void check() const {
    if (!error.empty()) throw std::runtime_error(error);
  }

  void add(std::span<const Float3> vertices, std::span<const Index3> triangles, EmbreeBuild build) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (geometry == nullptr) return;
    // A scene of low quality has a tree for each geometry, by the geometry's quality: medium unless it says low.
    if (build == EmbreeBuild::refitted) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    if (build == EmbreeBuild::low) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    fill_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices);
    fill_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
};

EmbreeContender::EmbreeContender(std::span<const Float3> vertices, std::span<const Index3> triangles,
                                 std::string_view isa, EmbreeBuild build, int threads) {
  validate_mesh(vertices, triangles);
  const SubnormalsAreZero subnormals;
  scene_ = std::make_unique<Scene>(isa, threads);
  scene_->vertex_count = vertices.size();
  const auto begin = std::chrono::steady_clock::now();
  scene_->scene = rtcNewScene(scene_->device);
  scene_->check();
  rtcSetSceneFlags(scene_->scene, flags_of(build));
  rtcSetSceneBuildQuality(scene_->scene, quality_of(build));
  if (!triangles.empty()) scene_->add(vertices, triangles, build);
  rtcCommitScene(scene_->scene);
  scene_->build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  scene_->check();
}

EmbreeContender::~EmbreeContender() = default;
EmbreeContender::EmbreeContender(EmbreeContender&&) noexcept = default;
EmbreeContender& EmbreeContender::operator=(EmbreeContender&&) noexcept = default;

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
  const auto has = [this](RTCDeviceProperty property) {
    return rtcGetDeviceProperty(scene_->device, property) != 0;
  };
  switch (mode) {
    case EmbreeMode::single:
      return true;
    case EmbreeMode::packet4:
      return has(RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED);
    case EmbreeMode::packet8:
      return has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED);
    case EmbreeMode::packet16:
      return has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED);
  }
  throw std::invalid_argument("Embree: unknown mode");
}

void EmbreeContender::closest(EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                              std::span<Hit> hits) const {
  check_sizes(rays.size(), hits.size());
  const SubnormalsAreZero subnormals;
  trace_closest(scene_->scene, mode, coherent, rays, hits);
  scene_->check();
}

void EmbreeContender::any(EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                          std::span<std::uint8_t> occluded) const {
  check_sizes(rays.size(), occluded.size());
  const SubnormalsAreZero subnormals;
  trace_any(scene_->scene, mode, coherent, rays, occluded);
  scene_->check();
}

double EmbreeContender::closest_packed(EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                                       std::span<Hit> hits) const {
  check_sizes(rays.size(), hits.size());
  const SubnormalsAreZero subnormals;
  const double seconds = trace_packed_closest(scene_->scene, mode, coherent, rays, hits);
  scene_->check();
  return seconds;
}

double EmbreeContender::any_packed(EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                                   std::span<std::uint8_t> occluded) const {
  check_sizes(rays.size(), occluded.size());
  const SubnormalsAreZero subnormals;
  const double seconds = trace_packed_any(scene_->scene, mode, coherent, rays, occluded);
  scene_->check();
  return seconds;
}

void EmbreeContender::all_hits(std::span<const Ray> rays, RayLists<Hit>& lists) const {
  const SubnormalsAreZero subnormals;
  trace_all(scene_->scene, rays, lists);
  scene_->check();
}

}  // namespace raylanes::bench

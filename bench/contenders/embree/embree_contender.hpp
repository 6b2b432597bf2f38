// Intel Embree 3 (Wald, Woop, Benthin, Johnson, Ernst 2014) on the rays and plain data of our own tracers. A well-known
// contender stands beside every figure.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/queries.hpp>
#include <raylanes/types.hpp>

#include "../../support/scenes/parts.hpp"

namespace raylanes::bench {

struct RaySet;
struct Answers;

// How many rays one call of Embree takes: one, a packet, or any number, as records or as packets of 16. A width that
// the instruction set does not have natively still works: Embree then splits the packet itself.
enum class EmbreeMode { single, packet4, packet8, packet16, stream, packet_stream };
inline constexpr std::size_t max_embree_stream = 1024;  // rays: longer streams are several calls

// Its trees: of medium quality, its default; of high quality, with spatial splits; robust, of medium quality, without
// the shortcuts that lose accuracy; and of low quality, by Morton codes. One more is not traced, for meshes in motion:
// a dynamic scene of low quality, whose geometry is refitted; no other combination of its settings refits as fast.
enum class EmbreeBuild : std::uint8_t { medium, high, robust, low, refitted };
inline constexpr std::array<std::string_view, 4> embree_build_names{"medium", "high", "robust", "low"};

// One line: the file that the dynamic linker took for Embree, and what to know of it beside a ratio.
std::string embree_note();

// One static triangle mesh in a device of its own, built with one thread or more. Primitive numbers, u and v mean what
// they mean in Hit. Triangles are two-sided. As Embree's manual asks, subnormal numbers count as zero while it builds
// and traces; MXCSR is as before afterwards.
//
// Differences from our own contract, which are Embree's: rays with tmin < 0 or a finite coordinate beyond
// 1.844e18 are refused; the fast mode excludes t == tmin; ties in t go to any of the primitives. Rays that
// hit nothing by the contract of Ray (NaN, infinity, empty segment, zero direction) miss.
//
// While an instance lives, Embree limits oneTBB of the whole process to its threads: destroy it before
// anything parallel of our own is run or timed.
class EmbreeContender {
 public:
  // `isa` is "sse2", "sse4.2", "avx", "avx2", "avx512", or "" for the best one of this CPU. `threads` build; 0: one per
  // core. The vertices and triangles are copied.
  // Throws std::invalid_argument for another name of an instruction set and for an invalid mesh (see
  // validate_mesh), std::runtime_error if the CPU lacks the instruction set or Embree reports an error.
  EmbreeContender(std::span<const Float3> vertices, std::span<const Index3> triangles,
                  std::string_view isa = "", EmbreeBuild build = EmbreeBuild::medium, int threads = 1);
  // Parts of one mesh, each a geometry of its own: all in one scene, or each placed as an instance with the identity.
  // Hits are numbered as the triangles of the whole mesh.
  EmbreeContender(const Parts& parts, bool are_instances, std::string_view isa, EmbreeBuild build);
  ~EmbreeContender();

  // Wall-clock seconds of the copy of the mesh into Embree and the build of its tree.
  double build_seconds() const;

  // Moves the vertices of the same triangles and updates the tree. Returns the seconds that this took, without the copy
  // of the vertices into Embree. Throws std::invalid_argument for another number of vertices.
  double move(std::span<const Float3> vertices);

  // Whether the chosen instruction set traces packets of this mode without splitting them.
  bool native(EmbreeMode mode) const;

  // Traces a ray set into answers of its size, streams in calls of `batch` rays, at most max_embree_stream. `coherent`
  // passes Embree's hint that neighbouring rays are similar.
  // Throws std::invalid_argument if a ray is refused; answers may then be written in part. Only streams allocate.
  void trace(EmbreeMode mode, bool coherent, const RaySet& set, Answers& answers,
             std::size_t batch = 0) const;

  // Traces as trace() does. Returns the seconds of Embree's own calls: rays are in its layout before the clock starts,
  // and results are converted after it has stopped. Allocates that layout.
  double trace_packed(EmbreeMode mode, bool coherent, const RaySet& set, Answers& answers) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace raylanes::bench

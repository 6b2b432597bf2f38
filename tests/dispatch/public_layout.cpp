// The layout of public types, which programs compile in. The compiler refuses this file if one changes: then raise the
// minor version in meson.build, which the name of the shared library has, and write the new numbers here.
#include <cstddef>

#include <raylanes/raylanes.hpp>

namespace raylanes {
namespace {

template <class Type, std::size_t size, std::size_t alignment>
constexpr bool has = sizeof(Type) == size && alignof(Type) == alignment;

static_assert(has<AfterView, 32, 8>);
static_assert(has<Box, 24, 4>);
static_assert(has<BuildOptions, 56, 8>);
static_assert(has<BvhView, 64, 8>);
static_assert(has<ClosedReport, 80, 8>);
static_assert(has<ClosestPoint, 32, 8>);
static_assert(has<ClosestPointOptions, 56, 8>);
static_assert(has<CpuFeatures, 4, 4>);
static_assert(has<CpuidRegisters, 48, 8>);
static_assert(has<Crossing, 12, 4>);
static_assert(has<CrossingCount, 8, 4>);
static_assert(has<FaultyEdge, 16, 4>);
static_assert(has<Hit, 16, 4>);
static_assert(has<HitView, 24, 8>);
static_assert(has<IndexView, 32, 8>);
static_assert(has<KdBuildOptions, 40, 8>);
static_assert(has<KdNode, 8, 4>);
static_assert(has<KdReport, 128, 8>);
static_assert(has<KdTreeView, 56, 8>);
static_assert(has<LeafReference, 8, 4>);
static_assert(has<ListOptions, 104, 8>);
static_assert(has<LocateOptions, 56, 8>);
static_assert(has<Mesh, 48, 8>);
static_assert(has<Path, 40, 8>);
static_assert(has<PrimitiveView, 32, 8>);
static_assert(has<PointDistances, 96, 8>);
static_assert(has<Ray, 32, 4>);
static_assert(has<RayArrays, 72, 8>);
static_assert(has<RayView, 32, 8>);
static_assert(has<SceneCrossing, 20, 4>);
static_assert(has<SceneHit, 24, 4>);
static_assert(has<SceneHitView, 24, 8>);
static_assert(has<SceneStretchD, 40, 8>);
static_assert(has<SegmentEnds, 8, 4>);
static_assert(has<SegmentEndsD, 16, 8>);
static_assert(has<SignedDistanceOptions, 56, 8>);
static_assert(has<Sphere, 16, 4>);
static_assert(has<SphereArrays, 40, 8>);
static_assert(has<TraceCounters, 64, 8>);
static_assert(has<TraceOptions, 136, 8>);
static_assert(has<Transform, 48, 4>);
static_assert(has<TreeReport, 152, 8>);
static_assert(has<TriangleArrays, 80, 8>);
static_assert(has<TriangleD, 72, 8>);
static_assert(has<TriangleHits, 64, 8>);
static_assert(has<VertexView, 24, 8>);
static_assert(has<VisitOptions, 104, 8>);
static_assert(has<LeafBlock<9>, 320, 64>);
static_assert(has<WideNode, 256, 64>);
static_assert(has<BoundedTree, 8, 8>);
static_assert(has<Bvh, 24, 8>);
static_assert(has<KdTree, 24, 8>);
static_assert(has<PreparedRay, 176, 8>);
static_assert(has<PreparedTriangles, 80, 8>);
static_assert(has<Scene, 8, 8>);
static_assert(has<SphereTree, 8, 8>);
static_assert(has<TriangleTree, 16, 8>);
static_assert(has<BoundedBuildOptions, 16, 4>);

static_assert(offsetof(Ray, origin) == 0);
static_assert(offsetof(Ray, tmin) == 12);
static_assert(offsetof(Ray, direction) == 16);
static_assert(offsetof(Ray, tmax) == 28);
static_assert(offsetof(Hit, t) == 0);
static_assert(offsetof(Hit, u) == 4);
static_assert(offsetof(Hit, v) == 8);
static_assert(offsetof(Hit, primitive) == 12);
static_assert(offsetof(SceneHit, t) == 0);
static_assert(offsetof(SceneHit, u) == 4);
static_assert(offsetof(SceneHit, v) == 8);
static_assert(offsetof(SceneHit, primitive) == 12);
static_assert(offsetof(SceneHit, geometry) == 16);
static_assert(offsetof(SceneHit, instance) == 20);
static_assert(offsetof(Crossing, t) == 0);
static_assert(offsetof(Crossing, primitive) == 4);
static_assert(offsetof(Crossing, side) == 8);
static_assert(offsetof(ClosestPoint, distance_squared) == 0);
static_assert(offsetof(ClosestPoint, point) == 8);
static_assert(offsetof(ClosestPoint, u) == 20);
static_assert(offsetof(ClosestPoint, v) == 24);
static_assert(offsetof(ClosestPoint, primitive) == 28);
static_assert(offsetof(TraceOptions, test) == 0);
static_assert(offsetof(TraceOptions, grade) == 1);
static_assert(offsetof(TraceOptions, mode) == 2);
static_assert(offsetof(TraceOptions, hint) == 3);
static_assert(offsetof(TraceOptions, path) == 8);
static_assert(offsetof(TraceOptions, threads) == 16);
static_assert(offsetof(TraceOptions, active) == 24);
static_assert(offsetof(TraceOptions, skip) == 32);
static_assert(offsetof(TraceOptions, mask) == 64);
static_assert(offsetof(TraceOptions, masks) == 72);
static_assert(offsetof(TraceOptions, counters) == 88);
static_assert(offsetof(TraceOptions, after) == 96);
static_assert(offsetof(ListOptions, max_count) == 0);
static_assert(offsetof(ClosestPointOptions, max_distance) == 0);
static_assert(offsetof(SignedDistanceOptions, rule) == 0);
static_assert(offsetof(SignedDistanceOptions, max_distance) == 4);
static_assert(offsetof(LocateOptions, rule) == 0);

}  // namespace
}  // namespace raylanes

"""Calls of the module as pairs (name, function): each function returns the same bytes or values again and again."""

import copy
import io
import pickle
import types

import numpy as np

import raylanes
import raylanes.trimesh
from raylanes import _native

random = np.random.default_rng(1)
vertices = random.uniform(-1, 1, (300, 3)).astype(np.float32)
faces = np.arange(300, dtype=np.int32).reshape(100, 3)
rays = raylanes.rays(random.uniform(-2, 2, (200, 3)), random.normal(size=(200, 3)), dtype=np.float32)
doubles = vertices + random.uniform(-1e-9, 1e-9, (300, 3))
points = np.ascontiguousarray(rays["origin"])
numbers = random.uniform(1, 2, 100)
active = np.arange(200) % 3 != 0
mesh = types.SimpleNamespace(vertices=vertices.astype(np.float64), faces=faces)


def saved(tree):
    file = io.BytesIO()
    tree.save(file)
    return file.getvalue()


def reported(tree):
    return {name: value for name, value in tree.report().items() if not name.endswith("seconds")}


def refitted(tree, to=vertices):
    tree.refit(to, faces, threads=1)
    return tree


def lists(found):
    return found.offsets.tobytes() + found.items.tobytes()


def calls_of_trees():
    for kind in (raylanes.Bvh, raylanes.KdTree):
        name, tree = kind.__name__, kind(vertices, faces, threads=1)
        for builder in {"Bvh": ("binned_sah", "sweep_sah", "spatial_splits", "morton", "median", "equal_partition",
                                "auto"), "KdTree": ("sah", "midpoint")}[name]:
            yield f"{name}({builder})", lambda kind=kind, builder=builder: saved(
                kind(vertices, faces, builder=builder, threads=1))
        yield f"{name}.load", lambda kind=kind, data=saved(tree): saved(kind.load(io.BytesIO(data)))
        yield f"{name}.save", lambda tree=tree: saved(tree)
        yield f"pickle.dumps({name})", lambda tree=tree: pickle.dumps(tree)
        yield f"pickle.loads({name})", lambda data=pickle.dumps(tree): saved(pickle.loads(data))
        yield f"{name}.report", lambda tree=tree: reported(tree)
        yield f"repr({name})", lambda tree=tree: repr(tree)
        yield f"{name}.bounds", lambda tree=tree: tree.bounds.tobytes()
        yield f"{name}.nbytes", lambda tree=tree: tree.nbytes
        yield from ((f"{name}.{query}", call) for query, call in queries_of(tree))
    yield from calls_of_doubles()
    tree = raylanes.Bvh(vertices, faces, threads=1)
    yield "Bvh(optimize)", lambda: saved(raylanes.Bvh(vertices, faces, optimize=True, threads=1))
    yield "Bvh.refit", lambda: saved(refitted(tree))
    yield "Bvh.refit(shared)", lambda: saved(refitted(copy.copy(tree)))
    yield "copy.deepcopy(Bvh)", lambda: saved(copy.deepcopy(tree))
    yield "Bvh.sah_cost", lambda: (tree.sah_cost(), tree.decay())


def calls_of_doubles():
    tree = raylanes.Bvh(doubles, faces, threads=1)
    data = saved(tree)
    yield "Bvh(float64)", lambda: saved(raylanes.Bvh(doubles, faces, threads=1))
    yield "Bvh(float64 as float32)", lambda: saved(raylanes.Bvh(doubles, faces, dtype=np.float32, threads=1))
    yield "float64.load", lambda: saved(raylanes.Bvh.load(io.BytesIO(data)))
    yield "float64.pickle", lambda: saved(pickle.loads(pickle.dumps(tree)))
    yield "float64.repr", lambda: (repr(tree), reported(tree), tree.bounds.tobytes(), tree.nbytes, tree.decay())
    yield "float64.refit", lambda: saved(refitted(tree, doubles))
    yield "float64.refit(shared)", lambda: saved(refitted(copy.copy(tree), doubles))
    yield "float64.rays", lambda: raylanes.rays(doubles, doubles).tobytes()
    yield from ((f"float64.{query}", call) for query, call in queries_of(tree))


def queries_of(tree):
    for mode in ("single", "packet", "stream"):
        yield f"closest({mode})", lambda mode=mode: tree.closest(rays, mode=mode, threads=1).tobytes()
        yield f"occluded({mode})", lambda mode=mode: tree.occluded(rays, mode=mode, threads=1).tobytes()
    first = tree.closest(rays, threads=1)
    yield "closest(after)", lambda: tree.closest(rays, after=first, active=active, threads=1).tobytes()
    yield "closest(filter)", lambda: tree.closest(rays, filter=even, threads=1).tobytes()
    yield "occluded_from(filter)", lambda: tree.occluded_from(points[0], points, filter=even, threads=1).tobytes()
    yield "closest(skip)", lambda: tree.closest(rays, skip=first, active=active, threads=1).tobytes()
    yield "closest(origins)", lambda: tree.closest(origins=[0, 0, 2], directions=points, tmax=numbers[0]).tobytes()
    yield "occluded_from", lambda: tree.occluded_from(points[0], points, threads=1).tobytes()
    yield "closest(masks)", lambda: tree.closest(rays, masks=range(len(faces)), mask=2, threads=1).tobytes()
    yield "all_hits", lambda: lists(tree.all_hits(rays, threads=1))
    yield "crossings", lambda: lists(tree.crossings(rays, threads=1))
    yield "stretches", lambda: lists(tree.stretches(rays, threads=1))
    yield "count_crossings", lambda: tree.count_crossings(rays, threads=1).tobytes()
    for rule in ("parity", "nonzero", "vote", "winding"):
        yield f"locate({rule})", lambda rule=rule: tree.locate(points, rule=rule, threads=1).tobytes()
    yield "inside", lambda: tree.inside(points, threads=1).tobytes()
    yield "winding_numbers", lambda: tree.winding_numbers(points, threads=1).tobytes()
    yield "closest_points", lambda: tree.closest_points(points, threads=1).tobytes()
    yield "signed_distances", lambda: tree.signed_distances(points, threads=1).tobytes()


def other_calls():
    yield "closed_report", lambda: raylanes.closed_report(vertices, faces)
    for root in (raylanes.sqrt, raylanes.rsqrt, raylanes.reciprocal):
        yield root.__name__, lambda root=root: root(numbers).tobytes() + root(numbers, "2^-11").tobytes()
    yield "rays", lambda: raylanes.rays(points, points).tobytes()
    yield "paths", lambda: (raylanes.paths(), raylanes.active_path())
    yield "use_path", path_used
    yield "unknown name", name_refused
    yield "trimesh.RayMeshIntersector", lambda: raylanes.trimesh.RayMeshIntersector(mesh).intersects_first(
        points, points).tobytes()
    yield "trimesh.closest_point", lambda: raylanes.trimesh.closest_point(mesh, points)[2].tobytes()


def path_used():
    with raylanes.use_path("scalar"):
        return raylanes.active_path()


def name_refused():
    """Errors, too, take memory: a text that finds none is a MemoryError."""
    try:
        raylanes.sqrt(numbers, "3ulp")
    except ValueError as error:
        return str(error)
    raise AssertionError("3ulp is no accuracy")


def calls_of_scenes():
    tree, scene, spheres = raylanes.Bvh(vertices, faces, threads=1), placed(), raylanes.SphereTree(points, 0.25)
    data, hits = saved(scene), scene.closest(rays, threads=1)
    yield "Scene", lambda: saved(placed())
    yield "Scene(copied)", lambda: saved(changed(copy.copy(scene)))
    yield "Scene.load", lambda: saved(raylanes.Scene.load(io.BytesIO(data)))
    yield "pickle of Scene", lambda: saved(pickle.loads(pickle.dumps(scene)))
    yield "repr(Scene)", lambda: (repr(scene), scene.bounds.tobytes(), scene.transform_of([0, 1]).tobytes())
    yield "Scene.refit", lambda: saved(refitted_part(placed()))
    for mode in ("single", "packet", "stream"):
        yield f"Scene.closest({mode})", lambda mode=mode: scene.closest(rays, mode=mode, threads=1).tobytes()
        yield f"Scene.occluded({mode})", lambda mode=mode: scene.occluded(rays, mode=mode, threads=1).tobytes()
    yield "Scene.closest(filter)", lambda: scene.closest(rays, filter=even, threads=1).tobytes()
    yield "Scene.occluded(filter)", lambda: scene.occluded(rays, filter=even, threads=1).tobytes()
    yield "Scene.closest(skip)", lambda: scene.closest(rays, skip=hits, threads=1).tobytes()
    yield "Scene.closest(after)", lambda: scene.closest(rays, after=hits, active=active, threads=1).tobytes()
    yield "Scene.occluded_from", lambda: scene.occluded_from(points[0], points, threads=1).tobytes()
    yield "SceneHits.normals", lambda: hits.normals(scene, [(vertices, faces)], rays).tobytes()
    yield "SphereTree", lambda: raylanes.SphereTree(points, 0.25, threads=1).report()
    yield "pickle of SphereTree", lambda: pickle.loads(pickle.dumps(spheres)).centres.tobytes()
    yield "SphereTree.closest", lambda: spheres.closest(rays, threads=1).tobytes()
    yield "SphereTree.closest(after)", lambda: spheres.closest(
        rays, after=spheres.closest(rays, threads=1), filter=even, threads=1).tobytes()
    yield "SphereTree.occluded_from", lambda: spheres.occluded_from(points[0], points, threads=1).tobytes()
    yield "SphereTree.occluded", lambda: spheres.occluded(rays, threads=1).tobytes()
    yield "Scene(shared)", lambda: (saved(placed(tree)), saved(tree))
    yield from calls_of_scenes_of_doubles()


def calls_of_scenes_of_doubles():
    tree = raylanes.Bvh(doubles, faces, threads=1)
    scene = placed(tree)
    hits = scene.closest(rays, threads=1)

    data = saved(scene)

    def rearranged(of):
        of.move(0, np.eye(4)), of.set_mask([0, 1], [1, 2]), of.place(0, name="third"), of.set_moving(0)
        of.refit(0, doubles[::-1], faces, threads=1), of.replace(of.add(doubles, faces, threads=1), tree)
        of.place(of.add(scene)), of.update(threads=1)
        return of

    def masked():
        of = placed(tree)
        of.set_triangle_masks(0, range(50)), of.update(threads=1)
        return of

    yield "Scene(float64)", lambda: saved(placed(tree))
    yield "Scene(float64, changed)", lambda: saved(rearranged(placed(tree)))
    yield "Scene(float64, copied)", lambda: saved(rearranged(copy.copy(scene)))
    yield "Scene(float64).load", lambda: saved(raylanes.Scene.load(io.BytesIO(data)))
    yield "pickle of Scene(float64)", lambda: saved(pickle.loads(pickle.dumps(scene)))
    yield "repr(Scene(float64))", lambda: (repr(scene), scene.report(), scene.bounds.tobytes())
    yield "Scene(float64).closest(masks)", lambda: masked().closest(rays, mask=2, threads=1).tobytes()
    yield "Scene(float64).occluded", lambda: scene.occluded(rays, filter=even, threads=1).tobytes()
    yield "Scene(float64).closest(after)", lambda: scene.closest(rays, after=hits, active=active, threads=1).tobytes()
    yield "Scene(float64).closest(skip)", lambda: scene.closest(rays, skip=hits, filter=even, threads=1).tobytes()
    yield "Scene(float64).occluded_from", lambda: scene.occluded_from(points[0], points, threads=1).tobytes()
    yield "Scene(float64).closest_crossing", lambda: scene.closest_crossing(rays, threads=1).tobytes()
    for call, of in ((scene.all_hits, rays), (scene.crossings, rays), (scene.stretches, rays),
                     (scene.containing_parts, points)):
        yield f"Scene(float64).{call.__name__}", lambda call=call, of=of: [
            column.tobytes() for column in call(of, threads=1).columns().values()]
    yield "Scene(float64).count_crossings", lambda: scene.count_crossings(rays, threads=1).tobytes()
    for call in (scene.closest_points, scene.locate, scene.winding_numbers, scene.signed_distances,
                 scene.innermost_parts):
        yield f"Scene(float64).{call.__name__}", lambda call=call: call(points, threads=1).tobytes()
    yield "Scene(float64).corners", lambda: (scene.corners(hits).tobytes(), scene.normals(hits, threads=1).tobytes())


def even(indices, hits):
    return hits.primitive % 2 == 0


def placed(*trees):
    scene = raylanes.Scene()
    for tree in trees or [raylanes.Bvh(vertices, faces, threads=1)]:
        scene.place(scene.add(tree), [np.eye(4), np.eye(4) * [[2], [2], [2], [1]]])
    scene.update()
    return scene


def changed(scene):
    scene.move(0, np.eye(4))
    scene.set_mask([0, 1], [1, 2])
    scene.place(0), scene.replace(0, raylanes.SphereTree(points, 0.25, threads=1))
    scene.update()
    return scene


def refitted_part(scene):
    scene.refit(0, vertices[::-1], faces, threads=1)
    scene.update()
    return scene


def native_calls():
    """What the Python text calls, where nothing but Python itself allocates besides the module."""
    tree, kd_tree = (kind(vertices, faces, threads=1)._tree for kind in (raylanes.Bvh, raylanes.KdTree))
    of_doubles = raylanes.Bvh(doubles, faces, threads=1)._tree.to_bytes()
    data, bits = tree.to_bytes(), np.packbits(active, bitorder="little")
    of_triangles = np.arange(len(faces), dtype=np.uint32)
    yield "_native.Bvh", lambda: _native.Bvh(vertices, faces, "binned_sah", 1, False, 0.0, None).nbytes()
    yield "_native.KdTree", lambda: _native.KdTree(vertices, faces, "sah", 1, None).nbytes()
    yield "_native.Bvh(data)", lambda: _native.Bvh(data).to_bytes()
    yield "_native.Bvh(read)", lambda: _native.Bvh(io.BytesIO(data).read).to_bytes()
    yield "_native.Bvh(tree)", lambda: _native.Bvh(tree).to_bytes()
    yield "_native.BvhD", lambda: _native.BvhD(doubles, faces, "binned_sah", 1, False, 0.0, None).nbytes()
    yield "_native.BvhD(data)", lambda: _native.BvhD(of_doubles).to_bytes()
    yield "_native.BvhD(read)", lambda: _native.BvhD(io.BytesIO(of_doubles).read).to_bytes()
    yield "_native.BvhD.found_holes", lambda: _native.BvhD(of_doubles).found_holes()
    yield "_native.BvhD.found_inside_out", lambda: _native.BvhD(of_doubles).found_inside_out()
    yield "_native.reduce", lambda: tree.__reduce_ex__(4)[1]
    yield "_native.found_holes", lambda: _native.Bvh(vertices, faces, "binned_sah", 1, False, 0.0, None).found_holes()
    yield "_native.report", lambda: (tree.report(), kd_tree.report())
    yield "_native.bounds", lambda: tree.bounds()
    yield "_native.sah_cost", lambda: (tree.sah_cost(), tree.decay())
    yield "_native.all_hits", lambda: [found.tobytes() for found in tree.all_hits(
        rays, 0xFFFFFFFF, "any", None, 1, bits, None, None, None)]
    yield "_native.all_hits(progress)", lambda: [found.tobytes() for found in tree.all_hits(
        rays, 0xFFFFFFFF, "any", None, 1, bits, abs, np.zeros(len(rays), np.uint32), (2, of_triangles, 2))]
    yield "_native.Bvh(progress)", lambda: _native.Bvh(
        vertices, faces, "binned_sah", 1, False, 0.0, abs).nbytes()
    spheres = _native.SphereTree(np.ones((9, 4), np.float32), "median", 1)
    yield "_native.SphereTree", lambda: _native.SphereTree(spheres.spheres(), "median", 1).spheres().tobytes()
    yield "_native.SphereTree.reduce", lambda: spheres.__reduce_ex__(4)[1]
    yield "_native.SphereTree.reports", lambda: (spheres.bounds(), spheres.nbytes(), spheres.left_out(),
                                                 spheres.builder(), _native.SphereTree(spheres).nbytes())
    yield from native_calls_of_scenes(_native.Scene, np.float32, tree, spheres)
    yield from native_calls_of_scenes(_native.SceneD, np.float64, *[_native.BvhD(of_doubles)] * 2)
    yield "_native.closed_report", lambda: _native.closed_report(vertices, faces, 16)
    yield "_native.paths", lambda: (_native.paths(), _native.active_path(), _native.find_path("scalar"))


def native_calls_of_scenes(kind, real, tree, other):
    places, masks = np.tile(np.eye(4, dtype=real)[:3].reshape(12), (3, 1)), np.arange(3, dtype=np.uint32)
    records, name = np.zeros((3, 8 + places[0].nbytes), np.uint8), f"_native.{kind.__name__}"

    def made():
        scene = kind()
        scene.add(tree), scene.add(other)
        scene.place(0, places, masks), scene.place(1, places[:1], masks[:1])
        scene.update(1)
        return scene

    def after_changes(scene):
        scene.move(masks, places), scene.set_mask(masks, masks), scene.replace(1, tree), scene.update(1)
        scene.set_moving(masks, False), scene.update(1), scene.report()
        scene.instances(masks, records)
        return scene.to_bytes(), scene.bounds(), scene.nbytes(), scene.instance_count(), records.tobytes()

    data = made().to_bytes()
    yield name, lambda: made().to_bytes()
    yield f"{name}(data)", lambda: kind(data).to_bytes()
    yield f"{name}(read)", lambda: kind(io.BytesIO(data).read).to_bytes()
    yield f"{name}(changed)", lambda: after_changes(made())
    yield f"{name}(scene)", lambda scene=made(): after_changes(kind(scene))
    yield f"{name}.reduce", lambda scene=made(): scene.__reduce_ex__(4)[1]


def first_calls():
    """For a process that has made no call so far."""
    for kind in (raylanes.Bvh, raylanes.KdTree):
        yield f"first {kind.__name__}", lambda kind=kind: saved(kind(vertices, faces))
        yield f"first {kind.__name__}.signed_distances", lambda kind=kind: kind(
            vertices, faces, threads=1).signed_distances(points).tobytes()
    yield "first Bvh(float64)", lambda: saved(raylanes.Bvh(doubles, faces))
    yield "first Bvh.winding_numbers", lambda: raylanes.Bvh(vertices, faces).winding_numbers(points).tobytes()
    yield "first Scene", lambda: saved(placed())
    yield "first Scene.closest", lambda: placed().closest(rays).tobytes()
    yield "first SphereTree", lambda: raylanes.SphereTree(points, 0.25).closest(rays).tobytes()
    yield "first closed_report", lambda: raylanes.closed_report(vertices, faces)
    yield "first sqrt", lambda: raylanes.sqrt(numbers).tobytes()
    yield "first use_path", path_used

"""Hits in scenes, against exact arithmetic over transformed meshes."""

import numpy as np
import pytest

import raylanes
from meshes import any_bits, cube_faces, cube_vertices, random_rays, sphere, supported
from parts import Parts, miss, nearest, sphere_hits, number_types


@pytest.fixture(scope="module", params=number_types)
def expected(request):
    """Parts with their scene and all hits, by the mask of the call."""
    return [(parts, parts.scene(), {mask: parts.hits(mask) for mask in (0xFFFFFFFF, 0b101, 0b1000)})
            for parts in (Parts(seed, dtype=request.param) for seed in range(2))]


def items(hits):
    return [hit.item() for hit in hits]


@pytest.mark.parametrize("path", supported)
def test_the_nearest_hits_are_those_of_exact_arithmetic(expected, path):
    with raylanes.use_path(path):
        for parts, scene, by_mask in expected:
            for mask, hits in by_mask.items():
                for mode in ("automatic", "single", "packet", "stream"):
                    assert items(scene.closest(parts.rays, mask=mask, mode=mode)) == nearest(hits)
                    assert scene.occluded(parts.rays, mask=mask, mode=mode).tolist() == [bool(h) for h in hits]
            assert 20 < sum(map(bool, by_mask[0b101])) < sum(map(bool, by_mask[0xFFFFFFFF])) < len(parts.rays)
            assert not any(by_mask[0b1000])
            assert items(scene.closest(parts.rays)) == nearest(by_mask[0xFFFFFFFF])


def test_hits_one_behind_the_other_are_all_hits(expected):
    for parts, scene, by_mask in expected:
        for mask, hits in by_mask.items():
            before = scene.closest(parts.rays, mask=mask)
            for depth in range(1, max(map(len, hits)) + 1):
                behind = scene.closest(parts.rays, after=before, mask=mask)
                assert items(behind) == [h[depth] if depth < len(h) else miss for h in hits]
                assert scene.closest(parts.rays, after=before, mask=mask, out=before) is before
            assert not before.hit.any()
        first = np.full(len(parts.rays), np.array(miss, before.dtype))
        first["t"], first["primitive"], first["instance"] = -np.inf, 0, 0
        assert items(scene.closest(parts.rays, after=first)) == nearest(by_mask[0xFFFFFFFF])


@pytest.mark.parametrize("facing", ["front", "back"])
def test_sides_are_those_of_the_part(expected, facing):
    for parts, scene, _ in expected:
        hits = parts.hits(facing=facing)
        assert items(scene.closest(parts.rays, facing=facing)) == nearest(hits)
        assert scene.occluded(parts.rays, facing=facing).tolist() == [bool(h) for h in hits]
        second = scene.closest(parts.rays, after=scene.closest(parts.rays, facing=facing), facing=facing)
        assert items(second) == [h[1] if len(h) > 1 else miss for h in hits]


def test_shadows_from_a_point(expected):
    for parts, scene, _ in expected:
        dtype, middle = scene.dtype, parts.meshes[0][0].mean(axis=0)
        light, points = np.array([3, 2, 1], dtype) + middle, random_rays(7, 400)["origin"] + middle
        rays = raylanes.rays(points, light - points, 0.25, 0.75, dtype=dtype)
        for mask in (0xFFFFFFFF, 0b10):
            dark = scene.occluded_from(light, points, start=0.25, end=0.75, mask=mask)
            assert dark.tolist() == scene.occluded(rays, mask=mask).tolist() and 0 < dark.mean() < 1
        sun = scene.occluded_towards([3, 2, 1], points)
        assert sun.tolist() == scene.occluded(raylanes.rays(points, [3, 2, 1], dtype=dtype)).tolist() and sun.any()
        whole = scene.occluded_from(light, points.reshape(20, 20, 3))
        assert whole.tolist() == scene.occluded(raylanes.rays(points, light - points, 0, 1,
                                                              dtype=dtype)).reshape(20, 20).tolist()


def test_a_place_without_a_transform_has_the_hits_of_its_tree():
    tree, scene, rays = raylanes.Bvh(*sphere(triangles=500)), raylanes.Scene(), random_rays(1, 3000)
    scene.place(scene.add(tree))
    scene.update()
    found, expected = scene.closest(rays), tree.closest(rays)
    for name in raylanes.hit_dtype.names:
        assert found[name].tobytes() == expected[name].tobytes()
    assert found.positions(rays).tobytes() == expected.positions(rays).tobytes()
    assert found.barycentric.tobytes() == expected.barycentric.tobytes()
    for test in ("watertight", "moller_trumbore"):
        assert scene.closest(rays, test=test)["t"].tobytes() == tree.closest(rays, test=test)["t"].tobytes()
    assert np.abs(scene.bounds - tree.bounds).max() < 1e-4
    for threads in (1, 2):
        assert scene.closest(rays, threads=threads, grade="fast", hint="incoherent").tobytes() == found.tobytes()


def test_spheres_are_hit_where_float64_says():
    random = np.random.default_rng(3)
    centres, radii = random.uniform(-1, 1, (12, 3)).astype(np.float32), random.uniform(0.1, 0.4, 12).astype(np.float32)
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    transforms = np.float32([np.eye(4)[:3], np.column_stack([2 * turn, [1, 2, 3]])])
    tree, scene = raylanes.SphereTree(centres, radii), raylanes.Scene()
    assert scene.place(scene.add(tree), transforms).tolist() == [0, 1]
    scene.update()
    rays = random_rays(4, 1500, reach=4)
    rays["direction"][::2] = centres[np.arange(750) % 12] - rays["origin"][::2]
    rays["tmax"][::5] = 1
    alone, found = tree.closest(rays), scene.closest(rays)
    assert tree.occluded(rays).tolist() == alone.hit.tolist()
    assert scene.occluded(rays).tolist() == found.hit.tolist()
    looked_at = 0
    for i, ray in enumerate(rays):
        (t0, clear0), (t1, clear1) = (sphere_hits(ray, centres, radii, np.float64(m)) for m in transforms)
        for hit, t, clear in ((alone[i], t0, clear0), (found[i], np.append(t0, t1), np.append(clear0, clear1))):
            if not clear.all():
                continue
            looked_at += 1
            # A rounded ray is off by 2^-24 of its coordinates, all below 32. A clear chord makes seven times that of it
            # along the ray. With 16 ULP of the test that is less than 1e-4 where the spheres are, twice that here.
            assert hit.t == t.min() or abs(hit.t - t.min()) * np.linalg.norm(ray["direction"]) <= 2e-4
            if np.isfinite(t.min()) and np.sort(t)[1] - t.min() > 1e-3:
                assert hit.primitive == t.argmin() % 12
                assert "instance" not in hit.dtype.names or hit.instance == t.argmin() // 12
    assert looked_at > 500 and alone.hit.mean() > 0.3


def test_any_bits_are_rays_on_all_paths():
    scene = Parts(4).scene()
    scene.place(scene.add(raylanes.SphereTree([[0, 0, 0]], 0.5)))
    scene.update()
    rays = any_bits(1, 1000, raylanes.ray_dtype)
    rays[::2]["origin"] = random_rays(3, 500)["origin"]
    rays[::4]["direction"] = random_rays(4, 250)["direction"]
    hits = scene.closest(rays)
    for path in supported:
        with raylanes.use_path(path):
            assert scene.closest(rays).tobytes() == hits.tobytes()
            assert scene.occluded(rays).tolist() == hits.hit.tolist()
    assert hits.hit.any()


def test_what_is_never_hit():
    cube, rays = raylanes.Bvh(cube_vertices, cube_faces), random_rays(5, 200)
    scene = raylanes.Scene()
    assert not scene.closest(rays).hit.any() and (scene.bounds == [[np.inf] * 3, [-np.inf] * 3]).all()
    part, nothing = scene.add(cube), scene.add(raylanes.Bvh([], [], dtype=np.float32))
    empty = scene.add(raylanes.SphereTree(np.zeros((0, 3)), 1))
    flat, broken, infinite, far = (np.eye(4)[:3] for _ in range(4))
    flat[2, 2], broken[0, 1], infinite[1, 3], far[0, 3] = 0, np.nan, np.inf, 3.4e38
    scene.place(part, [flat, broken, infinite, np.float32(far), np.float32(far) * 0])
    scene.place(nothing), scene.place(empty), scene.place(part, mask=0)
    scene.update()
    assert not scene.closest(rays).hit.any() and not scene.occluded(rays).any()
    assert scene.instance_count == 8 and scene.geometry_count == 3
    assert scene.transform_of(1).tobytes() == broken.astype(np.float32).tobytes()
    with pytest.warns(RuntimeWarning, match="overflow"):
        scene.place(part, np.eye(4)[:3] * 1e39)
    scene.set_mask(7, 1)
    scene.update()
    assert scene.closest(rays).hit.any()


def world(parts, instance):
    vertices, faces = parts.meshes[parts.geometries[instance]]
    transform = parts.transforms[instance]
    return vertices.astype(float) @ transform[:, :3].T + transform[:, 3], faces


def test_normals_and_means_are_those_of_transformed_meshes(expected):
    for parts, scene, _ in expected:
        hits = scene.closest(parts.rays)
        values = [np.random.default_rng(k).uniform(size=(24, 2)) for k in range(3)]
        faces = [mesh[1] for mesh in parts.meshes]
        normals, means = hits.normals(scene, parts.meshes), hits.interpolate(values, faces)
        assert np.isnan(normals[~hits.hit]).all() and np.isnan(means[~hits.hit]).all()
        for instance in range(len(parts.transforms)):
            chosen = hits.instance == instance
            some = np.asarray(hits[chosen]).view(raylanes.Hits)
            mirrored = np.linalg.det(parts.transforms[instance][:, :3]) < 0
            in_scene = some.normals(*world(parts, instance)) * (-1 if mirrored else 1)
            assert np.allclose(normals[chosen], in_scene, atol=1e-12, equal_nan=True)
            of_part = some.interpolate(values[parts.geometries[instance]], faces[parts.geometries[instance]])
            assert means[chosen].tobytes() == of_part.tobytes()
        by_number = hits.normals(scene, dict(enumerate(parts.meshes)))
        assert by_number.tobytes() == normals.tobytes()
        one = hits[int(np.argmax(hits.hit))]
        assert isinstance(one, raylanes.SceneHit) and one.hit and one.geometry == parts.geometries[one.instance]
        assert one.normals(scene, parts.meshes).tobytes() == normals[np.argmax(hits.hit)].tobytes()
        assert one.interpolate(values, faces).shape == (2,)
        grid = scene.closest(parts.rays.reshape(7, 10))
        assert grid.normals(scene, parts.meshes).shape == (7, 10, 3)
        assert grid.interpolate([v[:, 0] for v in values], faces).shape == (7, 10)
        with pytest.raises(ValueError, match="^parts: there is nothing for geometry [12], which is hit$"):
            hits.normals(scene, parts.meshes[:1])
        with pytest.raises(ValueError, match="^values: the rows of all geometries must have one shape"):
            hits.interpolate([values[0], values[1][:, 0], values[2][:, 0]], faces)


def test_normals_of_spheres_point_from_their_centres():
    spheres, scene = raylanes.SphereTree([[1, 2, 3], [0, 0, 0]], [0.5, 1]), raylanes.Scene()
    matrix = np.array([[0, 2, 0, 1], [-1, 0, 0, 2], [0, 0, -4, 3]])
    scene.place(scene.add(spheres), [np.eye(4)[:3], matrix])
    scene.update()
    rays = random_rays(8, 2000, reach=8, dtype=np.float32)
    rays["direction"][::2] = matrix[:, 3] - rays["origin"][::2]
    hits = scene.closest(rays)
    assert len(set(hits.instance[hits.hit])) == 2
    normals = hits.normals(scene, [spheres], rays)
    # A step along the surface of an ellipsoid is a step along that of its sphere.
    for instance, transform in enumerate((np.eye(4)[:3], matrix)):
        chosen = hits.instance == instance
        local = np.linalg.solve(transform[:, :3], (hits.positions(rays)[chosen] - transform[:, 3]).T).T
        outward = local - spheres.centres[hits.primitive[chosen]]
        gradient = outward @ np.linalg.inv(transform[:, :3])
        assert np.allclose(normals[chosen], gradient / np.linalg.norm(gradient, axis=1, keepdims=True), atol=1e-9)
    assert np.isnan(normals[~hits.hit]).all()
    with pytest.raises(ValueError, match="^rays: the normals of spheres need them$"):
        hits.normals(scene, [spheres])
    with pytest.raises(ValueError, match="^parts: there are 1 spheres, and a hit is on 1$"):
        hits.normals(scene, [raylanes.SphereTree([[0, 0, 0]], 1)], rays)

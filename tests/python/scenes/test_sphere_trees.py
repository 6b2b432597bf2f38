"""Trees over spheres alone: their arrays, copies and errors."""

import pickle

import numpy as np
import pytest

import raylanes
from meshes import copies, random_rays, supported

random = np.random.default_rng(2)
centres, radii = random.uniform(-1, 1, (200, 3)).astype(np.float32), random.uniform(0.01, 0.2, 200).astype(np.float32)
rays = random_rays(1, 1000, reach=1)


def test_results_depend_on_neither_builder_nor_path_nor_threads():
    expected = raylanes.SphereTree(centres, radii).closest(rays)
    assert 0.2 < expected.hit.mean() < 1 and not expected.u.any() and not expected.v.any()
    for builder in ("binned_sah", "sweep_sah", "spatial_splits", "morton", "median", "equal_partition"):
        tree = raylanes.SphereTree(centres, radii, builder=builder, threads=2)
        assert tree.report()["builder"] == builder
        for path in supported:
            with raylanes.use_path(path):
                for threads in (1, 2):
                    assert tree.closest(rays, threads=threads).tobytes() == expected.tobytes()
                    assert tree.occluded(rays, threads=threads).tolist() == expected.hit.tolist()
    on_surface = np.linalg.norm(expected.positions(rays) - centres[expected.primitive % 200], axis=1)
    assert np.abs(on_surface - radii[expected.primitive % 200])[expected.hit].max() < 1e-5


def test_arrays_of_spheres():
    tree = raylanes.SphereTree(centres, radii)
    assert len(tree) == 200 and tree.centres.tobytes() == centres.tobytes() and tree.radii.tobytes() == radii.tobytes()
    for array in (tree.centres, tree.radii):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    kept = tree.centres
    del tree
    assert kept.tobytes() == centres.tobytes()
    for laid in (centres.astype(float), np.asfortranarray(centres), centres[::-1].copy()[::-1], centres.tolist()):
        other = raylanes.SphereTree(laid, radii.astype(float), dtype=np.float32)
        assert other.centres.tobytes() == centres.tobytes()
    assert raylanes.SphereTree(centres, 2).radii.tolist() == [2] * 200
    assert raylanes.SphereTree(centres, [0.5] * 200).radii.tolist() == [0.5] * 200
    empty = raylanes.SphereTree([], [])
    assert len(empty) == 0 and not empty.closest(rays).hit.any() and np.isinf(empty.bounds).all()
    box = raylanes.SphereTree([[0, 0, 0], [4, 0, 0]], [1, 2]).bounds
    assert box.dtype == np.float32 and np.abs(box - [[-1, -2, -2], [6, 2, 2]]).max() < 1e-3


def test_spheres_that_are_never_hit_are_told():
    odd = [[0, 0, 0], [np.nan, 0, 0], [0, 0, 0], [3e38, 0, 0], [0, 0, 9]]
    tree = raylanes.SphereTree(np.float32(odd), np.float32([1, 1, -1, 2e38, 1]))
    assert tree.report() == {"builder": "binned_sah", "spheres": 5, "left_out": 3, "bytes": tree.nbytes}
    assert repr(tree) == f"<raylanes.SphereTree of 5 spheres, 3 of them never hit, {tree.nbytes} bytes>"
    assert set(tree.closest(random_rays(2, 3000, reach=9)).primitive) == {0, 4, raylanes.no_primitive}
    assert repr(raylanes.SphereTree([[0, 0, 0]], 1)).startswith("<raylanes.SphereTree of 1 spheres, ")


def test_answers_go_where_they_are_wanted():
    tree = raylanes.SphereTree(centres, radii)
    active = np.arange(1000) % 3 == 0
    for ask, dtype in ((tree.closest, raylanes.hit_dtype), (tree.occluded, bool)):
        expected = ask(rays)
        assert ask(rays.reshape(10, 100)).tobytes() == expected.tobytes() and ask(rays[0]).shape == ()
        for out in (np.zeros(1000, dtype), np.zeros(3000, dtype)[::3], np.zeros(1000, dtype)[::-1]):
            assert ask(rays, out=out) is out and out.tobytes() == expected.tobytes()
        out = np.ones(1000, dtype)
        ask(rays, out=out, active=active)
        assert out[active].tobytes() == expected[active].tobytes() and (out[~active] == np.ones(1, dtype)).all()
        assert ask(rays, active=active)[active].tobytes() == expected[active].tobytes()
    assert not tree.closest(rays, active=active).hit[~active].any()


@pytest.mark.parametrize("copied", copies)
def test_copies_and_pickles(copied):
    tree = raylanes.SphereTree(centres, radii, builder="morton")
    tree.names = ["a"]
    other = copied(tree)
    assert other.closest(rays).tobytes() == tree.closest(rays).tobytes() and other.names == ["a"]
    assert other.centres.tobytes() == centres.tobytes() and other.report() == tree.report()
    buffers = []
    apart = pickle.dumps(tree, 5, buffer_callback=buffers.append)
    assert len(apart) < 300 and pickle.loads(apart, buffers=buffers).radii.tobytes() == radii.tobytes()


def test_what_is_wrong():
    wrong = [(ValueError, r"^centres: .* must have 3 numbers, its shape is \(200, 2\)$",
              lambda: raylanes.SphereTree(centres[:, :2], radii)),
             (ValueError, r"^radii: one number or the shape \(200,\) is needed, it is \(199,\)$",
              lambda: raylanes.SphereTree(centres, radii[1:])),
             (ValueError, "^radii: ", lambda: raylanes.SphereTree(centres, radii[:, None])),
             (TypeError, "^radii: real numbers are needed", lambda: raylanes.SphereTree(centres, "1")),
             (ValueError, "^centres: float32 does not hold these float64 numbers; a SphereTree has float32: pass dtype",
              lambda: raylanes.SphereTree([[0.1, 0, 0]], 1)),
             (ValueError, "^radii: float32 does not hold", lambda: raylanes.SphereTree([[0, 0, 0]], 0.1)),
             (ValueError, "^radii: float32 does not hold", lambda: raylanes.SphereTree([[0, 0, 0]], [0.1])),
             (ValueError, "^dtype: a SphereTree has float32$",
              lambda: raylanes.SphereTree(centres, 1, dtype=np.float64)),
             (ValueError, 'no "sah", but median', lambda: raylanes.SphereTree(centres, 1, builder="sah")),
             (ValueError, "^spheres: the bytes are cut$", lambda: raylanes._native.SphereTree(b"cut", "median", 1)),
             (ValueError, "-1 threads", lambda: raylanes.SphereTree(centres, 1, threads=-1)),
             (ValueError, "-1 threads", lambda: raylanes.SphereTree(centres, 1).closest(rays, threads=-1))]
    for error, sentence, call in wrong:
        with pytest.raises(error, match=sentence):
            call()

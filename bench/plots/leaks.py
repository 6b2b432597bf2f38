#!/usr/bin/env python3
"""Draws which rays leave a closed sphere unseen: rays from within to its vertices, by Embree's fast mode, its robust
mode and raylanes. Needs the module raylanes, NumPy, matplotlib and Debian's libembree3.

usage: leaks.py [--json FILE] PICTURE.png
"""
import ctypes
import json
import pathlib
import sys

import matplotlib
import numpy as np

import raylanes

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs/examples"))
from common import ball, mesh_of  # noqa: E402

# RTCRayHit: a ray of 48 bytes, a hit of 32.
RAY_HIT = np.dtype([("origin", "f4", 3), ("tnear", "f4"), ("direction", "f4", 3), ("time", "f4"), ("tfar", "f4"),
                    ("mask", "u4"), ("id", "u4"), ("flags", "u4"), ("normal", "f4", 3), ("uv", "f4", 2),
                    ("primitive", "u4"), ("geometry", "u4"), ("instance", "u4")])
ROBUST, TRIANGLES, INDICES, VERTICES, UINT3, FLOAT3 = 4, 0, 0, 1, 0x5003, 0x9003  # of rtcore_common.h and others


def embree_hits(vertices, faces, origins, directions, flags):
    """Whether each ray hits anything, by single rays of Embree."""
    lib, pointer = ctypes.CDLL("libembree3.so.3"), ctypes.c_void_p
    for name in ("rtcNewDevice", "rtcNewScene", "rtcNewGeometry", "rtcSetNewGeometryBuffer"):
        getattr(lib, name).restype = pointer
    device = pointer(lib.rtcNewDevice(None))
    scene, geometry = pointer(lib.rtcNewScene(device)), pointer(lib.rtcNewGeometry(device, TRIANGLES))
    lib.rtcSetSceneFlags(scene, flags)
    for kind, form, rows in ((VERTICES, FLOAT3, vertices), (INDICES, UINT3, faces.astype(np.uint32))):
        size = ctypes.c_size_t
        to = lib.rtcSetNewGeometryBuffer(geometry, kind, 0, form, size(12), size(len(rows)))
        ctypes.memmove(to, np.ascontiguousarray(rows).ctypes.data, rows.nbytes)
    lib.rtcCommitGeometry(geometry)
    lib.rtcAttachGeometry(scene, geometry)
    lib.rtcReleaseGeometry(geometry)
    lib.rtcCommitScene(scene)
    memory = np.zeros(len(origins) * RAY_HIT.itemsize + 16, np.uint8)
    rays = memory[-memory.ctypes.data % 16:][:len(origins) * RAY_HIT.itemsize].view(RAY_HIT)
    rays["origin"], rays["direction"], rays["tfar"] = origins, directions, np.inf
    for name in ("mask", "geometry", "instance"):
        rays[name] = 0xFFFFFFFF
    context = np.full(64, 0, np.uint8)
    context[16:20] = 0xFF  # no instance
    for i in range(len(rays)):
        lib.rtcIntersect1(scene, pointer(context.ctypes.data), pointer(rays.ctypes.data + i * RAY_HIT.itemsize))
    lib.rtcReleaseScene(scene)
    lib.rtcReleaseDevice(device)
    return rays["geometry"] == 0


def main(picture, results=None):
    vertices, faces = mesh_of(ball([0, 0, 0], 1, 0, 200))
    assert raylanes.closed_report(vertices, faces)["is_closed"]
    random = np.random.default_rng(84)
    targets = np.unique(vertices, axis=0)[random.integers(0, len(np.unique(vertices, axis=0)), 300_000)]
    origins = random.uniform(-0.5, 0.5, targets.shape).astype(np.float32)
    directions = targets - origins
    hit = {"Embree, fast mode": embree_hits(vertices, faces, origins, directions, 0),
           "Embree, robust mode": embree_hits(vertices, faces, origins, directions, ROBUST),
           "raylanes": raylanes.Bvh(vertices, faces).closest(origins=origins, directions=directions).hit}
    lost = {name: int((~some).sum()) for name, some in hit.items()}
    print(", ".join(f"{name}: {count:,} of {len(targets):,} rays lost" for name, count in lost.items()))
    if results:
        pathlib.Path(results).write_text(json.dumps({"rays": len(targets), "triangles": len(faces), "lost": lost}))
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 4.2), layout="constrained")
    for panel, (name, some) in zip(axes, hit.items()):
        panel.add_patch(plt.Circle((0, 0), 1, color="lightgray"))
        seen = ~some & (targets[:, 2] > 0)
        panel.plot(*targets[seen, :2].T, "o", color="#d55e00", markersize=0.6, markeredgewidth=0)
        panel.set(xlim=(-1.05, 1.05), ylim=(-1.05, 1.05), xticks=[], yticks=[], aspect="equal")
        panel.set_title(f"{name}\n{lost[name]:,} of {len(targets):,} rays leave unseen", fontsize=10)
        panel.axis("off")
    figure.savefig(picture, dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    arguments = sys.argv[1:]
    found = [arguments.pop(1), arguments.pop(0)][0] if arguments[:1] == ["--json"] else None
    sys.exit(main(*arguments, found) if len(arguments) == 1 else __doc__)

"""The tool as a user runs it, in a folder of small meshes."""
import base64
import json
import os
import pathlib
import re
import resource
import struct
import subprocess
import tempfile

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
FACES = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
BOX = "".join(f"v {i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8)) + FACES
BOX_ABOVE = BOX.splitlines(keepends=True)[:8] + [re.sub(r"\d", lambda number: str(int(number[0]) - 9), FACES)]
TETRAHEDRON_BYTES = struct.pack("<12f12B", *(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1),
                                *(0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3))
NODES = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
         "nodes": [{"mesh": 0, "children": [1, 2]}, {"mesh": 0, "translation": [2, 0, 0]},
                   {"mesh": 0, "scale": [1, 3, 1], "rotation": [0, 0.6, 0, 0.8], "translation": [-2, 0, 0]}],
         "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
         "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                       {"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}],
         "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
         "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64," +
                      base64.b64encode(TETRAHEDRON_BYTES).decode("ascii")}]}
MESHES = {"flat.obj": TRIANGLE, "box.obj": BOX, "open.obj": BOX.replace("f 5 6 8 7\n", ""),
          "groups.obj": "g below\n" + BOX + "g above\n" + "".join(BOX_ABOVE).replace(" 1\n", " 3\n"),
          "nodes.gltf": json.dumps(NODES),
          **{f"frame{n}.obj": f"v 0 0 {n}\nv 1 0 0\nv 0 1 0\nv 1 1 {-n}\nf 1 2 3\nf 2 4 3\n" for n in range(3)}}

# What --help says about exit statuses.
USAGE, INPUT, OUTPUT = 2, 3, 4
COMMANDS = ["isa", "roots", "kernels", "trace", "points", "trees", "report"]


def all_of(holds):
    """As all(), but of something: nothing is no evidence."""
    holds = list(holds)
    return bool(holds) and all(holds)


class Tool:
    def __init__(self, program, folder):
        self.program, self.folder, self.checks, self.failures = program, pathlib.Path(folder), 0, 0
        for name, text in MESHES.items():
            (self.folder / name).write_text(text, encoding="ascii")

    def run(self, *arguments, short_files=False, stdout=subprocess.PIPE, **environment):
        """With short_files no file may grow beyond 16 bytes, for root neither; Python ignores SIGXFSZ."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (16, 16))
        env = {k: v for k, v in os.environ.items() if k != "RAYLANES_PATH"} | environment
        return subprocess.run([self.program, *arguments], stdout=stdout, stderr=subprocess.PIPE, text=True, env=env,
                              cwd=self.folder, restore_signals=not short_files,
                              preexec_fn=limit if short_files else None)

    def check(self, holds, what, result=None):
        self.checks += 1
        if not holds:
            self.failures += 1
            print(f"FAILED: {what}" + (f": exit {result.returncode}\nstdout: {result.stdout}\nstderr: {result.stderr}"
                                       if result else ""))

    def expect_error(self, words, *arguments, status=USAGE, **environment):
        """One line of bounded length that a terminal can show, with these words, and that exit status."""
        result = self.run(*arguments, **environment)
        line = result.stderr.strip("\n")
        self.check(result.returncode == status and all(word in line for word in words) and len(line) < 2000 and
                   not {"\n", "\x1b"} & {*line}, f"{arguments} {environment} names {words}, exit {status}", result)

    def rows(self, name="out.json"):
        report = json.loads((self.folder / name).read_text(encoding="utf-8"))
        machine = report["machine"]
        assert report["schema_version"] == 1 and report["rows"], "no rows"
        assert machine["processor"] and machine["date"] and machine["commit"] and machine["build_type"]
        assert machine["flags"].startswith("-O") and machine["load_average"] >= 0
        return report["rows"]

    def png_size(self, name):
        header = (self.folder / name).read_bytes()[:24]
        return struct.unpack(">II", header[16:24]) if header[:8] == b"\x89PNG\r\n\x1a\n" else (0, 0)


def status_of(test, program):
    """The exit status of a test, which gets the tool in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        tool = Tool(str(pathlib.Path(program).resolve()), folder)
        test(tool)
    print(f"{tool.checks - tool.failures} of {tool.checks} checks passed")
    return 1 if tool.failures else 0

"""The tool as a user runs it, for the gates that watch its command line."""
import json
import os
import struct
import subprocess

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"

# What --help says about exit statuses.
WRONG_ANSWERS, USAGE, INPUT, OUTPUT = 1, 2, 3, 4


def all_of(holds):
    """As all(), but of something: nothing is no evidence."""
    holds = list(holds)
    return bool(holds) and all(holds)


class Tool:
    commands = ["isa", "roots", "kernels", "trace", "points", "trees", "report"]

    def __init__(self, program, benchmarks):
        self.program = program
        self.benchmarks = benchmarks
        self.failures = 0
        self.checks = 0

    def run(self, *arguments, **environment):
        env = {k: v for k, v in os.environ.items() if k != "RAYLANES_PATH"} | environment
        # The limit is that of the test, which grows where instrumentation makes all slow.
        return subprocess.run([self.program, *arguments], capture_output=True, text=True, env=env)

    def check(self, holds, what, result):
        self.checks += 1
        if not holds:
            self.failures += 1
            print(f"FAILED: {what}: exit {result.returncode}\nstdout: {result.stdout}\nstderr: {result.stderr}")

    def expect_error(self, words, *arguments, status=USAGE, **environment):
        result = self.run(*arguments, **environment)
        lines = result.stderr.strip("\n").split("\n")
        clear = len(lines) == 1 and all(word in lines[0] for word in words)
        self.check(result.returncode == status and clear,
                   f"{arguments} {environment} names {words} in one line, exit {status}", result)
        return result


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        report = json.load(file)
    machine = report["machine"]
    assert report["schema_version"] == 1
    assert machine["processor"] and machine["date"] and machine["commit"] and machine["build_type"]
    assert machine["flags"].startswith("-O") and machine["load_average"] >= 0
    assert report["rows"], f"{path}: no rows"
    return report["rows"]


def png_size(path):
    with open(path, "rb") as file:
        header = file.read(24)
    return struct.unpack(">II", header[16:24]) if header[:8] == b"\x89PNG\r\n\x1a\n" else (0, 0)

"""Faults of users, files and disks, by exit status: words of the one line that is said, and the call."""
import re

from tool_user import COMMANDS, INPUT, OUTPUT, TRIANGLE, USAGE


BAD_FILES = {"range.obj": TRIANGLE.replace("1 2 3", "1 2 4").encode(), "mesh.xyz": b"",
             "hostile.obj": b"v 0 0 \x1b]0;title\x07" + b"x" * 100000 + b"\n"}
HALL, FRAMES = "trace hall --size 8x8 --seconds 0", "trees --frames frame0.obj frame1.obj"
FAULTS = {
    INPUT: [("range.obj 4", "trace range.obj"), ("mesh.xyz .obj", "trace mesh.xyz"),
        ("missing.obj", "trace missing.obj"), ("hostile.obj", "trace hostile.obj"),
        ("isa.json", "report --summary nowhere")],
    USAGE: [("sphere spheres hall fractal foliage", "trace sphere"), ("sse3 scalar", "trace flat.obj --path sse3"),
        ("no path avx2", "trace hall --path "), ("primary shadow diffuse", "trace hall --rays secondary"),
        ("--rays primary", "trace hall --rays "), ("watertight moller_trumbore", "trace hall --test exactly"),
        ("reproducible fast", "trace hall --grade best"), ("--mode packet", "trace hall --mode "),
        ("reproducible", "trace hall --counters --grade fast"),
        ("1073741824 pixels are too many 16777216", "trace hall --size 32768x32768"),
        ("embree", "trace hall --against nobody"), ("--query", "trace hall --against cgal"),
        ("--doubles", "trace hall --offset 1"), ("--samples 5 square", "trace --samples 5"),
        ("--against", "trace hall --against scene --tree kdtree"),
        ("--against", "trace hall --against user --test watertight"),
        ("--parts groups 1000000", "trace hall --parts 0"), ("--parts", "trace hall --parts 2 --doubles"),
        ("--skip exact", "trace hall --skip --doubles"), ("--skip exact", "trace hall --skip --test watertight"),
        ("median kdtree", "trace hall --tree kdtree --build median"), ("midpoint bvh", "trace hall --build midpoint"),
        ("bvh kdtree", "trace hall --tree octree"), ("--tree auto", "trace hall --tree auto --build median"),
        ("watertight plane_edges", "kernels --test best"), ("hardware goldschmidt", "roots --method hardware,best"),
        ("--grid 4x3", "points box.obj --grid 4x3"), ("--grid 16777216", "points --grid 2000x2000x2000"),
        ("not closed", "points hall --query inside --count 1 --against cgal"),
        ("--threads", "points hall --against cgal --threads 2"), ("median morton", "trees hall --build best"),
        ("--path", "trees hall --path all"), ("--stages --size", "trees hall --stages --size 8x8"),
        ("--rounds", "trees hall --rounds 2"), ("--choose", "trees hall --choose --build median"),
        ("at least two", "trees --frames frame0.obj"), ("flat.obj 1 triangles 2", "trees --frames frame0.obj flat.obj"),
        ("refit rebuild auto", FRAMES + " --policy never"), ("--build", FRAMES + " --build median"),
        ("--frames", "trees frame0.obj --policy refit"), ("--out --compare --summary", "report"),
        ("--format --json", "isa --format csv --json -"), ("table csv markdown", "isa --format xml"),
        ("promise max_ulp", "roots --format csv --columns promise"),
        *(("no_such_column all", call + " --columns no_such_column") for call in ("isa", "roots", "trace hall")),
        ("", "sqrt"), *(("", call + "=\x1b[2J") for call in ("trace hall --rays", "trace --camera", "isa --path")),
        ("", "roots --method=\x1b[2J" + "x" * 100000), ("", "trace \x1b[31mred")],
    OUTPUT: [("picture.png", HALL + " --image /nonexistent/picture.png"), ("irectory", HALL + " --image ."),
        ("rows.json", "isa --json /nonexistent/rows.json"), ("", "isa --json /\x1b[2J/rows.json"),
        ("hall.png", "trees hall --build median --size 8x8 --seconds 0 --heatmap /nonexistent"),
        ("", "isa --json /dev/full")],
}
# No option of any command takes these as a number. KNOWN options, at least, must be listed by --help with limits.
WRONG = ["-1", "99999999999999999999", "1e400", "nan", "-inf", "infinity", "1x", "0x10", " 1", "+1", "1,", "", "--"]
KNOWN = {"roots": {"--seconds", "--stride"}, "kernels": {"--seconds", "--pairs", "--leak-rays"},
         "trace": {"--threads", "--seconds", "--samples", "--batch", "--subdivide"},
         "points": {"--count", "--threads", "--seconds", "--holes", "--accuracy", "--beta", "--subdivide"},
         "trees": {"--threads", "--seconds", "--rounds", "--copies", "--subdivide"}, "report": {"--seconds"},
         "isa": set()}
SEVERAL = [("trace", "--size", "WIDTHxHEIGHT"), ("trace", "--camera", "number"), ("points", "--grid", "NxNxN"),
           ("trees", "--size", "WIDTHxHEIGHT")]


def test_faults(tool):
    for name, content in BAD_FILES.items():
        (tool.folder / name).write_bytes(content)
    for status, faults in FAULTS.items():
        for words, call in faults:
            tool.expect_error(words.split(), *call.split(" "), status=status)
    tool.expect_error(["sse3", "scalar"], "isa", RAYLANES_PATH="sse3")


def test_numbers(tool):
    """Every option that takes numbers refuses all others, in a line that names it, what was given and its limits."""
    for command in COMMANDS:
        result = tool.run(command, "--help")
        options = re.findall(r"^  (--[a-z-]+) (INT|FLOAT|UINT) in \[(\S+) - (\S+)\]", result.stdout, re.MULTILINE)
        tool.check({option for option, *_ in options} >= KNOWN[command] and
                   len(options) == len(re.findall(r"^  --[a-z-]+ (?:INT|FLOAT|UINT)\b", result.stdout, re.MULTILINE)),
                   f"{command}: numbers with limits in --help", result)
        for option, kind, least, most in options:
            beyond = ([repr(float(least) - 1e-9), repr(float(most) * (1 + 1e-9))] if kind == "FLOAT" else
                      [str(int(least) - 1), str(int(most) + 1), "1.5", "1e2"])
            for value in WRONG + beyond:
                words = [f'{option}: "{value}" is not ', f" from {least} to {most}"]
                # The parser takes -- for the end of the options.
                tool.expect_error(words if value != "--" else [option], command,
                                  *(["--frames"] if command == "trees" else []), option, value)
    for command, option, word in SEVERAL:
        for value in WRONG + ["1x1x1x1", "-1x1", "10x10x10x", "nan,0,0,0,0,1", "1,2,3,4,5,6x"]:
            tool.expect_error([option] if value == "--" else [option, word if value else ""], command, option, value)


def test_lost_output(tool):
    """Output that gets lost is an error, and leaves the file of before. WholeFile's tests have every kind of file."""
    with open("/dev/full", "wb") as full:
        for call in (["isa"], ["isa", "--json", "-"], ["--help"], ["trace", "--help"]):
            result = tool.run(*call, stdout=full)
            tool.check(result.returncode == OUTPUT and "standard output" in result.stderr, f"{call} is lost", result)
    for call in ("isa --json kept", HALL + " --mode single --image kept", HALL + " --mode single --heatmap heat",
                 "points hall --count 10 --query closest --seconds 0 --grid 9x9x2 --image kept"):
        (tool.folder / "heat").mkdir(exist_ok=True)
        file = tool.folder / ("heat/hall.png" if "heatmap" in call else "kept")
        file.write_text("old")
        result = tool.run(*call.split(), short_files=True)
        kept = file.read_text() == "old" and not [*tool.folder.rglob("*.part")]
        tool.check(kept and result.returncode == OUTPUT and "cannot be written" in result.stderr,
                   f"{call}: a short file", result)
        tool.check(tool.run(*call.split()).returncode == 0 and file.stat().st_size > 16, f"{call}: written", result)

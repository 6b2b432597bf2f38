"""Good runs of the tool: what is called, and what holds of its rows and of its output."""
import csv
import io
import json
import os
import pathlib
import re

from tool_user import TRIANGLE, all_of

MAX_WIDTH = 100


def of(rows, **wanted):
    return [row for row in rows if all(row.get(key) == value for key, value in wanted.items())]


def values(rows, *keys):
    return {tuple(row[key] for key in keys) if len(keys) > 1 else row[keys[0]] for row in rows}


def calls_are_batches(rows):
    keys = ("rays", "path", "test", "hits")
    return values(of(rows, mode="call"), *keys) == values(of(rows, mode="single"), *keys) and all_of(
        row["batch"] == 1 for row in of(rows, mode="call"))


def right(rows, **wanted):
    return all_of(row["wrong"] == 0 < row.get("judged", 1) for row in of(rows, **wanted))


def roots_are_as_good_as_promised(rows):
    """Also: every path has a correctly rounded root that is, and errors of doubles come near their bounds."""
    return (all_of(row["specials_ok"] or row["unchecked"] for row in rows) and values(rows, "path") == values(
        [row for row in of(rows, correctly_rounded=1) if "correctly_rounded" in row["serves"]], "path") and all_of(
            0.9 * row["max_ulp_promised"] < row["max_ulp"] <= row["max_ulp_promised"]
            for row in of(rows, function="double_sqrt", method="classic_0")))


def choices_are_told(row):
    built = values(row["costs"], "build")
    return len(row["choices"]) == 5 and all_of(
        {choice["build"], choice["best"]} <= built and choice["regret"] >= 0 and
        choice["why"].startswith(choice["build"]) for choice in row["choices"])


def tests_per_ray(rows):
    return [[kind["triangle_tests_per_ray"] for kind in row["counted"]["rays"]] for row in rows]


def frames_follow(rows):
    each, policies = [row for row in rows if "frame" in row], [row for row in rows if "frames" in row]
    return (len(each) == 6 and values(policies, "policy") == {"refit", "rebuild", "auto"} and
            all_of(row["built"] == (row["policy"] == "rebuild") for row in each if row["policy"] != "auto") and
            all_of(row["triangles"] == 6 for row in rows))


BUILDERS = ["binned_sah", "median", "equal_partition", "sweep_sah", "spatial_splits", "morton",
            "binned_sah+optimized", "spatial_splits+optimized", "morton+optimized"]
WAYS = {("scene", "automatic"), ("scene_turned", "automatic"), ("scene", "call"), ("scene_turned", "call"),
        ("user_leaves", "automatic"), ("user_rays", "automatic"), ("user_visits", "automatic")}
# Arguments, to which --json out.json and, where it is an option, --seconds 0 come; a picture that is written and its
# least size; what the output says; what holds of the rows.
RUNS = [
    ("isa", None, "", lambda rows: len(of(rows, active=True)) == 1 and of(rows, path="scalar")[0]["supported"]),
    ("isa --path scalar", None, "", lambda rows: values(rows, "path") == {"scalar"}),
    ("roots --path all --stride 4096", None, "", roots_are_as_good_as_promised),
    ("kernels --test exact,line --pairs 100 --leak-rays 1000", None, "", lambda rows:
     values(rows, "grade") == {"reproducible", "fast"} and values(rows, "test") == {"exact", "line"} and
     all_of(row["nanoseconds_per_primitive"] > 0 and not row["leaks_per_million"] and
            {*row["wrong_per_million"].values()} <= {0, None} for row in of(rows, test="exact"))),
    ("trace hall --size 96x64 --path all --rays primary,shadow,light,diffuse,ao --image hall.png",
     ("hall.png", 96, 64), "same bytes", lambda rows: values(of(rows, rays="primary"), "hits") == {96 * 64}),
    ("trace hall --size 32x24 --mode single,call --path all --rays primary,shadow --test exact,watertight --warm", None,
     "", lambda rows: calls_are_batches(rows) and values(rows, "warm") == {True}),
    ("trace hall --size 24x16 --mode single,automatic,call --rays primary,shadow,diffuse --batch 100,0 --skip", None,
     "", lambda rows: calls_are_batches(rows) and values(rows, "skips") == {True}),
    ("trace hall --query all,crossings,count,kept,spheres,own --size 24x16 --against cgal", None, "", lambda rows:
     right(rows, contender="raylanes") and values(rows, "query") ==
     {"all", "crossings", "count", "kept, leaves cut out", "spheres", "own spheres",
      *(f"kept, {share} % rejected" for share in (0, 50, 90))}),
    ("trace hall --doubles --offset 1e6 --size 16x16 --rays primary,ao --against cgal", None, "", lambda rows:
     values(rows, "rays") == {"primary", "ao", "edges"} and right(rows, contender="raylanes")),
    ("trace hall --against scene,user --mode automatic,stream,call --size 24x16", None, "", lambda rows:
     values([row for row in rows if row["contender"] != "raylanes"], "contender", "mode") == WAYS and
     all_of(row["ratio_to_tree"] > 0 and not row.get("wrong_per_million")
            for row in of(rows, contender="scene") + of(rows, contender="scene_turned"))),
    ("trace spheres --parts 100 --against scene --mode automatic,call --size 24x16", None, "parts; update()",
     lambda rows: values(rows, "contender", "mode") == {(name, mode) for name in ("raylanes", "scene", "scene_moving")
                                                        for mode in ("automatic", "call")} and
     not any(row.get("wrong_per_million") for row in rows)),
    ("trace groups.obj --parts groups --against scene --size 8x8", None, "2 parts", lambda rows:
     values(rows, "triangles") == {24} and not any(row.get("wrong_per_million") for row in rows)),
    ("trace nodes.gltf --parts groups --against scene --subdivide 1 --size 32x32", None, "3 parts", lambda rows:
     values(rows, "triangles") == {48} and len(of(rows, contender="scene", rays="primary")) == 1 and
     len(values(of(rows, rays="primary"), "hits")) == 1),
    ("trace hall --build spatial_splits --optimize --size 8x8", None, "",
     lambda rows: values(rows, "build") == {"spatial_splits+optimized"}),
    ("points box.obj --points grid --grid 4x3x2 --query inside,signed --image slice.png --against cgal",
     ("slice.png", 4, 3), "blue inside", lambda rows: right(rows) and values(rows, "inside", "judged") == {(24, 24)} and
     [row["contender"] for row in rows] == ["bvh", "kdtree", "bvh", "cgal", "bvh", "kdtree"]),
    ("points open.obj --points grid --grid 4x4x4 --query inside --rule vote", None, "not closed: 4 edges are open",
     lambda rows: right(rows) and values(rows, "inside") == {64}),
    ("points hall --query closest --count 500 --against cgal", None, "", lambda rows:
     values(rows, "contender") == {"bvh", "kdtree", "cgal"} and
     all_of(row["largest_difference"] < 1e-9 for row in rows)),
    ("points box.obj hall --path all --count 300", None, "", lambda rows:
     len(values(rows, "scene", "query", "points")) == 12 and
     all_of(row["point_count"] == 300 and row["largest_difference"] == 0 for row in rows) and
     right([row for row in of(rows, scene="box") if row["query"] != "closest"])),
    ("points hall --query winding --against barill --path all --count 300 --points box --holes 4", None, "",
     lambda rows: rows[-1]["winding_error"] > 0 and all_of(
         row["largest_difference"] == 0 and row["winding_error"] < 2e-6 and row["judged"] == 200 for row in rows[:-1])),
    ("points flat.obj --query winding --points box,surface,grid --grid 9x9x3 --count 300 --path all", None, "", right),
    ("trees hall --choose --size 24x16", None, "same bytes", lambda rows: choices_are_told(rows[0])),
    ("trees hall --stages --subdivide 1 --rounds 1", None, "", lambda rows:
     [row["build"] for row in rows] == ["binned_sah", "morton"] and
     all_of(0 < row["held_bytes"] <= row["build_peak_bytes"] and row["triangles"] == 248096 for row in rows)),
    ("trees --frames frame0.obj frame1.obj frame2.obj --size 24x16 --rounds 1 --copies 3", None, "same bytes",
     frames_follow),
]
COUNTED = [
    ("trace hall --size 96x64 --path all --counters --heatmap .", ("hall.png", 97, 129), "", lambda rows:
     all_of(row["triangle_tests_per_ray"] >= 1 for row in of(rows, mode="single", rays="primary"))),
    ("trees hall --size 32x24 --rays primary,ao --threads 2 --heatmap .", ("hall.png", 1200, 24), "same bytes",
     lambda rows: [row["build"] for row in rows] == BUILDERS and tests_per_ray(rows)[0] < tests_per_ray(rows)[1]),
    *((f"trace hall --tree kdtree --build {build} --size 64x48 --path all --counters --heatmap .",
       ("hall.png", 64, 48), "same bytes", lambda rows, build=build: values(rows, "tree", "build") ==
       {("kdtree", build)} and all_of(row["triangle_tests_per_ray"] > 0 for row in rows))
      for build in ("midpoint", "sah")),
]
BESIDE_EMBREE = [
    ("trace hall --size 32x24 --mode call --against embree", None, "", lambda rows:
     values(rows, "mode") == {"call", "call_packed"} and
     all_of(row["ratio"] > 0 and row["ratio_to"].endswith(" call") for row in of(rows, contender="raylanes"))),
    ("trace hall --size 32x24 --mode automatic,call --batch 1,8,100 --against embree", None, "", lambda rows:
     values(of(rows, mode="stream", build="medium"), "batch") == {1, 8, 100} and
     values(of(rows, mode="packet_stream", build="medium"), "batch") == {100} and
     all_of("coherent" not in row["mode"] for row in of(rows, rays="diffuse")) and
     all_of(row["ratio_to_calls"] > 0 for row in of(rows, mode="automatic")) and
     {row["ratio_to"].split()[-1] for row in of(rows, batch=1, mode="automatic")} <= {
         "single", "stream", "stream_coherent"}),
    ("trace hall --size 32x24 --mode automatic --batch 1,100 --streams 32 --against embree", None, "", lambda rows:
     values(of(rows, mode="packet_stream", build="high"), "batch") == {32} == values(of(rows, mode="stream"), "batch")),
    ("trace hall --size 32x24 --mode automatic --against embree", None, "", lambda rows:
     all_of(row["embree_wrong"] == 0 for row in rows if row["mode"].endswith("_packed")) and
     all_of(row["ratio_to_packed"] > 0 and "packed" not in row["ratio_to"] for row in of(rows, contender="raylanes"))),
    ("trace hall --test exact,moller_trumbore --grade fast --size 32x32 --against embree", None, "", lambda rows:
     all_of(row["ours_wrong"] == 0 and ("apart_per_million" in row) == (row["test"] != "exact")
            for row in of(rows, contender="raylanes"))),
    ("trace spheres --parts 40 --size 24x16 --rays primary,diffuse --mode automatic,call --against scene,embree", None,
     "", lambda rows: values(rows, "contender") ==
     {"raylanes", "scene", "scene_moving", "embree", "embree_instances"} and
     all_of(row["ratio"] > 0 for row in rows if not row["contender"].startswith("embree")) and
     all_of(row["ours_wrong"] == 0 for row in rows if "ours_wrong" in row)),
    ("trace nodes.gltf --parts groups --size 24x16 --rays primary --mode call --against scene,embree", None, "3 parts",
     lambda rows: len(of(rows, contender="embree_instances")) > 0 and
     all_of(row["ours_wrong"] == 0 for row in rows if "ours_wrong" in row) and len(values(rows, "hits")) == 1),
    ("trees hall --stages --rounds 1 --threads 2 --against embree", None, "", lambda rows: len(rows) == 5 and
     all_of({"build_ratio_to_embree", "refit_ratio_to_embree"} <= row.keys() for row in rows[:2])),
    ("trees --frames frame0.obj frame1.obj frame2.obj --size 8x8 --rounds 1 --against embree", None, "",
     lambda rows: sum("embree_refit_seconds" in row for row in rows) == 2),
]


def width_faults(text):
    """Lines too wide for a terminal, other than notes, which are sentences."""
    return [line for line in text.split("\n") if len(line) > MAX_WIDTH and
            not line.startswith(("Embree of ", "chosen: ", "slice: "))]


def test_runs(tool, runs, skip=""):
    """Each run is good, fits a terminal, writes its picture, and its rows hold. Without what `skip` names none does."""
    for call, picture, says, holds in runs:
        words = [*call.split(), "--json", "out.json"]
        if words[0] != "isa" and not {"--stages", "--frames"} & {*words}:
            words += ["--seconds", "0"]
        result = tool.run(*words)
        if skip and skip in result.stderr:
            print(f"SKIPPED: {len(runs)} runs, {result.stderr.strip()}")
            return
        good = result.returncode == 0 and says in result.stdout and not width_faults(result.stdout)
        tool.check(good and holds(tool.rows()), f"{call}: {width_faults(result.stdout)}", result)
        if picture:
            (name, *least), size = picture, tool.png_size(picture[0])
            exact = "--image" in words
            tool.check(size == tuple(least) if exact else size >= tuple(least), f"{call}: a picture of {size}", result)


def test_formats(tool):
    """CSV, Markdown and JSON have the rows of --json on standard output, and nothing else; names are made harmless."""
    hostile = os.fsencode(tool.folder) + b"/a|b,\"c\"\xe9\x1b[31m.obj"
    pathlib.Path(os.fsdecode(hostile)).write_text(TRIANGLE)
    call = ["trace", "hall", hostile, "--size", "16x12", "--seconds", "0", "--mode", "single,call", "--rays", "primary",
            "--json", "out.json"]
    result = tool.run(*call, "--format", "csv")
    rows, lines = tool.rows(), list(csv.DictReader(io.StringIO(result.stdout, newline="")))
    scenes = ["hall", "hall", *2 * ['a|b,"c"\\xe9\\x1b[31m']]
    same = all_of(str(row[key]) == cell for row, line in zip(rows, lines) for key, cell in line.items()
                  if isinstance(row.get(key), (int, str)) and not isinstance(row[key], bool) and row["scene"] == "hall")
    tool.check(result.returncode == 0 and len(rows) == 4 and same and [line["scene"] for line in lines] == scenes,
               "CSV has the values of JSON", result)
    result = tool.run(*call, "--format", "markdown")
    titles, dashes, *cells = ([cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
                              for line in result.stdout.strip().split("\n"))
    tool.check("Mrays/s" in titles and {*dashes} == {"---"} and [line[0] for line in cells] == scenes and
               all_of(len(line) == len(titles) for line in cells), "a table of Markdown", result)
    result = tool.run(*call, "--format", "json")
    tool.check(json.loads(result.stdout)["rows"] == tool.rows(), "JSON on standard output is that of --json", result)
    for words, shown in ((["--format", "csv"], "hits,scene\n192,hall\n"), ([], "\nhits  scene\n 192  hall\n")):
        result = tool.run(*call[:2], *call[3:], *words, "--columns", "hits,scene")
        tool.check(shown in result.stdout, "named columns in their order", result)
    result = tool.run("roots", "--stride", "524288", "--seconds", "0", "--method", "hardware", "--columns", "all")
    tool.check(result.returncode == 0 and width_faults(result.stdout), "all columns are wider", result)
    result = tool.run("isa", "--json", "-")
    tool.check(len(json.loads(result.stdout)["rows"]) > 1 and "supported" in result.stderr, "--json -", result)

"""How the tool prints: tables that fit a terminal, and rows as CSV, Markdown and JSON on standard output."""
import csv
import io
import json
import os
import re

from tool_user import TRIANGLE, all_of, rows_of

# Tables and --help have at most so many characters in a line.
MAX_WIDTH = 100


def width_faults(text):
    """Lines that are wider than people are promised; the note about a packaged Embree is a sentence, no table."""
    return [line for line in text.split("\n") if len(line) > MAX_WIDTH and not line.startswith("Embree of ")]


def cells_of_markdown(text):
    lines = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in text.strip().split("\n")]
    return lines[0], lines[1], lines[2:]


def json_value(cell):
    try:
        return json.loads(cell)
    except (TypeError, ValueError):
        return cell or None


# Runs whose tables have their widest cells.
LISTS = [
    ("isa",), ("isa", "--verify"), ("roots", "--stride", "65536", "--seconds", "0", "--path", "all"),
    ("kernels", "--test", "exact,moller_trumbore_edges,line", "--pairs", "20", "--leak-rays", "20", "--seconds", "0"),
    ("trace", "hall", "spheres", "--test", "exact,moller_trumbore", "--path", "all", "--mode", "automatic,call"),
    ("trace", "hall", "--against", "scene,user", "--mode", "automatic,call"),
    ("trace", "hall", "--query", "all,crossings,count"), ("trace", "hall", "--doubles"),
    ("points", "hall", "--count", "100", "--path", "all"),
    ("trees", "hall"), ("trees", "hall", "--choose"),
    ("trees", "hall", "--stages", "--rounds", "1"),
    ("trees", "--frames", "frame0.obj", "frame1.obj", "--rounds", "1"),
]


def test_formats(tool, folder):
    """Tables fit a terminal; CSV, Markdown and JSON have the rows of --json on standard output, and nothing else."""
    for number in range(2):
        with open(os.path.join(folder, f"frame{number}.obj"), "w", encoding="ascii") as file:
            file.write(TRIANGLE)
    for arguments in LISTS:
        if arguments[0] in ("trace", "trees") and "--stages" not in arguments:
            arguments = [*arguments, "--size", "16x12"]
        if arguments[0] in ("trace", "trees", "points") and not {"--frames", "--stages"} & {*arguments}:
            arguments = [*arguments, "--seconds", "0"]
        arguments = [os.path.join(folder, word) if word.endswith(".obj") else word for word in arguments]
        result = tool.run(*arguments)
        tool.check(result.returncode == 0 and not width_faults(result.stdout) and "  " in result.stdout,
                   f"{arguments}: tables of {MAX_WIDTH} columns: {width_faults(result.stdout)}", result)
        tool.expect_error(["no_such_column", "path" if arguments[0] in ("isa", "roots") else "", "all"], *arguments,
                          "--columns", "no_such_column")
    for arguments in [(), *((command,) for command in tool.commands)]:
        result = tool.run(*arguments, "--help")
        tool.check(not width_faults(result.stdout), f"{arguments} --help: lines of {MAX_WIDTH} columns", result)
    test_values(tool, folder)


def test_values(tool, folder):
    out = os.path.join(folder, "formats.json")
    arguments = ["trace", "hall", "spheres", "--size", "16x12", "--seconds", "0", "--mode", "single,call", "--rays",
                 "primary", "--json", out]
    result = tool.run(*arguments, "--format", "csv")
    lines, rows = list(csv.DictReader(io.StringIO(result.stdout, newline=""))), rows_of(out)
    tool.check(result.returncode == 0 and len(lines) == len(rows) == 4 and
               all_of({key: json_value(cell) for key, cell in line.items() if cell} == row
                      for line, row in zip(lines, rows)), "CSV has the values of JSON", result)
    result = tool.run(*arguments, "--format", "csv", "--columns", "hits,scene")
    tool.check([list(line) for line in csv.reader(io.StringIO(result.stdout))] ==
               [["hits", "scene"], *([str(row["hits"]), row["scene"]] for row in rows)], "two columns of CSV", result)
    result = tool.run(*arguments, "--format", "markdown")
    titles, dashes, cells = cells_of_markdown(result.stdout)
    tool.check(titles[0] == "scene" and "Mrays/s" in titles and len(cells) == 4 and set(dashes) == {"---"} and
               all_of(len(line) == len(titles) == len(dashes) for line in cells) and
               [line[0] for line in cells] == [row["scene"] for row in rows], "a table of Markdown", result)
    result = tool.run(*arguments, "--format", "json")
    tool.check(result.returncode == 0 and json.loads(result.stdout)["rows"] == rows_of(out),
               "JSON on standard output is that of --json", result)
    result = tool.run("trace", "hall", "--size", "16x12", "--seconds", "0", "--mode", "single", "--rays", "primary",
                      "--columns", "mode,hits,scene")
    tool.check("\nmode    hits  scene\nsingle   192  hall\n" in result.stdout, "named columns in their order", result)
    result = tool.run("roots", "--stride", "524288", "--seconds", "0", "--method", "hardware", "--columns", "all")
    tool.check(result.returncode == 0 and width_faults(result.stdout), "all columns are wider", result)
    tool.expect_error(["--format", "--json -"], "isa", "--format", "csv", "--json", "-")
    tool.expect_error(["table", "csv", "markdown", "json"], "isa", "--format", "xml")
    tool.expect_error(["promise", "max_ulp"], "roots", "--format", "csv", "--columns", "promise")
    hostile = os.path.join(os.fsencode(folder), b"a|b,\"c\"\x1b[31m.obj")
    with open(hostile, "wb") as file:
        file.write(TRIANGLE.encode())
    for form in ["csv", "markdown"]:
        result = tool.run("trace", hostile, "--size", "8x8", "--seconds", "0", "--mode", "single", "--rays", "primary",
                          "--format", form)
        if form == "csv":
            names = [line["scene"] for line in csv.DictReader(io.StringIO(result.stdout))]
        else:
            names = [line[0].replace("\\|", "|") for line in cells_of_markdown(result.stdout)[2]]
        tool.check(names == ['a|b,"c"\\x1b[31m'] and "\x1b" not in result.stdout, f"a hostile name in {form}", result)

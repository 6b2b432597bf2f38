"""Files that the tool writes: each appears, or replaces an older one, only when it is complete."""
import json
import os
import pathlib
import resource
import stat
import subprocess
import sys

from tool_user import OUTPUT, TRIANGLE, png_size, rows_of

PLOTS = pathlib.Path(__file__).resolve().parents[3] / "bench/plots"
TRACE = ("trace", "hall", "--size", "8x8", "--seconds", "0", "--mode", "single", "--rays", "primary,shadow")


def content_of(path):
    with open(path, "rb") as file:
        return file.read()


def parts_in(folder):
    return [name for name in os.listdir(folder) if name.endswith(".part")]


def run_with_short_files(*command):
    """Files may not grow, for root neither; without SIGXFSZ, which Python ignores."""
    return subprocess.run(command, capture_output=True, text=True, timeout=600, restore_signals=False,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (16, 16)))


def test_output(tool, folder):
    """Whatever gets lost is an error, and a file that was there stays until the new one is whole."""
    with open("/dev/full", "wb") as full:
        for arguments in [("isa",), ("isa", "--json", "-"), ("--help",), ("--version",), ("trace", "--help")]:
            result = subprocess.run([tool.program, *arguments], stdout=full, stderr=subprocess.PIPE, text=True,
                                    timeout=600)
            tool.check(result.returncode == OUTPUT and "standard output" in result.stderr, f"{arguments} > /dev/full",
                       subprocess.CompletedProcess(arguments, result.returncode, "", result.stderr))
    scene = os.path.join(os.fsencode(folder), b"caf\xe9\x1b[31m.obj")
    with open(scene, "wb") as file:
        file.write(TRIANGLE.encode())
    out = os.path.join(folder, "kept.json")
    result = subprocess.run([tool.program, "trace", scene, "--size", "8x8", "--seconds", "0", "--json", out],
                            capture_output=True, timeout=600)
    shown = subprocess.CompletedProcess(result.args, result.returncode, repr(result.stdout), repr(result.stderr))
    tool.check(result.returncode == 0 and b"\x1b" not in result.stdout, "a name that is not UTF-8 is traced", shown)
    tool.check(os.path.exists(out) and rows_of(out)[0]["scene"].startswith("caf\ufffd"), "and in the JSON", shown)
    before = content_of(out)
    tool.run("isa", "--path", "nonsense", "--json", out)
    full = run_with_short_files(tool.program, "isa", "--json", out)
    tool.check(full.returncode == OUTPUT and "cannot be written" in full.stderr,
               "a file that stays short is an error", full)
    tool.check(content_of(out) == before, "a failed run leaves the old file", full)
    tool.check(parts_in(folder) == [], "no part stays behind", shown)
    link = os.path.join(folder, "link.json")
    os.symlink(out, link)
    result = tool.run("isa", "--json", link)
    tool.check(os.path.islink(link) and len(rows_of(out)) > 1, "a link is followed", result)
    result = tool.run("isa", "--json", "/dev/stdout")
    tool.check('"rows"' in result.stdout and result.returncode == 0, "a device is written to", result)
    tool.check(tool.run("isa", "--json", "/dev/full").returncode == OUTPUT, "a full device is an error", result)
    result = tool.run("isa", "--json", "-")
    tool.check(len(json.loads(result.stdout)["rows"]) > 1 and "supported" in result.stderr,
               "- is standard output, for JSON alone", result)


def made_devices(folder):
    """Copies of /dev/null and /dev/full that may get lost, where the system allows to make and use them."""
    devices = []
    for minor in (3, 7):
        devices.append(os.path.join(folder, f"device{minor}"))
        try:
            os.mknod(devices[-1], stat.S_IFCHR | 0o666, os.makedev(1, minor))
            with open(devices[-1], "wb"):
                pass
        except OSError:
            print("SKIPPED: pictures on devices, none can be made here")
            return None
    return devices


def test_pictures(tool, folder):
    """A picture that cannot be written leaves what was there: a picture, a link, a folder, a device."""
    heat = os.path.join(folder, "kept_heat")
    os.mkdir(heat)
    runs = {os.path.join(folder, "kept.png"): (*TRACE, "--image"),
            os.path.join(heat, "hall.png"): (*TRACE, "--heatmap"),
            os.path.join(folder, "slice.png"): ("points", "hall", "--count", "10", "--query", "closest", "--seconds",
                                                "0", "--grid", "9x9x2", "--image")}
    for picture, arguments in runs.items():
        target = heat if arguments[-1] == "--heatmap" else picture
        result = tool.run(*arguments, target)
        tool.check(result.returncode == 0 and png_size(picture) != (0, 0), f"{arguments[-1]} writes a picture", result)
        before = content_of(picture)
        full = run_with_short_files(tool.program, *arguments, target)
        tool.check(full.returncode == OUTPUT and "cannot be written" in full.stderr and
                   len(full.stderr.strip().split("\n")) == 1, f"{arguments[-1]}: a short file is an error", full)
        tool.check(os.path.exists(picture) and content_of(picture) == before,
                   f"{arguments[-1]}: a failed run leaves the old picture", full)
        tool.check(parts_in(os.path.dirname(picture)) == [], f"{arguments[-1]}: no part stays behind", full)
    link = os.path.join(folder, "link.png")
    os.symlink("kept.png", link)
    pathlib.Path(folder, "kept.png").unlink(missing_ok=True)
    result = tool.run(*TRACE, "--image", link)
    tool.check(os.path.islink(link) and png_size(os.path.join(folder, "kept.png")) == (8, 8),
               "--image: a link is followed", result)
    result = run_with_short_files(tool.program, *TRACE, "--image", link)
    tool.check(result.returncode == OUTPUT and os.path.islink(link), "--image: a failed run leaves a link", result)
    tool.expect_error(["kept_heat", "irectory"], *TRACE, "--image", heat, status=OUTPUT)
    devices = made_devices(folder)
    for device, status in zip(devices or [], (0, OUTPUT)):
        result = tool.run(*TRACE, "--image", device)
        tool.check(result.returncode == status and pathlib.Path(device).is_char_device(),
                   "--image: a device is written to, and stays", result)


def test_report_files(tool, folder):
    """The function that writes files of a report: old content or new content, never less."""
    program = (f"import sys; sys.dont_write_bytecode = True; sys.path.insert(0, {str(PLOTS)!r}); "
               "from whole_file import write_whole; write_whole(sys.argv[1], 'new' * 100)")
    file, link = os.path.join(folder, "kept.html"), os.path.join(folder, "link.html")
    with open(file, "w", encoding="ascii") as out:
        out.write("old")
    os.chmod(file, 0o640)
    os.symlink("kept.html", link)
    result = run_with_short_files(sys.executable, "-c", program, link)
    tool.check(result.returncode == 1 and content_of(file) == b"old" and parts_in(folder) == [],
               "report: a failed run leaves the old file", result)
    result = subprocess.run([sys.executable, "-c", program, link], capture_output=True, text=True)
    tool.check(result.returncode == 0 and content_of(file) == b"new" * 100 and os.path.islink(link) and
               stat.S_IMODE(os.stat(file).st_mode) == 0o640, "report: a link is followed, permissions stay", result)
    pipe = os.path.join(folder, "pipe.html")
    os.mkfifo(pipe)
    for refused in (folder, pipe):
        result = subprocess.run([sys.executable, "-c", program, refused], capture_output=True, text=True)
        tool.check("cannot be written" in result.stderr, f"report: {refused} is no file", result)

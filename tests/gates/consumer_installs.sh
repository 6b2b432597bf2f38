# The kinds installs and every-install of tests/gates/consumers, which sources this: the commands of docs/python.md,
# as they stand there.
# shellcheck shell=bash disable=SC2154

# An index for pip without a network: packages that point to Debian's modules, by the names that pip asks for.
make_index() {
    /usr/bin/python3 - "$1" <<'END'
import pathlib, sys, zipfile
import mesonpy, numpy, wheel
folder = pathlib.Path(sys.argv[1])
folder.mkdir()
modules = pathlib.Path(numpy.__file__).parents[1]
for name, version in {"meson_python": mesonpy.__version__, "pybind11": "2.10.3", "wheel": wheel.__version__,
                      "numpy": numpy.__version__}.items():
    info = f"{name}-{version}.dist-info"
    files = {f"{name}_of_debian.pth": f"{modules}\n",
             f"{info}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n",
             f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"}
    files[f"{info}/RECORD"] = "".join(f"{file},,\n" for file in [*files, f"{info}/RECORD"])
    with zipfile.ZipFile(folder / f"{name}-{version}-py3-none-any.whl", "w") as archive:
        for file, text in files.items():
            archive.writestr(file, text)
END
}

# Runs a block in the copy of the source, a folder of its own for its environment, and the example of README.md.
run_block() {
    local number=$1
    block_of python.md 'Installing it' "$number" >"$work/block"
    cat "$work/block"
    (cd "$work/source" && rm -rf env build-wheel && env "${@:2}" bash -euo pipefail "$work/block") >"$work/log" 2>&1 ||
        { tail -n 40 "$work/log" && fail "block $number of docs/python.md"; }
}

# Whether the environment's module has these ISA paths.
has_paths() {
    "$work/source/env/bin/python" -c 'import raylanes, sys
paths = [path.name for path in raylanes.paths()]
print(*paths)
sys.exit(paths != sys.argv[1:])' "$@" || fail "other paths than $*"
}

# Each form that the page has, of scalar kernels but where the form chooses paths; from a copy, as pip writes there.
# The argument is `first` for the first form alone, whose library is compiled once, or `every`.
use_by_installs() {
    /usr/bin/python3 -c 'import mesonpy, ensurepip, wheel' 2>/dev/null && command -v patchelf >/dev/null ||
        { echo "SKIPPED: no python3-mesonpy, python3-venv, python3-wheel or patchelf: no install" && exit 77; }
    mkdir "$work/source"
    tar -C "$source" -cf - --exclude='./build*' --exclude=./.git . | tar -C "$work/source" -xf -
    sed -i 's/"-Dpaths=[^"]*"/"-Dpaths=[]"/' "$work/source/pyproject.toml"
    grep -q '"-Dpaths=\[\]"' "$work/source/pyproject.toml" || fail "pyproject.toml has no place for paths"
    make_index "$work/index"
    # Commands that Debian's Python runs, whatever comes first in PATH.
    mkdir "$work/bin" && ln -s /usr/bin/python3 "$work/bin/python3"
    local path=$work/bin:$PATH
    run_block 1 PATH="$path" PIP_NO_INDEX=1 PIP_FIND_LINKS="$work/index"
    has_paths scalar
    import_it "$work/source/env/bin/python"
    echo "a virtual environment without Debian's modules: good"
    [[ $1 == every ]] || return 0
    run_block 2 PATH="$path"
    has_paths scalar
    import_it "$work/source/env/bin/python"
    echo "a virtual environment with Debian's modules, without a network: good"
    run_block 3 PATH="$path" PIP_NO_INDEX=1 PIP_FIND_LINKS="$work/index"
    has_paths scalar avx2
    echo "chosen paths: good"
    make_wheels
}

# One command for several interpreters: those that are there and have the packages.
make_wheels() {
    local python wheel
    (cd "$work" && PIP_NO_INDEX=1 "$work/source/python/wheels" /usr/bin/python3 none-of-this-name >"$work/log") ||
        { tail -n 40 "$work/log" && fail "python/wheels"; }
    cat "$work/log"
    grep -q '^none-of-this-name: not on this machine' "$work/log" || fail "python/wheels hides what is missing"
    wheel=$(find "$work/wheels" -name '*.whl')
    [[ $wheel == *-cp311-cp311-manylinux* || $(/usr/bin/python3 -V) != 'Python 3.11'* ]] || fail "the wheel is $wheel"
    "$work/source/env/bin/pip" install --no-index --no-deps --force-reinstall "$wheel" >"$work/log" 2>&1 ||
        { cat "$work/log" && fail "pip install of the wheel"; }
    import_it "$work/source/env/bin/python"
    for python in python3.11 python3.13; do
        "$python" -c 'import mesonpy, numpy, wheel' 2>/dev/null ||
            echo "SKIPPED: $python is not here with meson-python, NumPy and wheel: no wheel for it was made"
    done
}

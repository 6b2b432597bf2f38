# The kinds wheel and wheel-for-arm of tests/gates/consumers, which sources this.
# shellcheck shell=bash disable=SC2154

# Where a wheel is made and unpacked for: its machine, and a command that runs that machine's programs in a root. The
# emulator is the one of the host, with its libraries.
machine=x86_64 architecture=amd64 emulator=()
emulate_arm() {
    machine=aarch64 architecture=arm64 emulator=(/usr/bin/qemu-aarch64)
}

# An unpacked Debian that has libstdc++, Python, NumPy and pip, and nothing else that the library links. Packages are
# not configured, which would take two minutes: NumPy's libraries get the names that it looks for.
unpack_bare_root() {
    local file
    mmdebstrap --mode=root --variant=extract --architectures="$architecture" \
        --include=libstdc++6,python3-minimal,python3-numpy,python3-pip bookworm "$1" &&
        ln -s blas/libblas.so.3 lapack/liblapack.so.3 "$1/usr/lib/$machine-linux-gnu" || return
    for file in "${emulator[@]}" $([[ -z ${emulator[*]} ]] || ldd "${emulator[0]}" | grep -o '/[^ ]*'); do
        mkdir -p "$1${file%/*}" && cp "$file" "$1$file" || return
    done
    chroot "$1" "${emulator[@]}" /usr/bin/python3 -c 'import numpy, pip'
}

# Where the wheel must bring all that it needs: installs it there and runs the module's tests, with pytest beside them.
# Emulated, Python cannot start itself.
use_in_bare_root() {
    local root=$1 wheel=$2 module left_out=()
    [[ -z ${emulator[*]} ]] || left_out=(-k 'not spawn')
    mkdir -p "$root/opt/pytest"
    while IFS= read -r module; do
        cp -r "$module" "$root/opt/pytest"
    done < <(/usr/bin/python3 - <<'END'
import attr, attrs, iniconfig, packaging, pluggy, py, pytest, _pytest
for module in attr, attrs, iniconfig, packaging, pluggy, py, pytest, _pytest:
    print(module.__file__.removesuffix("/__init__.py"))
END
    )
    cp "$wheel" "$root/opt"
    cp -r "$source/tests/python" "$root/opt/tests"
    example_in python >"$root/opt/example.py"
    [[ -z $(find "$root" -name 'libtbb*' -o -name 'libhwy*') ]] || fail "the bare root has libraries of the wheel"
    in_root() {
        env -i PATH=/usr/sbin:/usr/bin:/bin PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=/opt/pytest \
            chroot "$root" "${emulator[@]}" /usr/bin/python3 "$@"
    }
    in_root -m pip install --no-index --break-system-packages --root-user-action=ignore "/opt/${wheel##*/}" ||
        fail "pip install in a bare root"
    in_root /opt/example.py | tee /dev/stderr | has_line '[ True False] [1.5 inf] 3' ||
        fail "the example of README.md in a bare root"
    in_root /opt/tests/run.py "${left_out[@]}" /opt/tests/test_{arrays,roots,sharing,trees}.py ||
        fail "the module's tests in a bare root"
    in_root -c 'import numpy, platform
print("a bare root:", platform.machine(), "Python", platform.python_version(), "NumPy", numpy.__version__)'
}

# What pip needs to cross-build: Meson's cross files in one, as pip 23.0 passes one option on, and what the Python of
# the other machine says of itself.
build_for_arm() {
    local sysroot=$source/build-arm64-sysroot libraries
    libraries=$sysroot/usr/lib/aarch64-linux-gnu library=/dev/null
    [[ -f $sysroot/sysroot.ini ]] && command -v aarch64-linux-gnu-g++ >/dev/null ||
        { echo "SKIPPED: no cross compiler or arm64 packages in $sysroot: no wheel for Arm was made" && exit 77; }
    { cat "$sysroot/sysroot.ini" && grep -v '^\[constants\]' "$source/tests/arm/aarch64.ini"; } >"$work/aarch64.ini"
    options=--cross-file=$work/aarch64.ini
    mkdir "$work/sysconfig" && cp "$sysroot"/usr/lib/python3*/_sysconfigdata__aarch64-linux-gnu.py "$work/sysconfig"
    environment=(_PYTHON_HOST_PLATFORM=linux-aarch64 _PYTHON_SYSCONFIGDATA_NAME=_sysconfigdata__aarch64-linux-gnu
        PYTHONPATH="$work/sysconfig" LDD="qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH=$libraries \
            /usr/aarch64-linux-gnu/lib/ld-linux-aarch64.so.1 --list")
}

# As pip makes it, without a network, of scalar kernels alone but for Arm: what is in it, and whether it works where
# nothing else is.
use_by_wheel() {
    local log=$work/log wheel unpacking="" options=-Dpaths=[] library=$build/libraylanes.so environment=()
    /usr/bin/python3 -c 'import mesonpy, ensurepip, wheel' 2>"$log" && command -v patchelf >/dev/null ||
        { echo "SKIPPED: no python3-mesonpy, python3-venv, python3-wheel or patchelf: no wheel was made" && exit 77; }
    if command -v mmdebstrap >/dev/null && [[ $(id -u) == 0 ]]; then
        unpack_bare_root "$work/root" >"$work/root.log" 2>&1 &
        unpacking=$!
    fi
    mkdir "$work/source"
    tar -C "$source" -cf - --exclude='./build*' --exclude=./.git . | tar -C "$work/source" -xf -
    /usr/bin/python3 -m venv --system-site-packages "$work/venv"
    [[ $machine == x86_64 ]] || build_for_arm
    env "${environment[@]}" "$work/venv/bin/pip" wheel --no-build-isolation --no-index --no-deps \
        --wheel-dir "$work/wheels" "$work/source" --config-settings=builddir="$work/source/build" \
        --config-settings=setup-args="$options" >"$log" 2>&1 || { cat "$log" && fail "pip wheel"; }
    wheel=$(find "$work/wheels" -type f)
    for must in '' --must-fail; do
        # shellcheck disable=SC2086
        PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$source/tests/gates/wheel_contents" $must "$wheel" "$machine" \
            "$source/python/wheel_backend.py" "$library" "$source" "$work" ||
            fail "the contents of the wheel"
    done
    if [[ $machine == x86_64 ]]; then
        "$work/venv/bin/pip" install --no-index --no-deps "$wheel" >"$log" 2>&1 || { cat "$log" && fail "pip install"; }
        import_it "$work/venv/bin/python"
    fi
    if [[ -n $unpacking ]] && wait "$unpacking"; then
        use_in_bare_root "$work/root" "$wheel"
    elif [[ $machine != x86_64 ]]; then
        tail -n 3 "$work/root.log"
        echo "SKIPPED: no bare root could be made (mmdebstrap, as root, with a mirror): the wheel for Arm was not run"
    else
        [[ ! -s $work/root.log ]] || tail -n 3 "$work/root.log"
        echo "SKIPPED: no bare root could be made (mmdebstrap, as root, with a mirror): the wheel ran here alone"
        (cd "$work" && PYTHONDONTWRITEBYTECODE=1 "$work/venv/bin/python" "$source/tests/python/run.py" \
            "$source"/tests/python/test_{arrays,roots,sharing,trees}.py) || fail "the module's tests with the wheel"
    fi
}

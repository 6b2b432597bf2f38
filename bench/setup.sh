# The set-up that bench/run and tests/run share; sourced. Defines install_missing and build_release.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build

# What a bare Debian 12 lacks, by what it is for.
build_packages=(g++ meson ninja-build pkg-config libxsimd-dev libhwy-dev libtbb-dev libxxhash-dev libgtest-dev
  libgmp-dev libpng-dev binutils python3)
tool_packages=(libcli11-dev nlohmann-json3-dev libtinygltf-dev libcgal-dev libbenchmark-dev libembree-dev libsleef-dev
  python3-matplotlib)
test_packages=(qemu-user cmake gappa python3-dev python3-numpy python3-pytest pybind11-dev libembree-dev embree-tools)
# What only tests/run --all installs.
all_test_packages=(python3-mpi4py openmpi-bin python3-distributed mypy debhelper dh-python lintian mkdocs doxygen
  python3-mesonpy python3-venv g++-aarch64-linux-gnu)
# What only tests/run --exhaustive installs: wheels for a bare root, another C++ library.
exhaustive_packages=(python3-wheel patchelf mmdebstrap libc++-dev libc++abi-dev)
# The arm64 packages that the cross build for Arm includes and links, Python for its wheel among them.
arm_packages=({libtbb-dev,libtbb12,libtbbmalloc2,libxxhash-dev,libxxhash0,libhwy-dev,libhwy1,libgmp-dev,libgmp10}:arm64
  {libgmpxx4ldbl,libgtest-dev,libpython3.11-dev,libpython3.11-minimal}:arm64 pybind11-dev)
# What the cross build for Windows compiles, links and runs with.
windows_packages=(clang lld llvm g++-mingw-w64-x86-64-posix mingw-w64-x86-64-dev wine wine64 googletest libboost-dev)
# What builds with sanitizers or by another compiler need.
sanitizer_packages=(clang libclang-rt-dev)

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# Runs a command whose output nobody needs unless it fails; then its last lines are shown.
quietly() {
  local log
  log=$(mktemp "${TMPDIR:-/tmp}/raylanes-set-up.XXXXXX")
  if "$@" >"$log" 2>&1; then
    rm -f "$log"
  else
    tail -n 20 "$log" >&2
    rm -f "$log"
    return 1
  fi
}

# Those of the named packages that are not installed, one per line.
missing_packages() {
  local package
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || echo "$package"
  done
}

# Installs those of the named Debian packages that are missing, or says which they are and ends. Where there is
# no Debian it names them all and goes on, so that the build itself says what it cannot find.
install_missing() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "set-up: no Debian package tools here; needed are the equivalents of: $*" >&2
    return
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    echo "set-up: missing Debian packages: ${missing[*]}" >&2
    echo "set-up: install them as root (apt-get install ${missing[*]}) and start again" >&2
    exit 1
  fi
  echo "set-up: installing ${missing[*]}"
  quietly as_root apt-get update -qq || echo "set-up: apt-get update failed, trying with the lists of before" >&2
  if ! quietly as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}"; then
    echo "set-up: apt-get could not install: ${missing[*]}" >&2
    exit 1
  fi
  installed_some=yes
}

# Unpacks Debian's arm64 packages into a folder for tests/arm/aarch64.ini. apt's lists and archives of arm64 are in a
# folder of their own: nothing of this machine is replaced or removed, and no rights are needed. Where that fails it
# says so, and the test that wants the folder skips.
unpack_arm64() {
  local sysroot=$root/build-arm64-sysroot work file
  [ "${arm_packages[*]}" != "$(cat "$sysroot/packages" 2>/dev/null)" ] || return 0
  command -v apt-get >/dev/null && command -v dpkg >/dev/null || return 0
  echo "set-up: unpacking arm64 packages"
  work=$(mktemp -d "${TMPDIR:-/tmp}/raylanes-arm64.XXXXXX")
  mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
  if (cd "$work" && get() { quietly apt-get -q -o APT::Architectures::=arm64 -o Dir::State::Lists="$work/lists" \
    -o Dir::Cache="$work/cache" -o APT::Sandbox::User= "$@"; } &&
    get update && get download "${arm_packages[@]}"); then
    for file in "$work"/*.deb; do dpkg -x "$file" "$sysroot"; done
    printf "[constants]\nsysroot = '%s'\n" "$sysroot" >"$sysroot/sysroot.ini"
    echo "${arm_packages[*]}" >"$sysroot/packages"
  else
    echo "set-up: the arm64 packages could not be had" >&2
  fi
  rm -rf "$work"
}

# Gathers headers of Debian's packages for tests/windows/x86_64.ini. The folder that they are in has the headers of
# Linux's C library, too. Wine's home is there as well.
gather_windows() {
  local gathered=$root/build-windows-sysroot name
  mkdir -p "$gathered/include" "$gathered/pkgconfig" "$gathered/wine"
  for name in xsimd hwy xxhash.h boost; do
    ln -sfn "/usr/include/$name" "$gathered/include/$name"
  done
  for name in xsimd libhwy libxxhash; do
    sed "s|^prefix=.*|prefix=$gathered|" "$(find /usr/lib /usr/share -path "*/pkgconfig/$name.pc" -print -quit)" \
      >"$gathered/pkgconfig/$name.pc"
  done
  printf "[constants]\ngathered = '%s'\nwine_home = '%s'\n" "$gathered" "$gathered/wine" >"$gathered/sysroot.ini"
}

# Configures once, again when there are new packages or the tool is wanted for the first time, then builds what changed
# of the named targets, or of all. The first argument says whether the tool is wanted: enabled or disabled. A folder
# that has it keeps it. As many jobs as processors: on two hyperthreads Ninja's own number, one more, takes 5 to 10 %
# longer.
build_release() {
  local tools=$1
  shift
  if [ ! -f "$build/build.ninja" ]; then
    quietly meson setup "$build" "$root" --buildtype release --werror -Dtools="$tools" -Dtests=enabled || exit 1
  elif [ "$tools" = enabled ] && ! has_tool; then
    quietly meson setup --reconfigure "$build" "$root" -Dtools=enabled || exit 1
  elif [ -n "${installed_some-}" ]; then
    quietly meson setup --reconfigure "$build" "$root" || exit 1
  fi
  echo "set-up: building (the first time takes some minutes)"
  ninja -C "$build" -j "$(nproc)" --quiet "$@"
}

# Whether the build folder is set up to build the tool.
has_tool() {
  grep -q '^build bench/raylanes:' "$build/build.ninja"
}

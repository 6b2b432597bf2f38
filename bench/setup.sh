# The set-up that bench/run and tests/run share; sourced. Defines install_missing and build_release.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build

# What a bare Debian 12 lacks, by what it is for.
build_packages=(g++ meson ninja-build pkg-config libxsimd-dev libhwy-dev libtbb-dev libgtest-dev)
tool_packages=(libcli11-dev nlohmann-json3-dev libpng-dev libtinygltf-dev libcgal-dev libgmp-dev libbenchmark-dev
  libembree-dev libsleef-dev gnuplot-nox binutils python3)
test_packages=(qemu-user)
# To run AVX-512 where the processor has none.
emulator_packages=(bochs bochs-term bochsbios vgabios isolinux syslinux-common xorriso cpio)

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# Installs those of the named Debian packages that are missing; elsewhere names them all and goes on, so that
# the build itself says what it cannot find.
install_missing() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "set-up: not a Debian system; needed are the equivalents of: $*" >&2
    return
  fi
  local missing=() package
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    echo "set-up: missing Debian packages: ${missing[*]}" >&2
    echo "set-up: install them as root (apt-get install ${missing[*]}) and start again" >&2
    exit 1
  fi
  echo "set-up: installing ${missing[*]}"
  as_root apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
    >"${TMPDIR:-/tmp}/raylanes-apt.log" 2>&1 || {
    tail -n 20 "${TMPDIR:-/tmp}/raylanes-apt.log" >&2
    echo "set-up: apt-get could not install ${missing[*]}" >&2
    exit 1
  }
}

# A kernel image for the emulated machine, taken out of its package into the build folder: it is not installed.
# Sets RAYLANES_EMULATED_KERNEL; leaves it unset, and says so, where there is none to be had.
fetch_emulated_kernel() {
  local folder=$build/emulated package image
  image=$(compgen -G "$folder/boot/vmlinuz-*" | head -n 1) || true
  if [ -z "$image" ] && command -v apt-get >/dev/null; then
    package=$(apt-cache depends linux-image-cloud-amd64 2>/dev/null | sed -n 's/^ *Depends: //p' | head -n 1)
    mkdir -p "$folder"
    if [ -n "$package" ] && (cd "$folder" && apt-get download -qq "$package" >/dev/null 2>&1); then
      dpkg-deb -x "$folder/$package"_*.deb "$folder"
      rm -rf "$folder"/*.deb "$folder/lib" "$folder/usr"
    fi
    image=$(compgen -G "$folder/boot/vmlinuz-*" | head -n 1) || true
  fi
  if [ -n "$image" ]; then
    export RAYLANES_EMULATED_KERNEL=$image
  else
    echo "SKIPPED: no kernel image for the emulated AVX-512 machine (Debian: linux-image-cloud-amd64)"
  fi
}

# Configures once, then builds what changed of the named targets, or of all.
build_release() {
  if [ ! -f "$build/build.ninja" ]; then
    meson setup "$build" "$root" --buildtype release -Dtools=enabled -Dtests=enabled >"${TMPDIR:-/tmp}/raylanes-meson.log" 2>&1 || {
      cat "${TMPDIR:-/tmp}/raylanes-meson.log" >&2
      exit 1
    }
  fi
  echo "set-up: building (the first time takes some minutes)"
  ninja -C "$build" --quiet "$@"
}

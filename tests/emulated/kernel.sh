# A kernel image for the emulated machine, taken out of its package: it is not installed. Sourced by tests/run.
# shellcheck shell=bash

# Exports RAYLANES_EMULATED_KERNEL, an image in `folder`; or says that there is none to be had, and the machine
# then takes one in /boot, or is skipped.
fetch_emulated_kernel() {
  local folder=$1 package image
  image=$(compgen -G "$folder/boot/vmlinuz-*" | head -n 1) || true
  if [ -z "$image" ] && command -v apt-get >/dev/null; then
    # Where apt-cache does not know the package, or is missing, the pipe fails and there is no name.
    package=$(apt-cache depends linux-image-cloud-amd64 2>/dev/null | sed -n 's/^ *Depends: //p' | head -n 1) || true
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

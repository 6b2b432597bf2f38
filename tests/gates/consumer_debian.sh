# The kind debian of tests/gates/consumers, which sources this.
# shellcheck shell=bash disable=SC2154

# As Debian's tools make packages of it, of the fewest paths: these take two minutes to build, all of them ten.
use_by_debian() {
    local log=$work/log packages=$work/packages root=$work/root file
    for tool in dpkg-buildpackage dh dh_python3 lintian; do
        command -v "$tool" >/dev/null || { echo "SKIPPED: no $tool: no Debian packages were made" && exit 77; }
    done
    mkdir -p "$packages/raylanes"
    tar -C "$source" -cf - --exclude='./build*' --exclude=./.git . | tar -C "$packages/raylanes" -xf -
    (cd "$packages/raylanes" && MESON_OPTIONS='-Dpaths=sse2 -Dcounters=false' dpkg-buildpackage -b -us -uc) \
        >"$log" 2>&1 || { tail -n 40 "$log" && fail "dpkg-buildpackage"; }
    lintian --fail-on error,warning "$packages"/*.changes || fail "lintian"
    for file in "$packages"/*_amd64.deb; do
        [[ $file == *-dbgsym_* ]] && continue
        dpkg-deb -x "$file" "$root"
        echo "${file##*/}: $(stat -c %s "$file") bytes"
    done
    libraries=$root/usr/lib/x86_64-linux-gnu
    # Words of the compiler's command line, hence unquoted.
    # shellcheck disable=SC2046
    g++ -std=c++20 -O1 "$consumer" -o "$work/consumer" $(PKG_CONFIG_PATH=$libraries/pkgconfig \
        PKG_CONFIG_SYSROOT_DIR=$root pkg-config --cflags --libs raylanes)
    LD_LIBRARY_PATH=$libraries "$work/consumer"
    import_it env PYTHONPATH="$root/usr/lib/python3/dist-packages" LD_LIBRARY_PATH="$libraries" /usr/bin/python3
}

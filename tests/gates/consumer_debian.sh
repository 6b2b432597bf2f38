# The kinds debian and debian-from-source of tests/gates/consumers, which sources this.
# shellcheck shell=bash disable=SC2154

# Appends rules that package the library and the module of BUILD_FOLDER instead of compiling both again.
package_what_is_built() {
    local folder='obj-$(DEB_HOST_GNU_TYPE)'
    printf '\noverride_dh_auto_build:\n\tcp -a %s %s/\n\tcp -a %s %s/python/raylanes/\n' \
        "$build/libraylanes.a $build/libraylanes.so.*[0-9]" "$folder" "$build/python/raylanes/*" "$folder"
    printf '\noverride_dh_auto_install:\n\tmeson install -C %s --no-rebuild --destdir $(CURDIR)/debian/tmp\n' "$folder"
    printf '\noverride_dh_builddeb:\n\tdh_builddeb -- -z1\n'  # packed in a fifth of the time
}

# Makes packages as Debian's tools do. The argument is `built` for the library of BUILD_FOLDER, whose tests are not run
# again, or `source` to compile it with Debian's flags and to test its module, on the fewest paths.
build_debian_packages() {
    local log=$work/log tool options=
    for tool in dpkg-buildpackage dh dh_python3 lintian; do
        command -v "$tool" >/dev/null || { echo "SKIPPED: no $tool: no Debian packages were made" && exit 77; }
    done
    mkdir -p "$packages/raylanes"
    tar -C "$source" -cf - --exclude='./build*' --exclude=./.git . | tar -C "$packages/raylanes" -xf -
    if [[ $1 == built ]]; then
        package_what_is_built >>"$packages/raylanes/debian/rules"
        options='nocheck noautodbgsym'
    fi
    (cd "$packages/raylanes" && DEB_BUILD_OPTIONS=$options MESON_OPTIONS=-Dpaths=sse2 \
        dpkg-buildpackage -b -us -uc) >"$log" 2>&1 || { tail -n 40 "$log" && fail "dpkg-buildpackage"; }
    lintian --fail-on error,warning "$packages"/*.changes || fail "lintian"
}

# Unpacks a Debian that has g++, pkg-config and what they need, with apt to install more.
unpack_root_with_compiler() {
    mmdebstrap --mode=root --variant=apt --architectures=amd64 --include=g++,pkg-config bookworm "$1"
}

# Installs the packages of the C++ library as users do, with nothing but what they depend on, and compiles the example
# of README.md by the line of docs/guide/start.md.
use_debian_in_bare_root() {
    local root=$1 line
    line=$(grep -m 1 '^c++ .*pkg-config' "$source/docs/guide/start.md")
    cp "$packages"/libraylanes{0,-dev}*_amd64.deb "$root/opt"
    rm -f "$root/opt"/*-dbgsym_*
    example_in cpp >"$root/opt/main.cpp"
    in_root() { env PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive chroot "$root" "$@"; }
    in_root sh -c 'apt-get update && apt-get install -y --no-install-recommends /opt/*.deb' >"$work/log" 2>&1 ||
        { tail -n 20 "$work/log" && fail "apt-get install in a bare root"; }
    in_root sh -c "cd /opt && $line -o main && ./main" | tee /dev/stderr |
        has_line 't = 1, u = 0.25, v = 0.25, triangle 0' || fail "the example of README.md in a bare root"
    ! in_root dpkg-query -W -f '${db:Status-Status} ${Package}\n' 'lib*-dev' |
        grep -E '^installed lib(tbb|hwy|xsimd|xxhash)-dev' || fail "packages that only the build reads"
    echo "a bare root, without packages that only the build reads: good"
}

# The packages, unpacked here; those from source in a bare root, too, if one can be made.
use_by_debian() {
    local packages=$work/packages root=$work/root bare=$work/bare unpacking='' file
    if [[ $1 == source && $(id -u) == 0 ]] && command -v mmdebstrap >/dev/null; then
        unpack_root_with_compiler "$bare" >"$work/bare.log" 2>&1 &
        unpacking=$!
    fi
    build_debian_packages "$1"
    for file in "$packages"/*_amd64.deb; do
        [[ $file == *-dbgsym_* ]] && continue
        dpkg-deb -x "$file" "$root"
        echo "${file##*/}: $(stat -c %s "$file") bytes"
    done
    libraries=$root/usr/lib/x86_64-linux-gnu
    # Words of the compiler's command line, hence unquoted.
    # shellcheck disable=SC2046
    g++ -std=c++20 -O1 "$consumer" -o "$work/consumer" $(PKG_CONFIG_LIBDIR=$libraries/pkgconfig PKG_CONFIG_PATH='' \
        PKG_CONFIG_SYSROOT_DIR=$root pkg-config --cflags --libs raylanes)
    LD_LIBRARY_PATH=$libraries "$work/consumer"
    import_it env PYTHONPATH="$root/usr/lib/python3/dist-packages" LD_LIBRARY_PATH="$libraries" /usr/bin/python3
    [[ $1 == source ]] || return 0
    if [[ -n $unpacking ]] && wait "$unpacking"; then
        use_debian_in_bare_root "$bare"
    else
        [[ ! -s $work/bare.log ]] || tail -n 3 "$work/bare.log"
        echo "SKIPPED: no bare root could be made (mmdebstrap, as root, with a mirror): the packages ran here alone"
    fi
}

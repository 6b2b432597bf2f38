# Part of the kind pkg-config of tests/gates/consumers, which sources this: the commands of docs/guide/start.md, as they
# stand there, for a library in a prefix of the user's own.
# shellcheck shell=bash disable=SC2154

# The library that install_library installed, in the folder that the page names.
use_in_own_prefix() {
    local home=$work/home block
    mkdir -p "$home/program"
    cp -r "${description%/lib/*}" "$home/raylanes"
    sed -i "s|^prefix=.*|prefix=$home/raylanes|" "$home"/raylanes/lib/*/pkgconfig/raylanes.pc
    example_in cpp >"$home/program/main.cpp"
    printf '%s\n' '#include <raylanes/roots.hpp>' '#include <cstdio>' 'int main() {' '  float x[] = {2, 3, 5};' \
        '  raylanes::sqrt(x, x);' '  std::printf("%g %g %g\n", x[0], x[1], x[2]);' '}' >"$home/program/roots.cpp"
    for block in 'A prefix of your own 2' 'Static linking 1' 'Static linking 2'; do
        block_of guide/start.md "${block% *}" "${block##* }"
    done >"$work/block"
    cat "$work/block"
    (cd "$home/program" && env -u PKG_CONFIG_LIBDIR -u PKG_CONFIG_SYSROOT_DIR -u LD_LIBRARY_PATH HOME="$home" \
        bash -euo pipefail -c "$(sed '/^  -Wl,-rpath/s/$/\nmv main shared/' "$work/block")") ||
        fail "the commands of docs/guide/start.md"
    for program in shared main; do
        "$home/program/$program" | has_line 't = 1, u = 0.25, v = 0.25, triangle 0' || fail "$program of a prefix"
    done
    "$home/program/roots" | has_line '1.41421 1.73205 2.23607' || fail "roots alone"
    readelf --dynamic "$home/program/shared" | grep -q 'NEEDED.*libraylanes' || fail "not the shared library"
    ! readelf --dynamic "$home/program/main" | grep 'NEEDED.*libraylanes' || fail "not the static library"
    ! readelf --dynamic "$home/program/roots" | grep -E 'NEEDED.*(raylanes|tbb|hwy)' || fail "roots want libraries"
    echo "a prefix of one's own, static linking, roots alone by the lines of the page: good"
}

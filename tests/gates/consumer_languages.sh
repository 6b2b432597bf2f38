# The kind languages of tests/gates/consumers, which sources this: programs in C, in C++ without exceptions, Rust,
# Fortran and Python's ctypes, with the library as it is installed.
# shellcheck shell=bash disable=SC2154

# The C block of docs/guide/from_c.md with that number, or its output, the text behind it.
program_of_page() {
    awk -v language="$1" -v wanted="$2" '$0 == "```" language { ++block; inside = 1; next }
        /^```$/ { inside = 0 } inside && block == wanted' "$source/docs/guide/from_c.md" | grep . ||
        fail "docs/guide/from_c.md has no block $2 of $1" >&2
}

# Whether a program, the arguments, prints the text with that number.
expect_text() {
    local number=$1
    shift
    LD_LIBRARY_PATH=$libraries "$@" >"$work/printed" || fail "$*"
    program_of_page text "$number" | diff - "$work/printed" || fail "$* prints something else than the page says"
}

use_by_languages() {
    command -v pkg-config >/dev/null || { echo "SKIPPED: no pkg-config: other languages" && exit 77; }
    install_library "$build"
    local flags compiler number examples=$source/docs/examples/c strict='-Wall -Wextra -Wconversion -Wshadow -Werror'
    flags=$(pkg-config --cflags --libs raylanes)
    for number in 1 2 3; do
        program_of_page c "$number" >"$work/main.c"
        for compiler in gcc clang; do
            command -v "$compiler" >/dev/null || { echo "SKIPPED: C by $compiler, there is none" && continue; }
            # Words of the compiler's command line, hence unquoted.
            # shellcheck disable=SC2086
            "$compiler" -std=c99 -pedantic $strict "$work/main.c" -o "$work/main" $flags
            expect_text "$number" "$work/main"
            echo "program $number in C by $compiler: good"
        done
    done
    program_of_page c 1 >"$work/main.cpp"
    for compiler in "${compilers[@]}"; do
        # shellcheck disable=SC2086
        "$compiler" -std=c++11 $strict -fno-exceptions -fno-rtti "$work/main.cpp" -o "$work/main" $flags
        expect_text 1 "$work/main"
        echo "C++ without exceptions by $compiler: good"
    done
    use_by_rust
    if command -v gfortran >/dev/null; then
        # shellcheck disable=SC2086
        gfortran -std=f2008 -Wall -Wextra -Werror "$examples/closest.f90" -o "$work/main" $flags
        expect_text 1 "$work/main"
        echo "Fortran: good"
    else
        echo "SKIPPED: the program in Fortran, there is no gfortran"
    fi
    expect_text 1 python3 "$examples/closest.py" "$libraries/libraylanes.so.$(minor_version)"
    echo "ctypes: good"
}

# A rustc without its tool chain, as rustup may leave one, is none.
use_by_rust() {
    local rustc
    for rustc in rustc /usr/bin/rustc; do
        "$rustc" --version >/dev/null 2>&1 || continue
        "$rustc" -O -D warnings "$examples/closest.rs" -L native="$libraries" -l raylanes -o "$work/main"
        expect_text 1 "$work/main"
        echo "Rust: good"
        return
    done
    echo "SKIPPED: the program in Rust, there is no rustc"
}

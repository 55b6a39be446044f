#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds of one kind of context: only its header is needed, and it alone is built in.
. "$(dirname "$0")/../cli/checks.sh"
cache=$(dirname "$twinbox")/CMakeCache.txt
cached() { sed -n "s/^$1:[A-Z]*=//p" "$cache"; }
# With ccache (tests/run --all), most files are those of the preset `portable`, which runs this test.
launcher=$(cached CMAKE_C_COMPILER_LAUNCHER)
type=${launcher:+Release}

# configure FOLDER OPTION...
configure() {
    local build=$1
    shift
    cmake -S "$sources" -B "$build" -G Ninja -DCMAKE_C_COMPILER="$(cached CMAKE_C_COMPILER)" \
        -DCMAKE_C_COMPILER_LAUNCHER="$launcher" -DCMAKE_BUILD_TYPE="${type:-Debug}" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON \
        -DTWINBOX_AVX=OFF "$@" >"$build.log" 2>&1
}

# only KIND OTHER
only() {
    checks=$((checks + 1))
    configure "$1" "-DTWINBOX_${1^^}=ON" "-DTWINBOX_${2^^}=OFF" || fail "cmake with $1 alone: $(tail -5 "$1.log")"
    # A header that is included all the same cannot be read.
    mkdir -p "$1/refused/GL" "$1/refused/EGL"
    echo "#error" | tee "$1/refused/GL/osmesa.h" "$1/refused/EGL/egl.h" >/dev/null
    rm -r "$1/refused/$([ "$1" = egl ] && echo EGL || echo GL)"
    CPATH=$PWD/$1/refused cmake --build "$1" --target tests_pixels >"$1.log" 2>&1 ||
        fail "build with $1 alone: $(grep -m 3 error "$1.log")"
    for test in pixels contexts; do
        "$1/tests/tests_pixels" $test >"$1-$test.log" 2>&1 || fail "$test with $1 alone: $(tail -3 "$1-$test.log")"
    done
    equal "kinds that are built in" "$(sed -n "s/^built in: //p" "$1-contexts.log")" "$1"
}

only egl osmesa
! grep -q "^TWINBOX_OSMESA:BOOL=\(ON\|1\)" "$cache" || only osmesa egl
configure none -DTWINBOX_OSMESA=OFF -DTWINBOX_EGL=OFF && fail "cmake accepts a build without a context"
grep -q "Debian: libegl-dev" none.log || fail "no package named: $(cat none.log)"
finish

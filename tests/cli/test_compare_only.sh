#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# -DTWINBOX_PARTS=compare: configured where only its own libraries are known, built, packed. It links to four libraries, compares
# as the whole program does, and says what it lacks.
. "$(dirname "$0")/checks.sh"
whole=$twinbox

# A pkg-config that knows no other library, and headers of OpenGL that cannot be compiled.
cat >pkg-config <<'SH'
#!/bin/sh
for word in "$@"; do
    case $word in gsl | libzip | freetype2 | cmocka | egl | gl | osmesa) exit 1 ;; esac
done
exec /usr/bin/pkg-config "$@"
SH
chmod +x pkg-config
mkdir -p headers/GL headers/EGL headers/gsl
for header in GL/glcorearb.h GL/osmesa.h EGL/egl.h gsl/gsl_math.h zip.h ft2build.h; do
    echo '#error "of a library that compare does not need"' >headers/$header
done
launcher=$(command -v ccache) && export CCACHE_DIR=${CCACHE_DIR:-$folder/ccache}
cmake -S "$sources" -B build -G Ninja -DTWINBOX_PARTS=compare -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_COMPILE_WARNING_AS_ERROR=ON \
    -DCMAKE_C_FLAGS="-I$folder/headers" -DPKG_CONFIG_EXECUTABLE="$folder/pkg-config" -DHELP2MAN=HELP2MAN-NOTFOUND \
    ${launcher:+-DCMAKE_C_COMPILER_LAUNCHER="$launcher"} >log 2>&1 || fail "configure: $(tail -5 log)"
nice cmake --build build >log 2>&1 || fail "build: $(tail -5 log)"
twinbox=$folder/build/twinbox
[ -x "$twinbox" ] || finish

libraries=$(ldd "$twinbox" | sed -n 's/^[[:space:]]*\(lib[a-z0-9]*\)[-.].*/\1/p' | LC_ALL=C sort | paste -sd' ')
equal "libraries" "$libraries" "libc libdeflate libm libpng16 libyaml libz"
strip -o stripped "$twinbox"
size=$(stat -c %s stripped)
[ "$size" -lt 1000000 ] || fail "the program has $size bytes"
start=$(/usr/bin/python3 - "$twinbox" <<'PYTHON'
import subprocess, sys, time
def start():
    begin = time.perf_counter()
    subprocess.run([sys.argv[1], "--version"], stdout=subprocess.DEVNULL)
    return time.perf_counter() - begin
print(f"{1000 * min(start() for _ in range(60)):.2f}")
PYTHON
)
echo "program: $size bytes; start, with that of the process: $start ms"

run 2 simulate scene.yaml
complains "twinbox simulate: error: this build has compare only"
run 2 help render
complains "twinbox render: error: this build has compare only"
run 2 nonsense
complains "'nonsense' is not a command"
run 2 compare a.npz b.npz
complains "a.npz: error: this build has compare only"
run 0 --help
says "This build has compare only"
equal "commands" "$(sed -n 's/^  \([a-z]*\)  .*/\1/p' out | paste -sd' ')" "compare approve"

# Pictures of twinbox, with runs and texts of states; the rules, the limits, the report.
twinbox=$whole
run 0 simulate "$scenes/stack.yaml" -o a.npz
run 0 simulate "$scenes/stack.yaml" --no-warm-starting -o b.npz
run 0 render a.npz -o expected --frames 70:75 --size 320x180
run 0 render b.npz -o actual --frames 70:75 --size 320x180
cp -r expected same
printf 'rules:\n  - files: "*70*"\n    beyond: 0.5\n' >expected/compare.yaml
run 1 compare expected actual --tolerance 1 --antialias --json
/usr/bin/python3 -c 'import json; print([frame | {"words": "", "regions": []} for frame in json.load(open("out"))["frames"]])' >frames
twinbox=$folder/build/twinbox
run 1 compare expected actual --tolerance 1 --antialias --json
/usr/bin/python3 - <<'PYTHON' || fail "the frames are not those of the whole program"
import ast, json
mine = json.load(open("out"))
whole = ast.literal_eval(open("frames").read())
keys = "name", "failed", "differing", "beyond", "edges", "largest", "box", "region_count", "expected", "actual"
assert whole and [[frame[key] for key in keys] for frame in mine["frames"]] == [[frame[key] for key in keys] for frame in whole]
PYTHON
run 1 compare expected actual --report report
says "not compared: 1 .npz file (this build compares pictures only)"
for file in report.html junit.xml results.json; do [ -s report/$file ] || fail "no $file"; done
run 0 approve report
run 0 compare expected actual
run 0 compare same same

if command -v dpkg-shlibdeps >/dev/null; then
    (cd build && cpack) >log 2>&1 || fail "cpack: $(tail -5 log)"
    package=$(echo build/twinbox-compare_*.deb)
    size=$(stat -c %s "$package")
    echo "package: $size bytes"
    [ "$size" -lt 1000000 ] || fail "the package has $size bytes"
    equal "what it depends on" "$(dpkg-deb -f "$package" Depends | sed 's/ ([^)]*)//g; s/t64//g')" \
        "libc6, libdeflate0, libpng16-16, libyaml-0-2, zlib1g"
    dpkg-deb -c "$package" >files
    grep -q './usr/share/doc/twinbox-compare/golden/README.md$' files || fail "the package has no page"
    for file in twinbox-compare-.*.tgz pytest_twinbox-.*.whl; do grep -q "/twinbox/$file$" files || fail "no $file in the package"; done
    ! grep -q scenes files || fail "the package has scenes"
fi
finish

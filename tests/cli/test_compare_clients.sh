#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The pytest plugin and the npm wrapper of golden/: each by the example of its page, and what else it does.
. "$(dirname "$0")/checks.sh"

mkdir -p bin twinbox
ln -s "$twinbox" bin/twinbox
ln -s "$sources/golden" twinbox/golden
path=$folder/bin:$PATH
# picture FILE GREY: 20 x 20 pixels.
picture() {
    mkdir -p "$(dirname "$1")"
    /usr/bin/python3 "$sources/tests/cli/png.py" "$1" 20 20 "$2 $2 $2 255"
}

# Writes the marked files of the page, and its shell blocks to sh.1, sh.2, ...
blocks() {
    rm -f sh.*
    /usr/bin/python3 - "$sources/golden/$1/README.md" <<'PYTHON' || fail "golden/$1/README.md has no such example"
import re, sys
count = 0
for mark, text in re.findall(r"^```(\S+(?: file=\S+)?)\n(.*?)^```$", open(sys.argv[1]).read(), re.MULTILINE | re.DOTALL):
    if " file=" in mark:
        open(mark.partition("=")[2], "w").write(text)
    elif mark == "sh":
        count += 1
        open(f"sh.{count}", "w").write("set -e\n" + text)
assert count > 0
PYTHON
}
# example STATUS COMMAND...
example() {
    local wanted=$1
    shift
    PATH=$path "$@" >out 2>err </dev/null
    equal "exit status of $*" $? "$wanted"
}

# The plugin is loaded as if it were installed; a figure of one grey stands in for Matplotlib.
test_pytest() {
    mkdir -p plots/matplotlib
    : >plots/matplotlib/__init__.py
    cat >plots/matplotlib/pyplot.py <<PYTHON
import os, subprocess

class Figure:
    def savefig(self, path):
        grey = f"{os.environ['GREY']} " * 3 + "255"
        subprocess.run(["/usr/bin/python3", "$sources/tests/cli/png.py", path, "20", "20", grey], check=True)

class Axes:
    def plot(self, values):
        assert values == [1, 3, 2]

def subplots():
    return Figure(), Axes()

def close(figure):
    assert isinstance(figure, Figure)
    print("a figure is closed")
PYTHON
    printf '#!/bin/sh\nexec /usr/bin/python3 -B -m pytest -p no:cacheprovider "$@"\n' >bin/pytest
    printf '#!/bin/sh\n[ "$1" = install ] && [ -e "$2/pyproject.toml" ]\n' >bin/pip
    chmod +x bin/pytest bin/pip
    # What the build makes for pip: a wheel is also a folder of modules with entry points.
    set -- "$(dirname "$twinbox")"/clients/pytest_twinbox-*.whl
    export PYTHONPATH=$1:$PWD/plots PYTHONDONTWRITEBYTECODE=1
    /usr/bin/python3 - "$1" <<'PYTHON' || fail "RECORD of the wheel"
import base64, hashlib, sys, zipfile
wheel = zipfile.ZipFile(sys.argv[1])
record = next(name for name in wheel.namelist() if name.endswith("/RECORD"))
listed = {}
for line in wheel.read(record).decode().split():
    name, listed[name], size = line.split(",")
assert sorted(listed) == sorted(wheel.namelist()) and len(listed) == 5, listed
for name in set(listed) - {record}:
    assert listed[name] == "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(wheel.read(name)).digest()).decode().rstrip("="), name
PYTHON
    blocks pytest
    example 0 bash sh.1
    GREY=50 example 1 pytest
    says "there is no expected/test_chart/test_line.png; look at actual/test_chart/test_line.png"
    GREY=50 example 0 bash sh.2
    [ -s expected/test_chart/test_line.png ] || fail "no accepted picture"
    GREY=50 example 0 pytest -s --strict-markers
    says "a figure is closed"
    GREY=51 example 1 pytest
    says "400 pixels differ"
    says "accept the change by: twinbox approve actual/test_chart/test_line.report"
    [ -s actual/test_chart/test_line.report/report.html ] || fail "no report"
    GREY=50 example 0 pytest
    [ ! -e actual/test_chart/test_line.report ] || fail "an old report stays"
    GREY=51 example 1 pytest
    example 0 twinbox approve actual/test_chart/test_line.report
    GREY=51 example 0 pytest
    PATH=/usr/bin:/bin TWINBOX="" GREY=51 /usr/bin/python3 -B -m pytest -p no:cacheprovider >out 2>err
    equal "exit status without twinbox" $? 1
    says "twinbox is not installed"
    # A marked test does not pass without a comparison.
    cat >test_kinds.py <<'PYTHON'
import pathlib, pytest

@pytest.mark.twinbox_compare("--help")
@pytest.mark.parametrize("size", ["<", ">"])
def test_help(size):
    return pathlib.Path("actual/test_chart/test_line.png")

@pytest.mark.twinbox_compare
def test_nothing():
    pass
PYTHON
    GREY=51 example 1 pytest --twinbox-accept test_kinds.py
    says "the test must return a figure, an image or the path of a PNG file, not None"
    equal "names of their own" "$(ls expected/test_kinds | wc -l)" 2
    GREY=51 example 1 pytest test_kinds.py
    says "these options compare nothing: --help"
    says "3 failed"
}

test_npm() {
    picture expected/home.png 50
    picture actual/home.png 50
    mkdir node_modules
    tar xzf "$(dirname "$twinbox")"/clients/twinbox-compare-*.tgz -C node_modules || fail "the tarball"
    mv node_modules/package node_modules/twinbox-compare
    ln -s ../node_modules/twinbox-compare/twinbox-compare.js bin/twinbox-compare
    printf '#!/bin/sh\n[ "$1" = install ] && [ -e "$3/package.json" ]\n' >bin/npm
    printf '#!/bin/sh\nexec "$@"\n' >bin/npx
    chmod +x bin/npm bin/npx
    blocks npm
    example 0 bash sh.1
    says "equal: 1 frame"
    [ -s report/report.html ] || fail "no report"
    example 0 bash sh.2
    picture actual/home.png 160
    example 1 bash sh.1
    example 1 bash sh.2
    says "see report/report.html"
    TWINBOX=$folder/none example 3 node node_modules/twinbox-compare/twinbox-compare.js expected actual
    complains "$folder/none is no program"
    PATH=$path node -e 'require("twinbox-compare").compare("expected", "actual", ["--help"]).catch((error) => console.log(error.message))' >out
    equal "a promise of nothing" "$(cat out)" "these options compare nothing: --help"
    example 2 twinbox-compare expected none
    complains "none"
    rm bin/npm bin/npx
}

for client in pytest npm; do
    case $client in
        pytest) needed="/usr/bin/python3 -m pytest --version" ;;
        npm) needed="node --version" ;;
    esac
    if $needed >/dev/null 2>&1; then
        test_$client
    else
        echo "skipped: $client needs $needed"
    fi
    rm -rf expected actual report
done
finish

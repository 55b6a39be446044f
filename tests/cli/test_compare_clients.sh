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
    mkdir nested
    cat >nested/test_more.py <<'PYTHON'
import pathlib, pytest

class Image:
    def save(self, path):
        pathlib.Path(path).write_bytes(pathlib.Path("actual/test_chart/test_line.png").read_bytes())

class TestPictures:
    @pytest.mark.twinbox_compare("--tolerance", "1")
    @pytest.mark.parametrize("size", ["2 px", "1/3"])
    def test_path(self, size, tmp_path):
        Image().save(tmp_path / "a.png")
        return tmp_path / "a.png"

@pytest.mark.twinbox_compare
def test_image():
    return Image()

@pytest.mark.twinbox_compare
def test_nothing():
    pass

def test_other():
    pass
PYTHON
    GREY=51 example 1 pytest --twinbox-accept
    says "the test must return a figure, an image or the path of a PNG file, not None"
    says "1 failed, 5 passed"
    third=$(printf 'TestPictures::test_path[1/3]' | sha256sum | cut -c1-8)
    two=$(printf 'TestPictures::test_path[2 px]' | sha256sum | cut -c1-8)
    equal "names" "$(cd expected/nested && find . -name '*.png' | LC_ALL=C sort | paste -sd' ')" \
        "./test_more/TestPictures.test_path_1_3_-$third.png ./test_more/TestPictures.test_path_2_px_-$two.png ./test_more/test_image.png"
    picture expected/nested/test_more/TestPictures.test_path_1_3_-$third.png 52
    picture expected/nested/test_more/test_image.png 52
    GREY=51 example 1 pytest
    says "2 failed, 4 passed"
    says "test_image.png: 400 pixels differ"
    test_kinds
}

# Every way for a marked test to end: with a comparison, or not as passed. All pictures are accepted; then all have another grey.
test_kinds() {
    mkdir kinds
    cat >kinds/conftest.py <<'PYTHON'
import pytest

class Item(pytest.Item):
    def runtest(self):
        pass

class File(pytest.File):
    def collect(self):
        yield Item.from_parent(self, name="custom")

def pytest_collect_file(parent, file_path):
    if file_path.suffix == ".custom":
        return File.from_parent(parent, path=file_path)

def pytest_collection_modifyitems(items):
    for item in items:
        if item.name == "custom":
            item.add_marker("twinbox_compare")

# As pytest-asyncio does it.
def pytest_pyfunc_call(pyfuncitem):
    import asyncio, inspect
    if inspect.iscoroutinefunction(pyfuncitem.obj):
        asyncio.run(pyfuncitem.obj(**{name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}))
        return True
PYTHON
    : >kinds/one.custom
    cat >kinds/test_kinds.py <<PYTHON
import os, pathlib, subprocess, unittest, pytest

class Picture:
    def save(self, path):
        grey = f"{os.environ['GREY']} " * 3 + "255"
        subprocess.run(["/usr/bin/python3", "$sources/tests/cli/png.py", path, "20", "20", grey], check=True)

class Cases(unittest.TestCase):
    def setUp(self):
        self.path = pathlib.Path("made.png")
        Picture().save(self.path)

    def tearDown(self):
        self.path.unlink()

    @pytest.mark.twinbox_compare
    def test_case(self):
        return self.path

    @pytest.mark.twinbox_compare
    @unittest.skip("no")
    def test_skipped(self):
        return self.path

class Coroutines(unittest.IsolatedAsyncioTestCase):
    @pytest.mark.twinbox_compare
    async def test_case(self):
        return Picture()

@pytest.mark.twinbox_compare
async def test_coroutine():
    return Picture()

@pytest.mark.twinbox_compare
@pytest.mark.parametrize("sign", ["<", ">", "a", "A", "a+b", "a*b"])
def test_sign(sign):
    return Picture()

@pytest.mark.twinbox_compare("--help")
def test_help():
    return Picture()

@pytest.mark.twinbox_compare(tolerance=3)
def test_named():
    return Picture()

@pytest.mark.twinbox_compare("--tolerance", 3)
def test_number():
    return Picture()

@pytest.mark.twinbox_compare
def test_photo(tmp_path):
    (tmp_path / "a.jpg").write_bytes(b"\\xff\\xd8")
    return str(tmp_path / "a.jpg")
PYTHON
    GREY=50 example 1 pytest --twinbox-accept kinds
    says "no picture was compared"
    says "not tolerance="
    says "twinbox_compare takes options as texts, not 3"
    says "a.jpg, which is no PNG file"
    says "4 failed, 10 passed, 1 skipped" # one.custom, test_named, test_number, test_photo
    equal "pictures of test_sign" "$(find expected/kinds -iname 'test_sign*.png' | tr A-Z a-z | sort -u | wc -l)" 6
    GREY=50 example 1 pytest kinds
    says "5 failed, 9 passed, 1 skipped"
    says "these options compare nothing: --help"
    GREY=51 example 1 pytest kinds
    says "14 failed, 1 skipped"
    cat >kinds/test_claims.py <<'PYTHON'
import pytest

@pytest.mark.twinbox_compare
@pytest.mark.parametrize("n", ["a"])
def test_one(n):
    return None

@pytest.mark.twinbox_compare
def test_one_a_():
    return None
PYTHON
    GREY=50 example 4 pytest kinds/test_claims.py
    grep -q "would have the same picture" out err || fail "two tests claim one picture: $(cat out err)"
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
    TWINBOX=$folder/bin/twinbox PATH=$(dirname "$(command -v node)") node twinbox/golden/npm/twinbox-compare.js --version >out 2>err
    equal "exit status of --version" $? 0
    says "twinbox "
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

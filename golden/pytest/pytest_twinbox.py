# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that return a picture, compared with the accepted one by `twinbox compare`.

    @pytest.mark.twinbox_compare("--antialias")     # options of compare, or none
    def test_line():
        figure, axes = pyplot.subplots()
        axes.plot([1, 3, 2])
        return figure                               # or a Pillow image, or the path of a PNG file

expected/FOLDER/FILE/TEST.png is the accepted picture, below the root of the tests; actual/FOLDER/FILE/TEST.png is the one of
the last run. A test that fails leaves the report TEST.report beside it.
"""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest


def pytest_addoption(parser):
    parser.getgroup("twinbox").addoption(
        "--twinbox-accept", action="store_true", help="accept the pictures of the tests that run, instead of comparing")


def pytest_configure(config):
    config.addinivalue_line(
        "markers", "twinbox_compare(*options): compare the picture that the test returns by twinbox compare")


def program():
    found = os.environ.get("TWINBOX") or shutil.which("twinbox")
    if not found:
        pytest.fail("twinbox is not installed: it is not in PATH, and TWINBOX is not set", pytrace=False)
    return found


def picture_name(item):
    """tests/test_chart.py::TestLine::test_width[2 px] -> tests/test_chart/TestLine.test_width_2_px_.png"""
    file, _, test = item.nodeid.partition("::")
    test = re.sub(r"[^\w.-]", "_", test.replace("::", "."))
    return f"{os.path.splitext(file)[0]}/{test}.png"


def save(picture, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    if isinstance(picture, (str, os.PathLike)):
        shutil.copyfile(picture, path)
    elif hasattr(picture, "savefig"):
        picture.savefig(path)
        if "matplotlib.pyplot" in sys.modules:
            sys.modules["matplotlib.pyplot"].close(picture)  # pyplot keeps all figures that are not closed
    elif hasattr(picture, "save"):
        picture.save(path)
    else:
        pytest.fail(f"the test must return a figure, an image or the path of a PNG file, not {picture!r:.80}", pytrace=False)


def compare(expected, actual, options, root):
    """Fails with what twinbox prints; paths are relative to the root, where `twinbox approve` is to be run."""
    report = actual.with_suffix(".report")
    shutil.rmtree(root / report, ignore_errors=True)
    words = [program(), "compare", *options, "--quiet"]
    done = subprocess.run([*words, "--", expected, actual], cwd=root, capture_output=True, text=True)
    if done.returncode == 0:
        return
    message = (done.stdout + done.stderr).strip()
    if done.returncode == 1:
        subprocess.run([*words, "--report", report, "--", expected, actual], cwd=root, capture_output=True)
        message += f"\nlook at {report}/report.html; accept the change by: twinbox approve {report}"
    pytest.fail(message, pytrace=False)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    marker = pyfuncitem.get_closest_marker("twinbox_compare")
    if marker is None:
        return None
    arguments = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}
    root = Path(pyfuncitem.config.rootpath)
    name = picture_name(pyfuncitem)
    expected, actual = Path("expected", name), Path("actual", name)
    save(pyfuncitem.obj(**arguments), root / actual)
    if pyfuncitem.config.getoption("--twinbox-accept"):
        (root / expected).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(root / actual, root / expected)
    elif not (root / expected).exists():
        pytest.fail(f"there is no {expected}; look at {actual}, and accept it by: pytest --twinbox-accept", pytrace=False)
    else:
        compare(expected, actual, marker.args, root)
    return True

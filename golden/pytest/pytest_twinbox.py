# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that return a picture, compared with the accepted one by `twinbox compare`.

    @pytest.mark.twinbox_compare("--antialias")     # options of compare, or none
    def test_line():
        figure, axes = pyplot.subplots()
        axes.plot([1, 3, 2])
        return figure                               # or a Pillow image, or the path of a PNG file

expected/FOLDER/FILE/TEST.png is the accepted picture, below the root of the tests; actual/FOLDER/FILE/TEST.png is the one of
the last run. A test that fails leaves the report TEST.report beside it. A marked test that ends without a comparison fails,
of whatever kind it is.
"""
import functools
import hashlib
import inspect
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import pytest

compared = pytest.StashKey()  # of a marked test: whether its picture was compared, or accepted


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
    """tests/test_chart.py::TestLine::test_width[2-a] -> tests/test_chart/TestLine.test_width_2-a_.png

    A test whose parameters have other characters, capitals (which some file systems do not tell apart) or no end in sight gets
    a part of its hash as well: test_width[<] -> test_width___-6f4e4d3b.png
    """
    file, _, test = item.nodeid.partition("::")
    test = test[: test.rindex(item.name) + len(item.name)]  # without what pytest-xdist adds to it: @GROUP
    name = re.sub(r"[^\w.-]", "_", test.replace("::", "."))
    parameters = test.partition("[")[2]
    if not re.fullmatch(r"([a-z0-9_.-]*\])?", parameters) or len(name) > 100:
        name = f"{name[:100]}-{hashlib.sha256(test.encode()).hexdigest()[:8]}"
    return f"{os.path.splitext(file)[0]}/{name}.png"


def pytest_collection_modifyitems(items):
    claims = {}
    for item in items:
        if item.get_closest_marker("twinbox_compare"):
            other = claims.setdefault(picture_name(item).casefold(), item.nodeid)
            if other != item.nodeid:
                raise pytest.UsageError(f"{item.nodeid} and {other} would have the same picture: rename one of them")


def save(picture, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    if isinstance(picture, (str, os.PathLike)):
        if not Path(picture).read_bytes().startswith(b"\x89PNG"):
            pytest.fail(f"the test returned {picture}, which is no PNG file", pytrace=False)
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
    words = [program(), "compare", *options]
    done = subprocess.run([*words, "--", expected, actual], cwd=root, capture_output=True, text=True)
    if done.returncode == 0 and re.search("^(equal|passed): 1 frame", done.stdout, re.MULTILINE):
        return
    message = (done.stdout + done.stderr).strip()
    if done.returncode == 0:
        message = f"these options compare nothing: {' '.join(map(str, options))}\n{message}"
    if done.returncode == 1:
        subprocess.run([*words, "--report", report, "--", expected, actual], cwd=root, capture_output=True)
        message += f"\nlook at {report}/report.html; accept the change by: twinbox approve {report}"
    pytest.fail(message, pytrace=False)


def check(item, marker, picture):
    """Compares what a test returned, or accepts it."""
    root = Path(item.config.rootpath)
    name = picture_name(item)
    expected, actual = Path("expected", name), Path("actual", name)
    others = [f"{name}=" for name in marker.kwargs] + [repr(option) for option in marker.args if not isinstance(option, str)]
    if others:
        pytest.fail(f"twinbox_compare takes options as texts, not {', '.join(others)}", pytrace=False)
    save(picture, root / actual)
    if item.config.getoption("--twinbox-accept"):
        (root / expected).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(root / actual, root / expected)
    elif not (root / expected).exists():
        pytest.fail(f"there is no {expected}; look at {actual}, and accept it by: pytest --twinbox-accept", pytrace=False)
    else:
        compare(expected, actual, marker.args, root)
    item.stash[compared] = True


def checked(item, marker, function):
    """The test function, which then returns nothing: its picture is checked before its fixtures and tearDown are done."""
    if inspect.iscoroutinefunction(function):
        @functools.wraps(function)
        async def run(*arguments, **named):
            check(item, marker, await function(*arguments, **named))
    else:
        @functools.wraps(function)
        def run(*arguments, **named):
            check(item, marker, function(*arguments, **named))
    return run


@pytest.hookimpl(hookwrapper=True, tryfirst=True)
def pytest_runtest_call(item):
    marker = item.get_closest_marker("twinbox_compare")
    function = getattr(item, "obj", None)
    if marker is None or not callable(function):
        yield
        return
    item.stash[compared] = False
    case = getattr(function, "__self__", None)
    item.obj = checked(item, marker, function)
    if isinstance(case, unittest.TestCase):
        setattr(case, item.name, item.obj)  # unittest looks up functions that are coroutines by itself
    yield
    item.obj = function


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    """The only hook that sees the end of every test, whoever ran it."""
    report = (yield).get_result()
    if call.when == "call" and report.passed and item.get_closest_marker("twinbox_compare"):
        if not item.stash.get(compared, False):
            report.outcome = "failed"
            report.longrepr = "no picture was compared: twinbox_compare marks a test that is no function, or that nothing called"

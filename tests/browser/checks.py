# SPDX-License-Identifier: GPL-3.0-or-later
"""What the browser tests share: a folder of their own, runs of twinbox, counted checks. As cli/checks.sh is for the others.

    with Checks() as checks:         # the arguments of the script are the binary and the sources
        checks.twinbox("page", "a.npz", "-o", "a.html")
        checks.equal("bodies", page.run("player.runs[0].bodies"), 12)"""
import contextlib
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import traceback


class Checks(contextlib.AbstractContextManager):
    def __init__(self):
        self.program, self.sources = (os.path.abspath(path) for path in sys.argv[1:3])
        self.scenes = os.path.join(self.sources, "scenes")
        self.made, self.failed = 0, 0
        self.folder = tempfile.mkdtemp(prefix="browser-")
        os.chdir(self.folder)
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # leaves no folder and no browser

    def __exit__(self, kind, error, trace):
        """Ends the program: status 0 if checks were made and held."""
        os.chdir("/")
        shutil.rmtree(self.folder, ignore_errors=True)
        if kind is not None and not issubclass(kind, SystemExit):
            traceback.print_exception(kind, error, trace)
            self.failed += 1
        print(f"{self.made} checks, {self.failed} failed")
        sys.exit(self.made == 0 or self.failed > 0)

    def true(self, what, holds, found=""):
        self.made += 1
        if not holds:
            self.failed += 1
            print(f"FAILED: {what}" + (f": {str(found)[:1000]}" if found != "" else ""), flush=True)
        return bool(holds)

    def equal(self, what, found, wanted):
        return self.true(what, found == wanted, f"{found!r}, not {wanted!r}")

    def near(self, what, found, wanted, at_most):
        known = found is not None and math.isfinite(found)
        return self.true(what, known and abs(found - wanted) <= at_most,
                         f"{found!r}, not within {at_most} of {wanted!r}")

    def empty(self, what, found):
        """A list of faults that are named."""
        return self.true(what, not found,
                         "; ".join(map(str, found[:8])) + (f"; and {len(found) - 8} more" if found[8:] else ""))

    def twinbox(self, *arguments, status=0, **options):
        """Runs it; what it printed."""
        result = subprocess.run([self.program, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True,
                                text=True, **options)
        self.equal(f"exit status of twinbox {' '.join(map(str, arguments))[:200]} ({result.stderr[:300].strip()})",
                   result.returncode, status)
        return result

    def quiet(self, what, page):
        """Nothing in the console, nothing fetched."""
        self.empty(f"{what}: messages", [text[:300] for text in page.messages])
        self.empty(f"{what}: requests", page.requests)

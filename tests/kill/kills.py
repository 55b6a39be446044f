# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills commands of twinbox at the entry of a call that changes files, continues them, and compares with a run that was
not disturbed.

    kills.py TWINBOX SOURCES [--most N] [--jobs N] [--no-terms] [CASE...]

A case runs once undisturbed, which counts its calls (faults/shim.c). Then it is killed at N of them, spread evenly over
renames, writes, unlinks and fsyncs; at every second of them another run gets SIGTERM, which must give exit status 130.
After each, no final name may hold another file than before or at the end. Then the same command, or its --resume, must
end with the same files, hidden and temporary ones, too. Prints a line per case; exit status 1: there are findings."""
import argparse
import concurrent.futures
import ctypes
import hashlib
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile

from cases import CASES, PREPARED

COUNTED = ["malloc", "libmalloc", "open", "read", "write", "fsync", "rename", "unlink"]  # as in the file of counts
STRUCK = ["rename", "write", "unlink", "fsync"]
INTERRUPTED = 130
ENDS = {".html": b"</html>", ".md": b"", ".xml": b"</testsuite>", ".png": b"IEND\xaeB`\x82", ".svg": b"</svg>",
        ".pdf": b"%%EOF", ".csv": b"", ".txt": b""}


class Finding(Exception):
    pass


def content(path, timed):
    """What must be equal of a file. Of a file with times in it: that it is whole."""
    with open(path, "rb") as file:
        data = file.read()
    ending = os.path.splitext(path)[1]
    if not timed:
        return hashlib.sha1(data).hexdigest()
    if not data.rstrip().endswith(ENDS[ending]) or (ending == ".csv" and not data.endswith(b"\n")):
        return "half a file"
    return f"{data.count(10)} lines" if ending == ".csv" else "a whole file"


def reap():
    """Waits for the processes that the killed one left, which belong to this one: it is a subreaper."""
    try:
        while True:
            os.wait()
    except ChildProcessError:
        return


class Bench:
    """Runs one case again and again, each time from the same state of a folder. One per process."""

    def __init__(self, program, sources, prepared, case):
        self.program, self.sources, self.prepared, self.case = program, sources, prepared, case
        self.top = tempfile.mkdtemp(prefix="kills-")
        self.work, self.counts = os.path.join(self.top, "run"), os.path.join(self.top, "counts")
        self.restore()
        self.before = self.snapshot()
        self.run(case.command, "malloc:0:fail", (case.status,))
        with open(self.counts, "rb") as file:
            self.calls = dict(zip(COUNTED, struct.unpack(f"<{len(COUNTED)}Q", file.read(8 * len(COUNTED)))))
        self.after = self.snapshot()

    def close(self):
        shutil.rmtree(self.top)

    def restore(self):
        shutil.rmtree(self.work, ignore_errors=True)
        os.makedirs(os.path.join(self.work, "tmp"))
        for name in self.case.inputs:
            new, _, old = name.partition("=")
            source, target = os.path.join(self.prepared, old or new), os.path.join(self.work, new)
            (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, target)

    def snapshot(self):
        """Every file and folder below the one of the run, hidden ones and those of TMPDIR, too."""
        files = {}
        for root, folders, names in os.walk(self.work):
            for name in folders + names:
                path = os.path.join(root, name)
                inside = os.path.relpath(path, self.work)
                files[inside] = "a folder" if name in folders else content(path, self.case.timed(inside))
        return files

    def run(self, command, fault, statuses):
        """Its exit status, which must be one of these."""
        if os.path.exists(self.counts):
            os.remove(self.counts)
        environment = {"PATH": os.environ["PATH"], "OMP_NUM_THREADS": "1", "TMPDIR": os.path.join(self.work, "tmp"),
                       "LD_PRELOAD": os.path.join(os.path.dirname(self.program), "tests", "libfault_shim.so"),
                       "TWINBOX_FAULT": fault, "TWINBOX_FAULT_COUNTS": self.counts,
                       "ASAN_OPTIONS": "exitcode=99:verify_asan_link_order=0",
                       "LSAN_OPTIONS": f"suppressions={self.sources}/tests/known_leaks.txt:print_suppressions=0"}
        arguments = command.replace("SCENES", os.path.join(self.sources, "scenes")).split()
        done = subprocess.run([self.program, *arguments], cwd=self.work, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=environment, check=False)
        reap()
        if done.returncode not in statuses:
            raise Finding(f"exit status {done.returncode}: {done.stderr.decode(errors='replace').strip()[-300:]}")
        return done.returncode

    def check_names(self, interrupted):
        """No final name holds another file than before or at the end. An interrupted training stores its network."""
        for path, now in self.snapshot().items():
            if interrupted and path == self.case.early:
                continue
            if path in self.after and now not in (self.before.get(path), self.after[path]):
                raise Finding(f"{path} is half-written")

    def check_end(self):
        now = self.snapshot()
        for path in sorted(now.keys() | self.after.keys()):
            if path not in now:
                raise Finding(f"no {path} in the end")
            if path not in self.after:
                raise Finding(f"{path} is left over")
            if now[path] != self.after[path]:
                raise Finding(f"{path} differs in the end: {now[path]}")

    def strike(self, fault, status):
        """Whether the run was struck; it ends undisturbed where another order of threads calls less often."""
        self.restore()
        if self.run(self.case.command, fault, (status, self.case.status)) != status:
            return False
        self.check_names(status == INTERRUPTED)
        self.run(self.case.resume, "malloc:0:fail", (self.case.status,))
        self.check_end()
        return True

    def points(self, most):
        """About so many calls: of each kind the first, the last and some between, or one in the middle."""
        kinds = sorted((kind for kind in STRUCK if self.calls[kind] > 0), key=self.calls.get)
        for place, kind in enumerate(kinds):
            count = self.calls[kind]
            taken = min(count, max(1, most // (len(kinds) - place)))
            most -= taken
            for i in range(taken):
                yield kind, 1 + (i * (count - 1) // (taken - 1) if taken > 1 else count // 2)


def do_case(program, sources, prepared, case, most, terms):
    # PR_SET_CHILD_SUBREAPER: the workers of a killed process belong to this one.
    ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)
    bench = Bench(program, sources, prepared, case)
    kills = interrupts = 0
    findings = []
    for i, (kind, n) in enumerate(bench.points(most)):
        for mode, status in (("kill", -signal.SIGKILL), ("term", INTERRUPTED)):
            if mode == "term" and (not terms or i % 2 == 1):
                continue
            try:
                struck = bench.strike(f"{kind}:{n}:{mode}", status)
                kills += struck and mode == "kill"
                interrupts += struck and mode == "term"
            except Finding as finding:
                findings.append(f"{case.name}: {kind}:{n}:{mode}: {finding}")
    bench.close()
    return case.name, bench.calls, kills, interrupts, findings


def prepare(program, sources, folder, name):
    """Makes the input, after those that it needs."""
    if os.path.exists(os.path.join(folder, name)):
        return
    command = PREPARED[name].replace("SCENES", os.path.join(sources, "scenes"))
    if command.startswith("sh "):
        subprocess.run(["sh", "-c", command[3:]], cwd=folder, check=True)
        return
    for words in map(str.split, command.split(" && ")):
        for word in words:
            if word in PREPARED and word != name:
                prepare(program, sources, folder, word)
        done = subprocess.run([program, *words, "-q"], cwd=folder, stdout=subprocess.DEVNULL, check=False)
        if done.returncode not in (0, 1):
            sys.exit(f"{' '.join(words)}: exit status {done.returncode}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("sources")
    parser.add_argument("--most", type=int)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--no-terms", action="store_true")
    parser.add_argument("cases", nargs="*")
    options = parser.parse_intermixed_args()
    program, sources = os.path.abspath(options.program), os.path.abspath(options.sources)
    chosen = [case for case in CASES if not options.cases or case.name in options.cases]
    kills = interrupts = 0
    findings = []
    with tempfile.TemporaryDirectory(prefix="kills-") as prepared, \
         concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for case in chosen:
            for name in case.inputs:
                prepare(program, sources, prepared, name.rpartition("=")[2])
        jobs = [pool.submit(do_case, program, sources, prepared, case, options.most or case.most, not options.no_terms)
                for case in chosen]
        for job in concurrent.futures.as_completed(jobs):
            name, calls, killed, interrupted, found = job.result()
            print(f"{name}: {killed} kills, {interrupted} interrupts, {len(found)} findings; "
                  + ", ".join(f"{calls[kind]} {kind}" for kind in STRUCK), flush=True)
            kills, interrupts, findings = kills + killed, interrupts + interrupted, findings + found
    print(f"{len(chosen)} cases, {kills} kills, {interrupts} interrupts, {len(findings)} findings")
    for finding in findings:
        print(finding)
    sys.exit(1 if findings or kills == 0 else 0)


if __name__ == "__main__":
    main()

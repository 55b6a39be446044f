# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs commands of twinbox with one failing call each (shim.c), and judges what they do.

    faults.py TWINBOX SOURCES [--call CALL]... [--every] [--sample K] [--jobs N] [--case NAME]...

A run with a fault must either do what the run without does (the same status, output and files), or end with exit status 3,
a message, every old file intact, and no file left over. Short moves and interrupted reads and writes must not be noticed.
Prints each finding, and counts; exit status 1: there are findings."""
import argparse
import collections
import concurrent.futures
import fnmatch
import hashlib
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import zlib

from cases import LONG, PREPARATION, SHORT

CALLS = ["malloc", "libmalloc", "open", "read", "write", "fsync", "rename", "unlink", "readdir", "close", "stat", "mkdir",
         "process", "wait"]
MODES = {"malloc": ["fail", "rest"], "read": ["fail", "short", "eintr"], "write": ["fail", "rest", "short", "eintr"],
         "wait": ["eintr"]}
ALL_MODES = {mode for modes in MODES.values() for mode in modes}
# What the message of a failure names.
NO_THREAD = "Resource temporarily unavailable"
REASONS = {"malloc": ["memory"], "libmalloc": ["memory", NO_THREAD], "open": ["Too many open files"],
           "write": ["No space left"], "mkdir": ["No space left"], "process": [NO_THREAD]}
# A stream keeps no reason; a process that cannot write its report has none.
UNNAMED = ["standard output: error: cannot write", "a drawing process failed without an error message"]
HUNG = 120  # s

Result = collections.namedtuple("Result", "status out err files counts struck place strays")


def snapshot(folder):
    """Every file, hidden ones too, by its contents; folders have contents None."""
    files = {}
    for root, folders, names in os.walk(folder):
        inside = os.path.relpath(root, folder)
        for name in folders:
            files[os.path.normpath(os.path.join(inside, name))] = None
        for name in names:
            path = os.path.join(root, name)
            with open(path, "rb") as file:
                files[os.path.normpath(os.path.join(inside, name))] = hashlib.sha1(file.read()).hexdigest()
    return files


class Bench:
    """Runs one case again and again, each time in the same state of a folder."""

    def __init__(self, program, sources, prepared, case):
        self.program, self.sources, self.case = program, sources, case
        self.prepared = prepared
        self.folder = tempfile.mkdtemp(prefix="faults-")
        self.state = None
        self.start = None
        self.work = os.path.join(self.folder, "run", "work")
        self.counts = os.path.join(self.folder, "counts")

    def begin(self):
        """Kills a first run of the case, and keeps what it leaves as the state to begin with."""
        if self.run(f"{self.case.killed}:kill").status == -signal.SIGKILL:
            start = os.path.join(self.folder, "start")
            shutil.copytree(self.work, start)
            self.start = start
            self.state = None

    def close(self):
        shutil.rmtree(self.folder)

    def restore(self):
        top = os.path.dirname(self.work)
        if self.state is not None and snapshot(top) == self.state:
            return
        shutil.rmtree(top, ignore_errors=True)
        os.makedirs(os.path.join(top, "tmp"))
        if self.start is not None:
            shutil.copytree(self.start, self.work)
        else:
            os.mkdir(self.work)
            for name in self.case.inputs:
                new, _, old = name.partition("=")
                source, target = os.path.join(self.prepared, old or new), os.path.join(self.work, new)
                (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, target)
        self.state = snapshot(top)

    def run(self, fault, sites=None):
        self.restore()
        if os.path.exists(self.counts):
            os.remove(self.counts)
        # Libraries leak where their own memory runs out.
        leaks = 0 if fault.startswith("libmalloc") else 1
        environment = {"PATH": os.environ["PATH"], "OMP_NUM_THREADS": "1", "TMPDIR": os.path.join(self.folder, "run", "tmp"),
                       "LD_PRELOAD": os.path.join(os.path.dirname(self.program), "tests", "libfault_shim.so"),
                       "TWINBOX_FAULT": fault, "TWINBOX_FAULT_COUNTS": self.counts,
                       "ASAN_OPTIONS": f"exitcode=99:verify_asan_link_order=0:detect_leaks={leaks}",
                       "LSAN_OPTIONS": f"suppressions={self.sources}/tests/known_leaks.txt:print_suppressions=0"}
        if sites:
            environment["TWINBOX_FAULT_SITES"] = sites
        arguments = self.case.arguments.replace("SCENES", os.path.join(self.sources, "scenes")).split()
        with open(os.path.join(self.folder, "out"), "w+b") as out, open(os.path.join(self.folder, "err"), "w+b") as err:
            process = subprocess.Popen([self.program, *arguments], cwd=self.work, stdin=subprocess.DEVNULL, stdout=out,
                                       stderr=err, env=environment, start_new_session=True)
            try:
                status = process.wait(HUNG)
            except subprocess.TimeoutExpired:
                status = "hangs"
            strays = self.end_group(process.pid, status)
            out.seek(0)
            err.seek(0)
            texts = out.read(), err.read().decode(errors="replace")
        with open(self.counts, "rb") as file:
            numbers = struct.unpack(f"<{len(CALLS) + 2}Q", file.read(8 * (len(CALLS) + 2)))
        return Result(status, *texts, snapshot(os.path.dirname(self.work)), dict(zip(CALLS, numbers)), numbers[-2],
                      numbers[-1], strays)

    @staticmethod
    def end_group(group, status):
        """Whether processes of the run are left after it; they get half a second."""
        for _ in range(0 if status == "hangs" else 50):
            try:
                os.killpg(group, 0)
            except ProcessLookupError:
                return False
            time.sleep(0.01)
        try:
            os.killpg(group, signal.SIGKILL)
        except ProcessLookupError:
            return False
        return True


class Judge:
    """Knows what a case does without faults; what differs between two such runs (times) is not compared."""

    def __init__(self, bench):
        self.bench = bench
        sites = os.path.join(bench.folder, "sites")
        bench.run("malloc:0:fail", sites)
        self.reference, again = bench.run("malloc:0:fail"), bench.run("malloc:0:fail")
        self.before = bench.state
        if self.reference.status not in (0, 1):
            raise SystemExit(f"{bench.case.name}: exit status {self.reference.status}: {self.reference.err}")
        self.timed = {path for path, digest in self.reference.files.items() if again.files.get(path) != digest}
        self.timed_output = self.reference.out != again.out
        with open(sites) as file:
            self.sites = [line.split() for line in file]

    def is_journal(self, path):
        return any(fnmatch.fnmatch(path, f"work/{journal}") for journal in self.bench.case.journals)

    def done(self, result):
        """None if the run did what it does without faults."""
        wanted = self.reference
        if result.status != wanted.status:
            return f"exit status {result.status}: {result.err.strip()[-200:] or 'no message'}"
        if result.out != wanted.out and not self.timed_output:
            return f"exit status {result.status}, but other output"
        for path in sorted(result.files.keys() | wanted.files.keys()):
            if path not in result.files:
                return f"exit status {result.status}, but no {path}"
            if path not in wanted.files:
                return f"exit status {result.status}, but {path} is left over"
            if result.files[path] != wanted.files[path] and path not in self.timed:
                return f"exit status {result.status}, but {path} differs"
        return None

    def refused(self, result, call):
        """None if the run failed as it should."""
        if result.status != 3:
            return f"exit status {result.status}: {result.err.strip()[-200:] or 'no message'}"
        if not result.err.strip():
            return "no message"
        named = any(reason in result.err for reason in [*REASONS.get(call, [""]), *UNNAMED])
        if not named or "Success" in result.err or "No error" in result.err:
            return f"another reason: {result.err.strip()[-200:]}"
        for path, digest in self.before.items():
            if path not in result.files and path in self.reference.files and not self.is_journal(f"{path}.part"):
                return f"{path} is lost"
        for path, digest in result.files.items():
            if digest in (self.before.get(path, ""), self.reference.files.get(path, "")) or path in self.timed:
                continue
            if self.is_journal(path):
                continue
            if digest is None and path.startswith("work/"):
                continue  # a folder
            if call == "unlink" and path not in self.before:
                continue
            return f"{path} is damaged" if path in self.before else f"{path} is left over"
        return None

    def judge(self, result, call, mode):
        if result.strays:
            return "processes are left over"
        different = self.done(result)
        if different is None or not result.struck:
            return None
        if mode == "short" or (mode == "eintr" and call in ("read", "write", "wait")):
            return different
        return different if result.status == self.reference.status else self.refused(result, call)


def places(program, addresses):
    """Functions of the program by the address that a call returns to."""
    known = [address for address in addresses if address]
    if not known:
        return {}
    lines = subprocess.run(["addr2line", "-f", "-s", "-e", program, *[hex(address - 1) for address in known]],
                           capture_output=True, text=True, check=False).stdout.splitlines()
    return {address: f"{name} {line}".replace(" ??:?", "") for address, name, line in zip(known, lines[::2], lines[1::2])}


class Driver:
    def __init__(self, options):
        self.options = options
        self.program, self.sources = os.path.abspath(options.program), os.path.abspath(options.sources)
        self.tally = collections.Counter()
        self.lock = threading.Lock()
        self.prepared = tempfile.mkdtemp(prefix="faults-")

    def prepare(self):
        for line in PREPARATION:
            arguments = line.replace("SCENES", os.path.join(self.sources, "scenes")).split()
            done = subprocess.run([self.program, *arguments], cwd=self.prepared, capture_output=True, text=True, check=False)
            if done.returncode not in (0, 1):
                raise SystemExit(f"{line}: {done.stderr}")

    def numbers(self, judge, call, mode):
        """Which calls of a kind are to fail: all, or the first from each place. Of these, one in K, not always the first."""
        short = judge.bench.case in SHORT
        if (call == "malloc" and (short or self.options.every)) or (self.options.every and short and call != "write"):
            numbers = range(1, judge.reference.counts[call] + 1)
        else:
            numbers = [int(n) for kind, n, _ in judge.sites if kind == call]
        step = self.options.sample * judge.bench.case.sample
        return numbers[zlib.crc32(f"{judge.bench.case.name} {call} {mode}".encode()) % step :: step]

    def try_fault(self, judge, call, n, mode):
        """What a fault showed, or None."""
        result = judge.bench.run(f"{call}:{n}:{mode}")
        finding = judge.judge(result, call, mode)
        kind = "found" if finding else "unreached" if not result.struck else "refused" if result.status == 3 else "harmless"
        with self.lock:
            self.tally[call, mode, kind] += 1
        return (call, n, mode, result.place, finding) if finding else None

    def try_case(self, case):
        begun = time.monotonic()
        bench = Bench(self.program, self.sources, self.prepared, case)
        try:
            if case.killed:
                bench.begin()
            judge = Judge(bench)
            faults = [(call, n, mode) for call in self.options.call or CALLS
                      for mode in MODES.get(call, ["fail"]) if mode in (self.options.mode or ALL_MODES)
                      for n in self.numbers(judge, call, mode)]
            findings = [finding for fault in faults if (finding := self.try_fault(judge, *fault))]
        finally:
            bench.close()
        with self.lock:
            self.print_case(case, findings, time.monotonic() - begun)

    def print_case(self, case, findings, seconds):
        place = places(self.program, {finding[3] for finding in findings})
        for call, n, mode, address, finding in sorted(findings):
            print(f"{case.name}: {call}:{n}:{mode} in {place.get(address, 'a library')}: {finding}")
        print(f"{case.name}: {len(findings)} findings, {seconds:.0f} s", flush=True)

    def report(self):
        print(f"{'call':10} {'mode':6} {'tried':>7} {'refused':>8} {'harmless':>9} {'findings':>9}")
        for call, mode in sorted({key[:2] for key in self.tally}, key=lambda key: (CALLS.index(key[0]), key[1])):
            kinds = [self.tally[call, mode, kind] for kind in ("refused", "harmless", "found")]
            print(f"{call:10} {mode:6} {sum(kinds):7} {kinds[0]:8} {kinds[1]:9} {kinds[2]:9}")
        findings = sum(count for key, count in self.tally.items() if key[2] == "found")
        print(f"{sum(self.tally.values())} faults, {findings} findings")
        return 1 if findings else 0

    def run(self):
        cases = [case for case in SHORT + LONG if not self.options.case or case.name in self.options.case]
        try:
            self.prepare()
            with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
                for done in [pool.submit(self.try_case, case) for case in cases]:
                    done.result()
        finally:
            shutil.rmtree(self.prepared)
        return self.report()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("sources")
    parser.add_argument("--call", action="append", choices=[*CALLS, "system"])
    parser.add_argument("--mode", action="append")
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--sample", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--case", action="append")
    options = parser.parse_args()
    if options.call == ["system"]:
        options.call = [call for call in CALLS if not call.endswith("malloc")]
    sys.exit(Driver(options).run())


if __name__ == "__main__":
    main()

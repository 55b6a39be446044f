# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs commands of twinbox in which one call fails, or kills or interrupts them (shim.c), and judges what they do.

    faults.py TWINBOX SOURCES [--call CALL]... [--every] [--sample K] [--kills] [--most N] [--jobs N] [--case NAME]...

A run with a fault must either do what the run without does (the same status, output and files), or end with exit status 3,
a message, every old file intact, and no file left over. Short moves and interrupted reads and writes must not be noticed.
--kills: a run is killed, or gets SIGTERM, which must give exit status 130, before calls that are spread evenly over its renames,
writes, unlinks and fsyncs. No final name may hold another file than before or at the end. Then the same command, or its --resume,
must end with the files of an undisturbed run, hidden and temporary ones, too.
Prints each finding, and counts; exit status 1: there are findings."""
import argparse
import collections
import concurrent.futures
import contextlib
import ctypes
import fnmatch
import hashlib
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib

from cases import CASES, PREPARED

CALLS = ["malloc", "libmalloc", "open", "read", "write", "fsync", "rename", "unlink", "readdir", "close", "stat", "mkdir",
         "process", "wait"]
MODES = {"malloc": ["fail", "rest"], "read": ["fail", "short", "eintr"], "write": ["fail", "rest", "short", "eintr"],
         "wait": ["eintr"]}
KILLED = ["rename", "write", "unlink", "fsync"]
# What the message of a failure names.
NO_THREAD = "Resource temporarily unavailable"
REASONS = {"malloc": ["memory"], "libmalloc": ["memory", NO_THREAD], "open": ["Too many open files"],
           "write": ["No space left"], "mkdir": ["No space left"], "process": [NO_THREAD]}
# A stream keeps no reason; a process that cannot write its report has none.
UNNAMED = ["standard output: error: cannot write", "-: error: cannot write",
           "a drawing process failed without an error message"]
ENDS = {".html": b"</html>", ".xml": b"</testsuite>", ".png": b"IEND\xaeB`\x82", ".svg": b"</svg>", ".pdf": b"%%EOF"}
HUNG = 120  # s

Result = collections.namedtuple("Result", "status out err files counts struck place strays")


def snapshot(folder):
    """Every file, hidden ones too, by its contents; folders have contents None."""
    files = {}
    for root, folders, names in os.walk(folder):
        for name in folders + names:
            path = os.path.join(root, name)
            inside = os.path.relpath(path, folder)
            if name in folders:
                files[inside] = None
            else:
                with open(path, "rb") as file:
                    files[inside] = hashlib.sha1(file.read()).hexdigest()
    return files


def form(path):
    """What is equal of a file with times: that it is whole, and the number of its lines if it is a table."""
    with open(path, "rb") as file:
        data = file.read()
    ending = os.path.splitext(path)[1]
    whole = data.rstrip().endswith(ENDS.get(ending, b"")) and (ending != ".csv" or data.endswith(b"\n"))
    return data.count(b"\n") if whole and ending == ".csv" else whole


def end_group(group, patience):
    """Whether processes of the run are left after it; they get some seconds. Orphans belong to this process (subreaper)."""
    for _ in range(int(100 * patience)):
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return False
        time.sleep(0.01)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(group, signal.SIGKILL)
    return True


class Bench:
    """Runs one case again and again, each time in the same state of a folder. One per process."""

    def __init__(self, program, sources, prepared, case):
        self.program, self.sources, self.prepared, self.case = program, sources, prepared, case
        self.folder = tempfile.mkdtemp(prefix="faults-")
        self.top = os.path.join(self.folder, "run")
        self.work = os.path.join(self.top, "work")
        self.state = None
        # What differs between runs without faults (times) is compared by its form alone.
        self.restore()
        first = self.run("malloc:0:fail", sites=os.path.join(self.folder, "sites"))
        if first.status not in (0, 1):
            raise SystemExit(f"{case.name}: exit status {first.status}: {first.err}")
        self.restore()
        self.wanted = self.run("malloc:0:fail")
        self.timed = {path: form(os.path.join(self.top, path)) for path, digest in self.wanted.files.items()
                      if first.files.get(path) != digest}
        self.timed_output = case.says_how or first.out != self.wanted.out
        with open(os.path.join(self.folder, "sites")) as file:
            self.sites = [line.split() for line in file]

    def restore(self):
        if self.state is not None and snapshot(self.top) == self.state:
            return
        shutil.rmtree(self.top, ignore_errors=True)
        os.makedirs(os.path.join(self.top, "tmp"))
        os.mkdir(self.work)
        for name in self.case.inputs:
            new, _, old = name.partition("=")
            source, target = os.path.join(self.prepared, old or new), os.path.join(self.work, new)
            (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, target)
        self.state = snapshot(self.top)

    def run(self, fault, arguments=None, sites=None):
        counts = os.path.join(self.folder, "counts")
        if os.path.exists(counts):
            os.remove(counts)
        # Libraries leak where their own memory runs out.
        leaks = 0 if fault.startswith("libmalloc") else 1
        environment = {"PATH": os.environ["PATH"], "OMP_NUM_THREADS": "1", "TMPDIR": os.path.join(self.top, "tmp"),
                       "LD_PRELOAD": os.path.join(os.path.dirname(self.program), "tests", "libfault_shim.so"),
                       "TWINBOX_FAULT": fault, "TWINBOX_FAULT_COUNTS": counts,
                       "ASAN_OPTIONS": f"exitcode=99:verify_asan_link_order=0:detect_leaks={leaks}",
                       "LSAN_OPTIONS": f"suppressions={self.sources}/tests/known_leaks.txt:print_suppressions=0"}
        if sites:
            environment["TWINBOX_FAULT_SITES"] = sites
        words = (arguments or self.case.arguments).replace("SCENES", os.path.join(self.sources, "scenes")).split()
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            process = subprocess.Popen([self.program, *words], cwd=self.work, stdin=subprocess.DEVNULL, stdout=out,
                                       stderr=err, env=environment, start_new_session=True)
            try:
                status = process.wait(HUNG)
            except subprocess.TimeoutExpired:
                status = "hangs"
            # ffmpeg ends some time after those that were killed.
            strays = end_group(process.pid, 0 if status == "hangs" else HUNG if status == -signal.SIGKILL else 0.5)
            out.seek(0)
            err.seek(0)
            texts = out.read(), err.read().decode(errors="replace")
        with open(counts, "rb") as file:
            numbers = struct.unpack(f"<{len(CALLS) + 2}Q", file.read(8 * (len(CALLS) + 2)))
        return Result(status, *texts, snapshot(self.top), dict(zip(CALLS, numbers)), *numbers[-2:], strays)

    def is_journal(self, path):
        return any(fnmatch.fnmatch(path, f"work/{journal}") for journal in self.case.journals)

    def lost(self, result):
        """None if no old file is gone that the run would have renewed; what a journal renews may be gone meanwhile."""
        for path in self.state:
            renewed = self.is_journal(f"{path}.part") or path.startswith(f"work/{self.case.renews}/")
            if path not in result.files and path in self.wanted.files and not renewed:
                return f"{path} is lost"
        return None

    def done(self, result):
        """None if the run did what it does without faults."""
        wanted = self.wanted
        if result.status != wanted.status:
            return f"exit status {result.status}: {result.err.strip()[-200:] or 'no message'}"
        if result.out != wanted.out and not self.timed_output:
            return f"exit status {result.status}, but other output"
        return self.ended(result)

    def ended(self, result):
        """None if its files are those of a run without faults."""
        for path in sorted(result.files.keys() | self.wanted.files.keys()):
            if path not in result.files:
                return f"exit status {result.status}, but no {path}"
            if path not in self.wanted.files:
                return f"exit status {result.status}, but {path} is left over"
            if path in self.timed:
                if form(os.path.join(self.top, path)) != self.timed[path]:
                    return f"exit status {result.status}, but {path} is not whole"
            elif result.files[path] != self.wanted.files[path]:
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
        if lost := self.lost(result):
            return lost
        for path, digest in result.files.items():
            old = digest in (self.state.get(path, ""), self.wanted.files.get(path, "")) or path in self.timed
            folder = digest is None and path.startswith("work/")
            if not (old or folder or self.is_journal(path) or (call == "unlink" and path not in self.state)):
                return f"{path} is damaged" if path in self.state else f"{path} is left over"
        return None

    def fault(self, call, n, mode):
        """The result of a run with this fault, and what is wrong with it, or None."""
        self.restore()
        result = self.run(f"{call}:{n}:{mode}")
        if result.strays:
            return result, "processes are left over"
        different = self.done(result)
        if different is None or not result.struck:
            return result, None
        if mode != "short" and not (mode == "eintr" and call in ("read", "write", "wait")):
            different = different if result.status == self.wanted.status else self.refused(result, call)
        return result, different

    def kill(self, call, n, mode):
        """The same of a run that is killed or interrupted, and continued."""
        self.restore()
        result = self.run(f"{call}:{n}:{mode}")
        # Where another order of threads calls less often, it ends undisturbed.
        if result.status not in (self.wanted.status, -signal.SIGKILL if mode == "kill" else 130):
            return result, f"exit status {result.status}: {result.err.strip()[-200:]}"
        if result.status == self.wanted.status:
            return result, None
        if lost := self.lost(result):
            return result, lost
        for path, digest in result.files.items():
            early = mode == "term" and path == f"work/{self.case.early}"
            old = digest in (self.state.get(path, ""), self.wanted.files.get(path))
            if path in self.wanted.files and not (early or old or self.timed.get(path) == form(os.path.join(self.top, path))):
                return result, f"{path} is half-written"
        again = self.run("malloc:0:fail", self.case.resume)
        if again.status != self.wanted.status:
            return result, f"continued: exit status {again.status}: {again.err.strip()[-200:]}"
        return result, self.ended(again)

    def numbers(self, call, mode, options):
        """Which calls of a kind are to fail: all, or the first from each place. Of these, one in K, not always the first."""
        if self.case.short and (call == "malloc" or (options.every and call != "write")):
            numbers = range(1, self.wanted.counts[call] + 1)
        else:
            numbers = [int(n) for kind, n in self.sites if kind == call]
        step = options.sample * self.case.sample
        return numbers[zlib.crc32(f"{self.case.name} {call} {mode}".encode()) % step :: step]

    def kills(self, most):
        """About so many calls: of each kind the first, the last and some between, or one in the middle. SIGTERM at every second."""
        kinds = sorted((kind for kind in KILLED if self.wanted.counts[kind] > 0), key=self.wanted.counts.get)
        points = []
        for place, kind in enumerate(kinds):
            count = self.wanted.counts[kind]
            taken = min(count, max(1, (most - len(points)) // (len(kinds) - place)))
            points += [(kind, 1 + (i * (count - 1) // (taken - 1) if taken > 1 else count // 2)) for i in range(taken)]
        return [(*point, "kill") for point in points] + [(*point, "term") for point in points[::2]]


def try_case(program, sources, prepared, case, options):
    """Its counts of outcomes, and lines about it."""
    # PR_SET_CHILD_SUBREAPER: the workers of a killed process belong to this one.
    ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)
    begun = time.monotonic()
    bench = Bench(program, sources, prepared, case)
    faults = bench.kills(options.most or case.most) if options.kills else [
        (call, n, mode) for call in options.call or CALLS for mode in MODES.get(call, ["fail"])
        for n in bench.numbers(call, mode, options)]
    tally, lines = collections.Counter(), []
    for call, n, mode in faults:
        result, finding = (bench.kill if options.kills else bench.fault)(call, n, mode)
        met = result.status in (-signal.SIGKILL, 130) if options.kills else result.struck
        kind = "found" if finding else "unreached" if not met else "harmless" if result.status == bench.wanted.status else "refused"
        tally[call, mode, kind] += 1
        if finding:
            where = "" if options.kills else f" in {place(program, result.place)}"
            lines.append(f"{case.name}: {call}:{n}:{mode}{where}: {finding}")
    shutil.rmtree(bench.folder)
    return tally, [*lines, f"{case.name}: {len(lines)} findings, {time.monotonic() - begun:.0f} s"]


def place(program, address):
    """The function of the program to which a call returns."""
    if not address:
        return "a library"
    return " ".join(subprocess.run(["addr2line", "-f", "-s", "-e", program, hex(address - 1)], capture_output=True, text=True,
                                   check=False).stdout.split())


def prepare(program, sources, folder, name):
    """Makes the input, after those that its commands name."""
    if os.path.exists(os.path.join(folder, name)):
        return
    for command in PREPARED[name].replace("SCENES", os.path.join(sources, "scenes")).split(" && "):
        words = command.split()
        for word in words:
            if word in PREPARED and word != name:
                prepare(program, sources, folder, word)
        done = subprocess.run(["sh", "-c", command[3:]] if words[0] == "sh" else [program, *words, "-q"], cwd=folder,
                              stdout=subprocess.DEVNULL, check=False)
        if done.returncode not in (0, 1):
            sys.exit(f"{command}: exit status {done.returncode}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("sources")
    parser.add_argument("--call", action="append", choices=[*CALLS, "system"])
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--sample", type=int, default=1)
    parser.add_argument("--kills", action="store_true")
    parser.add_argument("--most", type=int)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--case", action="append")
    options = parser.parse_args()
    if options.call == ["system"]:
        options.call = [call for call in CALLS if not call.endswith("malloc")]
    program, sources = os.path.abspath(options.program), os.path.abspath(options.sources)
    if unknown := set(options.case or []) - {case.name for case in CASES}:
        sys.exit(f"cases.py has no {', '.join(sorted(unknown))}")
    cases = [case for case in CASES if case.name in (options.case or [case.name]) and (case.most or not options.kills)]
    tally = collections.Counter()
    with tempfile.TemporaryDirectory(prefix="faults-") as prepared, \
         concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for case in cases:
            for name in case.inputs:
                prepare(program, sources, prepared, name.rpartition("=")[2])
        for job in concurrent.futures.as_completed([pool.submit(try_case, program, sources, prepared, case, options)
                                                    for case in cases]):
            counts, lines = job.result()
            tally += counts
            print("\n".join(lines), flush=True)
    print(f"{'call':10} {'mode':6} {'tried':>7} {'refused':>8} {'harmless':>9} {'findings':>9}")
    for call, mode in sorted({key[:2] for key in tally}, key=lambda key: (CALLS.index(key[0]), key[1])):
        kinds = [tally[call, mode, kind] for kind in ("refused", "harmless", "found")]
        print(f"{call:10} {mode:6} {sum(kinds):7} {kinds[0]:8} {kinds[1]:9} {kinds[2]:9}")
    findings = sum(count for key, count in tally.items() if key[2] == "found")
    print(f"{tally.total()} faults, {findings} findings")
    sys.exit(1 if findings or not tally else 0)


if __name__ == "__main__":
    main()

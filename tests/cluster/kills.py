# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills shards and merges at random times, by SIGKILL and SIGTERM, until as many were killed as are asked for.

    kills.py TWINBOX SOURCES KILLS [--shared] [SEED]

Studies take turns. Shards of one are started in any order, sometimes two processes with the same shard, sometimes a merge
beside them, and are killed, until all pieces are there; then merges are killed. After each kill: no piece is lost or has
changed, and no file of the study is there but whole. In the end: the files of a run without shards, and no other.

--shared: as if the processes ran on three machines, on a file system that gives each file a name and each lock to everyone
(shared_shim.c)."""
import hashlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

import shards

SHARDS = 5
INTERRUPTED = 130
# A run that is drawn.
PREPARED = "simulate SCENES/single.yaml --frames 400 -o a.npz"
# Output, command, seconds of a shard and of a merge, within which they are killed.
STUDIES = [
    ("map", "stability SCENES/stability/heavy_on_one.yaml --vary ratio --vary iterations --methods engine", 0.3, 0.3),
    ("chart", "chart SCENES/single.yaml --quick --launches 40 --methods engine:k=10,momentum:k=20", 0.1, 0.6),
]


class Round:
    """One study, from nothing to its end."""

    def __init__(self, twinbox, number, kills, choice, machines):
        name, command, self.shard_time, self.merge_time = STUDIES[number % len(STUDIES)]
        self.twinbox, self.choice, self.kills, self.machines = twinbox, choice, kills, machines
        self.whole, self.output = f"{name}-whole", f"{name}-{number}"
        self.shards = f"{self.output}/shards"
        self.command = f"{command} -o {self.output}"
        self.killed, self.pieces, self.started = 0, {}, []
        self.timed = name == "chart"  # two processes that do the same piece measure other times
        if not os.path.exists(self.whole):
            twinbox.run(f"{command} -o {self.whole}")
        self.wanted = shards.files_of(self.whole)

    def start(self, arguments):
        environment = {**self.twinbox.environment, "TWINBOX_MACHINE": str(self.choice.randint(1, self.machines))}
        self.started.append(subprocess.Popen([self.twinbox.program, *self.twinbox.words(arguments)], env=environment,
                                             stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                             stderr=subprocess.PIPE, text=True, start_new_session=True))
        return self.started[-1]

    def close(self):
        """After a failure, others may be at work."""
        for process in self.started:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()

    def end(self, process, what, statuses):
        _, errors = process.communicate(timeout=120)
        if process.returncode not in statuses:
            raise shards.Failure(f"{what}: exit status {process.returncode}: {errors.strip()[-400:]}")
        return process.returncode

    def strike(self, process, what, statuses):
        """Whether it was killed; it may have ended before. SIGKILL reaches its children, too, as a scheduler's does."""
        sent = self.choice.choice((signal.SIGKILL, signal.SIGTERM))
        if process.poll() is None:
            (os.killpg if sent == signal.SIGKILL else os.kill)(process.pid, sent)
        # SIGTERM ends a process that does not handle it yet.
        expected = (-signal.SIGKILL,) if sent == signal.SIGKILL else (INTERRUPTED, -signal.SIGTERM)
        return self.end(process, what, (*expected, *statuses)) in expected

    def check(self):
        """Pieces stay as they are; files of the study are whole, but for the journal of one that was cut off."""
        found = {}
        for root, _, names in os.walk(self.shards):
            for name in filter(str.isdigit, names):
                with open(os.path.join(root, name), "rb") as file:
                    found[name] = None if self.timed else hashlib.sha1(file.read()).digest()
        for name, piece in self.pieces.items():
            if name not in found or found[name] != piece:
                raise shards.Failure(f"{self.shards}: piece {name} is lost or has changed")
        self.pieces = found
        if os.path.exists(self.output):
            for name, data in shards.files_of(self.output).items():
                if not shards.is_temporary(name) and not name.endswith(".part") and self.wanted.get(name) != data:
                    raise shards.Failure(f"{self.output}: {name} is not whole")

    def disturb_shard(self):
        shard = self.choice.randint(1, SHARDS)
        twins = [self.start(f"{self.command} --shard {shard}/{SHARDS}") for _ in range(self.choice.choice((1, 1, 2)))]
        merge = self.start(f"merge {self.output}") if self.pieces and self.choice.random() < 0.3 else None
        for process in twins:
            time.sleep(self.choice.uniform(0, self.shard_time))
            self.killed += self.strike(process, f"shard {shard}", (0,))
        if merge:
            self.end(merge, "a merge beside shards", (0, 1))
        self.check()

    def disturb_merge(self):
        process = self.start(f"merge {self.output}")
        time.sleep(self.choice.uniform(0, self.merge_time))
        self.killed += self.strike(process, "merge", (0,))
        self.check()

    def is_complete(self):
        return self.end(self.start(f"merge {self.output}"), "merge", (0, 1, 2) if not self.pieces else (0, 1)) == 0

    def run(self):
        """Half of the kills strike shards, unless these end before."""
        while self.killed < self.kills / 2 and not (self.pieces and self.is_complete()):
            self.disturb_shard()
        for shard in range(1, SHARDS + 1):
            self.twinbox.run(f"{self.command} --shard {shard}/{SHARDS}")
        self.check()
        for _ in range(4 * self.kills):
            if self.killed < self.kills:
                self.disturb_merge()
        for _ in range(2):
            self.twinbox.run(f"merge {self.output}")
            files = shards.expect_equal(self.output, self.whole, self.machines > 1)
        pieces = shards.expect_clean(self.shards, self.machines > 1)
        print(f"{self.output}: {self.killed} kills; {pieces} pieces, {files} files as without shards", flush=True)
        return self.killed


def check(twinbox):
    kills = int(sys.argv[3])
    shared = "--shared" in sys.argv
    seed = int(sys.argv[-1]) if len(sys.argv) > 4 + shared else random.randrange(10**6)
    print(f"kills: seed {seed}", flush=True)
    if shared:
        twinbox.environment["LD_PRELOAD"] = os.path.join(os.path.dirname(twinbox.program), "tests", "libshared_shim.so")
    choice = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="cluster-") as folder:
        os.chdir(folder)
        os.mkdir("tmp")
        twinbox.environment["TMPDIR"] = os.path.join(folder, "tmp")
        twinbox.run(PREPARED)
        killed = number = 0
        while killed < kills:
            one = Round(twinbox, number, min(10, kills - killed), choice, 3 if shared else 1)
            try:
                killed += one.run()
            finally:
                one.close()
            number += 1
        if os.listdir("tmp") and not shared:
            raise shards.Failure(f"temporary files are left over: {os.listdir('tmp')}")
        os.chdir("/")
    print(f"{killed} kills, nothing lost")


if __name__ == "__main__":
    shards.main(check)

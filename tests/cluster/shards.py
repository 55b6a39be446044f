# SPDX-License-Identifier: GPL-3.0-or-later
"""What the checks of shards share: commands of twinbox, and a comparison of what they wrote with what one process wrote."""
import csv
import fnmatch
import os
import subprocess
import sys

# Variables by which a scheduler outside of the test would be detected.
SCHEDULERS = ("SLURM_", "PMI_", "OMPI_")
# In chart.csv these columns have times and counts of a processor. From times follow the tables of errors at equal time,
# and what is drawn.
TIMED_COLUMNS = ("us_", "instructions", "cpu")
TIMED_FILES = ["equal_time*", "chart-*.png", "chart-*.svg", "chart-*.pdf", "chart-*.txt", "chart.html"]


class Failure(Exception):
    pass


class Twinbox:
    def __init__(self, program, sources):
        self.program, self.sources = os.path.abspath(program), os.path.abspath(sources)
        self.scenes = os.path.join(self.sources, "scenes")
        kept = {name: value for name, value in os.environ.items() if not name.startswith(SCHEDULERS)}
        self.environment = {**kept, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive",
                            "PATH": os.path.dirname(self.program) + ":" + os.environ["PATH"]}

    def words(self, command):
        """A command line; SCENES stands for the folder of scenes."""
        return command.replace("SCENES", self.scenes).split()

    def run(self, command, statuses=(0,)):
        done = subprocess.run([self.program, *self.words(command)], env=self.environment, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False)
        if done.returncode not in statuses:
            raise Failure(f"twinbox {command}: exit status {done.returncode}: {done.stderr.strip()[-400:]}")
        return done


def find_processes(twinbox):
    """Processes of twinbox that work in the current folder: {number: variables of its environment}."""
    found = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            if (os.readlink(f"/proc/{name}/exe") == os.path.realpath(twinbox.program)
                    and os.readlink(f"/proc/{name}/cwd") == os.getcwd()):
                with open(f"/proc/{name}/environ", encoding="utf-8", errors="replace") as file:
                    found[int(name)] = dict(entry.split("=", 1) for entry in file.read().split("\0") if "=" in entry)
        except OSError:
            continue  # it has ended
    return found


def content(path):
    """What must be equal of a file."""
    name = os.path.basename(path)
    if any(fnmatch.fnmatch(name, pattern) for pattern in TIMED_FILES):
        return "there" if os.path.getsize(path) > 0 else "empty"
    if name == "chart.csv":
        with open(path, encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        kept = [i for i, column in enumerate(rows[0]) if not column.startswith(TIMED_COLUMNS)]
        return [[row[i] for i in kept] for row in rows]
    with open(path, "rb") as file:
        return file.read()


def is_temporary(name):
    return os.path.basename(name).startswith(".twinbox-")


def files_of(output):
    """The files of an output, hidden ones too, without those of its shards."""
    if not os.path.isdir(output):
        return {"": content(output)}
    files = {}
    for root, folders, names in os.walk(output):
        if root == output and "shards" in folders:
            folders.remove("shards")
        for name in names:
            path = os.path.join(root, name)
            files[os.path.relpath(path, output)] = content(path)
    return files


def expect_equal(output, whole, several_machines=False):
    """Returns the number of files. A machine removes temporary files that its own killed processes left."""
    here, there = files_of(output), files_of(whole)
    if several_machines:
        here = {name: data for name, data in here.items() if not is_temporary(name)}
    for name in sorted(here.keys() | there.keys()):
        if name not in here:
            raise Failure(f"{output} has no {name}")
        if name not in there:
            raise Failure(f"{output} has {name}, which a run without shards does not write")
        if here[name] != there[name]:
            raise Failure(f"{output}/{name} differs from that of a run without shards")
    return len(here)


def expect_clean(shards, several_machines=False):
    """Each file of the shards is a piece or their record: temporary files of killed processes are gone."""
    count = 0
    for root, _, names in os.walk(shards):
        for name in names:
            count += name.isdigit()
            if not name.isdigit() and name != "run.json" and not (several_machines and is_temporary(name)):
                raise Failure(f"{os.path.join(root, name)} is left over")
    return count


def main(check):
    """check(twinbox): prints what it has found; a Failure is one."""
    if len(sys.argv) < 3:
        sys.exit("arguments: TWINBOX SOURCES ...")
    try:
        check(Twinbox(sys.argv[1], sys.argv[2]))
    except Failure as failure:
        print(f"FAILED: {failure}")
        sys.exit(1)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The runs of runs.csv: read, and made by twinbox."""
import csv
import os
import shlex
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))


def runs():
    with open(os.path.join(HERE, "runs.csv"), encoding="utf-8") as file:
        return list(csv.DictReader(file))


def command(twinbox, *words, **more):
    """What a command prints. One that fails ends the program with its message."""
    done = subprocess.run([twinbox, *words], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more)
    if done.returncode != 0:
        raise SystemExit(" ".join(words) + ": " + done.stderr.decode())
    return done.stdout


def poses_only(path):
    """Frame, body, x, y and angle of a run as CSV: what another engine gives."""
    with open(path, "rb") as file:
        return b"\n".join(b",".join(line.rstrip().split(b",")[:5]) for line in file)


def make(twinbox, run, folder):
    """Makes a run, as its .npz and, but for an imported one, the verdict while it was made. Returns both paths."""
    npz, verdict = os.path.join(folder, "run.npz"), os.path.join(folder, "verdict.json")
    options, poses = shlex.split(run["options"]), None
    if run["source"] == "poses":
        poses = subprocess.run([os.path.join(HERE, "poses"), run["scene"]], stdout=subprocess.PIPE, check=True).stdout
    elif run["source"] == "engine":
        command(twinbox, "import", run["scene"], *options, "-o", npz)
    else:
        command(twinbox, "simulate", run["scene"], "--method", run["method"], *options, "--no-contacts", "-o", npz,
                "--verdict", verdict)
    if run["source"] == "csv":
        command(twinbox, "export", npz, "-o", npz + ".csv")
        poses = poses_only(npz + ".csv")
    if poses is not None:
        command(twinbox, "import", "-", "-o", npz, input=poses)
    return npz, verdict

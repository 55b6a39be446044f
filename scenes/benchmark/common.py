# SPDX-License-Identifier: GPL-3.0-or-later
"""What make and score share: the cases, and twinbox."""
import json as reader
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"


@dataclass(frozen=True)
class Case:
    name: str
    scene: Path
    settings: dict
    struck: bool


# Struck scenes with three launches each: where the bomb begins, m.
STRUCK = {"stack": ("stack", 4.7, 3.3, -4.1), "pyramid_settled": ("pyramid_settled", 1.5, -3.2, 4.4),
          "stack_16": ("families/stack_16", -11, -12.4, -10.3), "tower_mixed": ("families/tower_mixed", 4.8, -3.7, 2.1),
          "towers": ("families/towers", 4.9, -4.3, 6.1), "gate": ("families/gate", 3, -2.4, 4.2),
          "wall": ("families/wall", 5.2, -3.8, 6.4), "dominoes": ("families/dominoes", -11, -12.7, -10.6),
          "pile_40": ("families/pile_40", 3, -1.9, 4.4)}

# Nothing strikes: what must stand for 20 seconds.
RESTING = {"stack_10": ("stack_height", {"height": 10}), "stack_20": ("stack_height", {"height": 20}),
           "stack_40": ("stack_height", {"height": 40}), "heavy_10": ("heavy_on_nine", {"ratio": 10}),
           "heavy_100": ("heavy_on_nine", {"ratio": 100}), "arch": ("arch", {"friction": 0.6}),
           "card_house": ("card_house", {"friction": 0.4}), "pyramid_15": ("pyramid_rows", {"rows": 15}),
           "slope": ("friction_ramp", {"slope": 0.19}), "tilted": ("tilted_stack", {"shift": 0.08})}

CASES = [Case(f"{name}-{i}", SCENES / f"{file}.yaml", {"bomb_x": x}, True)
         for name, (file, *launches) in STRUCK.items() for i, x in enumerate(launches, 1)]
CASES += [Case(name, SCENES / f"stability/{file}.yaml", settings, False) for name, (file, settings) in RESTING.items()]


def fail(text):
    sys.exit(f"{Path(sys.argv[0]).name}: {text}")


def words_of(settings):
    return [word for name, value in settings.items() for word in ("--set", f"{name}={value!r}")]


def twinbox(*words, json=False, may_fail=False):
    """Runs a command; with json, returns what it prints. may_fail: None where its exit status is 2."""
    program = sys.argv[-1] if Path(sys.argv[-1]).name == "twinbox" else os.environ.get("TWINBOX", ROOT / "build/twinbox")
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
    if may_fail and done.returncode == 2:
        return None
    if done.returncode not in ((0, 1) if json else (0,)):
        fail(done.stderr.strip() or f"twinbox {words[0]}: exit status {done.returncode}")
    return reader.loads(done.stdout) if json else done.stdout


def load(path):
    with numpy.load(path) as file:
        return {name: file[name] for name in file}

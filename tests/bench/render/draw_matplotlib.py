# SPDX-License-Identifier: GPL-3.0-or-later
# The same picture by matplotlib (Agg): two axes with a grid, one patch per body that moves from frame to frame, text.
# Arguments: DIR WIDTH HEIGHT FRAMES RUN RUN. Prints the seconds that the frames took.
import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle
from matplotlib.transforms import Affine2D

directory, width, height, frames = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
runs = [np.load(path) for path in sys.argv[5:7]]
figure, axes = plt.subplots(1, 2, figsize=(width / 100, height / 100), dpi=100)
moving = []  # position[T, 2], angle[T], the panel and the patch of each body
for run, panel, color in zip(runs, axes, ("#0072B2", "#E69F00")):
    panel.set(xlim=(-10, 10), ylim=(-1, 19), aspect="equal", title=str(run["method"]))
    panel.set_xticks(range(-10, 11))
    panel.set_yticks(range(0, 20))
    panel.set_axisbelow(True)
    panel.grid(color="#F0F2F5")
    positions, angles = run["position"], run["angle"]
    for body, size in enumerate(run["size"]):
        patch = Rectangle(-size / 2, *size, facecolor="#D3D8DF" if run["fixed"][body] else color, edgecolor="#00395C")
        moving.append((positions[:, body], angles[:, body], panel, panel.add_patch(patch)))
status = figure.text(0.7, 0.96, "")

start = time.perf_counter()
for frame in range(frames):
    for position, angle, panel, patch in moving:
        at = frame % len(angle)
        patch.set_visible(bool(np.isfinite(angle[at])))
        patch.set_transform(Affine2D().rotate(angle[at]).translate(*position[at]) + panel.transData)
    status.set_text(f"frame {frame}")
    figure.savefig(f"{directory}/matplotlib_{frame:06d}.png", dpi=100)
print(f"{time.perf_counter() - start:.6f}")

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A toy engine that speaks twinbox's protocol (README.md) in lines of JSON: copy it, and replace World by your engine. Boxes
fall, land on what is below them, and neither turn nor slide."""
import json
import sys
import time

WIDTH, HEIGHT, X, Y, ANGLE, VX, VY, OMEGA = range(1, 9)  # of a body: static, width, height, x, y, ..., mass, friction


class World:
    def __init__(self, gravity, dt):
        self.gravity, self.dt, self.bodies = gravity, dt, []

    def step(self):
        for b in self.bodies:
            if b[0]:
                continue
            b[VX] += self.dt * self.gravity[0]
            b[VY] += self.dt * self.gravity[1]
            below = [o[Y] + o[HEIGHT] / 2 for o in self.bodies if o is not b and o[Y] < b[Y]
                     and abs(o[X] - b[X]) < (o[WIDTH] + b[WIDTH]) / 2]
            floor = max(below, default=-1e6) + b[HEIGHT] / 2
            b[X] += self.dt * b[VX]
            b[Y] += self.dt * b[VY]
            if b[Y] < floor:
                b[Y], b[VX], b[VY] = floor, 0.0, 0.0


hello = json.loads(sys.stdin.readline())
assert hello["twinbox"] == 1, "another version of the protocol"
print(json.dumps({"twinbox": 1, "name": "toy", "version": "1"}), flush=True)
for line in sys.stdin:
    asked = json.loads(line)
    if asked["frame"] == 0:  # a new scene
        world = World(asked["gravity"], asked["dt"])
    del world.bodies[len(world.bodies) - asked["remove"]:]
    world.bodies += asked["add"]
    for k in range(asked["steps"]):
        begun = time.perf_counter_ns()
        world.step()
        ns = time.perf_counter_ns() - begun
        states = [number for b in world.bodies for number in b[X:OMEGA + 1]]
        print(json.dumps({"scene": asked["scene"], "frame": asked["frame"] + k + 1, "ns": ns, "states": states}), flush=True)

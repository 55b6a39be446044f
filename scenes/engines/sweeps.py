#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A solver of contact problems that speaks twinbox's protocol (README.md): copy it, and write your own solver, or what your
network predicts, in place of solve(). This one makes the sweeps of twinbox's engine: projected Gauss-Seidel, warm start."""
import json
import sys
import time

INV_MASS, INV_INERTIA, WIDTH, HEIGHT, X, Y, ANGLE, VX, VY, OMEGA = range(10)  # of a body


def solve(bodies, contacts, dt, k):
    """The normal and the tangent impulse of each contact, N s."""
    velocity = [body[VX:] for body in bodies]

    def row(a, b, x, y, ax, ay, bx, by):
        """An impulse along (x, y): for each number of both bodies' velocities its slope and its inverse mass."""
        return [(velocity[body], i, slope, bodies[body][INV_INERTIA if i == 2 else INV_MASS])
                for body, slopes in ((a, (-x, -y, ay * x - ax * y)), (b, (x, y, bx * y - by * x)))
                for i, slope in enumerate(slopes)]

    def push(row, impulse):
        for numbers, i, slope, inverse in row:
            numbers[i] += inverse * slope * impulse

    def missing(row, target):
        """The impulse that gives the contact this velocity."""
        now = sum(numbers[i] * slope for numbers, i, slope, _ in row)
        return (target - now) / sum(inverse * slope * slope for _, _, slope, inverse in row)

    rows = [(row(a, b, x, y, *arms), row(a, b, y, -x, *arms)) for a, b, x, y, *arms in (c[:8] for c in contacts)]
    impulses = [contact[11:] for contact in contacts]  # those of the step before
    for pair, impulse in zip(rows, impulses):
        push(pair[0], impulse[0])
        push(pair[1], impulse[1])
    for _ in range(k):
        for (_, friction, bias), (along, across), impulse in zip((c[8:11] for c in contacts), rows, impulses):
            normal = max(impulse[0] + missing(along, bias), 0)
            push(along, normal - impulse[0])
            tangent = min(max(impulse[1] + missing(across, 0), -friction * normal), friction * normal)
            push(across, tangent - impulse[1])
            impulse[:] = normal, tangent
    return impulses


settings = json.loads(sys.stdin.readline())["settings"]
print(json.dumps({"twinbox": 1, "name": "sweeps", "version": "1", "answers": "impulses"}), flush=True)
for line in sys.stdin:
    asked = json.loads(line)
    begun = time.perf_counter_ns()
    impulses = solve(asked["bodies"], asked["contacts"], asked["dt"], int(settings.get("k", 10)))
    ns = time.perf_counter_ns() - begun
    answer = {"problem": asked["problem"], "ns": ns, "impulses": [number for pair in impulses for number in pair]}
    print(json.dumps(answer), flush=True)

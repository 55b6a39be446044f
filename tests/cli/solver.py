#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A solver that speaks the protocol of scenes/engines: it answers the impulses of the step before, and fails in the way that its
argument names."""
import json
import os
import random
import sys
import time

kind = sys.argv[1]
hello = json.loads(sys.stdin.readline())
greeting = {"twinbox": 1, "name": "warm", "version": "1", "answers": "impulses"}
if kind == "states":
    del greeting["answers"]
if kind == "poses":
    greeting["answers"] = "poses"
if kind == "binary":
    greeting["form"] = "binary"
if kind == "settings":
    greeting["error"] = json.dumps(hello["settings"]).replace('"', "'")
print(json.dumps(greeting), flush=True)
for count, line in enumerate(sys.stdin):
    asked = json.loads(line)
    if kind == "keep":
        open("asked", "a").write(line)
    impulses = [number for contact in asked["contacts"] for number in contact[11:]]
    answer = {"problem": asked["problem"], "ns": 1500, "impulses": impulses}
    if count == 2:
        if kind == "few":
            impulses.pop()
        if kind == "none":
            del answer["impulses"]
        if kind == "nan":
            impulses[3] = float("nan")
        if kind == "huge":
            impulses[2] = 1e300
        if kind == "fast":
            impulses[2] = 3e38
        if kind == "text":
            impulses[0] = "much"
        if kind == "former":
            answer["problem"] -= 1
        if kind == "silent":
            time.sleep(1000)
        if kind == "die":
            sys.exit("ValueError: the network has no such input")
        if kind == "close":
            os.close(1)
            time.sleep(1000)
        if kind == "error":
            answer["error"] = "the network is for another scene"
    if kind == "ns-nan":
        answer["ns"] = float("nan")
    if kind == "ns-negative":
        answer["ns"] = -3
    if kind == "ns-none":
        del answer["ns"]
    if kind == "random":
        impulses[0] += random.random()
    print("no JSON" if kind == "chatty" and count == 2 else json.dumps(answer), flush=True)
    if kind == "twice" and count == 2:
        print(json.dumps(answer), flush=True)

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""An engine in free fall that speaks the protocol of scenes/engines, and fails in the way that its argument names."""
import json
import os
import random
import signal
import struct
import sys
import time

kind = sys.argv[1]
out = sys.stdout


def say(text):
    out.write(text)
    out.flush()


def sleep_for_ever():
    while True:
        time.sleep(100)


if kind == "binary":
    read = lambda size: sys.stdin.buffer.read(size)
    hello = sys.stdin.buffer.readline()
    say('{"twinbox": 1, "name": "fall", "version": "2.5", "form": "binary"}\n')
    while head := read(36):
        scene, frame, steps, added, removed, _, gx, gy, dt = struct.unpack("<6I3f", head)
        bodies = [] if frame == 0 else bodies[: len(bodies) - removed]
        bodies += [list(struct.unpack("<11f", read(44))) for _ in range(added)]
        for k in range(1, steps + 1):
            sys.stdout.buffer.write(struct.pack("<4IQ", scene, frame + k, len(bodies), 0, 1500))
            for b in bodies:
                b[7] += 0 if b[0] else dt * gy
                b[4] += dt * b[7]
                sys.stdout.buffer.write(struct.pack("<6f", *b[3:9]))
        sys.stdout.buffer.flush()
    sys.exit()

hello = sys.stdin.readline()
if kind == "silent":
    sleep_for_ever()
if kind == "stubborn":
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    sleep_for_ever()
if kind in ("group", "group-later"):
    if kind == "group-later":
        say('{"twinbox": 1, "name": "fall", "version": "1"}\n')
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
    os.setpgid(0, os.getpgid(os.getppid()))
    sleep_for_ever()
if kind == "bytes":
    sys.stdout.buffer.write(b'{"twinbox": 1, "name": "f\xe4ll", "version": "1"}\n')
    sys.stdout.buffer.flush()
    sleep_for_ever()
if kind == "escapes":
    say('{"error": "no \\"lib\\" in C:\\\\x\\/\\u00fc \\ud83d\\ude00"}\n')
if kind == "lone":
    say('{"error": "\\ud83d"}\n')
if kind == "doubled":
    say('{"twinbox": 1, "name": "fall", "name": "rise", "version": "1"}\n')
if kind == "wordy":
    say(json.dumps({"error": "much " * 200}) + "\n")
if kind == "garbage":
    say("Loading the engine...\n")
    sleep_for_ever()
if kind == "version":
    say('{"twinbox": 2, "name": "fall", "version": "1"}\n')
    sleep_for_ever()
if kind == "flood":
    while True:
        out.write("0" * 65536)
if kind == "settings":
    say(json.dumps({"error": json.dumps(json.loads(hello)["settings"]).replace('"', "'")}) + "\n")
say('{"twinbox": 1, "name": "fall", "version": "1"}\n')
scene = {}
for line in sys.stdin:
    asked = json.loads(line)
    if asked["frame"] == 0:
        bodies, scene = [], asked
        speed = random.random() if kind == "random" else 0
    bodies = bodies[: len(bodies) - asked["remove"]] + asked["add"]
    for k in range(1, asked["steps"] + 1):
        frame = asked["frame"] + k
        for b in bodies:
            b[6] = speed
            b[7] += 0 if b[0] else scene["dt"] * scene["gravity"][1]
            b[3] += 0 if b[0] else scene["dt"] * b[6]
            b[4] += scene["dt"] * b[7]
        answer = {"scene": asked["scene"], "frame": frame, "ns": 1500, "states": [n for b in bodies for n in b[3:9]]}
        if frame == 5:
            if kind == "sleep":
                sleep_for_ever()
            if kind == "close":
                os.close(1)
                sleep_for_ever()
            if kind == "fork" and os.fork() != 0:
                os._exit(0)
            if kind == "fork":
                sleep_for_ever()
            if kind == "die":
                sys.exit("ValueError: the engine has no more memory")
            if kind == "former":
                answer["scene"] -= 1
            if kind == "frame":
                answer["frame"] -= 1
            if kind == "count":
                answer["states"] = answer["states"][6:]
            if kind == "nan":
                answer["states"][7] = float("nan")
            if kind == "null":
                answer["states"][8] = None
            if kind == "huge":
                answer["states"][6] = 1e300
            if kind == "complain":
                for _ in range(1 << 14):
                    sys.stderr.write("a warning that is of no use to anybody\n" * 10)
            if kind == "long":
                while True:
                    out.write("1, " * 1000)
        text = json.dumps(answer)
        if kind == "comma":
            text = text.replace(".", ",")
        if kind == "again" and frame == 5:
            text = '{"frame": 5, ' + text[1:]
        if kind == "nul" and frame == 5:
            text += "\0, and more"
        if kind == "slow":
            time.sleep(0.3)
        say(text + ("\r\n" if kind == "crlf" else "\n"))
        if kind == "twice" and k == asked["steps"]:
            say(text + "\n")

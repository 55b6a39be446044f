#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a scene with Chipmunk2D 7: chipmunk.py SCENE.yaml RUN.npz. Debian has the library (libchipmunk7), but not its
module pymunk. With pymunk, Space, Body and Poly take the place of `cp`, in the form of the comments."""
import ctypes, fractions, math, os, sys, numpy, yaml

class Vec(ctypes.Structure):
    _fields_ = [("x", ctypes.c_double), ("y", ctypes.c_double)]

class Ref(ctypes.c_void_p): pass

cp, real = ctypes.CDLL("libchipmunk.so.7"), ctypes.c_double
for result, names in ((Ref, "SpaceNew BodyNew BodyNewStatic BoxShapeNew"), (real, "MomentForBox BodyGetAngle"),
                      (Vec, "BodyGetPosition")):
    for name in names.split(): getattr(cp, "cp" + name).restype = result

def number(value):  # 0.2, "1/60", {from: -5, to: 5, value: 5}
    return float(fractions.Fraction(str(value["value"] if isinstance(value, dict) else value)))

def boxes(entry):  # the boxes of an entry of `bodies`, which may be a pattern
    (x, y), (dx, dy), count = entry["position"], entry.get("spacing", (0, 0)), entry.get("count", 1)
    pyramid = entry.get("pattern") == "pyramid"
    for row in range(count if pyramid else 1):
        for i in range(count - row):
            yield dict(entry, position=(x + dx * (i + row / 2), y + dy * (row if pyramid else i)))

def add(box):
    mass, (w, h) = real(box.get("mass", 1)), map(real, box["size"])
    moment = real(cp.cpMomentForBox(mass, w, h))                      # pymunk.moment_for_box(mass, (w, h))
    body = cp.cpBodyNewStatic() if box.get("static") else cp.cpBodyNew(mass, moment)  # pymunk.Body(mass, moment)
    shape = cp.cpBoxShapeNew(body, w, h, real(0))                     # pymunk.Poly.create_box(body, (w, h))
    cp.cpShapeSetFriction(shape, real(math.sqrt(box["friction"])))    # shape.friction = ..., of a pair multiplied
    cp.cpBodySetPosition(body, Vec(*box["position"]))                 # body.position = ...
    cp.cpBodySetAngle(body, real(box.get("angle", 0)))                # body.angle = ...
    cp.cpBodySetVelocity(body, Vec(*box.get("velocity", (0, 0))))     # body.velocity = ...
    cp.cpSpaceAddBody(space, body), cp.cpSpaceAddShape(space, shape)  # space.add(body, shape)
    return body

scene = yaml.safe_load(open(sys.argv[1]))
todo, bomb = [box for entry in scene["bodies"] for box in boxes(entry)], scene["bomb"]
bomb["position"], factor = (number(bomb["x"]), number(bomb["y"])), bomb["velocity"]["times_position"]
bomb["velocity"] = [factor * x for x in bomb["position"]]
dt, frames, count = number(scene["dt"]), scene["frames"] + 1, len(todo) + 1
space = cp.cpSpaceNew()                              # pymunk.Space()
cp.cpSpaceSetGravity(space, Vec(*scene["gravity"]))  # space.gravity = ...
cp.cpSpaceSetIterations(space, scene["iterations"])  # space.iterations = ...
cp.cpSpaceSetCollisionSlop(space, real(0.01))        # space.collision_slop = ...
bodies = [add(box) for box in todo]
position, angle = numpy.full((frames, count, 2), numpy.nan), numpy.full((frames, count), numpy.nan)
for frame in range(frames):
    if frame > 0: cp.cpSpaceStep(space, real(dt))    # space.step(dt)
    if frame == bomb.get("frame", 0): bodies.append(add(bomb))
    for i, body in enumerate(bodies):
        at, angle[frame, i] = cp.cpBodyGetPosition(body), cp.cpBodyGetAngle(body)  # body.position, body.angle
        position[frame, i] = at.x, at.y
sizes, fixed = [box["size"] for box in todo + [bomb]], ["static" in box for box in todo + [bomb]]
numpy.savez(sys.argv[2], position=position, angle=angle, size=sizes, dt=dt, bomb=count - 1, fixed=fixed,
            method="Chipmunk2D 7", scene=os.path.splitext(os.path.basename(sys.argv[1]))[0])

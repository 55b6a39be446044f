# A run of twinbox as an animation: blender --python THIS_FILE
import json
import math

import bpy

DEPTH = 1.0  # m, of all boxes
RUN = json.loads(r"""
RUN_AS_JSON""")


def material(name, colour):
    made = bpy.data.materials.new(name)
    made.diffuse_color = colour
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
    return made


def box(name, width, height, look):
    x, y, z = width / 2, DEPTH / 2, height / 2
    corners = [(a * x, b * y, c * z) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], sides)
    mesh.materials.append(look)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def curves_of(action):  # Blender 5 keeps them in layers
    if hasattr(action, "fcurves"):
        return action.fcurves
    return action.layers[0].strips[0].channelbags[0].fcurves


def animate(made, frames, states):
    made.keyframe_insert("location", frame=frames[0])
    made.keyframe_insert("rotation_euler", frame=frames[0])
    values = {
        ("location", 0): [s[0] for s in states],
        ("location", 2): [s[1] for s in states],
        ("rotation_euler", 1): [-s[2] for s in states],
    }
    for curve in curves_of(made.animation_data.action):
        numbers = values.get((curve.data_path, curve.array_index))
        if numbers is None:
            continue
        points = curve.keyframe_points
        points.add(len(frames) - len(points))
        points.foreach_set("co", [n for pair in zip(frames, numbers) for n in pair])
        for point in points:
            point.interpolation = "LINEAR"
        curve.update()


def hide(made, frame, hidden):
    made.hide_viewport = made.hide_render = hidden
    made.keyframe_insert("hide_viewport", frame=frame)
    made.keyframe_insert("hide_render", frame=frame)


def add_body(index, body, last):
    look = looks["static" if body["static"] else "bomb" if index == RUN.get("bomb") else "box"]
    made = box(f"body {index}", *body["size"], look)
    there = [(k, f["states"][index]) for k, f in enumerate(RUN["frames"]) if f["states"][index]]
    if not there:
        made.hide_viewport = made.hide_render = True
        return
    frames, states = zip(*there)
    made.location = (states[0][0], 0, states[0][1])
    made.rotation_euler = (0, -states[0][2], 0)
    if not body["static"]:
        animate(made, frames, states)
    if frames[0] > 0:
        hide(made, 0, True)
        hide(made, frames[0], False)
    if frames[-1] < last:
        hide(made, frames[-1], False)
        hide(made, frames[-1] + 1, True)


def add_view():
    start = enumerate(zip(RUN["frames"][0]["states"], RUN["bodies"]))
    seen = [s for i, (s, b) in start if s and not b["static"] and i != RUN.get("bomb")]
    seen = seen or [[0, 0]]
    x, z = [s[0] for s in seen], [s[1] for s in seen]
    centre = RUN.get("camera_centre", [(min(x) + max(x)) / 2, (min(z) + max(z)) / 2])
    size = RUN.get("camera_size", [1.5 * (max(x) - min(x)) + 8, 1.2 * (max(z) - min(z)) + 4])
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = max(size[0], size[1] * 16 / 9)
    camera.location = (centre[0], -50, centre[1])
    camera.rotation_euler = (math.pi / 2, 0, 0)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.rotation_euler = (0.7, 0.3, 0)
    sun.data.energy = 3
    for made in (camera, sun):
        bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.camera = camera


bpy.ops.wm.read_homefile(use_empty=True)
scene = bpy.context.scene
scene.name = f"{RUN['scene']} by {RUN['method']}"[:60]
scene.frame_start, scene.frame_end = 0, len(RUN["frames"]) - 1
scene.render.fps = max(1, round(1 / RUN["dt"]))
scene.render.fps_base = scene.render.fps * RUN["dt"]
looks = {
    "static": material("static", (0.6, 0.63, 0.66, 1)),
    "box": material("box", (0.0, 0.16, 0.45, 1)),
    "bomb": material("bomb", (0.5, 0.03, 0.02, 1)),
}
for index, body in enumerate(RUN["bodies"]):
    add_body(index, body, len(RUN["frames"]) - 1)
add_view()
scene.frame_set(0)

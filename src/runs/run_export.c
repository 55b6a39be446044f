/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "engine/engine.h"
#include "runs/trajectory.h"

#include <stdlib.h>

/* Nine digits are enough for a float; all digits of its double would be twice as long. */
static void put_float(JsonWriter *json, const char *key, float value) {
    char digits[32];
    snprintf(digits, sizeof digits, "%.9g", (double)value);
    json_put_number(json, key, strtod(digits, NULL));
}

static void put_vector(JsonWriter *json, const char *key, Vec2 v) {
    json_begin_array(json, key, JSON_ONE_LINE);
    put_float(json, NULL, v.x);
    put_float(json, NULL, v.y);
    json_end(json);
}

static void put_head(JsonWriter *json, const Trajectory *run) {
    json_put_text(json, "format", "twinbox run");
    json_put_int(json, "version", TRAJECTORY_VERSION);
    json_put_text(json, "scene", run->scene);
    json_put_text(json, "method", run->method);
    if (run->scene_hash != 0) json_put_hash(json, "scene_hash", run->scene_hash);
    put_float(json, "dt", run->dt);
    if (run->bomb >= 0) json_put_int(json, "bomb", run->bomb);
    if (run->camera_size.x > 0 && run->camera_size.y > 0) {
        put_vector(json, "camera_centre", run->camera_center);
        put_vector(json, "camera_size", run->camera_size);
    }
}

static void put_bodies(JsonWriter *json, const Trajectory *run) {
    json_begin_array(json, "bodies", JSON_LINES);
    for (int body = 0; body < run->bodies; body++) {
        json_begin_object(json, NULL, JSON_ONE_LINE);
        put_vector(json, "size", run->size[body]);
        json_put_bool(json, "static", run->fixed[body]);
        json_end(json);
    }
    json_end(json);
}

/* [x, y, angle, vx, vy, omega] */
static void put_state(JsonWriter *json, const Trajectory *run, int frame, int body) {
    const size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
    if (!trajectory_has(run, frame, body)) {
        json_put_text(json, NULL, NULL);
        return;
    }
    json_begin_array(json, NULL, JSON_ONE_LINE);
    put_float(json, NULL, run->position[i].x);
    put_float(json, NULL, run->position[i].y);
    put_float(json, NULL, run->angle[i]);
    if (!run->no_velocities) {
        put_float(json, NULL, run->velocity[i].x);
        put_float(json, NULL, run->velocity[i].y);
        put_float(json, NULL, run->angular_velocity[i]);
    }
    json_end(json);
}

static void put_contacts(JsonWriter *json, const Trajectory *run, int frame) {
    json_begin_array(json, "contacts", JSON_ONE_LINE);
    for (int64_t i = run->contact_start[frame]; i < run->contact_start[frame + 1]; i++) {
        const TrajectoryContact *contact = &run->contacts[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_int(json, "a", contact->a);
        json_put_int(json, "b", contact->b);
        put_vector(json, "point", contact->point);
        put_vector(json, "normal", contact->normal);
        put_vector(json, "impulse", vec2(contact->normal_impulse, contact->tangent_impulse));
        json_end(json);
    }
    json_end(json);
}

/* Prints the object. */
static void json_run_print(FILE *out, const Trajectory *run, bool contacts) {
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_LINES);
    put_head(&json, run);
    put_bodies(&json, run);
    json_begin_array(&json, "frames", JSON_LINES);
    for (int frame = 0; frame < run->frames; frame++) {
        json_begin_object(&json, NULL, JSON_ONE_LINE);
        json_begin_array(&json, "states", JSON_ONE_LINE);
        for (int body = 0; body < run->bodies; body++) put_state(&json, run, frame, body);
        json_end(&json);
        if (contacts && !run->no_contacts) put_contacts(&json, run, frame);
        json_end(&json);
    }
    json_end(&json);
    json_end(&json);
}

static void json_run_print_run(FILE *out, const void *context) { json_run_print(out, context, true); }

bool json_run_write(const Trajectory *run, const char *path, Error *error) {
    return file_write_text(path, json_run_print_run, run, error);
}

/* x stays, y becomes Blender's z, and the view is along its y. A body is hidden while it is absent. */
static const char before[] = "# A run of twinbox as an animation: blender --python THIS_FILE\n"
                             "import json\n"
                             "import math\n"
                             "\n"
                             "import bpy\n"
                             "\n"
                             "DEPTH = 1.0  # m, of all boxes\n"
                             "RUN = json.loads(r\"\"\"\n";

static const char after[] =
    "\"\"\")\n"
    "\n"
    "\n"
    "def material(name, colour):\n"
    "    made = bpy.data.materials.new(name)\n"
    "    made.diffuse_color = colour\n"
    "    made.use_nodes = True\n"
    "    made.node_tree.nodes[\"Principled BSDF\"].inputs[\"Base Color\"].default_value = colour\n"
    "    return made\n"
    "\n"
    "\n"
    "def box(name, width, height, look):\n"
    "    x, y, z = width / 2, DEPTH / 2, height / 2\n"
    "    corners = [(a * x, b * y, c * z) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]\n"
    "    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]\n"
    "    mesh = bpy.data.meshes.new(name)\n"
    "    mesh.from_pydata(corners, [], sides)\n"
    "    mesh.materials.append(look)\n"
    "    made = bpy.data.objects.new(name, mesh)\n"
    "    bpy.context.scene.collection.objects.link(made)\n"
    "    return made\n"
    "\n"
    "\n"
    "def curves_of(action):  # Blender 5 keeps them in layers\n"
    "    if hasattr(action, \"fcurves\"):\n"
    "        return action.fcurves\n"
    "    return action.layers[0].strips[0].channelbags[0].fcurves\n"
    "\n"
    "\n"
    "def animate(made, frames, states):\n"
    "    made.keyframe_insert(\"location\", frame=frames[0])\n"
    "    made.keyframe_insert(\"rotation_euler\", frame=frames[0])\n"
    "    values = {\n"
    "        (\"location\", 0): [s[0] for s in states],\n"
    "        (\"location\", 2): [s[1] for s in states],\n"
    "        (\"rotation_euler\", 1): [-s[2] for s in states],\n"
    "    }\n"
    "    for curve in curves_of(made.animation_data.action):\n"
    "        numbers = values.get((curve.data_path, curve.array_index))\n"
    "        if numbers is None:\n"
    "            continue\n"
    "        points = curve.keyframe_points\n"
    "        points.add(len(frames) - len(points))\n"
    "        points.foreach_set(\"co\", [n for pair in zip(frames, numbers) for n in pair])\n"
    "        for point in points:\n"
    "            point.interpolation = \"LINEAR\"\n"
    "        curve.update()\n"
    "\n"
    "\n"
    "def hide(made, frame, hidden):\n"
    "    made.hide_viewport = made.hide_render = hidden\n"
    "    made.keyframe_insert(\"hide_viewport\", frame=frame)\n"
    "    made.keyframe_insert(\"hide_render\", frame=frame)\n"
    "\n"
    "\n"
    "def add_body(index, body, last):\n"
    "    look = looks[\"static\" if body[\"static\"] else \"bomb\" if index == RUN.get(\"bomb\") else \"box\"]\n"
    "    made = box(f\"body {index}\", *body[\"size\"], look)\n"
    "    there = [(k, f[\"states\"][index]) for k, f in enumerate(RUN[\"frames\"]) if f[\"states\"][index]]\n"
    "    if not there:\n"
    "        made.hide_viewport = made.hide_render = True\n"
    "        return\n"
    "    frames, states = zip(*there)\n"
    "    made.location = (states[0][0], 0, states[0][1])\n"
    "    made.rotation_euler = (0, -states[0][2], 0)\n"
    "    if not body[\"static\"]:\n"
    "        animate(made, frames, states)\n"
    "    if frames[0] > 0:\n"
    "        hide(made, 0, True)\n"
    "        hide(made, frames[0], False)\n"
    "    if frames[-1] < last:\n"
    "        hide(made, frames[-1], False)\n"
    "        hide(made, frames[-1] + 1, True)\n"
    "\n"
    "\n"
    "def add_view():\n"
    "    start = enumerate(zip(RUN[\"frames\"][0][\"states\"], RUN[\"bodies\"]))\n"
    "    seen = [s for i, (s, b) in start if s and not b[\"static\"] and i != RUN.get(\"bomb\")]\n"
    "    seen = seen or [[0, 0]]\n"
    "    x, z = [s[0] for s in seen], [s[1] for s in seen]\n"
    "    centre = RUN.get(\"camera_centre\", [(min(x) + max(x)) / 2, (min(z) + max(z)) / 2])\n"
    "    size = RUN.get(\"camera_size\", [1.5 * (max(x) - min(x)) + 8, 1.2 * (max(z) - min(z)) + 4])\n"
    "    camera = bpy.data.objects.new(\"camera\", bpy.data.cameras.new(\"camera\"))\n"
    "    camera.data.type = \"ORTHO\"\n"
    "    camera.data.ortho_scale = max(size[0], size[1] * 16 / 9)\n"
    "    camera.location = (centre[0], -50, centre[1])\n"
    "    camera.rotation_euler = (math.pi / 2, 0, 0)\n"
    "    sun = bpy.data.objects.new(\"sun\", bpy.data.lights.new(\"sun\", \"SUN\"))\n"
    "    sun.rotation_euler = (0.7, 0.3, 0)\n"
    "    sun.data.energy = 3\n"
    "    for made in (camera, sun):\n"
    "        bpy.context.scene.collection.objects.link(made)\n"
    "    bpy.context.scene.camera = camera\n"
    "\n"
    "\n"
    "bpy.ops.wm.read_homefile(use_empty=True)\n"
    "scene = bpy.context.scene\n"
    "scene.name = f\"{RUN['scene']} by {RUN['method']}\"[:60]\n"
    "scene.frame_start, scene.frame_end = 0, len(RUN[\"frames\"]) - 1\n"
    "scene.render.fps = max(1, round(1 / RUN[\"dt\"]))\n"
    "scene.render.fps_base = scene.render.fps * RUN[\"dt\"]\n"
    "looks = {\n"
    "    \"static\": material(\"static\", (0.6, 0.63, 0.66, 1)),\n"
    "    \"box\": material(\"box\", (0.0, 0.16, 0.45, 1)),\n"
    "    \"bomb\": material(\"bomb\", (0.5, 0.03, 0.02, 1)),\n"
    "}\n"
    "for index, body in enumerate(RUN[\"bodies\"]):\n"
    "    add_body(index, body, len(RUN[\"frames\"]) - 1)\n"
    "add_view()\n"
    "scene.frame_set(0)\n";

static void blender_run_print_run(FILE *out, const void *context) {
    fputs(before, out);
    json_run_print(out, context, false);
    fputs(after, out);
}

bool blender_run_write(const Trajectory *run, const char *path, Error *error) {
    return file_write_text(path, blender_run_print_run, run, error);
}

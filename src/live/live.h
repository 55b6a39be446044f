/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs in a page: scenes are stepped in a browser with the bits of this program.

   The room is compiled twice. As a WebAssembly module (the option TWINBOX_LIVE of CMake) it is what a page runs: one
   instance in each worker, without imports, threads and files. As part of the program it packs what a page needs, and
   tests link it.

   A page, in JavaScript, where `live` are the exports of the module, `memory` among them:

       live._initialize();
       const bytes = ...;                              // a bundle, from live_pack()
       const at = live.live_reserve(bytes.length);
       new Uint8Array(live.memory.buffer, at, bytes.length).set(bytes);
       const scene = live.live_open(at, bytes.length); // 0: live_error() says why
       const run = live.live_begin(scene, text("bomb_x=-1.5,height=20"), text("engine:k=4"), 1);
       const frame = live.live_step(run, 300);         // fewer than asked for: live_failure(run) says why
       const x = new Float32Array(live.memory.buffer, live.live_positions(run), 2 * frames * bodies);
       const hash = BigInt.asUintN(64, live.live_hash(run, frame)).toString(16).padStart(16, "0");

   All texts are UTF-8 with a NUL. A text that a function returns is valid until the next call that returns one. Any
   call may move or grow the memory: make views of it again after each call. Pointers are numbers; 0 is NULL.
   tests/live/live.mjs is a small client. */
#pragma once
#include "base/base.h"
#include "methods/methods.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __wasm__
#define LIVE_EXPORT(name) __attribute__((export_name(#name)))
#else
#define LIVE_EXPORT(name)
#endif

/* The methods that a page can run are those of the list METHODS with LIVE or LIVE_NETWORK (methods/methods.h). There
   are two modules: the plain one has no networks, and is three quarters as large. */

/* The functions of the module. */

/* A scene file with its networks. Runs can be made of it with any settings. */
typedef struct LiveScene LiveScene;

/* A run: all frames so far, their hashes and the verdict. */
typedef struct LiveRun LiveRun;

/* Memory for a bundle or a text that the page writes; NULL when memory is short. */
LIVE_EXPORT(live_reserve) void *live_reserve(int size);
LIVE_EXPORT(live_release) void live_release(void *memory);

/* Why the last function failed that returned NULL: "scene.yaml:7:12: error: ...". Empty: none has. */
LIVE_EXPORT(live_error) const char *live_error(void);

/* The methods of this module as JSON: an array of objects with name, summary, caption (or null), needs_network, and
   settings: an array of {key, summary, type: "int" | "float" | "bool" | "text", from, to}, where only numbers have from
   and to. */
LIVE_EXPORT(live_methods) const char *live_methods(void);

/* Takes over the memory of the bundle, also on failure. NULL: it is damaged. */
LIVE_EXPORT(live_open) LiveScene *live_open(void *bundle, int size);

/* After the last of its runs has ended. */
LIVE_EXPORT(live_close) void live_close(LiveScene *scene);

/* The scene with these settings ("name=value,name=value", as --set takes them; empty: none) as JSON: name, dt, steps,
   iterations, scene_hash (of Trajectory), bodies (with the bomb), gravity [x, y], camera {center, size} (size [0, 0]:
   fitted to the run), bomb (or null) with frame, x, y, mass, speed, velocity [x, y], size [x, y] and reach [from, to]
   of x; parameters, an array of {name, unit, value, from, to, whole, common}. common: every scene has it; from and to
   are then no bounds, only a sensible range. NULL: a setting is refused. */
LIVE_EXPORT(live_describe) const char *live_describe(LiveScene *scene, const char *settings);

/* A run of the scene with these settings by a method as on the command line, "interior:near=0.02". It has frame 0.
   contacts: whether they are recorded; they take most of the memory. NULL: settings, method or launch are refused, or
   memory is short. */
LIVE_EXPORT(live_begin)
LiveRun *live_begin(LiveScene *scene, const char *settings, const char *method, int contacts);
LIVE_EXPORT(live_end) void live_end(LiveRun *run);

/* At most `count` more steps. Returns the number of the last frame. Where a step fails, the run ends before it. */
LIVE_EXPORT(live_step) int live_step(LiveRun *run, int count);

/* Why a step of this run failed; empty: none has. */
LIVE_EXPORT(live_failure) const char *live_failure(const LiveRun *run);

/* Frames of the whole run, steps + 1; bodies, with the bomb; index of the bomb, or -1. */
LIVE_EXPORT(live_frames) int live_frames(const LiveRun *run);
LIVE_EXPORT(live_bodies) int live_bodies(const LiveRun *run);
LIVE_EXPORT(live_bomb) int live_bomb(const LiveRun *run);

/* [bodies] width and height, m; kg; names of 32 bytes, with zeros behind them, or NULL if no body has one; 1:
   static. */
LIVE_EXPORT(live_sizes) const float *live_sizes(const LiveRun *run);
LIVE_EXPORT(live_masses) const float *live_masses(const LiveRun *run);
LIVE_EXPORT(live_names) const BodyName *live_names(const LiveRun *run);
LIVE_EXPORT(live_fixed) const uint8_t *live_fixed(const LiveRun *run);

/* [frames, bodies] x and y, m; rad; x and y, m/s; rad/s. NaN in frames to come, and for a body that does not exist. */
LIVE_EXPORT(live_positions) const float *live_positions(const LiveRun *run);
LIVE_EXPORT(live_angles) const float *live_angles(const LiveRun *run);
LIVE_EXPORT(live_velocities) const float *live_velocities(const LiveRun *run);
LIVE_EXPORT(live_spins) const float *live_spins(const LiveRun *run);

/* The contacts of the step that led to frame k, up to the last one, are live_contact_start(k) ... live_contact_start(k
   + 1) - 1 of the array, nine 32-bit words each: a, b, feature (integers), point x, y, normal x, y, normal and tangent
   impulse (floats; TrajectoryContact). */
LIVE_EXPORT(live_contact_start) int live_contact_start(const LiveRun *run, int frame);
LIVE_EXPORT(live_contacts) const void *live_contacts(const LiveRun *run);

/* What a contact of the array does in its step: 0 open, 1 sticks, 2 slips (ContactMode). */
LIVE_EXPORT(live_contact_mode) int live_contact_mode(const LiveRun *run, int contact);

/* The hash of a frame that `twinbox simulate` prints of the last one, and writes with --hash. */
LIVE_EXPORT(live_hash) uint64_t live_hash(const LiveRun *run, int frame);

/* The verdict on the run so far as JSON: verdict, frame, body (or -1), words: "falls at 4.22 s (body 7, 0.53 m lower)".
   NULL if a step failed for another reason than a NaN or infinite state. */
LIVE_EXPORT(live_verdict) const char *live_verdict(const LiveRun *run);

/* What a picture of the run so far shows, as twinbox render frames it, as JSON: set, left, right, bottom, top,
   action_left, action_right, room_left, room_right, middle (CameraFrame in runs/framing.h), m. */
LIVE_EXPORT(live_framing) const char *live_framing(const LiveRun *run);

/* The functions of the program. */

/* A module, as it is embedded in a page: not compressed. */
typedef struct LiveModule {
    const unsigned char *bytes;
    size_t size; /* 0: this build is without it (TWINBOX_LIVE) */
} LiveModule;

/* The plain module, or that with networks. */
LiveModule live_module(bool networks);

/* Whether the module with networks has this method. */
bool live_has_method(const MethodDescription *description);

/* What live_module() returns. */
extern const unsigned char live_networks_wasm[], live_plain_wasm[];
extern const size_t live_networks_wasm_size, live_plain_wasm_size;

/* A bundle: the scene file and the networks of these methods [count], as on the command line. The paths in it are
   without the scene's folder. *bundle: to be freed. ERROR_INPUT also for a method that the module does not have. */
bool live_pack(const char *scene, const char *const *methods, int count, void **bundle, size_t *size, Error *error);

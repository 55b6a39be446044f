/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which part of the world a picture of runs shows. */
#pragma once
#include "base/json_write.h"
#include "runs/trajectory.h"

#include <stdbool.h>

/* A part of the world, in metres: its centre and its size. */
typedef struct CameraView {
    double x, y, width, height; /* width 0: none */
} CameraView;

/* True if the view has a size that can be drawn. */
bool camera_view_is_usable(const CameraView *view);

/* The view that the run's scene sets; false if it sets none that is usable. */
bool camera_view_of(const Trajectory *run, CameraView *view);

/* A part of the world that bodies cover, or that is shown. */
typedef struct Extent {
    double left, right, bottom, top; /* m */
} Extent;

/* What a fixed camera shows. By default it frames what stands, so that this fills three quarters of a panel's width or
   height: the moving bodies where they start, the ground below them, and the bomb when it strikes them. The bomb comes
   into the picture from its edge. Of what happens after the impact counts only how far what stood gets in half of the
   runs, as long as it stays near, in coarse steps: so runs that differ little have the same view, and a body that flies
   off leaves the picture and changes nothing in the frames before. Only if most of the first run's bodies go far away,
   as on a slope, is it all that they reach in the whole run. */
typedef struct CameraFrame {
    bool set;      /* given: shown in the middle of a panel */
    Extent held;   /* in view whatever the panel's shape, with the margin */
    Extent action; /* in view unless all would get too small: what happens after the impact; only the width counts */
    Extent room;   /* in view as far as the panel has room: where what stands falls when the bomb strikes it */
    double middle; /* m, x of the middle of what stands */
} CameraFrame;

/* A usable view. */
CameraFrame camera_frame_of(const CameraView *view);

/* The view that the first run's scene sets. Otherwise, what stands in the first run, and in the others what is near
   that. */
CameraFrame camera_frame(const Trajectory *const *runs, int count);

/* What stands at the start and the bomb's way to it, as far as it is not far away. */
CameraFrame camera_frame_approach(const Trajectory *run);

/* An object with set, the sides of held, action_left, action_right, room_left, room_right and middle. */
void camera_frame_put(JsonWriter *json, const char *key, const CameraFrame *frame);

/* The part of the world that bodies of a run cover. */

/* Of the panel's height: a strip of ground. */
#define FRAMING_GROUND 0.05

/* m; bodies that reach farther do not count, or nothing else could be made out. */
#define EXTENT_FARTHEST 1e5

extern const Extent extent_empty;

bool extent_is_empty(const Extent *extent);

/* The larger side. */
double extent_side(const Extent *extent);

/* Widens the extent by a body's bounding box in this frame, unless it has no pose there or reaches too far. */
void extent_include(Extent *extent, const Trajectory *run, int frame, int body);

/* What runs show in these frames: the moving bodies of the first run, where they are near what stood at its start, and
   those of the others that stay near it, if most of a run's do; without any, the static bodies. Empty if nothing can be
   framed. A frame beyond a run's last counts as that. */
Extent framing_in_frames(const Trajectory *const *runs, int run_count, const int *frames, int count);

/* The frame in which the bomb appears; the last one if it does not. */
int bomb_first_frame(const Trajectory *run);

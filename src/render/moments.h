/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of moments in a video: title card, the run with slow motion around the impact, its last frame held, end
   card. In closed form, without a list.

   In real time, picture p of the run is shown p / rate seconds after its first. The frame there is p * step / per, exactly;
   poses between two frames are interpolated. Without options, step = per = 1 and the pictures are the frames. */
#pragma once
#include "picture/moment.h"
#include "render/render.h"

#include <stdint.h>

typedef struct MomentPlan {
    int first, last;           /* frames of the run, inclusive */
    int slow;                  /* slow-motion factor; 1: none */
    int slow_first, slow_last; /* range of frames; equal if there is no slow motion */
    int title, run, hold, end; /* number of pictures */
    double rate;               /* pictures per second */
    int64_t step, per;         /* in lowest terms: the run advances by step / per frames per picture */
    double speed;              /* s of the run per s of the film, apart from slow motion */
} MomentPlan;

/* Plans these frames. The impact is the first one in any panel; without one there is no slow motion. ERROR_INPUT for
   options out of range, and for a duration that leaves the run less than two pictures. */
bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, int first, int last,
                  const RenderOptions *options, Error *error);

/* The first frame in which any panel's bomb touches a dynamic body; -1: none. */
int moments_impact(const Trajectory *const *panels, int panel_count);

/* The index of the last picture. The first has the index of the first frame: without options, index and frame are
   equal. */
int moments_last(const MomentPlan *plan);

/* The moment of picture `index`, plan->first <= index <= moments_last(). */
Moment moments_at(const MomentPlan *plan, int index);

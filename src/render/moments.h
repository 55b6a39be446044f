/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of moments in a video: title card, the run with slow motion around the impact, its last frame held, end
   card. In closed form, without a list. */
#pragma once
#include "picture/moment.h"
#include "render/render.h"

typedef struct MomentPlan {
    int first, last;           /* frames of the run, inclusive */
    int slow;                  /* slow-motion factor; 1: none */
    int slow_first, slow_last; /* range of frames; equal if there is no slow motion */
    int title, hold, end;      /* number of pictures */
} MomentPlan;

/* Plans these frames. The impact is the first one in any panel; without one there is no slow motion. ERROR_INPUT for
   options out of range. */
bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, int first, int last,
                  const RenderOptions *options, Error *error);

/* The index of the last picture. The first has the index of the first frame: without options, index and frame are
   equal. */
int moments_last(const MomentPlan *plan);

/* The moment of picture `index`, plan->first <= index <= moments_last(). */
Moment moments_at(const MomentPlan *plan, int index);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which moments a video shows, in which order: a card, the run with slow motion around the impact, its last frame held, a
   card. In closed form: a long run needs no list. */
#pragma once
#include "picture/moment.h"
#include "render/render.h"

typedef struct MomentPlan {
    int first, last;           /* frames of the run, both included */
    int slow;                  /* times slower between two frames; 1: nowhere */
    int slow_first, slow_last; /* these frames; equal where nothing is slow */
    int title, hold, end;      /* pictures of each */
} MomentPlan;

/* For these frames. The impact is the first in any panel; where none has one, nothing is slow. ERROR_INPUT for options
   out of range. */
bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, int first, int last,
                  const RenderOptions *options, Error *error);

/* The number of the last picture. The first has that of the first frame, so that without options they are the same. */
int moments_last(const MomentPlan *plan);

/* The moment of a picture, plan->first <= index <= moments_last(). */
Moment moments_at(const MomentPlan *plan, int index);

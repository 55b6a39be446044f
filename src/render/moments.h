/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which moments a video shows, in which order: a card, the run with slow motion around the impact, its last frame held, a
   card. In closed form: a long run needs no list. */
#pragma once
#include "render/moment.h"
#include "render/render.h"

typedef struct MomentPlan {
    int frames;                /* of the run: 0 .. frames - 1 */
    int slow;                  /* times slower between two frames; 1: nowhere */
    int slow_first, slow_last; /* these frames; equal where nothing is slow */
    int title, hold, end;      /* pictures of each */
} MomentPlan;

/* The impact is the first in any panel; where none has one, nothing is slow. ERROR_INPUT for options out of range. */
bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                  Error *error);

int moments_count(const MomentPlan *plan);

/* The moment of a picture, 0 <= index < moments_count(). */
Moment moments_at(const MomentPlan *plan, int index);

/* The pictures of the frames `first` to `last`: what lies between these, and the card and the hold beside the run's own
   first and last. */
void moments_range(const MomentPlan *plan, int first, int last, int *first_index, int *last_index);

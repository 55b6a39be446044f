/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/moments.h"

#include <limits.h>
#include <math.h>

/* s of the run: enough to see the bomb come, and the boxes fly. */
static const double slow_before = 0.15, slow_after = 0.6;

/* s that a card of few words takes to read */
static const double card_seconds = 2;

static int first_impact(const Trajectory *const *panels, int count) {
    int first = -1;
    for (int i = 0; i < count; i++) {
        int impact = trajectory_impact(panels[i]);
        if (impact >= 0 && (first < 0 || impact < first)) first = impact;
    }
    return first;
}

static double frames_of(double seconds, double dt) { return floor(seconds / dt + 0.5); }

/* At least one: steps may be longer than what they are to show. */
static double some_frames_of(double seconds, double dt) { return fmax(1, frames_of(seconds, dt)); }

static void plan_slow(MomentPlan *plan, int impact, double dt) {
    plan->slow_first = (int)fmax(0, impact - some_frames_of(slow_before, dt));
    plan->slow_last = (int)fmin(plan->frames - 1, impact + some_frames_of(slow_after, dt));
}

static bool check(const RenderOptions *options, Error *error) {
    if (options->slow < 0 || options->slow > RENDER_SLOW_MAX)
        return error_input(error, "render", "%d times slower asked for; it can be up to %d", options->slow,
                           RENDER_SLOW_MAX);
    if (!(options->hold >= 0) || options->hold > RENDER_HOLD_MAX)
        return error_input(error, "render", "the end to be held for %g s; it can be up to %d", options->hold,
                           RENDER_HOLD_MAX);
    return true;
}

bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                  Error *error) {
    double dt = (double)panels[0]->dt, hold = frames_of(options->hold, dt), card = some_frames_of(card_seconds, dt);
    *plan = (MomentPlan){.slow = 1};
    if (!check(options, error)) return false;
    for (int i = 0; i < panel_count; i++)
        if (panels[i]->frames > plan->frames) plan->frames = panels[i]->frames;
    if (hold + 2 * card + (double)RENDER_SLOW_MAX * plan->frames > INT_MAX)
        return error_input(error, "render", "more pictures than a sequence can have: steps of %g s are too short", dt);
    plan->title = options->title_card ? (int)card : 0;
    plan->end = options->end_card ? (int)card : 0;
    plan->hold = (int)hold;
    int impact = options->slow > 1 ? first_impact(panels, panel_count) : -1;
    if (impact < 0) return true;
    plan->slow = options->slow;
    plan_slow(plan, impact, dt);
    return true;
}

static int index_of(const MomentPlan *plan, int frame) {
    int slow = frame < plan->slow_first ? 0 : (frame < plan->slow_last ? frame : plan->slow_last) - plan->slow_first;
    return plan->title + frame + (plan->slow - 1) * slow;
}

int moments_count(const MomentPlan *plan) { return index_of(plan, plan->frames - 1) + 1 + plan->hold + plan->end; }

Moment moments_at(const MomentPlan *plan, int index) {
    const int last = plan->frames - 1, first_slow = index_of(plan, plan->slow_first);
    const int pictures = index_of(plan, plan->slow_last) - first_slow, slow = index - first_slow;
    if (index < plan->title) return (Moment){MOMENT_TITLE, 0, 0, 1};
    if (index > index_of(plan, last) + plan->hold) return (Moment){MOMENT_END, last, 0, 1};
    if (slow < 0) return moment_stored(index - plan->title);
    if (slow >= pictures) {
        int frame = plan->slow_last + slow - pictures;
        return moment_stored(frame < last ? frame : last);
    }
    int frame = plan->slow_first + slow / plan->slow, part = slow % plan->slow;
    if (part == 0) return (Moment){MOMENT_STORED, frame, 0, plan->slow};
    return (Moment){MOMENT_BETWEEN, frame, (double)part / plan->slow, plan->slow};
}

void moments_range(const MomentPlan *plan, int first, int last, int *first_index, int *last_index) {
    *first_index = first == 0 ? 0 : index_of(plan, first);
    *last_index = last == plan->frames - 1 ? moments_count(plan) - 1 : index_of(plan, last);
}

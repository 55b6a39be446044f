/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/moments.h"

#include <limits.h>
#include <math.h>

/* s of simulated time: enough to see the bomb arrive and the boxes fly */
static const double slow_before = 0.15, slow_after = 0.6;

/* s, time to read a card */
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

/* At least 1, as time steps may be longer than `seconds`. */
static double at_least_one_frame(double seconds, double dt) { return fmax(1, frames_of(seconds, dt)); }

static void plan_slow(MomentPlan *plan, int impact, int slow, double dt) {
    plan->slow_first = (int)fmax(plan->first, impact - at_least_one_frame(slow_before, dt));
    plan->slow_last = (int)fmin(plan->last, impact + at_least_one_frame(slow_after, dt));
    if (plan->slow_first >= plan->slow_last)
        plan->slow_last = plan->slow_first = plan->first;
    else
        plan->slow = slow;
}

static bool check(const RenderOptions *options, Error *error) {
    if (options->slow < 0 || options->slow > RENDER_SLOW_MAX)
        return error_input(error, "render", "the slow-motion factor must be 0 to %d (got %d)", RENDER_SLOW_MAX,
                           options->slow);
    if (!(options->hold >= 0) || options->hold > RENDER_HOLD_MAX)
        return error_input(error, "render", "the last frame can be held for 0 to %d s (got %g)", RENDER_HOLD_MAX,
                           options->hold);
    return true;
}

bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, int first, int last,
                  const RenderOptions *options, Error *error) {
    double dt = (double)panels[0]->dt, hold = frames_of(options->hold, dt), card = at_least_one_frame(card_seconds, dt);
    *plan = (MomentPlan){.first = first, .last = last, .slow = 1, .slow_first = first, .slow_last = first};
    if (!check(options, error)) return false;
    if (hold + 2 * card + (double)RENDER_SLOW_MAX * (last + 1.0) > INT_MAX)
        return error_input(error, "render", "too many pictures for one sequence: time steps of %g s are too short", dt);
    plan->title = options->title_card ? (int)card : 0;
    plan->end = options->end_card ? (int)card : 0;
    plan->hold = (int)hold;
    int impact = options->slow > 1 ? first_impact(panels, panel_count) : -1;
    if (impact >= 0) plan_slow(plan, impact, options->slow, dt);
    return true;
}

static int index_of(const MomentPlan *plan, int frame) {
    int slow = frame < plan->slow_first ? 0 : (frame < plan->slow_last ? frame : plan->slow_last) - plan->slow_first;
    return plan->title + frame + (plan->slow - 1) * slow;
}

int moments_last(const MomentPlan *plan) { return index_of(plan, plan->last) + plan->hold + plan->end; }

Moment moments_at(const MomentPlan *plan, int index) {
    const int first_slow = index_of(plan, plan->slow_first), slow = index - first_slow;
    const int pictures = index_of(plan, plan->slow_last) - first_slow;
    if (index < plan->first + plan->title) return (Moment){MOMENT_TITLE, plan->first, 0, 1};
    if (index > index_of(plan, plan->last) + plan->hold) return (Moment){MOMENT_END, plan->last, 0, 1};
    if (slow < 0) return moment_stored(index - plan->title);
    if (slow >= pictures) {
        int frame = plan->slow_last + slow - pictures;
        return moment_stored(frame < plan->last ? frame : plan->last);
    }
    int frame = plan->slow_first + slow / plan->slow, part = slow % plan->slow;
    if (part == 0) return (Moment){MOMENT_STORED, frame, 0, plan->slow};
    return (Moment){MOMENT_BETWEEN, frame, (double)part / plan->slow, plan->slow};
}

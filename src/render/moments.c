/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/moments.h"

#include "render/divisor.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>

/* s of simulated time: enough to see the bomb arrive and the boxes fly */
static const double slow_before = 0.15, slow_after = 0.6;

/* s, time to read a card */
static const double card_seconds = 2;

/* Thousandths of a Hz: frame rates are compared as whole numbers, so that a run of 60 Hz at 60 pictures per second shows
   its frames, although 1/60 s is no binary fraction. */
static const double rate_unit = 1000;

int moments_impact(const Trajectory *const *panels, int count) {
    int first = -1;
    for (int i = 0; i < count; i++) {
        int impact = trajectory_impact(panels[i]);
        if (impact >= 0 && (first < 0 || impact < first)) first = impact;
    }
    return first;
}

static double nearest(double number) { return floor(number + 0.5); }

/* At least 1, as a picture may be shown for longer than `seconds`. */
static double at_least_one(double seconds, double rate) { return fmax(1, nearest(seconds * rate)); }

static void plan_slow(MomentPlan *plan, int impact, int slow, double dt) {
    plan->slow_first = (int)fmax(plan->first, impact - at_least_one(slow_before, 1 / dt));
    plan->slow_last = (int)fmin(plan->last, impact + at_least_one(slow_after, 1 / dt));
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
    if (options->fps != 0 && !(options->fps >= RENDER_FPS_MIN && options->fps <= RENDER_FPS_MAX))
        return error_input(error, "render", "the pictures per second must be %d to %d (got %g)", RENDER_FPS_MIN,
                           RENDER_FPS_MAX, options->fps);
    if (options->duration != 0 && !(options->duration > 0 && options->duration <= RENDER_DURATION_MAX))
        return error_input(error, "render", "the film can last up to %d s (got %g)", RENDER_DURATION_MAX,
                           options->duration);
    return true;
}

/* Time in the film at which a frame is shown, in time steps of the run at full speed. */
static int64_t film_time(const MomentPlan *plan, int frame) {
    const int slow =
        frame < plan->slow_first ? 0 : (frame < plan->slow_last ? frame : plan->slow_last) - plan->slow_first;
    return (int64_t)frame - plan->first + (int64_t)(plan->slow - 1) * slow;
}

static void set_step(MomentPlan *plan, int64_t step, int64_t per) {
    const int64_t divisor = greatest_divisor(step, per);
    plan->step = step / divisor;
    plan->per = per / divisor;
}

/* The frame rate of the run is rounded to a thousandth of a Hz, far below what can be seen. */
static bool choose_rate(MomentPlan *plan, const RenderOptions *options, double dt, Error *error) {
    static const double longest = 1000, shortest = 1e-9; /* s: the rate fits a whole number, and is not 0 */
    set_step(plan, 1, 1);
    plan->rate = 1 / dt;
    if (options->fps == 0) return true;
    if (!(dt >= shortest && dt <= longest))
        return error_input(error, "--fps", "time steps of %g s have no real time that a video can show", dt);
    const double rate = nearest(rate_unit * options->fps);
    plan->rate = rate / rate_unit;
    set_step(plan, (int64_t)nearest(rate_unit / dt), (int64_t)rate);
    return true;
}

/* The run takes what cards and the held frame leave of the film. */
static bool fit_duration(MomentPlan *plan, double duration, double dt, Error *error) {
    const double rest = plan->title + plan->hold + plan->end, pictures = nearest(duration * plan->rate) - rest;
    if (plan->first == plan->last)
        return error_input(error, "--duration", "a single frame has no speed; --hold shows it for some seconds");
    if (pictures < 2)
        return error_input(error, "--duration", "%g s are too short: %s%.3g s at %g pictures per second are needed",
                           duration, rest > 0 ? "with the cards and the held frame, " : "", (rest + 2) / plan->rate,
                           plan->rate);
    set_step(plan, film_time(plan, plan->last), (int64_t)pictures - 1);
    plan->speed = (double)plan->step / (double)plan->per * plan->rate * dt;
    return true;
}

/* The last frame is always shown, at most one picture late. */
static bool count_pictures(MomentPlan *plan, double dt, Error *error) {
    const double length = (double)film_time(plan, plan->last), rest = plan->title + plan->hold + plan->end;
    if (plan->first + rest + length * (double)plan->per / (double)plan->step + 2 > INT_MAX)
        return error_input(error, "render", "too many pictures for one sequence: %.0f time steps of %g s", length, dt);
    plan->run = (int)((film_time(plan, plan->last) * plan->per + plan->step - 1) / plan->step) + 1;
    return true;
}

bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, int first, int last,
                  const RenderOptions *options, Error *error) {
    const double dt = (double)panels[0]->dt;
    *plan = (MomentPlan){.first = first, .last = last, .slow = 1, .slow_first = first, .slow_last = first, .speed = 1};
    if (!check(options, error) || !choose_rate(plan, options, dt, error)) return false;
    const double hold = nearest(options->hold * plan->rate), card = at_least_one(card_seconds, plan->rate);
    if (hold + 2 * card > INT_MAX)
        return error_input(error, "render", "too many pictures for one sequence: time steps of %g s are too short", dt);
    plan->title = options->title_card ? (int)card : 0;
    plan->end = options->end_card ? (int)card : 0;
    plan->hold = (int)hold;
    int impact = options->slow > 1 ? moments_impact(panels, panel_count) : -1;
    if (impact >= 0) plan_slow(plan, impact, options->slow, dt);
    return (options->duration == 0 || fit_duration(plan, options->duration, dt, error)) &&
           count_pictures(plan, dt, error);
}

int moments_last(const MomentPlan *plan) { return plan->first + plan->title + plan->run - 1 + plan->hold + plan->end; }

/* A time in the film, in parts of a time step, in the stretch that begins at `frame` and is `slow` times slower. */
static Moment moment_in(const MomentPlan *plan, int64_t time, int frame, int slow) {
    const int64_t parts = plan->per * slow, begin = film_time(plan, frame) * plan->per, since = time - begin;
    /* What divides all times of the stretch: without interpolation, a moment has one part. */
    const int64_t divisor = greatest_divisor(greatest_divisor(parts, plan->step), begin);
    const int64_t part = since % parts;
    return (Moment){part == 0 ? MOMENT_STORED : MOMENT_BETWEEN, frame + (int)(since / parts), (int)(part / divisor),
                    (int)(parts / divisor), slow / plan->speed};
}

Moment moments_at(const MomentPlan *plan, int index) {
    const int picture = index - plan->first - plan->title;
    if (picture < 0) return (Moment){MOMENT_TITLE, plan->first, 0, 1, 1};
    if (picture >= plan->run + plan->hold) return (Moment){MOMENT_END, plan->last, 0, 1, 1};
    const int64_t slow_begin = film_time(plan, plan->slow_first) * plan->per;
    const int64_t slow_end = film_time(plan, plan->slow_last) * plan->per;
    const int64_t time = picture < plan->run - 1 ? picture * plan->step : film_time(plan, plan->last) * plan->per;
    if (time < slow_begin) return moment_in(plan, time, plan->first, 1);
    if (time < slow_end) return moment_in(plan, time, plan->slow_first, plan->slow);
    return moment_in(plan, time, plan->slow_last, 1);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sequence: which moments its pictures show, and the folder of these pictures, with its manifest. */
#include "pictures/render.h"

#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/numbers.h"
#include "pictures/picture.h"
#include "pictures/render_internal.h"
#include "pictures/style.h"
#include "runs/trajectory.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* s, time to read a card */
static const double card_seconds = 2;

/* Thousandths of a Hz: frame rates are compared as whole numbers, so that a run of 60 Hz at 60 pictures per second
   shows its frames, although 1/60 s is no binary fraction. */
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

bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, int first, int last,
                  const RenderOptions *options, Error *error) {
    static const double longest = 1000, shortest = 1e-9; /* s, of a step: the rate fits a whole number, and is not 0 */
    const double dt = (double)panels[0]->dt;
    *plan = (MomentPlan){.first = first, .last = last, .slow = 1, .slow_first = first, .slow_last = first, .speed = 1};
    if (!check(options, error)) return false;

    /* The frame rate of the run is rounded to a thousandth of a Hz, far below what can be seen. */
    set_step(plan, 1, 1);
    plan->rate = 1 / dt;
    if (options->fps != 0) {
        if (!(dt >= shortest && dt <= longest))
            return error_input(error, "--fps", "time steps of %g s have no real time that a video can show", dt);
        const double rate = nearest(rate_unit * options->fps);
        plan->rate = rate / rate_unit;
        set_step(plan, (int64_t)nearest(rate_unit / dt), (int64_t)rate);
    }

    const double hold = nearest(options->hold * plan->rate), card = at_least_one(card_seconds, plan->rate);
    if (hold + 2 * card > INT_MAX)
        return error_input(error, "render", "too many pictures for one sequence: time steps of %g s are too short", dt);
    plan->title = options->title_card ? (int)card : 0;
    plan->end = options->end_card ? (int)card : 0;
    plan->hold = (int)hold;

    const int impact = options->slow > 1 ? moments_impact(panels, panel_count) : -1;
    if (impact >= 0) {
        plan->slow_first = (int)fmax(first, impact - at_least_one(SLOW_BEFORE, 1 / dt));
        plan->slow_last = (int)fmin(last, impact + at_least_one(SLOW_AFTER, 1 / dt));
        if (plan->slow_first >= plan->slow_last)
            plan->slow_last = plan->slow_first = first;
        else
            plan->slow = options->slow;
    }

    /* Of a film of given duration, the run takes what cards and the held frame leave. */
    const int64_t length = film_time(plan, last);
    const double rest = plan->title + plan->hold + plan->end;
    if (options->duration != 0) {
        const double pictures = nearest(options->duration * plan->rate) - rest;
        if (first == last)
            return error_input(error, "--duration", "a single frame has no speed; --hold shows it for some seconds");
        if (pictures < 2)
            return error_input(error, "--duration", "%g s are too short: %s%.3g s at %g pictures per second are needed",
                               options->duration, rest > 0 ? "with the cards and the held frame, " : "",
                               (rest + 2) / plan->rate, plan->rate);
        set_step(plan, length, (int64_t)pictures - 1);
        plan->speed = (double)plan->step / (double)plan->per * plan->rate * dt;
    }

    /* The last frame is always shown, at most one picture late. */
    if (first + rest + (double)length * (double)plan->per / (double)plan->step + 2 > INT_MAX)
        return error_input(error, "render", "too many pictures for one sequence: %.0f time steps of %g s",
                           (double)length, dt);
    plan->run = (int)((length * plan->per + plan->step - 1) / plan->step) + 1;
    return true;
}

int moments_last(const MomentPlan *plan) { return plan->first + plan->title + plan->run - 1 + plan->hold + plan->end; }

Moment moments_at(const MomentPlan *plan, int index) {
    const int picture = index - plan->first - plan->title;
    if (picture < 0) return (Moment){MOMENT_TITLE, plan->first, 0, 1, 1};
    if (picture >= plan->run + plan->hold) return (Moment){MOMENT_END, plan->last, 0, 1, 1};
    /* A time in the film, in parts of a time step, in the stretch that begins at `frame` and is `slow` times slower. */
    const int64_t time = picture < plan->run - 1 ? picture * plan->step : film_time(plan, plan->last) * plan->per;
    int frame = plan->first, slow = 1;
    if (time >= film_time(plan, plan->slow_last) * plan->per)
        frame = plan->slow_last;
    else if (time >= film_time(plan, plan->slow_first) * plan->per)
        frame = plan->slow_first, slow = plan->slow;
    const int64_t parts = plan->per * slow, begin = film_time(plan, frame) * plan->per, since = time - begin;
    /* What divides all times of the stretch: without interpolation, a moment has one part. */
    const int64_t divisor = greatest_divisor(greatest_divisor(parts, plan->step), begin);
    const int64_t part = since % parts;
    return (Moment){part == 0 ? MOMENT_STORED : MOMENT_BETWEEN, frame + (int)(since / parts), (int)(part / divisor),
                    (int)(parts / divisor), slow / plan->speed};
}

static bool store_runs(const Picture *picture, const char *directory, Error *error) {
    for (int i = 0; i < picture->count; i++) {
        char name[TRAJECTORY_FILE_NAME_SIZE], path[PATH_MAX];
        trajectory_file_name(picture->runs, i, name);
        if (!file_path(path, sizeof path, error, "%s/%s", directory, name) ||
            !trajectory_write(picture->runs[i], path, error))
            return false;
    }
    return true;
}

/* `picture` is planned. */
static bool make_sequence(Picture *picture, const RenderOptions *options, RenderResult *result,
                          const Progress *progress, Error *error) {
    const int first = options->first, last = options->last < 0 ? picture->frames - 1 : options->last;
    MomentPlan plan;
    if (first < 0 || first > last || last >= picture->frames)
        return error_input(error, "render", "the frames must be a range within 0 to %d (got %d to %d)",
                           picture->frames - 1, first, last);
    if (!moments_plan(&plan, picture->runs, picture->count, first, last, options, error) ||
        !picture_apply_options(picture, options, error))
        return false;
    *result = (RenderResult){.first = first, .last = moments_last(&plan), .rate = plan.rate};
    const bool whole = first == 0 && last == picture->frames - 1;
    Manifest manifest;
    const WorkerJob job = {picture, options, &plan, &manifest, result->first, result->last};
    bool ok = manifest_open(&manifest, picture, options, &plan, result->first, result->last, error) &&
              manifest_check(&manifest, error) && folder_reserve(options->directory, error) &&
              (!options->store_runs || store_runs(picture, options->directory, error));
    if (ok && options->resume) manifest_recall(&manifest, result->why, sizeof result->why);
    ok = ok && manifest_begin(&manifest, whole, error) && workers_draw(&job, &result->kept, progress, error) &&
         manifest_end(&manifest, error);
    if (ok) {
        result->hashes = manifest.hashes;
        manifest.hashes = NULL;
    }
    manifest_close(&manifest);
    return ok;
}

bool render_sequence(const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                     RenderResult *result, const Progress *progress, Error *error) {
    Picture picture;
    RenderResult ignored;
    if (result == NULL) result = &ignored;
    *result = (RenderResult){0};
    if (options->jobs < 1 || options->jobs > RENDER_JOBS_MAX)
        return error_input(error, "render", "the number of jobs must be 1 to %d (got %d)", RENDER_JOBS_MAX,
                           options->jobs);
    if (!picture_plan(&picture, panels, panel_count, options->width, options->height, error)) return false;
    bool ok = make_sequence(&picture, options, result, progress, error);
    picture_free(&picture);
    if (result == &ignored) free(ignored.hashes);
    return ok;
}

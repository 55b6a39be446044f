/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sequence: which moments its pictures show, and how they are drawn, as a whole or in pieces (runs/pieces.h): ranges
   of consecutive pictures, whose frames are files in the folder. The results of a piece are lines "INDEX PIXELS FILE":
   the hashes of its pictures. */
#include "pictures/render.h"

#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/numbers.h"
#include "pictures/picture.h"
#include "pictures/render_internal.h"
#include "pictures/style.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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

static void plan_slow(MomentPlan *plan, int impact, int slow, double dt) {
    plan->slow_first = (int)fmax(plan->first, impact - at_least_one(SLOW_BEFORE, 1 / dt));
    plan->slow_last = (int)fmin(plan->last, impact + at_least_one(SLOW_AFTER, 1 / dt));
    if (plan->slow_first >= plan->slow_last)
        plan->slow_last = plan->slow_first = plan->first;
    else
        plan->slow = slow;
}

static bool render_check(const RenderOptions *options, Error *error) {
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
    if (!render_check(options, error) || !choose_rate(plan, options, dt, error)) return false;
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

/* A piece takes some seconds on one core, as a process takes as long to start as some dozens of small pictures; a short
   film has pieces for some shards all the same. */
static const double piece_seconds = 4;

enum { MOST_PICTURES = 256, FEW_PICTURES = 32, FEW_PIECES = 16 };

/* The plan's context. */
typedef struct Ranges {
    WorkerJob all;
    double seconds; /* about those of a picture */
    int size;       /* pictures in a piece; fewer in the last */
} Ranges;

/* Follows from the options alone, so that all shards have the same pieces. */
static void plan_ranges(Ranges *ranges, const WorkerJob *job) {
    const RenderOptions *options = job->options;
    const double pixel_seconds = options->small ? 4e-8 : 2.5e-9;
    const int pictures = job->last - job->first + 1;
    *ranges = (Ranges){.all = *job, .seconds = 1e-3 + pixel_seconds * options->width * options->height};
    ranges->size = int_max(1, int_min(MOST_PICTURES, (int)(piece_seconds / ranges->seconds)));
    ranges->size = int_min(ranges->size, int_max(FEW_PICTURES, pictures / FEW_PIECES));
}

static int first_of(const Ranges *ranges, int64_t piece) { return ranges->all.first + (int)piece * ranges->size; }

static int last_of(const Ranges *ranges, int64_t piece) {
    return int_min(first_of(ranges, piece + 1) - 1, ranges->all.last);
}

static void render_describe(void *context, int64_t piece, PieceInfo *info) {
    const Ranges *ranges = context;
    const int first = first_of(ranges, piece), last = last_of(ranges, piece);
    snprintf(info->name, sizeof info->name, "pictures %d-%d", first, last);
    info->weight = (last - first + 1) * ranges->seconds;
    info->alone = true; /* its processes take all cores */
}

static bool render_work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    const Ranges *ranges = context;
    WorkerJob job = ranges->all;
    const Manifest *manifest = job.manifest;
    job.first = first_of(ranges, piece);
    job.last = last_of(ranges, piece);
    if (!workers_draw(&job, NULL, progress, error)) return false;
    for (int i = job.first; i <= job.last; i++) {
        const PictureHashes *hashes = &manifest->hashes[i - manifest->first];
        fprintf(results, "%d %016" PRIx64 " %016" PRIx64 "\n", i, hashes->pixels, hashes->file);
    }
    return true;
}

/* The hashes of picture `index` from the line at *text, which then stands at the next one. */
static bool read_line(const char **text, int index, PictureHashes *hashes) {
    int read, end = 0;
    if (sscanf(*text, "%d %16" SCNx64 " %16" SCNx64 "%n", &read, &hashes->pixels, &hashes->file, &end) != 3 ||
        read != index || (*text)[end] != '\n')
        return false;
    *text += end + 1;
    return true;
}

/* Whether the frames are as the shard left them. */
static bool render_whole(void *context, int64_t piece, const char *results, size_t size, bool *there, Error *error) {
    const Ranges *ranges = context;
    const char *text = results;
    *there = true;
    for (int i = first_of(ranges, piece); *there && i <= last_of(ranges, piece); i++) {
        PictureHashes hashes;
        *there = read_line(&text, i, &hashes);
        if (*there && !sink_frame_check(ranges->all.options->directory, i, hashes.file, there, error)) return false;
    }
    *there = *there && text == results + size;
    return true;
}

static bool take_piece(const Ranges *ranges, const Pieces *pieces, int64_t piece, Error *error) {
    Manifest *manifest = ranges->all.manifest;
    size_t size;
    char *results = pieces_read(pieces, piece, &size, NULL, error);
    const char *text = results;
    bool ok = results != NULL;
    for (int i = first_of(ranges, piece); ok && i <= last_of(ranges, piece); i++) {
        ok = read_line(&text, i, &manifest->hashes[i - manifest->first]) ||
             error_input(error, pieces->folder, "the hashes of picture %d have changed", i);
        manifest->known[i - manifest->first] = ok;
    }
    free(results);
    return ok;
}

/* An earlier manifest of the same pictures stays until it is replaced. */
static bool take_all(const Ranges *ranges, const Pieces *pieces, Error *error) {
    char why[256];
    manifest_recall(ranges->all.manifest, why, sizeof why);
    for (int64_t i = 0; i < pieces->plan->count; i++)
        if (!take_piece(ranges, pieces, i, error)) return false;
    return true;
}

/* Draws the pieces of a shard; checks those of a merge, and takes their hashes into the job's manifest. Of a whole
   sequence, checks only that no shards are in the folder. */
static bool sequence_pieces_do(const WorkerJob *job, RenderStudy *study, const Progress *progress, Error *error) {
    Pieces *pieces = &study->pieces;
    Ranges ranges;
    plan_ranges(&ranges, job);
    const PiecePlan plan = {.count = (job->last - job->first) / ranges.size + 1,
                            .describe = render_describe,
                            .work = render_work,
                            .whole = render_whole,
                            .context = &ranges};
    study_key_add(study->key, job->manifest->head, strlen(job->manifest->head));
    if (!manifest_check(job->manifest, error) ||
        !pieces_open(pieces, job->options->directory, study->key, study->run, error))
        return false;
    if (pieces->mode == PIECES_WHOLE) return true;
    const bool ok =
        pieces_do(pieces, &plan, progress, error) && (pieces->mode == PIECES_SHARD || take_all(&ranges, pieces, error));
    pieces->plan = NULL;
    return ok;
}

static bool choose_range(const RenderOptions *options, const Picture *picture, int *first, int *last, Error *error) {
    *first = options->first;
    *last = options->last < 0 ? picture->frames - 1 : options->last;
    if (*first >= 0 && *first <= *last && *last < picture->frames) return true;
    return error_input(error, "render", "the frames must be a range within 0 to %d (got %d to %d)", picture->frames - 1,
                       *first, *last);
}

/* Draws or keeps the selected pictures; the manifest is open. Of a merge, all pictures are known and were checked. */
static bool make_pictures(const WorkerJob *job, bool merged, RenderResult *result, const Progress *progress,
                          Error *error) {
    Manifest *manifest = job->manifest;
    if (job->options->resume && !merged) manifest_recall(manifest, result->why, sizeof result->why);
    if (!manifest_begin(manifest, result->all, error) ||
        (!merged && !workers_draw(job, &result->kept, progress, error)) || !manifest_end(manifest, error))
        return false;
    if (merged) result->kept = job->last - job->first + 1;
    result->hashes = manifest->hashes;
    manifest->hashes = NULL;
    return true;
}

/* Shards share a folder; others have it to themselves. */
static bool make_study(const WorkerJob *job, RenderStudy *study, RenderResult *result, const Progress *progress,
                       Error *error) {
    if (study != NULL && !sequence_pieces_do(job, study, progress, error)) return false;
    if (study != NULL && study->pieces.mode == PIECES_SHARD) return true;
    return folder_reserve(job->options->directory, error) && (study == NULL || study->begin(study->context, error)) &&
           make_pictures(job, study != NULL && study->pieces.mode == PIECES_MERGE, result, progress, error);
}

/* `picture` is planned. */
static bool make_sequence(Picture *picture, const RenderOptions *options, RenderStudy *study, RenderResult *result,
                          const Progress *progress, Error *error) {
    MomentPlan plan;
    int first, last;
    if (!choose_range(options, picture, &first, &last, error) ||
        !moments_plan(&plan, picture->runs, picture->count, first, last, options, error) ||
        !picture_apply_options(picture, options, error))
        return false;
    result->first = first;
    result->last = moments_last(&plan);
    result->rate = plan.rate;
    result->all = first == 0 && last == picture->frames - 1;
    Manifest manifest;
    const WorkerJob job = {picture, options, &plan, &manifest, result->first, result->last};
    bool ok = manifest_open(&manifest, picture, options, &plan, result->first, result->last, error) &&
              make_study(&job, study, result, progress, error);
    manifest_close(&manifest);
    return ok;
}

bool render_study(const Trajectory *const *panels, int panel_count, const RenderOptions *options, RenderStudy *study,
                  RenderResult *result, const Progress *progress, Error *error) {
    Picture picture;
    RenderResult ignored;
    if (result == NULL) result = &ignored;
    *result = (RenderResult){0};
    if (options->jobs < 1 || options->jobs > RENDER_JOBS_MAX)
        return error_input(error, "render", "the number of jobs must be 1 to %d (got %d)", RENDER_JOBS_MAX,
                           options->jobs);
    if (!picture_plan(&picture, panels, panel_count, options->width, options->height, error)) return false;
    bool ok = make_sequence(&picture, options, study, result, progress, error);
    picture_free(&picture);
    if (result == &ignored) free(ignored.hashes);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/folder_reserve.h"
#include "render/sequence_pieces.h"
#include "render/workers.h"

#include <stdlib.h>

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

bool render_sequence(const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                     RenderResult *result, const Progress *progress, Error *error) {
    return render_study(panels, panel_count, options, NULL, result, progress, error);
}

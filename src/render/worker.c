/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/worker.h"

#include "common/file.h"
#include "render/frame_texts.h"
#include "render/renderer.h"
#include "render/sink.h"

#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

/* State of a worker. */
typedef struct Worker {
    const WorkerJob *job;
    Renderer *renderer;
    Image *image;
    uint64_t *rows; /* [height] hashes of the image */
    FrameSink sink;
    FrameTexts texts;
} Worker;

static bool send(int pipe, const WorkerReport *report) { return file_write_all(pipe, report, sizeof *report); }

/* Whether the file of an earlier call exists with unchanged bytes. */
static bool is_unchanged(const Worker *worker, int index, PictureHashes *hashes) {
    const Manifest *manifest = worker->job->manifest;
    if (!manifest->known[index - manifest->first]) return false;
    *hashes = manifest->hashes[index - manifest->first];
    return sink_frame_is(worker->job->options->directory, index, hashes->file);
}

static bool prepare(Worker *worker, Error *error) {
    const RenderOptions *options = worker->job->options;
    worker->renderer = renderer_create_planned(worker->job->picture, options, error);
    if (worker->renderer == NULL) return false;
    worker->image = image_create(options->width, options->height, error);
    worker->rows = calloc((size_t)options->height, sizeof *worker->rows);
    return worker->image != NULL && (worker->rows != NULL || error_memory(error, "render"));
}

static bool draw_one(Worker *worker, Moment moment, int index, PictureHashes *hashes, Error *error) {
    const bool *changed;
    /* Created on demand: possibly every picture is kept. */
    if (worker->renderer == NULL && !prepare(worker, error)) return false;
    frame_texts_fill(&worker->texts, worker->job->picture, moment);
    if (!renderer_draw_next(worker->renderer, moment, worker->image, &changed, error) ||
        !worker->sink.write(worker->sink.context, index, worker->image, changed, worker->texts.entries,
                            worker->texts.count, &hashes->file, error))
        return false;
    hashes->pixels = image_hash_next(worker->image, changed, worker->rows);
    return true;
}

static bool draw_all(Worker *worker, int pipe, Error *error) {
    const WorkerJob *job = worker->job;
    for (int index = job->first; index <= job->last; index++) {
        WorkerReport report = {.index = index};
        report.kept = is_unchanged(worker, index, &report.hashes);
        if (!report.kept && !draw_one(worker, moments_at(job->plan, index), index, &report.hashes, error)) return false;
        if (!send(pipe, &report)) return false; /* the parent has ended or cancelled */
    }
    return true;
}

/* An interrupt goes to the parent, which then closes the pipes; the worker ends between two frames and leaves no
   partial file. */
static void prepare_process(void) {
    signal(SIGINT, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

static bool draw_to_sink(Worker *worker, int pipe, Error *error) {
    const RenderOptions *options = worker->job->options;
    if (!sink_open_png(&worker->sink, options->directory, options->width, options->height,
                       options->small ? PNG_SMALL : PNG_FAST, error))
        return false;
    bool drawn = draw_all(worker, pipe, error);
    return worker->sink.close(worker->sink.context, error) && drawn;
}

bool worker_run(const WorkerJob *job, int pipe) {
    WorkerReport end = {.index = -1};
    Worker worker = {.job = job};
    prepare_process();
    bool ok = draw_to_sink(&worker, pipe, &end.error);
    if (end.error.kind != ERROR_NONE) send(pipe, &end);
    image_destroy(worker.image);
    renderer_destroy(worker.renderer);
    free(worker.rows);
    return ok;
}

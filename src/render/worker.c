/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/worker.h"

#include "render/renderer.h"
#include "render/sink.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Texts of a frame, all panels joined. */
enum { TEXTS = 5, METHODS_SIZE = RENDER_PANELS_MAX * (TRAJECTORY_NAME_SIZE + 3), HASHES_SIZE = RENDER_PANELS_MAX * 20 };

typedef struct FrameTexts {
    char methods[METHODS_SIZE], frame[16], state[HASHES_SIZE];
    ImageText entries[TEXTS];
} FrameTexts;

static void append(char *text, size_t size, const char *part) {
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s", used == 0 ? "" : " | ", part);
}

/* What tells a frame's origin. No date: the same frame gives the same file. */
static void fill_texts(FrameTexts *texts, const Picture *picture, int frame) {
    texts->methods[0] = texts->state[0] = '\0';
    for (int i = 0; i < picture->count; i++) {
        const Trajectory *trajectory = picture->panels[i];
        char hash[20];
        int shown = picture_panel_frame(picture, i, frame);
        snprintf(hash, sizeof hash, "%016" PRIx64, trajectory_frame_hash(trajectory, shown));
        append(texts->methods, sizeof texts->methods, trajectory->method);
        append(texts->state, sizeof texts->state, hash);
    }
    snprintf(texts->frame, sizeof texts->frame, "%d", frame);
    const ImageText entries[TEXTS] = {{"Scene", picture->panels[0]->scene},
                                      {"Method", texts->methods},
                                      {"Frame", texts->frame},
                                      {"State", texts->state},
                                      {"Software", "twinbox"}};
    memcpy(texts->entries, entries, sizeof entries);
}

static bool report(int pipe, const Error *error) { return write(pipe, error, sizeof *error) == sizeof *error; }

static bool draw_frames(const WorkerJob *job, Renderer *renderer, const FrameSink *sink, Image *image, int pipe,
                        Error *error) {
    FrameTexts texts;
    const bool *changed;
    for (int frame = job->first; frame <= job->last; frame++) {
        fill_texts(&texts, job->picture, frame);
        if (!renderer_draw_next(renderer, moment_stored(frame), image, &changed, error) ||
            !sink->write(sink->context, frame, image, changed, texts.entries, TEXTS, error))
            return false;
        if (!report(pipe, error)) return false; /* the parent has gone, or wants no more */
    }
    return true;
}

/* An interrupt reaches the parent, which then stops listening; the worker ends between two frames and leaves
   no half-written file. */
static void prepare_process(void) {
    signal(SIGINT, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

static bool draw_to_sink(const WorkerJob *job, Renderer *renderer, Image *image, int pipe, Error *error) {
    const RenderOptions *options = job->options;
    FrameSink sink;
    if (!sink_open_png(&sink, options->directory, options->width, options->height,
                       options->small ? PNG_SMALL : PNG_FAST, error))
        return false;
    bool drawn = draw_frames(job, renderer, &sink, image, pipe, error);
    return sink.close(sink.context, error) && drawn;
}

bool worker_run(const WorkerJob *job, int pipe) {
    Error error = {0};
    prepare_process();
    Renderer *renderer = renderer_create_planned(job->picture, job->options, &error);
    Image *image = renderer == NULL ? NULL : image_create(job->options->width, job->options->height, &error);
    bool ok = image != NULL && draw_to_sink(job, renderer, image, pipe, &error);
    if (error.kind != ERROR_NONE) report(pipe, &error);
    image_destroy(image);
    renderer_destroy(renderer);
    return ok;
}

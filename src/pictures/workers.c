/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of a sequence: processes draw them, and one hears from these. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "base/numbers.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pictures/render_internal.h"
#include "pixels/png.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Bytes; far more than the largest picture file. */
static const size_t MAX_FILE_SIZE = (size_t)1 << 30;

void sink_frame_name(char name[SINK_NAME_SIZE], int index) { snprintf(name, SINK_NAME_SIZE, "frame_%06d.png", index); }

bool sink_frame_path(char *path, size_t size, const char *directory, int index) {
    char name[SINK_NAME_SIZE];
    sink_frame_name(name, index);
    return snprintf(path, size, "%s/%s", directory, name) < (int)size;
}

bool sink_frame_is(const char *directory, int index, uint64_t hash) {
    char path[PATH_MAX];
    size_t size;
    if (!sink_frame_path(path, sizeof path, directory, index)) return false;
    char *data = file_read(path, MAX_FILE_SIZE, &size, &(Error){0});
    const bool same = data != NULL && hash_xxh3(data, size) == hash;
    free(data);
    return same;
}

/* Writes frame_000000.png, ... into an existing directory, whose name must outlive the sink. Files appear complete. */
typedef struct FrameSink {
    const char *directory;
    PngEncoder *encoder;
    int first, end; /* frames first <= index < end were written; others in the folder are older */
} FrameSink;

static bool sink_open(FrameSink *sink, const char *directory, int width, int height, PngEffort effort, Error *error) {
    *sink = (FrameSink){.directory = directory, .encoder = png_encoder_create(width, height, effort, error)};
    return sink->encoder != NULL;
}

/* `changed`: as for png_encode(). *hash: XXH3 of the file. */
static bool sink_write(FrameSink *sink, int index, const Image *image, const bool *changed, const ImageText *texts,
                       int count, uint64_t *hash, Error *error) {
    char path[PATH_MAX];
    const uint8_t *data;
    size_t size;
    if (!sink_frame_path(path, sizeof path, sink->directory, index))
        return error_input(error, sink->directory, "the name is too long");
    if (!png_encode(sink->encoder, image, changed, texts, count, &data, &size, error) ||
        !file_write_soon(path, data, size, error))
        return false;
    *hash = hash_xxh3(data, size);
    if (sink->end == 0) sink->first = index;
    sink->end = index + 1;
    return true;
}

/* Also after errors; true if all frames are safely stored. Once, at the end: syncing many files takes hardly longer
   than one. */
static bool sink_close(FrameSink *sink, Error *error) {
    char path[PATH_MAX];
    bool ok = true;
    for (int index = sink->first; ok && index < sink->end; index++)
        ok = sink_frame_path(path, sizeof path, sink->directory, index) && file_sync(path, error);
    ok = ok && (sink->end == 0 || file_sync(sink->directory, error));
    png_encoder_destroy(sink->encoder);
    return ok;
}

/* A process that draws. */

/* What it writes to its pipe: one report per picture, or a final one with an error. */
typedef struct Report {
    Error error; /* ERROR_NONE: the picture is finished */
    int index;
    bool kept; /* the file is of an earlier call */
    PictureHashes hashes;
} Report;

/* Draws or keeps the pictures and reports each; ends early if the pipe is closed: then the parent has ended or
   cancelled. */
static bool draw(const WorkerJob *job, FrameSink *sink, int pipe, Error *error) {
    const RenderOptions *options = job->options;
    const Manifest *manifest = job->manifest;
    Renderer *renderer = NULL; /* created on demand: possibly every picture is kept */
    Image *image = NULL;
    uint64_t *rows = NULL; /* [height] hashes of the image */
    FrameTexts texts;
    bool ok = true;
    for (int index = job->first; ok && index <= job->last; index++) {
        const Moment moment = moments_at(job->plan, index);
        Report report = {.index = index, .hashes = manifest->hashes[index - manifest->first]};
        report.kept =
            manifest->known[index - manifest->first] && sink_frame_is(options->directory, index, report.hashes.file);
        if (!report.kept && renderer == NULL) {
            renderer = renderer_create_planned(job->picture, options, error);
            image = renderer != NULL ? image_create(options->width, options->height, error) : NULL;
            rows = calloc((size_t)options->height, sizeof *rows);
            ok = image != NULL && (rows != NULL || error_memory(error, "render"));
        }
        if (ok && !report.kept) {
            const bool *changed;
            frame_texts_fill(&texts, job->picture, moment);
            ok = renderer_draw_next(renderer, moment, image, &changed, error) &&
                 sink_write(sink, index, image, changed, texts.entries, texts.count, &report.hashes.file, error);
            if (ok) report.hashes.pixels = image_hash_next(image, changed, rows);
        }
        ok = ok && file_write_all(pipe, &report, sizeof report);
    }
    renderer_destroy(renderer);
    image_destroy(image);
    free(rows);
    return ok;
}

/* Runs in its own process and changes its environment. Returns true if all pictures are finished. */
static bool work(const WorkerJob *job, int pipe) {
    const RenderOptions *options = job->options;
    Report end = {.index = -1};
    FrameSink sink;
    /* A signal is for the parent, also one that timeout(1), a terminal or a scheduler sends to the whole group: the
       parent then closes the pipes, and the worker ends between two frames and leaves no partial file. */
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    for (int i = 0; i < 4; i++) signal(signals[i], SIG_IGN);
    bool ok = sink_open(&sink, options->directory, options->width, options->height,
                        options->small ? PNG_SMALL : PNG_FAST, &end.error);
    if (ok) {
        ok = draw(job, &sink, pipe, &end.error);
        ok = sink_close(&sink, &end.error) && ok;
    }
    if (end.error.kind != ERROR_NONE) file_write_all(pipe, &end, sizeof end);
    return ok;
}

/* The process that hears. */

typedef struct Worker {
    pid_t process; /* 0 after it has ended */
    int pipe;      /* -1 after it was closed */
} Worker;

typedef struct Crew {
    Worker *workers;
    struct pollfd *polls;
    int jobs, listening;
    int done, total, kept; /* pictures */
    Manifest *manifest;
} Crew;

/* Each worker gets consecutive pictures; the counts differ by at most one. */
static bool start_workers(Crew *crew, const WorkerJob *all, Error *error) {
    for (int i = 0; i < crew->jobs; i++) {
        WorkerJob job = *all;
        job.first = all->first + (int)((long long)crew->total * i / crew->jobs);
        job.last = all->first + (int)((long long)crew->total * (i + 1) / crew->jobs) - 1;
        int ends[2];
        if (pipe(ends) != 0) return error_system(error, "render", "cannot create a pipe: %s", strerror(errno));
        const pid_t process = fork();
        if (process == 0) {
            /* The pipes of the workers forked before it would stay open after the parent's end. */
            close(ends[0]);
            for (int k = 0; k < i; k++) close(crew->workers[k].pipe);
            _exit(work(&job, ends[1]) ? 0 : 1);
        }
        close(ends[1]);
        if (process < 0) {
            close(ends[0]);
            return error_system(error, "render", "cannot start a process: %s", strerror(errno));
        }
        crew->workers[i] = (Worker){process, ends[0]};
        crew->listening++;
    }
    return true;
}

/* A running worker notices at its next report. */
static void stop_listening(Crew *crew, Worker *worker) {
    if (worker->pipe < 0) return;
    close(worker->pipe);
    worker->pipe = -1;
    crew->listening--;
}

static void await_end(Worker *worker, Error *error) {
    int status = 0;
    if (worker->process == 0) return;
    while (waitpid(worker->process, &status, 0) < 0 && errno == EINTR) continue;
    worker->process = 0;
    if (WIFSIGNALED(status))
        error_system(error, "render", "a drawing process was killed by signal %d%s", WTERMSIG(status),
                     memory_limit().text);
    else if (WEXITSTATUS(status) != 0)
        error_system(error, "render", "a drawing process failed without an error message");
}

static bool listen_to(Crew *crew, Worker *worker, Error *error) {
    Report report;
    const ssize_t size = file_read_all(worker->pipe, &report, sizeof report);
    if (size == sizeof report && report.error.kind == ERROR_NONE) {
        crew->done++;
        crew->kept += report.kept;
        return manifest_add(crew->manifest, report.index, report.hashes, error);
    }
    if (size == sizeof report)
        *error = report.error;
    else if (size != 0) /* 0: it has ended */
        return error_system(error, "render", "cannot read the report of a drawing process: %s",
                            size < 0 ? strerror(errno) : "it is cut short");
    stop_listening(crew, worker);
    await_end(worker, error);
    return error->kind == ERROR_NONE;
}

static bool wait_for_workers(Crew *crew, const Progress *progress, Error *error) {
    while (crew->listening > 0) {
        for (int i = 0; i < crew->jobs; i++)
            crew->polls[i] = (struct pollfd){.fd = crew->workers[i].pipe, .events = POLLIN};
        if (poll(crew->polls, (nfds_t)crew->jobs, -1) < 0 && errno != EINTR)
            return error_system(error, "render", "cannot wait for the drawing processes: %s", strerror(errno));
        for (int i = 0; i < crew->jobs; i++)
            if (crew->polls[i].revents != 0 && !listen_to(crew, &crew->workers[i], error)) return false;
        if (!progress_report(progress, crew->done, crew->total)) return error_interrupted(error, "render", "stopped");
    }
    return crew->done == crew->total ||
           error_system(error, "render", "%d of %d pictures were not reported", crew->total - crew->done, crew->total);
}

bool workers_draw(const WorkerJob *job, int *kept, const Progress *progress, Error *error) {
    Crew crew = {.total = job->last - job->first + 1, .manifest = job->manifest};
    crew.jobs = int_min(job->options->jobs, crew.total);
    crew.workers = calloc((size_t)crew.jobs, sizeof *crew.workers);
    crew.polls = calloc((size_t)crew.jobs, sizeof *crew.polls);
    for (int i = 0; crew.workers != NULL && i < crew.jobs; i++) crew.workers[i].pipe = -1;
    bool ok = (crew.workers != NULL && crew.polls != NULL) || error_memory(error, "render");
    /* Signals are held from the first report on. A worker that is forked before would end at a signal to its group. */
    ok = ok && (progress_report(progress, 0, crew.total) || error_interrupted(error, "render", "stopped"));
    ok = ok && start_workers(&crew, job, error) && wait_for_workers(&crew, progress, error);
    /* After an error, all pipes are closed first, and then the workers end. */
    for (int i = 0; crew.workers != NULL && i < crew.jobs; i++) stop_listening(&crew, &crew.workers[i]);
    for (int i = 0; crew.workers != NULL && i < crew.jobs; i++) await_end(&crew.workers[i], &(Error){0});
    free(crew.workers);
    free(crew.polls);
    *kept = crew.kept;
    return ok;
}

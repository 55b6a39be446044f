/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processes that draw the pictures of a sequence, and the one that hears from them. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pictures/render_internal.h"
#include "pixels/png.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* State of a worker. */
typedef struct WorkerProcess {
    const WorkerJob *job;
    Renderer *renderer;
    Image *image;
    uint64_t *rows; /* [height] hashes of the image */
    FrameSink sink;
    FrameTexts texts;
} WorkerProcess;

static bool workers_send(int pipe, const WorkerReport *report) { return file_write_all(pipe, report, sizeof *report); }

/* Whether the file of an earlier call exists with unchanged bytes. */
static bool is_unchanged(const WorkerProcess *worker, int index, PictureHashes *hashes) {
    const Manifest *manifest = worker->job->manifest;
    if (!manifest->known[index - manifest->first]) return false;
    *hashes = manifest->hashes[index - manifest->first];
    return sink_frame_is(worker->job->options->directory, index, hashes->file);
}

static bool workers_prepare(WorkerProcess *worker, Error *error) {
    const RenderOptions *options = worker->job->options;
    worker->renderer = renderer_create_planned(worker->job->picture, options, error);
    if (worker->renderer == NULL) return false;
    worker->image = image_create(options->width, options->height, error);
    worker->rows = calloc((size_t)options->height, sizeof *worker->rows);
    return worker->image != NULL && (worker->rows != NULL || error_memory(error, "render"));
}

static bool draw_one(WorkerProcess *worker, Moment moment, int index, PictureHashes *hashes, Error *error) {
    const bool *changed;
    /* Created on demand: possibly every picture is kept. */
    if (worker->renderer == NULL && !workers_prepare(worker, error)) return false;
    frame_texts_fill(&worker->texts, worker->job->picture, moment);
    if (!renderer_draw_next(worker->renderer, moment, worker->image, &changed, error) ||
        !worker->sink.write(worker->sink.context, index, worker->image, changed, worker->texts.entries,
                            worker->texts.count, &hashes->file, error))
        return false;
    hashes->pixels = image_hash_next(worker->image, changed, worker->rows);
    return true;
}

static bool draw_all(WorkerProcess *worker, int pipe, Error *error) {
    const WorkerJob *job = worker->job;
    for (int index = job->first; index <= job->last; index++) {
        WorkerReport report = {.index = index};
        report.kept = is_unchanged(worker, index, &report.hashes);
        if (!report.kept && !draw_one(worker, moments_at(job->plan, index), index, &report.hashes, error)) return false;
        if (!workers_send(pipe, &report)) return false; /* the parent has ended or cancelled */
    }
    return true;
}

/* A signal is for the parent, also one that timeout(1), a terminal or a scheduler sends to the whole group: the parent
   then closes the pipes, and the worker ends between two frames and leaves no partial file. */
static void prepare_process(void) {
    signal(SIGINT, SIG_IGN);
    signal(SIGTERM, SIG_IGN);
    signal(SIGHUP, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

static bool draw_to_sink(WorkerProcess *worker, int pipe, Error *error) {
    const RenderOptions *options = worker->job->options;
    if (!sink_open_png(&worker->sink, options->directory, options->width, options->height,
                       options->small ? PNG_SMALL : PNG_FAST, error))
        return false;
    bool drawn = draw_all(worker, pipe, error);
    return worker->sink.close(worker->sink.context, error) && drawn;
}

/* Draws the pictures of the job; ends early if the pipe is closed. Runs in its own process and changes its
   environment. Returns true if all pictures are finished. */
static bool worker_run(const WorkerJob *job, int pipe) {
    WorkerReport end = {.index = -1};
    WorkerProcess worker = {.job = job};
    prepare_process();
    bool ok = draw_to_sink(&worker, pipe, &end.error);
    if (end.error.kind != ERROR_NONE) workers_send(pipe, &end);
    image_destroy(worker.image);
    renderer_destroy(worker.renderer);
    free(worker.rows);
    return ok;
}

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

/* The child closes the pipes of the workers forked before it; otherwise they would stay open after the parent's end. */
static void run_child(const Crew *crew, int index, const WorkerJob *job, int pipe) {
    for (int i = 0; i < index; i++) close(crew->workers[i].pipe);
    bool ok = worker_run(job, pipe);
    _exit(ok ? 0 : 1);
}

static bool start_worker(Crew *crew, int index, const WorkerJob *job, Error *error) {
    int ends[2];
    if (pipe(ends) != 0) return error_system(error, "render", "cannot create a pipe: %s", strerror(errno));
    pid_t process = fork();
    if (process == 0) {
        close(ends[0]);
        run_child(crew, index, job, ends[1]);
    }
    close(ends[1]);
    if (process < 0) {
        close(ends[0]);
        return error_system(error, "render", "cannot start a process: %s", strerror(errno));
    }
    crew->workers[index] = (Worker){process, ends[0]};
    crew->listening++;
    return true;
}

/* Each worker gets consecutive pictures; the counts differ by at most one. */
static bool start_workers(Crew *crew, const WorkerJob *all, Error *error) {
    WorkerJob job = *all;
    for (int i = 0; i < crew->jobs; i++) {
        job.first = all->first + (int)((long long)crew->total * i / crew->jobs);
        job.last = all->first + (int)((long long)crew->total * (i + 1) / crew->jobs) - 1;
        if (!start_worker(crew, i, &job, error)) return false;
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
    WorkerReport report;
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

/* After an error, close all pipes first, then wait for the workers. */
static void end_all(Crew *crew) {
    Error ignored = {0};
    if (crew->workers == NULL) return;
    for (int i = 0; i < crew->jobs; i++) stop_listening(crew, &crew->workers[i]);
    for (int i = 0; i < crew->jobs; i++) await_end(&crew->workers[i], &ignored);
}

bool workers_draw(const WorkerJob *job, int *kept, const Progress *progress, Error *error) {
    Crew crew = {.total = job->last - job->first + 1, .manifest = job->manifest};
    crew.jobs = job->options->jobs < crew.total ? job->options->jobs : crew.total;
    crew.workers = calloc((size_t)crew.jobs, sizeof *crew.workers);
    crew.polls = calloc((size_t)crew.jobs, sizeof *crew.polls);
    for (int i = 0; crew.workers != NULL && i < crew.jobs; i++) crew.workers[i].pipe = -1;
    bool ok = (crew.workers != NULL && crew.polls != NULL) || error_memory(error, "render");
    ok = ok && start_workers(&crew, job, error) && wait_for_workers(&crew, progress, error);
    end_all(&crew);
    free(crew.workers);
    free(crew.polls);
    if (kept != NULL) *kept = crew.kept;
    return ok;
}

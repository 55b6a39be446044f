/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distributes the frames of a sequence over worker processes and reads their reports. Workers are forked before any
   OpenGL context is created: a context does not survive a fork. */
#include "common/file.h"
#include "common/folder_reserve.h"
#include "common/memory_limit.h"
#include "render/worker.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct Worker {
    pid_t process; /* 0 after it has ended */
    int pipe;      /* -1 after it was closed */
} Worker;

typedef struct Sequence {
    Worker *workers;
    struct pollfd *polls;
    int jobs, listening;
    int done, total, kept; /* pictures */
    Manifest *manifest;
} Sequence;

static bool choose_range(const RenderOptions *options, const Picture *picture, int *first, int *last, Error *error) {
    *first = options->first;
    *last = options->last < 0 ? picture->frames - 1 : options->last;
    if (*first >= 0 && *first <= *last && *last < picture->frames) return true;
    return error_input(error, "render", "the frames must be a range within 0 to %d (got %d to %d)", picture->frames - 1,
                       *first, *last);
}

/* The child closes the pipes of the workers forked before it; otherwise they would stay open after the parent's end. */
static void run_child(const Sequence *sequence, int index, const WorkerJob *job, int pipe) {
    for (int i = 0; i < index; i++) close(sequence->workers[i].pipe);
    bool ok = worker_run(job, pipe);
    _exit(ok ? 0 : 1);
}

static bool start_worker(Sequence *sequence, int index, const WorkerJob *job, Error *error) {
    int ends[2];
    if (pipe(ends) != 0) return error_system(error, "render", "cannot create a pipe: %s", strerror(errno));
    pid_t process = fork();
    if (process == 0) {
        close(ends[0]);
        run_child(sequence, index, job, ends[1]);
    }
    close(ends[1]);
    if (process < 0) {
        close(ends[0]);
        return error_system(error, "render", "cannot start a process: %s", strerror(errno));
    }
    sequence->workers[index] = (Worker){process, ends[0]};
    sequence->listening++;
    return true;
}

/* Each worker gets consecutive pictures; the counts differ by at most one. */
static bool start_workers(Sequence *sequence, WorkerJob job, int first, Error *error) {
    for (int i = 0; i < sequence->jobs; i++) {
        job.first = first + (int)((long long)sequence->total * i / sequence->jobs);
        job.last = first + (int)((long long)sequence->total * (i + 1) / sequence->jobs) - 1;
        if (!start_worker(sequence, i, &job, error)) return false;
    }
    return true;
}

/* A running worker notices at its next report. */
static void stop_listening(Sequence *sequence, Worker *worker) {
    if (worker->pipe < 0) return;
    close(worker->pipe);
    worker->pipe = -1;
    sequence->listening--;
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

static bool listen_to(Sequence *sequence, Worker *worker, Error *error) {
    WorkerReport report;
    const ssize_t size = file_read_all(worker->pipe, &report, sizeof report);
    if (size == sizeof report && report.error.kind == ERROR_NONE) {
        sequence->done++;
        sequence->kept += report.kept;
        return manifest_add(sequence->manifest, report.index, report.hashes, error);
    }
    if (size == sizeof report)
        *error = report.error;
    else if (size != 0) /* 0: it has ended */
        return error_system(error, "render", "cannot read the report of a drawing process: %s",
                            size < 0 ? strerror(errno) : "it is cut short");
    stop_listening(sequence, worker);
    await_end(worker, error);
    return error->kind == ERROR_NONE;
}

static bool wait_for_workers(Sequence *sequence, const Progress *progress, Error *error) {
    while (sequence->listening > 0) {
        for (int i = 0; i < sequence->jobs; i++)
            sequence->polls[i] = (struct pollfd){.fd = sequence->workers[i].pipe, .events = POLLIN};
        if (poll(sequence->polls, (nfds_t)sequence->jobs, -1) < 0 && errno != EINTR)
            return error_system(error, "render", "cannot wait for the drawing processes: %s", strerror(errno));
        for (int i = 0; i < sequence->jobs; i++)
            if (sequence->polls[i].revents != 0 && !listen_to(sequence, &sequence->workers[i], error)) return false;
        if (!progress_report(progress, sequence->done, sequence->total))
            return error_interrupted(error, "render", "stopped");
    }
    return sequence->done == sequence->total || error_system(error, "render", "%d of %d pictures were not reported",
                                                             sequence->total - sequence->done, sequence->total);
}

/* After an error, close all pipes first, then wait for the workers. */
static void end_all(Sequence *sequence) {
    Error ignored = {0};
    if (sequence->workers == NULL) return;
    for (int i = 0; i < sequence->jobs; i++) stop_listening(sequence, &sequence->workers[i]);
    for (int i = 0; i < sequence->jobs; i++) await_end(&sequence->workers[i], &ignored);
}

static bool draw_all(Sequence *sequence, const WorkerJob *job, int first, const Progress *progress, Error *error) {
    sequence->workers = calloc((size_t)sequence->jobs, sizeof *sequence->workers);
    sequence->polls = calloc((size_t)sequence->jobs, sizeof *sequence->polls);
    for (int i = 0; sequence->workers != NULL && i < sequence->jobs; i++) sequence->workers[i].pipe = -1;
    bool ok = (sequence->workers != NULL && sequence->polls != NULL) || error_memory(error, "render");
    ok = ok && start_workers(sequence, *job, first, error) && wait_for_workers(sequence, progress, error);
    end_all(sequence);
    free(sequence->workers);
    free(sequence->polls);
    return ok;
}

/* Draws or keeps the selected pictures; the manifest is open. */
static bool make_pictures(WorkerJob *job, Manifest *manifest, RenderResult *result, const Progress *progress,
                          Error *error) {
    Sequence sequence = {.total = manifest->last - manifest->first + 1, .manifest = manifest};
    sequence.jobs = job->options->jobs < sequence.total ? job->options->jobs : sequence.total;
    if (job->options->resume) manifest_recall(manifest, result->why, sizeof result->why);
    if (!manifest_begin(manifest, result->all, error) || !draw_all(&sequence, job, manifest->first, progress, error) ||
        !manifest_end(manifest, error))
        return false;
    result->kept = sequence.kept;
    result->hashes = manifest->hashes;
    manifest->hashes = NULL;
    return true;
}

/* Everything before the first picture; `picture` is planned. */
static bool make_sequence(Picture *picture, const RenderOptions *options, RenderResult *result,
                          const Progress *progress, Error *error) {
    MomentPlan plan;
    int first, last;
    if (!choose_range(options, picture, &first, &last, error) ||
        !moments_plan(&plan, picture->runs, picture->count, first, last, options, error) ||
        !picture_apply_options(picture, options, error) || !folder_reserve(options->directory, error))
        return false;
    result->first = first;
    result->last = moments_last(&plan);
    result->rate = plan.rate;
    result->all = first == 0 && last == picture->frames - 1;
    Manifest manifest;
    WorkerJob job = {.picture = picture, .options = options, .plan = &plan, .manifest = &manifest};
    bool ok = manifest_open(&manifest, picture, options, &plan, result->first, result->last, error) &&
              make_pictures(&job, &manifest, result, progress, error);
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

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/workers.h"

#include "common/file.h"
#include "common/memory_limit.h"

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

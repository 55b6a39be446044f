/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
/* The machine, by POSIX and OpenMP. */
#include "base/machine.h"

#include "base/base.h"

#include <ctype.h>
#include <errno.h>
#include <omp.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

/* Spaces are joined, and what cannot stand in every table becomes one. */
static void copy_plain(char name[CPU_NAME_SIZE], const char *text) {
    size_t used = 0;
    for (; *text != '\0' && used + 1 < CPU_NAME_SIZE; text++) {
        const char c = isalnum((unsigned char)*text) || strchr("-_.,:()+/@", *text) != NULL ? *text : ' ';
        if (c != ' ' || (used > 0 && name[used - 1] != ' ')) name[used++] = c == '@' ? ' ' : c;
        if (used > 1 && name[used - 1] == ' ' && name[used - 2] == ' ') used--;
    }
    while (used > 0 && name[used - 1] == ' ') used--;
    name[used] = '\0';
}

void cpu_name(char name[CPU_NAME_SIZE]) {
    char line[256];
    struct utsname system;
    name[0] = '\0';
    FILE *file = fopen("/proc/cpuinfo", "re");
    while (file != NULL && name[0] == '\0' && fgets(line, sizeof line, file) != NULL) {
        const char *colon = strchr(line, ':');
        if (colon != NULL && strncmp(line, "model name", strlen("model name")) == 0) copy_plain(name, colon + 1);
    }
    if (file != NULL) fclose(file);
    if (name[0] == '\0' && uname(&system) == 0) copy_plain(name, system.machine);
    if (name[0] == '\0') strcpy(name, "unknown");
}

/* letter: of the shell's ulimit. */
static void lower(MemoryLimit *limit, rlim_t *least, rlim_t found, char letter) {
    if (found == RLIM_INFINITY || found >= *least) return;
    *least = found;
    snprintf(limit->text, sizeof limit->text, "; the memory of a process is limited to %llu MiB (ulimit -%c)",
             (unsigned long long)found >> 20, letter);
}

MemoryLimit memory_limit(void) {
    rlim_t least = RLIM_INFINITY;
    MemoryLimit limit = {""};
    struct rlimit found;
    if (getrlimit(RLIMIT_AS, &found) == 0) lower(&limit, &least, found.rlim_cur, 'v');
    if (getrlimit(RLIMIT_DATA, &found) == 0) lower(&limit, &least, found.rlim_cur, 'd');
    return limit;
}

/* Threads without work would take processor time waiting. */
static int threads_for(int count) {
    const int most = omp_get_max_threads();
    return count < 1 ? 1 : count < most ? count : most;
}

bool parallel_for(const ParallelWork *work, int count, const char *what, const Progress *progress, Error *error) {
    atomic_int done = 0, end = count; /* pieces from `end` on are not begun */
    int failed = count;
#pragma omp parallel for schedule(dynamic) num_threads(threads_for(count))
    for (int i = 0; i < count; i++) {
        if (i >= atomic_load(&end)) continue;
        Error failure = {0};
        const bool ok = work->piece(work->context, i, &failure);
#pragma omp critical
        if (!ok) {
            if (i < failed) *error = failure, failed = i;
            if (i < atomic_load(&end)) atomic_store(&end, i);
        } else if (!progress_report(progress, atomic_fetch_add(&done, 1) + 1, count))
            atomic_store(&end, 0);
    }
    if (failed < count) return false;
    return atomic_load(&end) == count ||
           error_interrupted(error, what, "stopped after %d of %d", atomic_load(&done), count);
}

double clock_seconds(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

struct Background {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    BackgroundWork *work;
    void *context;
    void *item; /* in work; NULL: none */
    bool ends;
    Error error;
};

/* Until the item is NULL (idle) or not. The mutex is locked. */
static void wait_until(Background *background, bool idle) {
    while ((background->item == NULL) != idle && !(background->ends && !idle))
        pthread_cond_wait(&background->changed, &background->mutex);
}

static void *run(void *argument) {
    Background *background = argument;
    pthread_mutex_lock(&background->mutex);
    for (wait_until(background, false); background->item != NULL; wait_until(background, false)) {
        pthread_mutex_unlock(&background->mutex);
        /* Only this thread sets the error while there is an item. */
        if (background->error.kind == ERROR_NONE)
            background->work(background->context, background->item, &background->error);
        pthread_mutex_lock(&background->mutex);
        background->item = NULL;
        pthread_cond_broadcast(&background->changed);
    }
    pthread_mutex_unlock(&background->mutex);
    return NULL;
}

Background *background_start(BackgroundWork *work, void *context, Error *error) {
    Background *background = calloc(1, sizeof *background);
    if (background == NULL) return error_memory(error, "second thread"), NULL;
    background->work = work;
    background->context = context;
    pthread_mutex_init(&background->mutex, NULL);
    pthread_cond_init(&background->changed, NULL);
    const int cause = pthread_create(&background->thread, NULL, run, background);
    if (cause == 0) return background;
    error_system(error, "second thread", "cannot be started: %s", strerror(cause));
    pthread_cond_destroy(&background->changed);
    pthread_mutex_destroy(&background->mutex);
    free(background);
    return NULL;
}

bool background_give(Background *background, void *item, Error *error) {
    pthread_mutex_lock(&background->mutex);
    wait_until(background, true);
    bool done = background->error.kind == ERROR_NONE;
    if (done) {
        background->item = item;
        pthread_cond_broadcast(&background->changed);
    } else if (error->kind == ERROR_NONE) {
        *error = background->error;
    }
    pthread_mutex_unlock(&background->mutex);
    return done;
}

bool background_wait(Background *background, Error *error) { return background_give(background, NULL, error); }

void background_stop(Background *background) {
    if (background == NULL) return;
    pthread_mutex_lock(&background->mutex);
    background->ends = true;
    pthread_cond_broadcast(&background->changed);
    pthread_mutex_unlock(&background->mutex);
    pthread_join(background->thread, NULL);
    pthread_cond_destroy(&background->changed);
    pthread_mutex_destroy(&background->mutex);
    free(background);
}

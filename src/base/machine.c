/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The machine and the process, by POSIX and OpenMP. */
#include "base/machine.h"

#include "base/base.h"
#include "base/file.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <omp.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/utsname.h>
#include <sys/wait.h>
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

MemoryLimit memory_limit(void) {
    static const struct {
        int resource;
        char letter; /* of the shell's ulimit */
    } kinds[] = {{RLIMIT_AS, 'v'}, {RLIMIT_DATA, 'd'}};
    rlim_t least = RLIM_INFINITY;
    MemoryLimit limit = {""};
    for (int i = 0; i < 2; i++) {
        struct rlimit found;
        if (getrlimit(kinds[i].resource, &found) != 0 || found.rlim_cur == RLIM_INFINITY || found.rlim_cur >= least)
            continue;
        least = found.rlim_cur;
        snprintf(limit.text, sizeof limit.text, "; the memory of a process is limited to %llu MiB (ulimit -%c)",
                 (unsigned long long)least >> 20, kinds[i].letter);
    }
    return limit;
}

/* Threads without work would take processor time waiting. */
static int threads_for(int count) {
    int most = omp_get_max_threads();
    return count < 1 ? 1 : count < most ? count : most;
}

bool parallel_for(const ParallelWork *work, int count, const char *what, const Progress *progress, Error *error) {
    atomic_int done = 0;
    atomic_bool stopped = false;
#pragma omp parallel for schedule(dynamic) num_threads(threads_for(count))
    for (int i = 0; i < count; i++) {
        if (atomic_load(&stopped)) continue;
        Error failure = {0};
        bool ok = work->piece(work->context, i, &failure);
#pragma omp critical
        {
            if (ok)
                ok = progress_report(progress, atomic_fetch_add(&done, 1) + 1, count);
            else if (error->kind == ERROR_NONE)
                *error = failure;
        }
        if (!ok) atomic_store(&stopped, true);
    }
    if (!atomic_load(&stopped)) return true;
    return error->kind == ERROR_NONE
               ? error_interrupted(error, what, "stopped after %d of %d", atomic_load(&done), count)
               : false;
}

static double read_clock(clockid_t clock) {
    struct timespec time;
    clock_gettime(clock, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

double clock_seconds(void) { return read_clock(CLOCK_MONOTONIC); }

double clock_thread_seconds(void) { return read_clock(CLOCK_THREAD_CPUTIME_ID); }

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

extern char **environ;

static void trace_start(const char *const *argv) {
    char line[900] = "";
    for (int i = 0; argv[i] != NULL; i++) text_add(line, sizeof line, " %s", argv[i]);
    trace_line("started%s", line);
}

/* Each needs memory. */
static int redirect(posix_spawn_file_actions_t *actions, int input, int output) {
    int code = posix_spawn_file_actions_adddup2(actions, input, STDIN_FILENO);
    if (code == 0) code = posix_spawn_file_actions_adddup2(actions, output, STDOUT_FILENO);
    if (code == 0) code = posix_spawn_file_actions_adddup2(actions, output, STDERR_FILENO);
    return code;
}

static bool spawn(Process *process, const char *const *argv, int child_input, Error *error) {
    posix_spawn_file_actions_t actions;
    int code = posix_spawn_file_actions_init(&actions);
    if (code == 0) {
        code = redirect(&actions, child_input, fileno(process->output));
        /* posix_spawn's signature needs the cast; it does not write to the strings. */
        if (code == 0) code = posix_spawnp(&process->pid, argv[0], &actions, NULL, (char *const *)argv, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    if (code != 0)
        return error_system(error, argv[0], "cannot be run: %s%s", strerror(code),
                            code == ENOENT ? "; is its package installed?" : "");
    trace_start(argv);
    return true;
}

/* In the folder for temporary files, for which tmpfile() has no choice. */
static FILE *open_output(void) {
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/output", temporary_files_folder()) >= PATH_MAX) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    const int file = temporary_nameless(path);
    FILE *output = file >= 0 ? fdopen(file, "r+") : NULL;
    if (output == NULL && file >= 0) close(file);
    return output;
}

bool process_start(Process *process, const char *const *argv, Error *error) {
    /* A socket, not a pipe: a write to a pipe without a reader raises SIGPIPE in the whole program. */
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return error_system(error, argv[0], "%s", strerror(errno));
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    *process = (Process){.name = argv[0], .input = ends[0], .output = open_output()};
    bool ok = process->output != NULL ? spawn(process, argv, ends[1], error)
                                      : error_system(error, argv[0], "no temporary file in %s: %s",
                                                     temporary_files_folder(), strerror(errno));
    close(ends[1]);
    if (ok) return true;
    close(process->input);
    if (process->output != NULL) fclose(process->output);
    return false;
}

bool process_write(Process *process, const void *data, size_t size) {
    const char *bytes = data;
    while (size > 0) {
        ssize_t sent = send(process->input, bytes, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0 && errno != EPIPE && errno != ECONNRESET) process->unsent = errno;
        if (sent <= 0) return false;
        bytes += sent;
        size -= (size_t)sent;
    }
    return true;
}

static int wait_for(Process *process) {
    int status = -1;
    while (waitpid(process->pid, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

bool process_finish(Process *process, char *text, size_t size, Error *error) {
    close(process->input);
    int status = wait_for(process);
    rewind(process->output);
    size_t length = fread(text, 1, size - 1, process->output);
    text[length] = '\0';
    fclose(process->output);
    if (process->unsent != 0)
        return error_system(error, process->name, "cannot be given its input: %s", strerror(process->unsent));
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
    return error_system(error, process->name, "failed (%s %d)\n%s", WIFEXITED(status) ? "status" : "signal",
                        WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status), text);
}

void process_kill(Process *process) {
    kill(process->pid, SIGKILL);
    close(process->input);
    wait_for(process);
    fclose(process->output);
}

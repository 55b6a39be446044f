/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
/* Other programs, by POSIX. */
#include "base/process.h"

#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

/* Returns an errno, or 0. streams: its standard input, output and error. group_signals: NULL, or the signals that are
   blocked in a process group of its own. */
static int spawn(pid_t *pid, const char *const *argv, const int streams[3], const sigset_t *group_signals) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int code = posix_spawn_file_actions_init(&actions);
    if (code != 0) return code;
    code = posix_spawnattr_init(&attributes);
    if (code == 0) {
        for (int i = 0; code == 0 && i < 3; i++) code = posix_spawn_file_actions_adddup2(&actions, streams[i], i);
        if (code == 0 && group_signals != NULL) {
            posix_spawnattr_setsigmask(&attributes, group_signals);
            code = posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
        }
        /* posix_spawn's signature needs the cast; it does not write to the strings. */
        if (code == 0) code = posix_spawnp(pid, argv[0], &actions, &attributes, (char *const *)argv, environ);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&actions);
    char line[900] = "";
    for (int i = 0; argv[i] != NULL; i++) text_add(line, sizeof line, " %s", argv[i]);
    if (code == 0) trace_line("started%s", line);
    return code;
}

bool process_start(Process *process, const char *const *argv, Error *error) {
    /* A socket, not a pipe: a write to a pipe without a reader raises SIGPIPE in the whole program. */
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return error_system(error, argv[0], "%s", strerror(errno));
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    const int draft = file_draft("-", error); /* in the folder for temporary files, for which tmpfile() has no choice */
    *process = (Process){.name = argv[0], .input = ends[0], .output = draft >= 0 ? fdopen(draft, "r+") : NULL};
    if (process->output == NULL && draft >= 0) {
        error_system(error, argv[0], "%s", strerror(errno));
        close(draft);
    }
    bool ok = process->output != NULL;
    if (ok) {
        const int code = spawn(&process->pid, argv, (const int[]){ends[1], draft, draft}, NULL);
        ok = code == 0 || error_system(error, argv[0], "cannot be run: %s%s", strerror(code),
                                       code == ENOENT ? "; is its package installed?" : "");
    }
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

static int wait_for(pid_t pid) {
    int status = -1;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

bool process_finish(Process *process, char *text, size_t size, Error *error) {
    close(process->input);
    int status = wait_for(process->pid);
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
    wait_for(process->pid);
    fclose(process->output);
}

static bool talk_failed(Talk *talk, const char *format, ...) PRINTF_LIKE(2, 3);
static bool talk_failed(Talk *talk, const char *format, ...) {
    PRINT_ARGUMENTS(talk->why, sizeof talk->why, format);
    return false;
}

static void close_pair(const int ends[2]) {
    for (int i = 0; i < 2; i++)
        if (ends[i] >= 0) close(ends[i]);
}

/* Programs that talk, for a handler of signals: it ends them, as the process is about to end. A signal may come to any
   thread, so one that starts a program holds its own back, and the handler waits for the others. */
enum { TALKS_MAX = 4096 };
static atomic_int talking[TALKS_MAX]; /* process ids; 0: free */
static atomic_int starting;

/* The group, and the program where it has left that. */
static void kill_program(pid_t pid) {
    kill(-pid, SIGKILL);
    kill(pid, SIGKILL);
}

void talks_kill(void) {
    for (int i = 0; i < 200 && atomic_load(&starting) > 0; i++) poll(NULL, 0, 5);
    for (int i = 0; i < TALKS_MAX; i++) {
        const pid_t pid = (pid_t)atomic_load(&talking[i]);
        if (pid > 0) kill_program(pid);
    }
}

/* As long as a program takes to end once it is killed. One of another user cannot be, and is left. */
static void wait_briefly(pid_t pid) {
    const double until = clock_seconds() + 2;
    pid_t ended;
    while ((ended = waitpid(pid, NULL, WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
        if (clock_seconds() >= until) return;
        poll(NULL, 0, 1);
    }
}

static int spawn_talk(pid_t *pid, const char *const *argv, const int streams[3]) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    atomic_fetch_add(&starting, 1);
    int code = spawn(pid, argv, streams, &before);
    bool kept = code != 0;
    for (int i = 0; !kept && i < TALKS_MAX; i++) {
        int none = 0;
        kept = atomic_compare_exchange_strong(&talking[i], &none, (int)*pid);
    }
    if (!kept) { /* too many */
        kill_program(*pid);
        wait_briefly(*pid);
        code = EAGAIN;
    }
    atomic_fetch_sub(&starting, 1);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return code;
}

bool talk_start(Talk *talk, const char *const *argv) {
    int in[2] = {-1, -1}, out[2] = {-1, -1}, complaints[2] = {-1, -1};
    *talk = (Talk){.input = -1};
    /* A socket for what is sent, as in process_start(). The other two are pipes, which any program can write to. */
    int code = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) != 0 || pipe2(out, O_CLOEXEC) != 0 ||
                       pipe2(complaints, O_CLOEXEC) != 0
                   ? errno
                   : 0;
    if (code == 0) code = spawn_talk(&talk->pid, argv, (const int[]){in[1], out[1], complaints[1]});
    if (code != 0) {
        close_pair(in);
        close_pair(out);
        close_pair(complaints);
        return talk_failed(talk, "cannot be run: %s", strerror(code));
    }
    close(in[1]);
    close(out[1]);
    close(complaints[1]);
    talk->input = in[0];
    talk->output = out[0];
    talk->complaints = complaints[0];
    return true;
}

static void hear_complaint(Talk *talk) {
    char forgotten[4096];
    const size_t room = sizeof talk->complaint - 1 - talk->complaint_size;
    const ssize_t got = read(talk->complaints, room > 0 ? talk->complaint + talk->complaint_size : forgotten,
                             room > 0 ? room : sizeof forgotten);
    if (got > 0 && room > 0) talk->complaint_size += (size_t)got;
    if (got > 0 || (got < 0 && errno == EINTR)) return;
    close(talk->complaints);
    talk->complaints = -1;
}

static bool has_ended(const Talk *talk, siginfo_t *info) {
    info->si_pid = 0;
    return waitid(P_PID, (id_t)talk->pid, info, WEXITED | WNOHANG | WNOWAIT) != 0 || info->si_pid != 0;
}

/* What it did, and of all that it complained about the line that names an error, else the last; frames of a stack are
   indented. A program that closes its output is about to end, mostly. */
static bool talk_stopped(Talk *talk, const char *what) {
    siginfo_t info;
    char *last = NULL, *named = NULL, *rest = talk->complaint;
    const double until = clock_seconds() + 0.5;
    while (!has_ended(talk, &info) && clock_seconds() < until) poll(NULL, 0, 5);
    struct pollfd file = {.fd = talk->complaints, .events = POLLIN};
    for (int i = 0; i < 100 && talk->complaints >= 0 && poll(&file, 1, 0) > 0; i++) hear_complaint(talk);
    if (!has_ended(talk, &info))
        talk_failed(talk, "%s", what);
    else
        talk_failed(talk, "has ended (%s %d)", info.si_code == CLD_EXITED ? "status" : "signal", info.si_status);
    talk->complaint[talk->complaint_size] = '\0';
    talk->complaint_size = 0;
    for (char *line; (line = strtok_r(rest, "\r\n", &rest)) != NULL;) {
        if (line[strspn(line, " \t")] == '\0') continue;
        last = line;
        if (line[0] != ' ' && line[0] != '\t' && strstr(line, "rror") != NULL) named = line;
    }
    if (named == NULL) named = last;
    if (named != NULL) text_add(talk->why, sizeof talk->why, ": %s", named);
    return false;
}

/* Waits until the file can be read or written. Slices of a tenth of a second find a program that has ended while one
   that it started keeps its output open. */
static bool talk_wait(Talk *talk, int fd, short events, double until, const char *late) {
    siginfo_t info;
    for (bool over = false;;) {
        struct pollfd files[2] = {{fd, events, 0}, {talk->complaints, POLLIN, 0}};
        const double left = until - clock_seconds();
        const int ready = poll(files, 2, over || left <= 0 ? 0 : left < 0.1 ? (int)(left * 1000) + 1 : 100);
        if (ready > 0 && files[0].revents != 0) return true;
        if (ready > 0 && files[1].revents != 0) hear_complaint(talk);
        if (over) return talk_stopped(talk, "has ended");
        over = ready == 0 && has_ended(talk, &info);
        if (!over && left <= 0) return talk_failed(talk, "%s", late);
    }
}

bool talk_send(Talk *talk, const void *data, size_t size, double until) {
    const char *bytes = data;
    while (size > 0) {
        const ssize_t sent = send(talk->input, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0) {
            bytes += sent;
            size -= (size_t)sent;
        } else if (errno == EAGAIN) {
            if (!talk_wait(talk, talk->input, POLLOUT, until, "does not read what it is sent")) return false;
        } else if (errno != EINTR) {
            return talk_stopped(talk, "has closed its standard input");
        }
    }
    return true;
}

/* Reads more of the answer: room for `wanted` unread bytes. */
static bool talk_fill(Talk *talk, size_t wanted, double until) {
    if (talk->begin > 0) memmove(talk->unread, talk->unread + talk->begin, talk->end - talk->begin);
    talk->end -= talk->begin;
    talk->begin = 0;
    if (!array_reserve((void **)&talk->unread, &talk->capacity, wanted < 4096 ? 4096 : wanted, 1))
        return talk_failed(talk, "takes more memory than there is");
    for (;;) {
        if (!talk_wait(talk, talk->output, POLLIN, until, "has not answered in time")) return false;
        const ssize_t got = read(talk->output, talk->unread + talk->end, talk->capacity - talk->end);
        if (got > 0) talk->end += (size_t)got;
        if (got > 0) return true;
        if (got == 0 || errno != EINTR) return talk_stopped(talk, "has closed its standard output");
    }
}

char *talk_read(Talk *talk, size_t size, double until) {
    while (talk->end - talk->begin < size)
        if (!talk_fill(talk, size, until)) return NULL;
    char *bytes = talk->unread + talk->begin;
    talk->begin += size;
    return bytes;
}

char *talk_line(Talk *talk, size_t most, double until) {
    char *end;
    for (size_t seen = 0;;) {
        const size_t size = talk->end - talk->begin;
        end = size > seen ? memchr(talk->unread + talk->begin + seen, '\n', size - seen) : NULL;
        if (end != NULL) break;
        if (size > most) {
            talk_failed(talk, "has written a line of more than %zu bytes", most);
            return NULL;
        }
        seen = size;
        if (!talk_fill(talk, most + 1 < 2 * size ? most + 1 : 2 * size + 1, until)) return NULL;
    }
    char *line = talk->unread + talk->begin;
    talk->begin = (size_t)(end + 1 - talk->unread);
    if (memchr(line, '\0', (size_t)(end - line)) != NULL) {
        talk_failed(talk, "has written a NUL byte in a line of text");
        return NULL;
    }
    if (end > line && end[-1] == '\r') end--;
    *end = '\0';
    return line;
}

bool talk_is_quiet(Talk *talk) {
    siginfo_t info;
    struct pollfd file = {.fd = talk->output, .events = POLLIN};
    return talk->begin == talk->end && poll(&file, 1, 0) == 0 && !has_ended(talk, &info);
}

void talk_end(Talk *talk) {
    /* One that cannot be killed may still end when nobody listens. */
    close(talk->input);
    close(talk->output);
    if (talk->complaints >= 0) close(talk->complaints);
    kill_program(talk->pid); /* before it is waited for: until then nothing else can have this number */
    for (int i = 0; i < TALKS_MAX; i++) {
        int own = (int)talk->pid;
        if (atomic_compare_exchange_strong(&talking[i], &own, 0)) break;
    }
    wait_briefly(talk->pid);
    free(talk->unread);
    *talk = (Talk){.input = -1};
}

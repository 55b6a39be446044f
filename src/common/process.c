/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/process.h"

#include "common/temporary.h"
#include "common/text_add.h"
#include "common/trace.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static void trace(const char *const *argv) {
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
    process->missing = code == ENOENT;
    if (code != 0)
        return error_system(error, argv[0], "cannot be run: %s%s", strerror(code),
                            code == ENOENT ? "; is its package installed?" : "");
    trace(argv);
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

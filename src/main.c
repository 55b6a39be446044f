/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the command, runs it, and makes an exit status of its error. */
#define _GNU_SOURCE
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/installed.h"
#include "cli/interrupt.h"
#include "cli/notes.h"

#include <fcntl.h>
#include <omp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void print_help(FILE *file) {
    fprintf(file, "Usage: twinbox COMMAND [OPTION...]\n%s Help: twinbox help COMMAND\n", program_summary);
    for (const Command *command = commands; command->name != NULL; command++) {
        if (command->summary == NULL) continue; /* left out of this build */
        if (command->heading != NULL) fprintf(file, "%s:\n", command->heading);
        fprintf(file, "  %-10s %s\n", command->name, command->summary);
    }
    fprintf(file,
            "Exit status: 0 done and equal, 1 different or incomplete, 2 bad input,\n"
            "  3 failure of the system, 130 interrupted.\n"
            "Begin with: %s\n",
            program_begin);
}

/* Whether the word is one of the two. */
static bool is(const char *word, const char *name, const char *letter) {
    return strcmp(word, name) == 0 || strcmp(word, letter) == 0;
}

static bool is_help(const char *word) { return strcmp(word, "help") == 0 || is(word, "--help", "-h"); }

/* OpenMP exits with status 1 when it gets no memory or no thread, which must not pass for "different". Help that cannot
   be written is no success; argp exits after it. */
static void check_exit(int status, void *command_ended) {
    if (status == 1 && !*(const bool *)command_ended) _exit(ERROR_SYSTEM);
    if (status != 0 || (fflush(stdout) == 0 && !ferror(stdout))) return;
    fputs("standard output: error: cannot write\n", stderr);
    _exit(ERROR_SYSTEM);
}

static bool ended; /* the command */

/* The words begin with the one of the command. */
static int run(const Command *command, int argc, char **argv) {
    char name[64];
    Error error = {0};
    snprintf(name, sizeof name, "twinbox %s", command->name);
    argv[0] = name;
    const bool same = command->run(argc, argv, &error);
    results_end(!same || error.kind != ERROR_NONE);
    note_end();
    ended = true;
    /* Output that could not be written is a failure of the system, not success. */
    if (error.kind == ERROR_NONE && (fflush(stdout) != 0 || ferror(stdout)))
        error_system(&error, "standard output", "cannot write");
    if (error.kind != ERROR_NONE) fprintf(stderr, "%s\n", error.message);
    if (interrupt_requested() && error.kind != ERROR_INTERRUPTED) {
        fprintf(stderr, "%s: error: interrupted\n", name);
        return ERROR_INTERRUPTED;
    }
    if (error.kind != ERROR_NONE) return (int)error.kind;
    return same ? 0 : 1;
}

int main(int argc, char **argv) {
    /* The next file would get the number of a closed stream. Writing to /dev/full fails, as it would there. */
    for (int stream = STDOUT_FILENO; stream <= STDERR_FILENO; stream++) {
        const int full = fcntl(stream, F_GETFD) >= 0 ? -1 : open("/dev/full", O_WRONLY);
        if (full < 0 || full == stream) continue;
        dup2(full, stream);
        close(full);
    }
    on_exit(check_exit, &ended);
    file_elsewhere = installed_path;
    interrupt_handle();
    /* OpenMP takes any number that the environment asks for, and an area of the stack for each. More threads than
       processors gain nothing. */
    const int enough = 256, processors = omp_get_num_procs(), most = processors > enough ? processors : enough;
    if (omp_get_max_threads() > most) omp_set_num_threads(most);
    signal(SIGXFSZ, SIG_IGN); /* A file beyond the limit of sizes is an error of write(), with a message. */
    if (argc < 2) {
        print_help(stderr);
        return ERROR_INPUT;
    }
    const bool help = is_help(argv[1]);
    if (help && (argc == 2 || is_help(argv[2]))) {
        print_help(stdout);
        return 0;
    }
    const char *wanted = argv[help ? 2 : 1];
    const Command *command = commands;
    while (command->name != NULL && strcmp(command->name, wanted) != 0) command++;
    const bool known = command->name != NULL;
    if (is(argv[argc == 3 && known ? 2 : 1], "--version", "-V")) {
        puts("twinbox " TWINBOX_VERSION);
        if (argc == 3 && is(argv[2], "--verbose", "-v")) print_contexts(stdout);
        return 0;
    }
    if (!known) {
        Error error = {0};
        NameList names = {0};
        for (const Command *other = commands; other->name != NULL; other++) name_list_add(&names, other->name);
        error_unknown(&error, "twinbox", wanted, "a command", &names);
        fprintf(stderr, "%s\n", error.message);
        return ERROR_INPUT;
    }
    if (help) argv[2] = "--help";
    return run(command, argc - 1, argv + 1);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the command, runs it, prints its error, exits: 0 done and equal, 1 done and different, 2 bad usage or input,
   3 the system failed. */
#include "cli/commands.h"

#include <stdio.h>
#include <string.h>

static void print_help(FILE *file) {
    fputs("Usage: twinbox COMMAND [OPTION...]\n"
          "A rigid-box physics engine and a neural network, side by side.\n\n",
          file);
    for (const Command *command = commands; command->name != NULL; command++)
        fprintf(file, "  %-10s %s\n", command->name, command->summary);
    fputs("\nEach command has its own help and an example: twinbox COMMAND --help\n"
          "Exit status: 0 done (and equal), 1 different, 2 bad usage or input, 3 system failure.\n\n"
          "Begin with: twinbox render scenes/stack.yaml -o out/stack --video out/stack.mp4\n",
          file);
}

static const Command *find_command(const char *name) {
    for (const Command *command = commands; command->name != NULL; command++)
        if (strcmp(command->name, name) == 0) return command;
    return NULL;
}

int main(int argc, char **argv) {
    if (argc < 2) {
        print_help(stderr);
        return ERROR_INPUT;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_help(stdout);
        return 0;
    }
    if (strcmp(argv[1], "--version") == 0) {
        puts("twinbox " TWINBOX_VERSION);
        return 0;
    }
    const Command *command = find_command(argv[1]);
    if (command == NULL) {
        fprintf(stderr, "twinbox: error: no command '%s'; twinbox --help lists all\n", argv[1]);
        return ERROR_INPUT;
    }
    char name[64];
    snprintf(name, sizeof name, "twinbox %s", command->name);
    argv[1] = name;
    Error error = {0};
    bool same = command->run(argc - 1, argv + 1, &error);
    /* Output that could not be written is a failure of the system, not success. */
    if (error.kind == ERROR_NONE && (fflush(stdout) != 0 || ferror(stdout)))
        error_system(&error, "standard output", "cannot write");
    if (error.kind != ERROR_NONE) {
        fprintf(stderr, "%s\n", error.message);
        return (int)error.kind;
    }
    return same ? 0 : 1;
}

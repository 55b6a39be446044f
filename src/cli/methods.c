/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/options.h"
#include "simulate/method.h"

#include <stdio.h>

static error_t parse(int key, char *value, struct argp_state *state) {
    if (key == ARGP_KEY_ARG) argp_error(state, "takes no arguments (got '%s')", value);
    return ARGP_ERR_UNKNOWN;
}

static const struct argp argp = {NULL,
                                 parse,
                                 "",
                                 "List the methods and their settings. A method is given as NAME or "
                                 "NAME:KEY=VALUE,...\v"
                                 "Example: twinbox simulate scenes/stack.yaml --method engine:k=50 -o stack50.npz",
                                 NULL,
                                 NULL,
                                 NULL};

int command_methods(int argc, char **argv, Error *error) {
    (void)error;
    if (!options_parse(&argp, argc, argv, NULL)) return STATUS_DIFFERENT;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        printf("%-17s %s\n", method->name, method->summary);
        for (const SettingSpec *setting = method->settings; setting != NULL && setting->key != NULL; setting++)
            printf("    %s: %s\n", setting->key, setting->summary);
        if (method->twin != NULL)
            printf("    Without its learned part: %s, with the same settings otherwise.\n", method->twin);
    }
    return STATUS_SAME;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/options.h"
#include "simulate/method.h"

#include <stdio.h>

static const CommandSpec spec = {
    .options = (const Option[]){{0}},
    .help = "List the methods and their settings. A method is given as NAME or NAME:KEY=VALUE,...\v"
            "Example: twinbox simulate scenes/stack.yaml --method engine:k=50 -o stack50.npz"};

bool command_methods(int argc, char **argv, Error *error) {
    if (!options_parse(&spec, argc, argv, NULL, error)) return false;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        printf("%-17s %s\n", method->name, method->summary);
        for (const SettingSpec *setting = method->settings; setting != NULL && setting->key != NULL; setting++)
            printf("    %s: %s\n", setting->key, setting->summary);
        if (method->twin != NULL)
            printf("    Without its learned part: %s, with the same settings otherwise.\n", method->twin);
    }
    return true;
}

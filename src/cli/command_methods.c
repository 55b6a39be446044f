/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox methods: lists the registry. */
#include "base/base.h"
#include "base/json.h"
#include "cli/cli.h"
#include "cli/json_output.h"
#include "cli/options.h"
#include "methods/methods.h"

typedef struct Options {
    bool json;
} Options;

static const Option option_table[] = {{OPTION_JSON(Options, json)}, {0}};

static const CommandSpec spec = {
    .options = option_table,
    .help = "List the methods and their settings. A method is given as NAME or NAME:KEY=VALUE,...\v"
            "Example: twinbox simulate stack --method engine:k=50 -o stack50.npz\n"
            "An installed program finds its networks in any folder:\n"
            "network=scenes/networks/NAME.npz"};

static void write_methods(JsonWriter *json, const void *context) {
    (void)context;
    json_begin_array(json, "methods", JSON_LINES);
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        json_begin_object(json, NULL, JSON_LINES);
        json_put_text(json, "name", method->name);
        json_put_text(json, "summary", method->summary);
        json_put_bool(json, "contact_solver", kind->solver != NULL);
        json_put_bool(json, "needs_network", method->needs_network);
        json_put_text(json, "without_learned_part", method->twin);
        json_begin_array(json, "settings", JSON_LINES);
        for (const SettingSpec *setting = method->settings; setting != NULL && setting->key != NULL; setting++) {
            json_begin_object(json, NULL, JSON_ONE_LINE);
            json_put_text(json, "key", setting->key);
            json_put_text(json, "summary", setting->summary);
            json_end(json);
        }
        json_end(json);
        json_end(json);
    }
    json_end(json);
}

bool command_methods(int argc, char **argv, Error *error) {
    Options options = {.json = false};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (options.json) return json_output("twinbox methods 1", write_methods, NULL, error);
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

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox new: writes a template of a scene. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/notes.h"
#include "cli/options.h"

#include <string.h>

#define TEMPLATE_NAME(name) #name,
#define TEMPLATE_TEXT(name) template_##name##_yaml,
static const char *const names[] = {TEMPLATES(TEMPLATE_NAME) NULL};
static const char *const texts[] = {TEMPLATES(TEMPLATE_TEXT) NULL};

typedef struct Options {
    const char *path;
    unsigned like; /* index of names */
} Options;

static const Option option_table[] = {{"--like", 0, "KIND",
                                       "wall, stack, pyramid, arch, dominoes, towers, gate, cardhouse or pile",
                                       OPTION_ENUM(Options, like, names), .needed = "--like KIND is needed"},
                                      {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "SCENE.yaml", .needed = "the name of the scene to write is needed", OPTION_TEXT(Options, path)},
    .inputs = {1, 1, "scene"},
    .help =
        "Write a scene to start from: a structure, a bomb with a family of launches, and parameters, with comments. "
        "Never overwrites a file; - writes to standard output.\v"
        "Example: twinbox new wall.yaml --like wall"};

bool command_new(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    const char *text = texts[options.like];
    if (strcmp(options.path, "-") == 0) return fputs(text, stdout) >= 0 || error_system(error, "-", "cannot write");
    if (!file_name_ends_with(options.path, ".yaml"))
        return error_input(error, options.path, "the name of a scene must end in .yaml");
    if (!file_create(options.path, text, strlen(text), error)) return false;
    if (note_level() > NOTES_QUIET) printf("%s -> %s\n", names[options.like], options.path);
    next_print((const char *const[]){"check", options.path, NULL});
    return true;
}
